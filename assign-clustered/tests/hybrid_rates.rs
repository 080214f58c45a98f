//! How loose HG's lists are: compares them with the exact distance of each light's ball from each cell, in f64.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Assignment, DepthMapping, ENTRY_LIGHT, EncoderPasses, Frame, Gpu, Light, LightBuffer,
    Projection, SampleDomain, View,
};
use assign_clustered::{FroxelSize, FroxelsUniform, HybridGrid};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A part of the view: a range of window coordinates and a range of depths. Window coordinates are metres at
/// depth 1 or, in an orthographic view, at any depth.
struct Cell {
    low: DVec2,
    high: DVec2,
    depths: [f64; 2],
    perspective: bool,
}

impl Cell {
    /// Squared distance of a ball's centre from the cell, in view space with depth for z. It is the minimum
    /// over depth of a convex function.
    fn distance_squared(&self, center: DVec3) -> f64 {
        let at = |depth: f64| {
            let footprint = if self.perspective { depth } else { 1.0 };
            let across = center.truncate().clamp(self.low * footprint, self.high * footprint);
            (across - center.truncate()).length_squared() + (depth - center.z).powi(2)
        };
        let [mut low, mut high] = self.depths;
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if at(low + third) < at(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        at(0.5 * (low + high))
    }
}

fn cells(size: FroxelSize, view: &View, uniform: &FroxelsUniform) -> Vec<Cell> {
    let (perspective, window) = match view.projection {
        Projection::Perspective { min, max } => (true, [min, max]),
        Projection::Orthographic { min, max } => (false, [min, max]),
    };
    let [min, max] = window.map(Vec2::as_dvec2);
    let pixels = DVec2::new(view.viewport.width.into(), view.viewport.height.into());
    let tile = DVec2::new(size.tile_px[0].into(), size.tile_px[1].into());
    let depth = |slice: u32| {
        let coordinate = f64::from(slice) / f64::from(uniform.slices_per_unit);
        let first = f64::from(uniform.first_m);
        if perspective { first * coordinate.exp2() } else { first + coordinate }
    };
    let mut cells = Vec::new();
    for y in 0..uniform.counts[1] {
        for x in 0..uniform.counts[0] {
            let corner = DVec2::new(x.into(), y.into()) * tile / pixels;
            let end = (corner + tile / pixels).min(DVec2::ONE);
            let at = |u: f64, v: f64| min + (max - min) * DVec2::new(u, 1.0 - v);
            for slice in 0..size.slices {
                cells.push(Cell {
                    low: at(corner.x, end.y),
                    high: at(end.x, corner.y),
                    depths: [depth(slice), depth(slice + 1)],
                    perspective,
                });
            }
        }
    }
    cells
}

/// The number of pairs of a light and a cell that meet, and the share of listed pairs that do not.
fn rates(gpu: &Gpu, view: &View, ranges_m: [f32; 2]) -> (usize, f64) {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut between = |low: f32, high: f32| rng.random_range(low..high);
    let lights: Vec<Light> = (0..300)
        .map(|_| {
            let position = Vec3::new(between(-9.0, 9.0), between(-6.0, 6.0), between(-18.0, 3.0));
            Light::point(position, between(ranges_m[0], ranges_m[1]), Vec3::ONE)
        })
        .collect();
    let buffer = LightBuffer::new(gpu, &lights).unwrap();
    let size: FroxelSize = "48x48x24".parse().unwrap();
    let uniform =
        FroxelsUniform::new(size, assign_clustered::Slices::default(), view, buffer.bounds())
            .unwrap();
    let mut strategy = HybridGrid::new(gpu, size).unwrap();
    let frame = Frame::new(view, &buffer).sampled_at(SampleDomain::AnyDepth);
    // The pool grows before the second frame.
    for _ in 0..2 {
        strategy.prepare(gpu, &frame).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().unwrap();
        strategy.prepare(gpu, &frame).unwrap();
    }
    let drawn = strategy.lists().snapshot(gpu).unwrap();
    assert_eq!(drawn.counters.overflowed_groups, 0);
    let (mut met, mut listed) = (0, 0);
    for (ix, cell) in cells(size, view, &uniform).iter().enumerate() {
        let entries: Vec<u32> =
            drawn.entries_of(ix as u32).unwrap().iter().map(|e| e & ENTRY_LIGHT).collect();
        listed += entries.len();
        for (light_ix, light) in lights.iter().enumerate() {
            let at = view.world_to_view.as_dmat4().transform_point3(light.position.as_dvec3());
            let center = DVec3::new(at.x, at.y, -at.z);
            let range = f64::from(light.range_m);
            if cell.distance_squared(center) < range * range * (1.0 - 1e-6) {
                met += 1;
                assert!(entries.contains(&(light_ix as u32)), "cell {ix} misses light {light_ix}");
            }
        }
    }
    (met, 1.0 - met as f64 / listed as f64)
}

#[test]
fn most_listed_lights_meet_their_cell() {
    let gpu = Gpu::open(None).unwrap();
    let perspective =
        View { far_m: Some(20.0), ..View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [640, 360]) };
    let window = Projection::Orthographic { min: Vec2::new(-8.0, -5.0), max: Vec2::new(7.0, 4.0) };
    let orthographic = View { projection: window, depth: DepthMapping::Standard, ..perspective };
    for (view, ranges_m, most) in [
        (perspective, [0.2, 1.0], 0.01),
        (perspective, [1.0, 6.0], 0.01),
        (perspective, [10.0, 40.0], 0.01),
        (orthographic, [0.2, 1.0], 0.01),
        (orthographic, [1.0, 6.0], 0.01),
    ] {
        let (met, false_share) = rates(&gpu, &view, ranges_m);
        println!("{ranges_m:?}: {met} pairs, {:.2} % false", 100.0 * false_share);
        assert!(met > 1_000, "{ranges_m:?}: only {met} pairs meet");
        assert!(false_share < most, "{ranges_m:?}: {false_share} of the listed pairs do not meet");
    }
}
