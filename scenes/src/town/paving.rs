//! Setts, flagstones and kerbs.

use glam::{Vec2, Vec3};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::{kit::Parts, land::Lot, materials::Surface};
use crate::builder::Builder;

/// Side of a patch of setts, metres.
pub(super) const PATCH_M: f32 = 4.0;

/// A patch of setts around the origin, `count` along each side, with every other row moved by half
/// a sett. Their tops differ by up to 3 cm. A count of one gives a slab.
pub(super) fn patch(rng: &mut Pcg64Mcg, count: u32) -> Parts {
    let mut parts = Parts::default();
    let size = PATCH_M / count as f32;
    let half = 0.5 * PATCH_M;
    for row in 0..count {
        let shifted = row % 2 == 1;
        let low_z = row as f32 * size - half;
        for column in 0..count + u32::from(shifted) {
            let from = column as f32 - if shifted { 0.5 } else { 0.0 };
            let [x0, x1] = [from, from + 1.0].map(|x| (x * size - half).clamp(-half, half));
            let joint = 0.012 + 0.02 * size * rng.random::<f32>();
            let (low, high) = (Vec2::new(x0, low_z) + joint, Vec2::new(x1, low_z + size) - joint);
            let top = 0.05 + 0.03 * rng.random::<f32>();
            let dark = count > 1 && rng.random::<f32>() < 0.4;
            let surface = if dark { Surface::SettDark } else { Surface::Sett };
            stone(parts.mesh(surface), low, high, top, 0.035_f32.min(0.2 * size));
        }
    }
    parts
}

/// A stone from the ground up to `top`, its upper edges bevelled.
fn stone(b: &mut Builder, low: Vec2, high: Vec2, top: f32, bevel: f32) {
    let ring = |inset: f32, y: f32| {
        let (low, high) = (low + inset, high - inset);
        [(low.x, high.y), (high.x, high.y), (high.x, low.y), (low.x, low.y)]
            .map(|(x, z)| Vec3::new(x, y, z))
    };
    let (outer, inner) = (ring(0.0, -0.02), ring(bevel, top));
    b.quad(inner[0], inner[1] - inner[0], inner[3] - inner[0]);
    for i in 0..4 {
        let j = (i + 1) % 4;
        b.gable([outer[i], outer[j], inner[j]]);
        b.gable([outer[i], inner[j], inner[i]]);
    }
}

/// Flagstones over a lot of that size around the origin, with a hole of size `hole` in its middle
/// (0 means none). The slabs are about `slab` metres wide and their tops are `top` above the
/// ground.
pub(super) fn flags(rng: &mut Pcg64Mcg, lot: Lot, hole: f32, slab: f32, top: f32) -> Builder {
    let mut b = Builder::default();
    let [width, depth] = lot.size();
    let count = |length: f32| (length / slab).round().max(1.0) as u32;
    let (columns, rows) = (count(width), count(depth));
    for row in 0..rows {
        for column in 0..columns {
            let cell = Vec2::new(width / columns as f32, depth / rows as f32);
            let low = Vec2::new(column as f32, row as f32) * cell - 0.5 * Vec2::new(width, depth);
            let high = low + cell;
            let middle = (0.5 * (low + high)).abs();
            if middle.max_element() < 0.5 * hole {
                continue;
            }
            let top = top + 0.015 * rng.random::<f32>();
            stone(&mut b, low + 0.01, high - 0.01, top, 0.015);
        }
    }
    b
}
