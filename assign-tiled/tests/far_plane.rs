//! A far plane gives tiles far corners, which SAT-N needs: HS+SAT-N then lists fewer lights than HS.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Frame, Gpu, Light, LightBuffer, View,
};
use assign_tiled::{TileSize, Tiled};
use glam::Vec3;

/// Lights around the near plane, wider than tiles are there. Next to a tile's corner, SAT-N separates lights
/// that HS passes. Along a tile's long sides, both pass the same lights.
fn lights() -> Vec<Light> {
    let at = |ix: u32| {
        let share = |factor: f32| (ix as f32 * factor).fract() - 0.5;
        let depth = 0.45 + 0.5 * share(0.618_034);
        Light::point(Vec3::new(share(0.754_878), share(0.569_84), -depth), 0.3, Vec3::ONE)
    };
    (0..400).map(at).collect()
}

/// The number of entries in all lists of T-I.
fn entries(gpu: &Gpu, far_m: Option<f32>, tests: &str) -> u64 {
    let lights = LightBuffer::new(gpu, &lights()).unwrap();
    let view = View { far_m, ..View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [256, 192]) };
    let settings = CullSettings { tests: tests.parse().unwrap(), ..CullSettings::default() };
    let mut tiles = Tiled::new(gpu, TileSize([16, 16]), Bounds::Implicit, settings).unwrap();
    let frame = Frame::new(&view, &lights);
    tiles.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    tiles.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    tiles.lists().snapshot(gpu).unwrap().counters.requested()
}

#[test]
fn with_a_far_plane_hs_and_sat_n_list_fewer_lights_than_hs() {
    let gpu = Gpu::open(None).unwrap();
    let [open, far] = [None, Some(40.0)].map(|far_m| entries(&gpu, far_m, "hs+sat-n"));
    let [open_hs, far_hs] = [None, Some(40.0)].map(|far_m| entries(&gpu, far_m, "hs"));
    println!("HS+SAT-N {open} without a far plane, {far} with one; HS {open_hs} and {far_hs}");
    // Without far corners only HS runs, whatever the settings say.
    assert_eq!(open, open_hs);
    // All lights lie in front of the far plane, so HS lists the same lights with and without it. Only the
    // slack for rounding differs, which grows with the distance of the far corners.
    assert!(far_hs.abs_diff(open_hs) < 10);
    assert!(far < far_hs * 4 / 5);
}
