//! SC-E with a specular reach conforms, and lists lights beyond their range for their specular term only, as far as the
//! group's surfaces need.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    AssignError, Assignment, Bounds, CullSettings, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR,
    EncoderPasses, Frame, Gpu, Light, LightBuffer, LightShape, LightSource, Storage, Touched, View,
    conformance::{self, faulty::Fault, flat_depth, flat_half_floats},
};
use assign_clustered::{ClusterOptions, Clustered, Normals, Occupancy, Slices, SpecularCut};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];
const BOTH: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;
const SOURCES: [LightSource; 2] = [LightSource::Linear, LightSource::Hierarchy];

fn options(size: &str, source: LightSource, reach: f32) -> ClusterOptions {
    let settings = CullSettings { source, ..CullSettings::default() };
    let size = size.parse().unwrap();
    let plain = ClusterOptions::new(size, Bounds::Explicit, Occupancy::Sparse, settings);
    ClusterOptions { reach: Some(reach), ..plain }
}

#[test]
fn clusters_with_a_reach_conform() {
    let with = |source| {
        move |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Clustered::with_options(gpu, options("32x32x8", source, 8.0))?))
        }
    };
    let [linear, bvh] = SOURCES.map(with);
    println!("{}", conformance::run(&bvh).expect("conforms"));
    for case in ["mixed-kinds", "overflow", "lights-move"] {
        conformance::run_case(case, &linear).expect("conforms");
    }
    let faults = [Fault::LostTerms, Fault::LostDiffuse, Fault::ShrunkenBound, Fault::NarrowCone];
    for fault in faults {
        conformance::rejects_fault(fault, &bvh).expect("rejects");
    }
}

/// An image of one colour in half floats.
fn flat(gpu: &Gpu, texel: [u16; 4]) -> wgpu::TextureView {
    flat_half_floats(gpu, SIZE, texel)
}

/// Bits of half floats.
const ZERO: u16 = 0;
const QUARTER: u16 = 0x3400;
const ONE: u16 = 0x3c00;

/// For each light, the flags with which any group lists it. The eye is two metres in front of a black wall in the plane
/// z = 0, of that roughness and metallic.
fn flags(
    gpu: &Gpu,
    lights: &[Light],
    source: LightSource,
    [roughness, metallic]: [u16; 2],
) -> Vec<u32> {
    let view = View::look_at(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 1.0, 0.1, SIZE);
    // A clip depth of near / 2.
    let depth = flat_depth(gpu, SIZE, 0.05);
    let normals = flat(gpu, [ZERO, ZERO, ONE, roughness]);
    let base_color = flat(gpu, [ONE, ONE, ONE, metallic]);
    let buffer = LightBuffer::new(gpu, lights).unwrap();
    assert!(buffer.rejected().is_empty());
    let mut strategy = Clustered::with_options(gpu, options("64x64x8", source, 8.0)).unwrap();
    let frame = Frame::new(&view, &buffer)
        .with_depth(&depth)
        .with_normals(&normals)
        .with_base_color(&base_color);
    strategy.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let lists = strategy.lists().snapshot(gpu).unwrap();
    let mut flags = vec![0; lights.len()];
    for group in 0..strategy.lists().group_count() {
        // Groups without samples have the list of all lights.
        if lists.is_all_lights(group) {
            continue;
        }
        for entry in lists.entries_of(group).unwrap() {
            flags[(entry & ENTRY_LIGHT) as usize] |= entry & !ENTRY_LIGHT;
        }
    }
    flags
}

#[test]
fn lights_beyond_their_range_are_listed_for_their_specular_term_only() {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    let point = |z: f32| Light::point(Vec3::new(0.0, 0.0, z), 1.0, Vec3::ONE);
    let spot = |z: f32, direction: Vec3| Light {
        shape: LightShape::Spot { direction, inner_angle: 0.3, outer_angle: 0.5 },
        ..point(z)
    };
    let area = Light {
        shape: LightShape::Area(assign::Emitter::rectangle(0.1 * Vec3::X, 0.1 * Vec3::NEG_Y)),
        ..point(3.0)
    };
    let lights = [
        point(0.9),
        point(1.5),
        point(7.9),
        point(8.1),
        spot(7.5, Vec3::NEG_Z),
        // It shines away from the wall.
        spot(3.0, Vec3::Z),
        // Area lights keep their range.
        area,
    ];
    for source in SOURCES {
        let found = |surface| flags(&gpu, &lights, source, surface);
        let specular = ENTRY_SPECULAR;
        // A mirror reaches as far as it may, a rough wall as far as the range.
        assert_eq!(found([ZERO, ONE]), [BOTH, specular, specular, 0, specular, 0, 0], "{source:?}");
        assert_eq!(found([ONE, ZERO]), [BOTH, 0, 0, 0, 0, 0, 0], "{source:?}");
        // In between, the reach is that of the function: 1.57 ranges from straight above.
        let reach = assign::specular_reach(0.25, 0.04, 0.84, 8.0);
        assert!(reach > 1.5 && reach < 2.2, "{reach}");
        assert_eq!(found([QUARTER, ZERO]), [BOTH, specular, 0, 0, 0, 0, 0], "{source:?}");
    }
}

#[test]
fn options_that_contradict_a_reach_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let plain = options("32x32x8", LightSource::Linear, 8.0);
    let refused = |options| Clustered::with_options(&gpu, options).unwrap_err().to_string();
    assert_eq!(Clustered::with_options(&gpu, plain).unwrap().id(), "SC-E/32x32x8/reach8");
    for reach in [0.5, 65.0, f32::NAN] {
        let error = refused(ClusterOptions { reach: Some(reach), ..plain });
        assert!(error.ends_with("it must be 1 to 64, in ranges of a light"), "{error}");
    }
    for (options, said) in [
        (ClusterOptions { normals: Normals::Bins(6), ..plain }, "end at the lights' ranges"),
        (ClusterOptions { cut: SpecularCut::WhereDiffuse, ..plain }, "end at the lights' ranges"),
        (ClusterOptions { occupancy: Occupancy::Dense, ..plain }, "only sparse clusters"),
        (ClusterOptions { bounds: Bounds::Implicit, ..plain }, "only sparse clusters"),
    ] {
        let error = refused(options);
        assert!(
            error.contains("a specular reach of 8 ranges") || error.contains("bins"),
            "{error}"
        );
        assert!(error.contains(said), "{error}");
    }
    for storage in [Storage::Masks, Storage::Trees, Storage::PrunedLists] {
        let settings = CullSettings { storage, ..CullSettings::default() };
        let error = refused(ClusterOptions { settings, ..plain });
        assert!(error.contains("only plain lists hold lights beyond"), "{storage:?}: {error}");
    }
    let cascaded = ClusterOptions { slices: Slices::Cascaded(2), ..plain };
    assert!(Clustered::with_options(&gpu, cascaded).is_ok());
    let strategy = Clustered::with_options(&gpu, plain).unwrap();
    assert!(Touched::new(&gpu, Box::new(strategy)).is_err());
}
