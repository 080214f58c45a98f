//! HG passes the conformance suite, and the suite rejects it with each planted fault.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, Counters, ENTRY_LIGHT, EncoderPasses, Frame, Gpu, Light, LightBuffer,
    LightShape, ListsSnapshot, Reuse, SampleDomain, View,
    conformance::{self, faulty::Fault, flat_depth},
};
use assign_clustered::{HybridGrid, Scatter};
use glam::Vec3;

fn grid(size: &str) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(HybridGrid::new(gpu, size.parse()?)?))
}

fn raster_grid(size: &str) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(HybridGrid::with_scatter(gpu, size.parse()?, Scatter::Raster)?))
}

fn conforms(size: &str) {
    let report = conformance::run(&grid(size)).expect("conforms");
    println!("{report}");
}

#[test]
fn coarse_cells_conform() {
    conforms("48x48x40");
    conforms("4096x4096x1");
}

#[test]
fn odd_cells_conform() {
    conforms("13x9x5");
}

#[test]
fn fine_cells_conform() {
    conforms("9x7x200");
}

#[test]
fn rasterised_cells_conform() {
    for size in ["48x48x40", "4096x4096x1", "9x7x200"] {
        conformance::run(&raster_grid(size)).expect("conforms");
    }
}

#[test]
fn faults_of_rasterised_cells_are_rejected() {
    let make = raster_grid("16x16x8");
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}

/// The rasteriser finds the tiles that lanes find: lists are equal, entry for entry.
#[test]
fn the_rasteriser_makes_the_lists_of_the_lanes() {
    let gpu = Gpu::open(None).unwrap();
    let lights: Vec<Light> = (0..200)
        .map(|i| {
            let at = |step: u32| (i * step % 101) as f32 / 25.0 - 2.0;
            let position = Vec3::new(at(17), at(29), at(43));
            let range_m = 0.1 + (i * 7 % 13) as f32 * 0.2;
            match i % 3 {
                0 => Light {
                    shape: LightShape::Spot {
                        direction: Vec3::new(at(5), 1.0, at(3)).normalize(),
                        inner_angle: 0.2,
                        outer_angle: 0.5,
                    },
                    ..Light::point(position, range_m, Vec3::ONE)
                },
                _ => Light::point(position, range_m, Vec3::ONE),
            }
        })
        .collect();
    let lights = LightBuffer::new(&gpu, &lights).unwrap();
    // A viewport inside a larger target, whose last tiles are cut.
    let mut view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [61, 45]);
    view.viewport = assign::Viewport { x: 5, y: 3, ..view.viewport };
    let frame = Frame::new(&view, &lights).sampled_at(SampleDomain::AnyDepth);
    let [lanes, raster] = [Scatter::Compute, Scatter::Raster].map(|scatter| {
        let mut strategy =
            HybridGrid::with_scatter(&gpu, "7x5x9".parse().unwrap(), scatter).unwrap();
        draw(&gpu, &mut strategy, &frame);
        gpu.wait().unwrap();
        let drawn = draw(&gpu, &mut strategy, &frame);
        assert_eq!(drawn.counters.overflowed_groups, 0);
        drawn
    });
    assert!(lanes.counters.requested() > 1_000, "{:?}", lanes.counters);
    assert_eq!(lanes.counters, raster.counters);
    for group in 0..9 * 9 * 9 {
        assert_eq!(lanes.entries_of(group), raster.entries_of(group), "group {group}");
    }
}

#[test]
fn faults_are_rejected() {
    let make = grid("16x16x8");
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}

#[test]
fn reused_lists_miss_lights_that_move() {
    let reused = |frames| {
        let make = grid("16x16x8");
        move |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Reuse::new(make(gpu)?, frames)?))
        }
    };
    conformance::run_case("lights-move", &reused(1)).expect("conforms");
    let error = conformance::run_case("lights-move", &reused(3))
        .expect_err("lists of an earlier frame miss lights that moved");
    assert!(error.to_string().contains("missed pair"), "{error}");
}

/// A view of 4 x 3 tiles of 16 pixels.
fn view() -> View {
    View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48])
}

fn draw(gpu: &Gpu, strategy: &mut dyn Assignment, frame: &Frame<'_>) -> ListsSnapshot {
    strategy.prepare(gpu, frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    strategy.lists().snapshot(gpu).unwrap()
}

/// Counters and lists are those of the frame, whether earlier frames held nothing or everything.
#[test]
fn only_cells_that_hold_samples_get_lists() {
    let gpu = Gpu::open(None).unwrap();
    let light = Light::point(Vec3::ZERO, 50.0, Vec3::ONE);
    let lights = LightBuffer::new(&gpu, &[light; 3]).unwrap();
    let view = view();
    let [wall, nothing] = [0.05, view.depth_clear()].map(|depth| flat_depth(&gpu, [64, 48], depth));
    let mut strategy = grid("16x16x8")(&gpu).unwrap();
    let frame = Frame::new(&view, &lights);
    let walls = [&wall, &wall].map(|depth| draw(&gpu, &mut *strategy, &frame.with_depth(depth)));
    assert_eq!(walls[0].counters.occupied_groups, 12, "one slice of 4 x 3 tiles");
    assert_eq!((walls[0].counters.requested(), walls[0].counters.longest), (36, 3));
    assert_eq!(walls[0].counters, walls[1].counters);
    for _ in 0..2 {
        let nothing = draw(&gpu, &mut *strategy, &frame.with_depth(&nothing));
        assert_eq!(nothing.counters, Counters::default());
        assert!((0..4 * 3 * 8).all(|group| nothing.is_all_lights(group)), "no samples: all lights");
    }
    // If look-ups may come at any depth, every cell counts as holding samples.
    let any = draw(&gpu, &mut *strategy, &frame.sampled_at(SampleDomain::AnyDepth));
    assert_eq!(any.counters.occupied_groups, 4 * 3 * 8);
    assert_eq!(draw(&gpu, &mut *strategy, &frame.with_depth(&wall)).counters, walls[0].counters);
}

/// A capped list keeps its lowest lights, in whatever order it was filled.
#[test]
fn capped_lists_keep_the_lowest_lights() {
    let gpu = Gpu::open(None).unwrap();
    let view = view();
    let wall = flat_depth(&gpu, [64, 48], 0.05);
    // Short and long lists are sorted in different ways.
    for (count, cap) in [(240, 101), (5_000, 1_001), (5_000, 2_501)] {
        let light = Light::point(Vec3::ZERO, 50.0, Vec3::ONE);
        let lights = LightBuffer::new(&gpu, &vec![light; count]).unwrap();
        let mut strategy = grid("16x16x8")(&gpu).unwrap();
        strategy.lists_mut().cap_lists(cap);
        let frame = Frame::new(&view, &lights).with_depth(&wall);
        // The pool grows before the second frame.
        draw(&gpu, &mut *strategy, &frame);
        strategy.prepare(&gpu, &frame).unwrap();
        let drawn = draw(&gpu, &mut *strategy, &frame);
        assert_eq!(drawn.counters.overflowed_groups, 0);
        assert_eq!(drawn.counters.longest, count as u32);
        let mut capped = 0;
        for group in 0..4 * 3 * 8 {
            let entries = drawn.entries_of(group).unwrap();
            if !drawn.is_all_lights(group) {
                let kept: Vec<u32> = entries.iter().map(|entry| entry & ENTRY_LIGHT).collect();
                assert!(kept == (0..cap).collect::<Vec<_>>(), "group {group}: {kept:?}");
                capped += 1;
            }
        }
        assert_eq!(capped, 12);
    }
}

#[test]
fn errors_name_what_is_wrong() {
    let gpu = Gpu::noop().unwrap();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let view = view();
    let mut strategy = grid("32x32x8")(&gpu).unwrap();
    assert_eq!(strategy.id(), "HG/32x32x8");
    let frame = Frame::new(&view, &lights);
    let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("HG/32x32x8 needs depth"), "{error}");
    strategy.prepare(&gpu, &frame.sampled_at(SampleDomain::AnyDepth)).unwrap();
    let error = grid("0x32x8")(&gpu).err().unwrap().to_string();
    assert!(error.contains("froxel tile size is 0: it must be 1 to 16384"), "{error}");
    let huge =
        View { viewport: assign::Viewport { x: 0, y: 0, width: 16384, height: 16384 }, ..view };
    let error =
        grid("1x1x8")(&gpu).unwrap().prepare(&gpu, &Frame::new(&huge, &lights)).unwrap_err();
    assert!(error.to_string().contains("larger tiles or fewer slices"), "{error}");
    let flat = View { near_m: 0.0, ..view };
    let error = strategy.prepare(&gpu, &Frame::new(&flat, &lights)).unwrap_err();
    assert!(matches!(error, AssignError::View(_)), "{error}");
}
