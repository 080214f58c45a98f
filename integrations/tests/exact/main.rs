//! The image of the forward renderer in `examples/forward.rs` equals that of its own loop over all lights, in every bit.
//!
//! The device has the limits of WebGPU. Every image shows opaque surfaces, and glass through a second look-up. With four
//! samples per pixel, each sample is compared.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, Bounds, CullSettings, DepthMapping, Fewer, Gpu, GpuLights, Kept,
    LightBuffer, LightKinds, LightOrder, Projection, View, entry,
    kernel::{self, Slot},
};
use assign_clustered::{Clustered, Occupancy};
use assign_tiled::Tiled;
use glam::{Vec2, Vec3};
use integrations::{Draw, Shot, Target, lights_at, open_device, split_screen};

#[allow(dead_code, reason = "a test runs no main function")]
#[path = "../../examples/forward.rs"]
mod forward;

mod engine;
mod never_ordered;

use engine::VIEWPORT;
use forward::Forward;

const SIZE: [u32; 2] = [128, 48];
const LIGHTS: u32 = 150;

type Made = Result<Box<dyn Assignment>, AssignError>;

fn tiles(gpu: &Gpu, bounds: Bounds) -> Made {
    Ok(Box::new(Tiled::new(gpu, "16x16".parse()?, bounds, CullSettings::default())?))
}

fn clusters(gpu: &Gpu, bounds: Bounds, occupancy: Occupancy) -> Made {
    let (size, settings) = ("16x16x12".parse()?, CullSettings::default());
    Ok(Box::new(Clustered::new(gpu, size, bounds, occupancy, settings)?))
}

/// Makes a strategy for opaque surfaces.
type Make = fn(&Gpu) -> Made;

/// All kinds of tiles and clusters, by implicit and by explicit bounds.
const STRATEGIES: [(&str, Make); 8] = [
    ("T-I", |gpu| tiles(gpu, Bounds::Implicit)),
    ("T-E", |gpu| tiles(gpu, Bounds::Explicit)),
    ("DC-I", |gpu| clusters(gpu, Bounds::Implicit, Occupancy::Dense)),
    ("DC-E", |gpu| clusters(gpu, Bounds::Explicit, Occupancy::Dense)),
    ("SC-I", |gpu| clusters(gpu, Bounds::Implicit, Occupancy::Sparse)),
    ("SC-E", |gpu| clusters(gpu, Bounds::Explicit, Occupancy::Sparse)),
    ("DA-I", |gpu| clusters(gpu, Bounds::Implicit, Occupancy::DepthAware)),
    ("DA-E", |gpu| clusters(gpu, Bounds::Explicit, Occupancy::DepthAware)),
];

/// A renderer and its target.
struct Rig {
    gpu: Gpu,
    renderer: Forward,
    target: Target,
}

impl Rig {
    /// `make` makes the strategy of opaque surfaces. Glass reads dense clusters.
    fn new(gpu: &Gpu, depth: DepthMapping, cameras: usize, make: &dyn Fn(&Gpu) -> Made) -> Self {
        Self::with_samples(gpu, depth, cameras, 1, make)
    }

    /// A rig whose target has `samples` samples per pixel.
    fn with_samples(
        gpu: &Gpu,
        depth: DepthMapping,
        cameras: usize,
        samples: u32,
        make: &dyn Fn(&Gpu) -> Made,
    ) -> Self {
        // Blending in half floats rounds, so that a weak light might not show.
        let is_blendable = gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE);
        let format = match (samples, is_blendable) {
            (1, true) => wgpu::TextureFormat::Rgba32Float,
            (1, false) => wgpu::TextureFormat::Rgba16Float,
            // Four channels of 32 bits have no multisampling. Every light has some red.
            (_, true) => wgpu::TextureFormat::R32Float,
            (_, false) => wgpu::TextureFormat::R16Float,
        };
        let both = |gpu: &Gpu| Ok([make(gpu)?, clusters(gpu, Bounds::Implicit, Occupancy::Dense)?]);
        let draw = Draw { format, samples, depth, is_glass: false };
        let renderer = Forward::new(gpu, draw, cameras, &both).unwrap();
        Self { gpu: gpu.clone(), renderer, target: Target::new(gpu, format, SIZE, samples) }
    }

    fn read(&self) -> Vec<u8> {
        match self.target.color.sample_count() {
            1 => self.target.read(&self.gpu),
            _ => self.target.read_samples(&self.gpu),
        }
        .unwrap()
    }

    /// Draws once by lists and once by the renderer's own loop, and counts the pixels that differ.
    fn differing(&mut self, lights: &LightBuffer, shots: &[Shot]) -> usize {
        assert!(lights.rejected().is_empty(), "both images lack what the buffer refused");
        let mut image = |own_loop| {
            let Self { gpu, renderer, target } = self;
            renderer.draw(gpu, target, lights, shots, own_loop).unwrap();
            self.read()
        };
        let (listed, all) = (image(false), image(true));
        let texel = listed.len() / (SIZE[0] * SIZE[1]) as usize;
        let pixels = || listed.chunks_exact(texel).zip(all.chunks_exact(texel));
        let lit =
            all.chunks_exact(texel).filter(|p| p[..texel / 2].iter().any(|b| *b != 0)).count();
        let viewports = shots.iter().map(|shot| shot.view.viewport);
        let shown: u32 = viewports.map(|viewport| viewport.width * viewport.height).sum();
        assert!(2 * lit > shown as usize, "{lit} of {shown} pixels are lit: {shots:?}");
        pixels().filter(|(listed, all)| listed != all).count()
    }
}

/// Reversed depth with an infinitely far plane, a viewport with an offset, two cameras in one submission, moving lights.
#[test]
fn two_cameras_and_moving_lights_are_exact_with_every_strategy() {
    let gpu = open_device().unwrap();
    assert_eq!(gpu.device.limits().max_storage_buffers_per_shader_stage, 8);
    let mut lights =
        LightBuffer::ordered(&gpu, &lights_at(0.0, LIGHTS), LightOrder::Gpu { every: 1 }).unwrap();
    for (name, make) in STRATEGIES {
        let mut rig = Rig::new(&gpu, DepthMapping::Reversed, 2, &make);
        for frame in 0..3 {
            lights.update(&gpu, &lights_at(frame as f32, LIGHTS)).unwrap();
            let differing = rig.differing(&lights, &split_screen(SIZE));
            assert_eq!(differing, 0, "{name}, frame {frame}");
        }
    }
}

/// Views made from parameters.
fn own_views() -> [View; 3] {
    let base = split_screen(SIZE)[0].view;
    let window = Projection::Perspective { min: Vec2::new(-0.7, -0.45), max: Vec2::new(0.9, 0.2) };
    let standard =
        View { viewport: VIEWPORT, depth: DepthMapping::Standard, far_m: Some(60.0), ..base };
    let (min, max) = (Vec2::new(-9.0, -5.0), Vec2::new(9.0, 3.0));
    [
        View { projection: window, jitter: Vec2::new(0.3, -0.2), ..standard },
        View { projection: Projection::Orthographic { min, max }, ..standard },
        View { projection: window, depth: DepthMapping::Reversed, ..standard },
    ]
}

/// Draws shots with every strategy, and returns the strategies and shots that differ. Shots of one direction of depth share
/// a renderer.
fn differing_shots(gpu: &Gpu, samples: u32, shots: &[(&'static str, Shot)]) -> Vec<String> {
    let lights = LightBuffer::new(gpu, &lights_at(0.0, LIGHTS)).unwrap();
    let mut differing = Vec::new();
    for (name, make) in STRATEGIES {
        for depth in [DepthMapping::Standard, DepthMapping::Reversed] {
            let mut rig = Rig::with_samples(gpu, depth, 1, samples, &make);
            for (shown, shot) in shots.iter().filter(|(_, shot)| shot.view.depth == depth) {
                let pixels = rig.differing(&lights, &[*shot]);
                if pixels > 0 {
                    differing.push(format!("{name}, {shown}: {pixels} pixels"));
                }
            }
        }
    }
    differing
}

#[test]
fn own_projections_and_viewports_are_exact_with_every_strategy() {
    let gpu = open_device().unwrap();
    let names = ["off-centre with jitter", "orthographic", "off-centre reversed"];
    let views = own_views().map(Shot::from);
    let shots: Vec<_> = names.into_iter().zip(views).collect();
    assert_eq!(differing_shots(&gpu, 1, &shots), Vec::<String>::new());
}

/// The renderer draws with its own matrices, and the view is made from them.
#[test]
fn views_of_own_matrices_are_exact_with_every_strategy() {
    let gpu = open_device().unwrap();
    assert_eq!(differing_shots(&gpu, 1, &engine::shots()), Vec::<String>::new());
}

/// Fragments of four samples per pixel are shaded at the pixel's centre, also where their triangle does not cover it.
#[test]
fn four_samples_per_pixel_are_exact_with_every_strategy() {
    let gpu = open_device().unwrap();
    // Such fragments of an orthographic view may lie behind the eye, which these strategies refuse.
    let taken = ["reversed infinite", "standard finite", "oblique", "OpenGL perspective"];
    let mut shots = engine::shots().to_vec();
    shots.retain(|(name, _)| taken.contains(name));
    assert_eq!(shots.len(), taken.len());
    // The near plane cuts pillars and glass. Fragments at the cut may lie in front of it.
    let cut = split_screen(SIZE)[0].view;
    shots.push(("cut", Shot::from(View { near_m: 4.0, ..cut })));
    assert_eq!(differing_shots(&gpu, 4, &shots), Vec::<String>::new());
}

/// A kernel of the renderer that writes lights.
const MAKE_LIGHTS: &str = "
struct Sphere { position: vec3f, radius_m: f32 }
struct Emission { intensity: vec3f, kind_and_shape: u32 }
@group(0) @binding(0) var<storage, read_write> spheres: array<Sphere>;
@group(0) @binding(1) var<storage, read_write> emissions: array<Emission>;
@group(0) @binding(2) var<storage, read_write> count: u32;
@compute @workgroup_size(64)
fn make(@builtin(global_invocation_id) thread: vec3u) {
  let i = thread.x;
  if i >= arrayLength(&spheres) { return; }
  let across = vec2f(f32(i % 15u), f32(i / 15u)) * 1.5 - 10.0;
  spheres[i] = Sphere(vec3f(across.x, 0.7 + 0.1 * f32(i % 4u), across.y), 1.0 + f32(i % 3u));
  emissions[i] = Emission(vec3f(0.2, 0.1 * f32(i % 5u), 0.3), 0u);
  count = arrayLength(&spheres);
}";

#[test]
fn lights_made_by_the_gpu_are_exact_with_every_strategy() {
    let gpu = open_device().unwrap();
    let [spheres, emissions] =
        ["spheres", "emissions"].map(|name| gpu.storage(name, u64::from(LIGHTS) * 16).unwrap());
    let (shapes, count) = (gpu.storage("shapes", 16).unwrap(), gpu.storage("count", 4).unwrap());
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(MAKE_LIGHTS.into()),
    });
    let layout = kernel::layout(&gpu, "make", wgpu::ShaderStages::COMPUTE, &[Slot::Write; 3]);
    let pipeline = kernel::pipeline(&gpu, &module, "make", &[&layout]);
    let buffers = [&spheres, &emissions, &count];
    let entries: Vec<_> = (0..).zip(buffers).map(|(ix, buffer)| entry(ix, buffer)).collect();
    let group = kernel::bind_entries(&gpu, &layout, &entries);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(LIGHTS.div_ceil(64), 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);

    let described = GpuLights {
        spheres: &spheres,
        emissions: &emissions,
        shapes: &shapes,
        count: &count,
        count_offset: 0,
        capacity: LIGHTS,
        kinds: LightKinds::default(),
        bounds: (Vec3::splat(-20.0), Vec3::splat(20.0)),
        radius_max_m: 4.0,
        step_max_m: None,
    };
    let lights = LightBuffer::from_gpu(&gpu, &described, 1).unwrap();
    for (name, make) in STRATEGIES {
        let mut rig = Rig::new(&gpu, DepthMapping::Reversed, 2, &make);
        assert_eq!(rig.differing(&lights, &split_screen(SIZE)), 0, "{name}");
    }
    assert_eq!(lights.read_counts(&gpu).unwrap().unwrap().faulty, 0);
}

/// The comparison sees lost lights.
#[test]
fn lists_that_lose_lights_differ() {
    let gpu = open_device().unwrap();
    let lights = LightBuffer::new(&gpu, &lights_at(0.0, LIGHTS)).unwrap();
    let lossy = |gpu: &Gpu| -> Made {
        let inner = clusters(gpu, Bounds::Explicit, Occupancy::Sparse)?;
        Ok(Box::new(Fewer::new(gpu, inner, Kept::First, LIGHTS / 2)?))
    };
    for samples in [1, 4] {
        let mut rig = Rig::with_samples(&gpu, DepthMapping::Reversed, 2, samples, &lossy);
        assert!(rig.differing(&lights, &split_screen(SIZE)) > 0, "{samples} samples");
    }
}

/// What is marked as integration in the example, without empty lines and marks.
#[test]
fn integration_takes_under_120_lines() {
    let source = include_str!("../../examples/forward.rs");
    let mut counted = 0;
    let mut marks = source.split("// integration: begin");
    assert!(marks.next().is_some());
    for part in marks {
        let (inside, _) = part.split_once("// integration: end").expect("an end of each mark");
        counted += inside.lines().filter(|line| !line.trim().is_empty()).count();
    }
    assert!((30..120).contains(&counted), "{counted} lines");
}
