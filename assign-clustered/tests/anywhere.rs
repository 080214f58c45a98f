//! Look-ups at samples that are not in the depth buffer lose no light, whether the frame states them or not.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Frame, Gpu, LightBuffer,
    SampleDomain, Shader, Storage, View, conformance,
};
use assign_clustered::{ClusterOptions, Clustered, HybridGrid, Occupancy, Slices};
use glam::Vec3;

const FOUND_FROM_SAMPLES: [(Bounds, Occupancy); 5] = [
    (Bounds::Explicit, Occupancy::Dense),
    (Bounds::Implicit, Occupancy::Sparse),
    (Bounds::Explicit, Occupancy::Sparse),
    (Bounds::Implicit, Occupancy::DepthAware),
    (Bounds::Explicit, Occupancy::DepthAware),
];

fn options((bounds, occupancy): (Bounds, Occupancy)) -> ClusterOptions {
    let size = "16x16x8".parse().unwrap();
    ClusterOptions::new(size, bounds, occupancy, CullSettings::default())
}

fn clustered(options: ClusterOptions) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Clustered::with_options(gpu, options)?))
}

#[test]
fn clusters_lose_no_light_in_front_of_surfaces() {
    for variant in [FOUND_FROM_SAMPLES[2], FOUND_FROM_SAMPLES[4]] {
        conformance::run_in_front(&clustered(options(variant))).expect("conforms");
    }
}

#[test]
fn look_ups_that_no_frame_stated_lose_no_light() {
    let found_from_view = (Bounds::Implicit, Occupancy::Dense);
    for variant in FOUND_FROM_SAMPLES.into_iter().chain([found_from_view]) {
        conformance::run_unstated(&clustered(options(variant))).expect("conforms");
    }
    let sparse = options((Bounds::Explicit, Occupancy::Sparse));
    let masks = CullSettings { storage: Storage::Masks, ..CullSettings::default() };
    for options in [
        ClusterOptions { settings: masks, ..sparse },
        ClusterOptions { slices: Slices::Cascaded(2), ..sparse },
    ] {
        conformance::run_unstated(&clustered(options)).expect("conforms");
    }
    conformance::run_unstated(&|gpu| Ok(Box::new(HybridGrid::new(gpu, "16x16x8".parse()?)?)))
        .expect("conforms");
}

/// A layer's samples are part of the bounds: their clusters have lists of their own.
#[test]
fn clusters_hold_the_samples_of_layers() {
    let gpu = Gpu::open(None).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let light = assign::Light::point(Vec3::ZERO, 50.0, Vec3::ONE);
    let lights = LightBuffer::new(&gpu, &[light; 3]).unwrap();
    let [wall, glass] = [0.05, 0.2].map(|depth| conformance::flat_depth(&gpu, [64, 48], depth));
    for (variant, with_layers) in [
        (FOUND_FROM_SAMPLES[0], 24),
        (FOUND_FROM_SAMPLES[1], 24),
        (FOUND_FROM_SAMPLES[2], 24),
        // One workgroup reads one tile of one image.
        (FOUND_FROM_SAMPLES[4], 12),
    ] {
        let mut strategy = clustered(options(variant))(&gpu).unwrap();
        let mut occupied = |layers: &[&wgpu::TextureView]| {
            let frame = Frame::new(&view, &lights)
                .sampled_at(SampleDomain::InFront)
                .with_depth(&wall)
                .with_layer_depths(layers);
            strategy.prepare(&gpu, &frame).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            strategy.lists().snapshot(&gpu).unwrap().counters.occupied_groups
        };
        let found = [occupied(&[]), occupied(&[&glass]), occupied(&[])];
        assert_eq!(found, [12, with_layers, 12], "{variant:?}: 4 x 3 tiles");
    }
}

/// A look-up that reads only the depth buffer's samples pays nothing for the others.
#[test]
fn only_shaders_that_look_up_anywhere_read_the_boxes() {
    let root = "import package::look_up::{next_light, open_lights};
        import package::sample::sample_at;
        @group(2) @binding(0) var<storage, read_write> found: array<u32>;
        @compute @workgroup_size(1) fn run() {
          var cursor = open_lights(sample_at(vec2f(0.5), 0.5, vec3f(0.0), 0u));
          if next_light(&cursor) { found[0] = cursor.entry; }
        }";
    let gpu = Gpu::noop().unwrap();
    for variant in FOUND_FROM_SAMPLES {
        let strategy = clustered(options(variant))(&gpu).unwrap();
        let shader = Shader::new(1).module("package::root", root);
        let shader = shader.strategy(strategy.lookup().module);
        let plain = shader.link("package::root").unwrap();
        let anywhere = shader.looks_up_anywhere().link("package::root").unwrap();
        assert!(!plain.contains("marks"), "{plain}");
        assert_eq!(anywhere.contains("marks"), variant.0 == Bounds::Explicit, "{anywhere}");
    }
}
