//! Frames make no pipeline, bind group or buffer and never wait, while nothing is resized.

use assign::{
    EncoderPasses, Frame, Gpu, Hitches, Light, LightBuffer, LightKinds, LightOrder, LightTraits,
    ModelBox, SampleDomain, View,
};
use glam::{Mat4, Vec3};
use harness::strategy::Row;

use crate::stage::{Contender, contender, contenders, lights, scene, view};

const SIZE: [u32; 2] = [64, 48];
/// Frames until buffers have their sizes: a whole round of the camera and the lights.
const WARM_UP: u32 = 25;
const FRAMES: u32 = 100;

/// What the depth images of a frame hold.
#[derive(Clone, Copy, Debug)]
enum Depths {
    OneSample,
    SeveralSamples,
    Layers,
}

/// Images of the surfaces. Nothing is drawn to them, for it does not matter where surfaces are.
struct Images {
    /// Depth, normals and base colours.
    surfaces: [wgpu::TextureView; 3],
    several_samples: wgpu::TextureView,
    layers: [wgpu::TextureView; 2],
}

impl Images {
    fn new(gpu: &Gpu) -> Self {
        let image = |format, sample_count| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        use wgpu::TextureFormat::{Depth32Float, Rgba8Unorm, Rgba16Float};
        Self {
            surfaces: [Depth32Float, Rgba16Float, Rgba8Unorm].map(|format| image(format, 1)),
            several_samples: image(Depth32Float, 4),
            layers: [0, 1].map(|_| image(Depth32Float, 1)),
        }
    }

    fn frame<'a>(
        &'a self,
        view: &'a View,
        lights: &'a LightBuffer,
        models: &'a [ModelBox],
        (depths, layers): (Depths, &'a [&'a wgpu::TextureView]),
    ) -> Frame<'a> {
        let [depth, normals, base_color] = &self.surfaces;
        let frame = Frame::new(view, lights)
            .with_depth(depth)
            .with_normals(normals)
            .with_base_color(base_color)
            .with_models(models)
            .with_surface_bounds(Vec3::splat(-50.0), Vec3::splat(50.0));
        match depths {
            Depths::OneSample => frame,
            Depths::SeveralSamples => {
                frame.with_depth(&self.several_samples).sampled_at(SampleDomain::NearSurfaces)
            }
            Depths::Layers => frame.with_layer_depths(layers).sampled_at(SampleDomain::InFront),
        }
    }
}

/// A renderer that moves its camera and its lights in every frame.
struct Living {
    gpu: Gpu,
    images: Images,
    depths: Depths,
    given: Vec<Light>,
    buffer: LightBuffer,
    views: Vec<View>,
    models: Vec<ModelBox>,
}

impl Living {
    fn new(gpu: &Gpu, order: LightOrder) -> Self {
        let scene = scene();
        let models = scene.bounds;
        Self {
            gpu: gpu.clone(),
            images: Images::new(gpu),
            depths: Depths::OneSample,
            given: lights(&scene, 60),
            buffer: LightBuffer::ordered(gpu, &[], order).expect("lights"),
            views: (0..WARM_UP).map(|i| view(&scene, 1e-3 * i as f32, SIZE)).collect(),
            models: vec![ModelBox::new(Mat4::IDENTITY, models.min, models.max)],
        }
    }

    /// Draws a frame. With `spot`, the last light is a spot, and else a point.
    fn draw(&mut self, contender: &mut Contender, number: u32, has_spot: bool) -> Hitches {
        let before = self.gpu.hitches();
        let phase = (number % WARM_UP) as f32;
        let mut moved = self.given.clone();
        for (light, i) in moved.iter_mut().zip(0..) {
            light.position.x += 0.1 * (phase + i as f32).sin();
        }
        if !has_spot && let Some(last) = moved.last_mut() {
            last.shape = assign::LightShape::Point;
        }
        self.buffer.update(&self.gpu, &moved).expect("updates");
        let view = &self.views[(number % WARM_UP) as usize];
        let layers = self.images.layers.each_ref();
        let depths = (self.depths, &layers[..]);
        let frame = self.images.frame(view, &self.buffer, &self.models, depths);
        contender.strategy.prepare(&self.gpu, &frame).expect("prepares");
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        self.buffer.record(&mut passes);
        contender.strategy.record(&frame, &mut passes);
        self.gpu.queue.submit([encoder.finish()]);
        let made = self.gpu.hitches().since(before);
        // A renderer waits for its frames elsewhere.
        self.gpu.wait().expect("waits");
        made
    }
}

#[test]
fn a_hundred_frames_of_moving_lights_and_camera_make_nothing_and_never_wait() {
    // What the CPU makes does not depend on what the GPU runs.
    let gpu = Gpu::noop().expect("a device");
    let mut tested = 0;
    for order in [LightOrder::Given, LightOrder::Gpu { every: 1 }] {
        for mut contender in contenders(&gpu) {
            let mut living = Living::new(&gpu, order);
            for number in 0..WARM_UP {
                living.draw(&mut contender, number, true);
            }
            for number in WARM_UP..WARM_UP + FRAMES {
                let made = living.draw(&mut contender, number, true);
                assert_eq!(made, Hitches::default(), "{}, {order}, frame {number}", contender.id);
            }
            tested += 1;
        }
    }
    assert!(tested > 60, "{tested} strategies");
}

/// A lamp that is the last spot flickers. What is compiled ahead is not compiled in a frame.
#[test]
fn kinds_of_lights_are_compiled_once_and_ahead_if_asked() {
    let gpu = Gpu::open(None).expect("an adapter");
    let order = LightOrder::Gpu { every: 1 };
    let ids = ["SC-E/bvh", "T-E", "G", "HG", "HG/raster", "SC-I/bvh/touched"];
    let default_id = |id: &str| harness::strategy::row(id).map_or(id.to_owned(), Row::default_id);
    let kinds = [false, true].map(|spots| LightKinds { spots, ..LightKinds::default() });
    for id in ids {
        // Another device: what it compiled before does not count.
        let gpu = Gpu::new(gpu.device.clone(), gpu.queue.clone(), gpu.info.clone());
        let id = default_id(id);
        let mut ahead = contender(&gpu, &id).expect("a strategy");
        let mut living = Living::new(&gpu, order);
        living.draw(&mut ahead, 0, true);
        living.buffer.compile(&gpu, kinds[0]).expect("compiles");
        for kinds in kinds {
            ahead.strategy.compile(&gpu, LightTraits::from(kinds)).expect("compiles");
        }
        let compiled = |made: Hitches| made.pipelines + made.modules;
        let flicker = |living: &mut Living, contender: &mut Contender| -> Vec<u64> {
            (1..9).map(|n| compiled(living.draw(contender, n, n % 2 == 0))).collect()
        };
        assert_eq!(flicker(&mut living, &mut ahead), [0; 8], "{id}, compiled ahead");
        // Not compiled ahead: the first frame without a spot compiles, and no other does.
        let gpu = Gpu::new(gpu.device.clone(), gpu.queue.clone(), gpu.info.clone());
        let mut late = contender(&gpu, &id).expect("a strategy");
        let mut living = Living::new(&gpu, order);
        living.draw(&mut late, 0, true);
        let made = flicker(&mut living, &mut late);
        assert!(made[0] > 0, "{id} compiles the kernel for points");
        assert_eq!(made[1..], [0; 7], "{id}, compiled in a frame");
    }
}

/// What a strategy binds is counted: a new view of the depth buffer needs a new bind group.
#[test]
fn a_new_view_of_the_depth_buffer_in_each_frame_is_found() {
    let gpu = Gpu::open(None).expect("an adapter");
    let mut living = Living::new(&gpu, LightOrder::Given);
    let mut contender = contender(&gpu, "T-E/28x28").expect("tiles");
    living.draw(&mut contender, 0, true);
    living.draw(&mut contender, 1, true);
    assert_eq!(living.draw(&mut contender, 2, true), Hitches::default());
    let texture = living.images.surfaces[0].texture().clone();
    living.images.surfaces[0] = texture.create_view(&wgpu::TextureViewDescriptor::default());
    assert_eq!(living.draw(&mut contender, 3, true).bind_groups, 1);
}

/// A renderer may alternate between frames with several samples per pixel and frames with glass.
#[test]
fn kernels_and_bind_groups_of_all_kinds_of_depth_stay() {
    let gpu = Gpu::open(None).expect("an adapter");
    for id in ["SC-E", "DC-E", "DA-E", "HC", "T-E", "G/8x8x8/visible"] {
        let id = harness::strategy::row(id).map_or(id.to_owned(), Row::default_id);
        let mut contender = contender(&gpu, &id).expect("a strategy");
        let mut living = Living::new(&gpu, LightOrder::Given);
        let mut number = 0;
        let mut draw_all = |living: &mut Living| {
            [Depths::OneSample, Depths::SeveralSamples, Depths::Layers].map(|depths| {
                living.depths = depths;
                number += 1;
                living.draw(&mut contender, number, true)
            })
        };
        let made = draw_all(&mut living);
        assert!(made[1].bind_groups > 0, "{id} binds another depth buffer: {made:?}");
        for _ in 0..WARM_UP {
            draw_all(&mut living);
        }
        for _ in 0..4 {
            assert_eq!(draw_all(&mut living), [Hitches::default(); 3], "{id}");
        }
    }
}
