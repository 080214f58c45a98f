//! Area lights bounded by balls, a baseline: lists are as complete as with outlines, but longer.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    AreaBounds, Assignment, Bounds, CullSettings, Emitter, EncoderPasses, Frame, Gpu, Light,
    LightBuffer, View,
    conformance::{self, flat_depth},
};
use assign_clustered::{Clustered, Occupancy};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];

fn settings(area_bounds: AreaBounds) -> CullSettings {
    CullSettings { area_bounds, ..CullSettings::default() }
}

fn clusters(gpu: &Gpu, bounds: Bounds, settings: CullSettings) -> Clustered {
    let size = "16x16x8".parse().unwrap();
    Clustered::new(gpu, size, bounds, Occupancy::Sparse, settings).unwrap()
}

#[test]
fn lists_with_balls_are_complete() {
    for bounds in [Bounds::Explicit, Bounds::Implicit] {
        for case in ["area-lights", "area-lights-grazing"] {
            let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, assign::AssignError> {
                Ok(Box::new(clusters(gpu, bounds, settings(AreaBounds::Ball))))
            };
            conformance::run_case(case, &make).expect("conforms");
        }
    }
}

/// The number of entries in all lists of a wall two metres from the eye, without groups that hold no sample and have
/// the list of all lights.
fn entries(gpu: &Gpu, bounds: Bounds, area_bounds: AreaBounds, lights: &[Light]) -> u64 {
    let view = View::look_at(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 1.0, 0.1, SIZE);
    let depth = flat_depth(gpu, SIZE, 0.05);
    let lights = LightBuffer::new(gpu, lights).unwrap();
    let frame = Frame::new(&view, &lights).with_depth(&depth);
    let mut strategy = clusters(gpu, bounds, settings(area_bounds));
    strategy.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let lists = strategy.lists().snapshot(gpu).unwrap();
    assert_eq!(lists.counters.overflowed_groups, 0, "only groups without samples are skipped");
    let groups = (0..strategy.lists().group_count()).filter(|group| !lists.is_all_lights(*group));
    groups.map(|group| lists.entries_of(group).unwrap().len() as u64).sum()
}

#[test]
fn balls_also_list_groups_behind_an_emitter_or_beside_a_long_one() {
    let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
    let at = |emitter, z: f32, range| Light::area(emitter, Vec3::Z * z, range, Vec3::ONE);
    // One light emits away from the wall. The other is a long bar that faces the wall from beyond its range.
    let behind = at(Emitter::rectangle(Vec3::X, Vec3::Y), 1.0, 5.0);
    let long = at(Emitter::rectangle(Vec3::X * 3.0, Vec3::NEG_Y * 0.01), 2.0, 0.5);
    for bounds in [Bounds::Explicit, Bounds::Implicit] {
        for light in [behind, long] {
            let [outline, ball] = [AreaBounds::Outline, AreaBounds::Ball]
                .map(|area_bounds| entries(&gpu, bounds, area_bounds, &[light]));
            assert!(
                outline == 0 && ball > 0,
                "{bounds:?}: {outline} entries by outline, {ball} by ball"
            );
        }
        // The outline of a point light is the ball.
        let point = [Light::point(Vec3::Z, 5.0, Vec3::ONE)];
        let [outline, ball] = [AreaBounds::Outline, AreaBounds::Ball]
            .map(|area_bounds| entries(&gpu, bounds, area_bounds, &point));
        assert_eq!(outline, ball, "{bounds:?}");
    }
}

/// Dobetsberger 2025, section 5.1: the box around the reach of a one-sided rectangle is smaller than the ball by
/// a factor of at least pi / 3. The outline's volume is smaller still.
#[test]
fn the_ball_is_larger_than_the_box_and_the_box_than_the_reach() {
    let pi = std::f64::consts::PI;
    for width in [0.0, 0.1, 1.0, 10.0] {
        for height in [0.0, 0.5, 2.0] {
            for range in [0.1_f64, 1.0, 20.0] {
                let ball = 4.0 / 3.0 * pi * (range + 0.5 * f64::hypot(width, height)).powi(3);
                let boxed = (2.0 * range + width) * (2.0 * range + height) * range;
                let reach = width * height * range
                    + 0.5 * pi * range * range * (width + height)
                    + 2.0 / 3.0 * pi * range.powi(3);
                assert!(ball >= pi / 3.0 * boxed * (1.0 - 1e-12), "{width} {height} {range}");
                assert!(boxed > reach, "{width} {height} {range}");
            }
        }
    }
}
