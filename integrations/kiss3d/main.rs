//! kiss3d draws a scene without a window, whose material looks lights up in lightbench's clusters.
//!
//! `scripts/kiss3d` runs it. It draws three frames of moving lights with one and with four samples per pixel, once by lists
//! and once by a loop over all lights, and compares the images. It fails if a pixel differs. With a path, it also
//! writes the last image there.

mod clusters;
mod lit;

use std::{cell::RefCell, error::Error, process::ExitCode, rc::Rc};

use assign::{glam::Vec3, wgpu};
use kiss3d::{
    event::WindowEvent,
    prelude::{
        Camera3d, Color, Context, Light, LightCollection, Material3d, NumSamples, OffscreenSurface,
        OrbitCamera3d, RenderContext, RenderPhase, SceneNode3d,
    },
};

use clusters::Clusters;
use lit::{Draws, Lit, Shared};

const SIZE: [u32; 2] = [320, 200];
const LIGHTS: u32 = 200;

/// A scene of kiss3d whose objects have the material.
struct Scene {
    root: SceneNode3d,
    lights: Vec<SceneNode3d>,
    camera: OrbitCamera3d,
    shared: Rc<RefCell<Shared>>,
}

impl Scene {
    /// A floor with pillars. `most` loses lights.
    fn new(sample_count: u32, most: Option<u32>) -> Result<Self, Box<dyn Error>> {
        let clusters = Clusters::new(sample_count, most)?;
        let shared = Rc::new(RefCell::new(Shared { clusters, draws: Draws::Depth }));
        let lit: Box<dyn Material3d> = Box::new(Lit::new(shared.clone())?);
        let lit = Rc::new(RefCell::new(lit));
        let mut root = SceneNode3d::empty();
        let mut cube = |size: Vec3, at: Vec3, color: Color| {
            let mut node = root.add_cube(size.x, size.y, size.z);
            node.set_material(lit.clone()).set_position(at).set_color(color);
        };
        let grey = Color::new(0.7, 0.7, 0.7, 1.0);
        cube(Vec3::new(24.0, 0.2, 24.0), Vec3::new(0.0, -0.1, 0.0), grey);
        for i in 0..16 {
            let height = 1.5 + 0.5 * (i % 3) as f32;
            let (x, z) = ((i % 4) as f32 * 5.0 - 7.5, (i / 4) as f32 * 5.0 - 7.5);
            let color = Color::new(0.9, 0.5 + 0.1 * (i % 4) as f32, 0.4, 1.0);
            cube(Vec3::new(1.0, height, 1.0), Vec3::new(x, height / 2.0, z), color);
        }
        let light = |i: u32| {
            let hue = |shift: f32| 0.5 + 0.4 * (i as f32 * 2.4 + shift).sin();
            let color = Color::new(hue(0.0), hue(2.0), hue(4.0), 1.0);
            let radius = 1.5 + (i % 3) as f32;
            let light = Light::point(radius).with_color(color).with_intensity(0.5);
            root.add_light(light.with_casts_shadows(false))
        };
        let lights = (0..LIGHTS).map(light).collect();
        let camera = OrbitCamera3d::new_with_frustum(
            0.9,
            0.1,
            100.0,
            Vec3::new(9.0, 5.0, 11.0),
            Vec3::new(0.0, 0.5, 0.0),
        );
        Ok(Self { root, lights, camera, shared })
    }

    fn move_lights(&mut self, time: f32) {
        for (i, light) in self.lights.iter_mut().enumerate() {
            let phase = i as f32 * 2.399_963;
            let radius = 12.0 * ((i as f32 + 0.5) / LIGHTS as f32).sqrt();
            let angle = phase + 0.3 * time;
            let height = 0.4 + 0.3 * (1.0 + (phase + time).sin());
            light.set_position(Vec3::new(radius * angle.cos(), height, radius * angle.sin()));
        }
    }

    /// Draws the depth of the surfaces into kiss3d's depth buffer, and makes the lists from it. It runs before kiss3d's
    /// own frame.
    fn make_lists(&mut self, surface: &OffscreenSurface) -> Result<(), Box<dyn Error>> {
        let Self { root, camera, shared, .. } = self;
        let canvas = surface.window().canvas();
        let depth = canvas.depth_view().clone();
        let [width, height] = SIZE;
        camera.handle_event(canvas, &WindowEvent::FramebufferSize(width, height));
        camera.update(canvas);
        let mut lights = LightCollection::new();
        root.data_mut().prepare(0, camera, &mut lights, width, height);
        let view = shared.borrow_mut().clusters.prepare(camera, &lights.lights, &depth)?;

        let mut encoder = Context::get().create_command_encoder(Some("lists"));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        let context = RenderContext {
            phase: RenderPhase::Opaque,
            surface_format: Context::render_format(),
            sample_count: surface.samples(),
            viewport_width: width,
            viewport_height: height,
            render_layers: camera.render_layers(),
            force_no_cull: false,
            shadow: None,
        };
        shared.borrow_mut().draws = Draws::Depth;
        root.data_mut().render(0, camera, &lights, &mut pass, &context);
        drop(pass);
        shared.borrow_mut().clusters.record(&view, &depth, &mut encoder);
        Context::get().submit([encoder.finish()]);
        Ok(())
    }

    /// kiss3d's own frame, after its tone mapping: three bytes per pixel.
    async fn draw(&mut self, surface: &mut OffscreenSurface, draws: Draws) -> Vec<u8> {
        self.shared.borrow_mut().draws = draws;
        surface.render_3d(&mut self.root, &mut self.camera).await;
        surface.snap_image().into_raw()
    }
}

/// Draws three frames, and returns how many pixels differ, and how many are lit.
async fn compare(
    surface: &mut OffscreenSurface,
    most: Option<u32>,
) -> Result<(usize, usize), Box<dyn Error>> {
    let mut scene = Scene::new(surface.samples(), most)?;
    let (mut differing, mut lit) = (0, 0);
    for frame in 0..3 {
        scene.move_lights(frame as f32);
        scene.make_lists(surface)?;
        let listed = scene.draw(surface, Draws::ListedLights).await;
        let all = scene.draw(surface, Draws::AllLights).await;
        let pixels = || listed.chunks_exact(3).zip(all.chunks_exact(3));
        differing += pixels().filter(|(listed, all)| listed != all).count();
        lit += pixels().filter(|(_, all)| all.iter().any(|value| *value > 64)).count();
    }
    Ok((differing, lit))
}

async fn run() -> Result<bool, Box<dyn Error>> {
    let [width, height] = SIZE;
    let mut surface = OffscreenSurface::new(width, height).await;
    surface.set_shadows_enabled(false);
    let pixels = 3 * (width * height) as usize;
    let mut is_right = true;
    for samples in [NumSamples::One, NumSamples::Four] {
        surface.set_samples(samples);
        let (differing, lit) = compare(&mut surface, None).await?;
        let (lossy, _) = compare(&mut surface, Some(LIGHTS / 2)).await?;
        println!(
            "kiss3d, {} samples per pixel, {LIGHTS} lights, 3 frames: {differing} of {pixels} pixels differ from all \
             lights; {lit} are lit. With half of the lights lost, {lossy} differ",
            surface.samples(),
        );
        is_right &= differing == 0 && 2 * lit > pixels && lossy > 0;
    }
    if let Some(path) = std::env::args().nth(1) {
        surface.snap_image().save(&path)?;
    }
    Ok(is_right)
}

fn main() -> ExitCode {
    match pollster::block_on(run()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("kiss3d: the images are wrong");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("kiss3d: {error}");
            ExitCode::FAILURE
        }
    }
}
