//! Lists that are kept for several frames lose no light, wherever the lights move.

use std::collections::BTreeMap;

use assign::{
    AssignError, Assignment, CullSettings, Frame, Gpu, Keep, Light, LightBuffer, LightOrder,
    Touched, View,
    conformance::{self, CountedPasses},
};
use assign_grid::{Grid, GridBox};
use glam::Vec3;

/// A grid that keeps its lists for some frames.
fn kept(frames: u32) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| {
        let counts = "8x8x8".parse()?;
        let grid = Grid::new(gpu, counts, GridBox::Positions, CullSettings::default())?;
        Ok(Box::new(Keep::new(gpu, Box::new(grid), frames)?))
    }
}

#[test]
fn kept_lists_conform() {
    for case in [
        "33-lights",
        "overflow",
        "light-at-tile-corner",
        "mixed-kinds",
        "lights-move",
        "gpu-order",
        "gpu-order-stale",
        "gpu-order-some-move",
        "lights-from-gpu",
    ] {
        conformance::run_case(case, &kept(3)).expect(case);
    }
}

#[test]
fn lists_that_stay_conform() {
    let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        let grid = Grid::new(gpu, "8x8x8".parse()?, GridBox::Positions, CullSettings::default())?;
        Ok(Box::new(Touched::new(gpu, Box::new(grid))?))
    };
    for case in ["33-lights", "overflow", "lights-move", "gpu-order-some-move", "lights-from-gpu"] {
        conformance::run_case(case, &touched).expect(case);
    }
}

/// How often lists are made in 9 frames, in each of which every light moves by `step_m`.
fn made(order: LightOrder, step_m: f32, view_step_m: f32) -> u32 {
    let gpu = Gpu::open(None).expect("a GPU");
    let mut strategy = kept(4)(&gpu).expect("a strategy");
    let mut lights: Vec<Light> = (0..100)
        .map(|ix| Light::point(Vec3::new((ix % 10) as f32, (ix / 10) as f32, 0.0), 2.0, Vec3::ONE))
        .collect();
    let mut buffer = LightBuffer::ordered(&gpu, &lights, order).expect("lights");
    // Draws a frame, and counts its passes.
    let draw = |strategy: &mut dyn Assignment, buffer: &LightBuffer, back_m: f32| {
        let mut counts = BTreeMap::new();
        let eye = Vec3::new(5.0, 5.0, 9.0 + back_m);
        let view = View::look_at(eye, Vec3::ZERO, 1.0, 0.1, [64, 48]);
        let frame = Frame::new(&view, buffer);
        strategy.prepare(&gpu, &frame).expect("prepares");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = CountedPasses::new(&mut encoder, &mut counts);
        buffer.record(&mut passes);
        strategy.record(&frame, &mut passes);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().expect("waits");
        assert_eq!(counts.get("widen"), counts.get("cull"));
        counts.get("cull").copied().unwrap_or(0)
    };
    // The pool grows first: lists that overflow are made anew.
    for _ in 0..8 {
        draw(&mut *strategy, &buffer, 0.0);
    }
    strategy.lists_mut().expire();
    let mut made = 0;
    for frame_ix in 0..9 {
        for light in &mut lights {
            light.position.z += step_m;
        }
        buffer.update(&gpu, &lights).expect("lights");
        made += draw(&mut *strategy, &buffer, frame_ix as f32 * view_step_m);
    }
    made
}

#[test]
fn lists_are_kept_as_long_as_they_hold_all_lights() {
    let still = LightOrder::Given;
    // Frames 0, 4 and 8.
    assert_eq!(made(still, 0.0, 0.0), 3);
    // A grid's cells do not move with the camera.
    assert_eq!(made(still, 0.0, 0.1), 3);
    // Larger lights have longer lists. If they overflow the pool, lists are made once more.
    assert!((3..=4).contains(&made(still, 0.01, 0.0)));
    assert!((3..=4).contains(&made(LightOrder::Gpu { every: 100 }, 0.01, 0.0)));
    // Each new order makes the lists anew: frames 0, 1, 3, 5 and 7.
    assert!((5..=6).contains(&made(LightOrder::Gpu { every: 2 }, 0.01, 0.0)));
}

#[test]
fn frames_and_strategies_are_checked() {
    let gpu = Gpu::open(None).expect("a GPU");
    assert!(kept(0)(&gpu).is_err());
    assert_eq!(kept(4)(&gpu).expect("a strategy").id(), "G/8x8x8/keep4");
}
