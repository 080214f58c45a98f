//! Deep images at their limits: buffers that overflow, lists that are too long, and odd or faulty input.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod builds;
mod scene;

use assign::Gpu;
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, Directions, Raster, Spread, Storage,
};
use builds::{BRUTE, DRAWN, SINGLE, TOUCHED, lists, lists_of, settings};
use glam::Vec3;
use scene::{Scene, frame, room, settled};

#[test]
fn buffers_that_overflow_are_reported_and_grow() {
    let gpu = Gpu::open(None).unwrap();
    // So many layers have more samples than a first frame makes room for.
    let mut triangles = Vec::new();
    for layer in 0..90 {
        let z = layer as f32 * 0.04;
        let at = |x: f32, y: f32| Vec3::new(x, y, z);
        triangles.push([at(-9.0, -9.0), at(9.0, -9.0), at(9.0, 9.0)]);
        triangles.push([at(-9.0, -9.0), at(9.0, 9.0), at(-9.0, 9.0)]);
    }
    let scene = Scene::new(&gpu, triangles);
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        for storage in [Storage::Arrays, Storage::LinkedLists] {
            let mut images = DeepImages::new(&gpu, settings(build, storage)).unwrap();
            frame(&gpu, &mut images, &scene);
            let first = images.snapshot(&gpu).unwrap().counters;
            assert_eq!(first.is_overflowed, 1, "{build:?} {storage:?} {first:?}");
            frame(&gpu, &mut images, &scene);
            let second = images.snapshot(&gpu).unwrap().counters;
            assert_eq!(second.is_overflowed, 0, "{build:?} {storage:?} {second:?}");
            assert!(second.fragment_count >= first.fragment_count);
            assert_eq!(images.stats().map(|stats| stats.is_overflowed), Some(1));
            // With a limit that is too small, the overflow stays, and nothing fails.
            let tight = DeepImageSettings { most_fragments: 1000, ..settings(build, storage) };
            let tight = settled(&gpu, tight, &scene);
            assert_eq!(tight.snapshot(&gpu).unwrap().counters.is_overflowed, 1);
        }
    }
}

#[test]
fn longer_lists_than_are_sorted_are_incomplete_until_rounds_are_added() {
    let gpu = Gpu::open(None).unwrap();
    // Eight thousand layers, one behind the other.
    let layer = |ix: u32| {
        let z = ix as f32 * 0.001;
        [Vec3::new(-1.0, -1.0, z), Vec3::new(9.0, -1.0, z), Vec3::new(-1.0, 9.0, z)]
    };
    let scene = Scene::new(&gpu, (0..8000).map(layer).collect());
    let settings = DeepImageSettings {
        directions: Directions::new(Spread::StacksAndSlices, 1, 1).unwrap(),
        size_px: 4,
        ..settings(SINGLE, Storage::Arrays)
    };
    let mut images = DeepImages::new(&gpu, settings).unwrap();
    frame(&gpu, &mut images, &scene);
    assert_eq!(images.is_complete(), None);
    let mut seen = Vec::new();
    for _ in 0..4 {
        frame(&gpu, &mut images, &scene);
        seen.extend(images.is_complete());
    }
    // First samples overflow, then lists are too long to be sorted, then all is complete.
    assert_eq!(seen.first(), Some(&false), "{seen:?}");
    assert_eq!(seen.last(), Some(&true), "{seen:?}");
    let snapshot = images.snapshot(&gpu).unwrap();
    assert!(snapshot.counters.longest > 2048, "{:?}", snapshot.counters);
    assert!(lists_of(&snapshot, &settings).iter().all(|list| list.is_sorted()));
}

#[test]
fn rejected_triangles_are_counted() {
    let gpu = Gpu::open(None).unwrap();
    let mut triangles = room(9, 2, 5);
    let scene = Scene::new(&gpu, triangles.clone());
    let good = scene.input().bounds_world;
    triangles.insert(3, [Vec3::splat(f32::NAN), Vec3::ZERO, Vec3::X]);
    triangles.insert(9, [Vec3::splat(1e4), Vec3::ZERO, Vec3::X]);
    triangles.insert(12, [Vec3::ZERO, Vec3::new(1.0, f32::INFINITY, 1.0), Vec3::X]);
    let odd = Scene::new(&gpu, triangles);
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        let settings = settings(build, Storage::Arrays);
        let clean = lists(&gpu, &scene, settings);
        let mut images = DeepImages::new(&gpu, settings).unwrap();
        let mut input = odd.input();
        input.bounds_world = good;
        for _ in 0..2 {
            images.prepare(&gpu, &input).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            images.record(&mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            gpu.wait().unwrap();
        }
        let snapshot = images.snapshot(&gpu).unwrap();
        assert!(lists_of(&snapshot, &settings) == clean, "{build:?}");
        if build != DRAWN {
            assert_eq!(snapshot.counters.rejected_count, 3, "{build:?}");
        }
    }
}

#[test]
fn flat_triangles_make_fragments_only_with_conservative_coverage() {
    let gpu = Gpu::open(None).unwrap();
    let flat = [Vec3::ZERO, Vec3::X, Vec3::X * 0.5];
    for triangles in [vec![], vec![flat], vec![[Vec3::ONE; 3]]] {
        let scene = Scene::new(&gpu, triangles);
        for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
            let settings = settings(build, Storage::Arrays);
            let mut images = DeepImages::new(&gpu, settings).unwrap();
            let mut input = scene.input();
            if input.count == 0 {
                input.bounds_world = (Vec3::ZERO, Vec3::ZERO);
            }
            images.prepare(&gpu, &input).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            images.record(&mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            let snapshot = images.snapshot(&gpu).unwrap();
            assert_eq!(snapshot.counters.is_overflowed, 0);
            let is_empty = snapshot.fragment_count() == 0;
            // A line and a point touch pixels but cover no pixel centre.
            assert_eq!(is_empty, build != TOUCHED || input.count == 0, "{build:?}");
        }
    }
}

#[test]
fn errors_name_the_faulty_input() {
    let gpu = Gpu::noop().unwrap();
    let refused = |change: &dyn Fn(&mut DeepImageSettings)| {
        let mut settings = settings(SINGLE, Storage::Arrays);
        change(&mut settings);
        DeepImages::new(&gpu, settings).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|s| s.size_px = 0),
        "pixels along the side of a deep image (size_px) is 0: it must be 1 to 1024"
    );
    assert_eq!(
        refused(&|s| s.size_px = 1025),
        "pixels along the side of a deep image (size_px) is 1025: it must be 1 to 1024"
    );
    let raster = Raster::Compute;
    let finer = |s: &mut DeepImageSettings| {
        s.build = Build::SinglePass { oversampling: 33, raster };
    };
    assert_eq!(refused(&finer), "oversampling of deep images is 33: it must be 1 to 32");
    let none = |s: &mut DeepImageSettings| {
        s.build = Build::PerDirection { coverage: Coverage::Centres, at_once: 0 };
    };
    assert_eq!(refused(&none), "directions per dispatch (at_once) is 0: it must be 1 to 32");
    assert!(refused(&|s| s.most_fragments = 0).contains("(most_fragments) is 0"));
    let large = |s: &mut DeepImageSettings| {
        s.size_px = 1024;
        s.directions = Directions::new(Spread::Squares, 32, 32).unwrap();
    };
    assert!(refused(&large).contains("(directions x size_px^2) is 1073741824"));

    let mut images = DeepImages::new(&gpu, settings(SINGLE, Storage::Arrays)).unwrap();
    let positions = gpu.storage("positions", 36).unwrap();
    let mut input = assign_cdi::Triangles {
        positions: &positions,
        count: 2,
        bounds_world: (Vec3::ZERO, Vec3::ONE),
    };
    let message = images.prepare(&gpu, &input).unwrap_err().to_string();
    let expected =
        "buffer of triangle positions is 36 bytes: it must be at least 72 bytes for 2 triangles";
    assert_eq!(message, expected);
    input.count = 1;
    for corner in [-Vec3::ONE, Vec3::splat(2e9), Vec3::new(0.0, f32::NAN, 0.0), Vec3::INFINITY] {
        input.bounds_world.1 = corner;
        let message = images.prepare(&gpu, &input).unwrap_err().to_string();
        assert!(message.contains("(bounds_world) is"), "{corner} {message}");
    }
}
