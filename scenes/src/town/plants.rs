//! Trees, bushes and tufts.

use std::f32::consts::{PI, TAU};

use glam::{Mat4, Vec2, Vec3};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::{kit::Parts, materials::Surface};
use crate::builder::Builder;

/// A random direction, uniform over the sphere.
fn direction(rng: &mut Pcg64Mcg) -> Vec3 {
    let y = 2.0 * rng.random::<f32>() - 1.0;
    let (sin, cos) = (TAU * rng.random::<f32>()).sin_cos();
    Vec3::new(cos, 0.0, sin) * (1.0 - y * y).sqrt() + Vec3::Y * y
}

/// A leaf, or a spray of leaves, that faces roughly outwards.
fn leaf(b: &mut Builder, rng: &mut Pcg64Mcg, center: Vec3, out: Vec3, size: f32) {
    let face = (out + 0.9 * direction(rng)).normalize_or(Vec3::Y);
    let face = if face.dot(out) < 0.1 { out } else { face };
    let turn = TAU * rng.random::<f32>();
    let side = face.any_orthonormal_vector();
    let u = (side * turn.cos() + face.cross(side) * turn.sin()) * size;
    let v = face.cross(u) * 0.7;
    // The normal leans outwards, so that a crown is shaded as one body.
    b.card(center - 0.5 * (u + v), u, v, (face + out).normalize_or(face));
}

/// A limb from `foot` to `tip`, tapering.
fn limb(b: &mut Builder, foot: Vec3, tip: Vec3, radius: f32, segments: u32) {
    let along = tip - foot;
    let length = along.length();
    let turn = glam::Quat::from_rotation_arc(Vec3::Y, along / length);
    let mut wood = Builder::default();
    let profile = [[1.0, 0.0], [0.8, 0.3], [0.62, 0.6], [0.35, 1.0]];
    let profile = profile.map(|[r, y]| Vec2::new(r * radius, y * length));
    wood.lathe(Vec3::ZERO, segments, &profile);
    b.append(&wood, &Mat4::from_rotation_translation(turn, foot));
}

/// A broad-leaved tree some 8 m tall.
pub(super) fn broadleaf(rng: &mut Pcg64Mcg, surface: Surface, fine: bool) -> Parts {
    let mut parts = Parts::default();
    let fork = Vec3::new(0.2 * rng.random::<f32>(), 2.6, 0.2 * rng.random::<f32>());
    let segments = if fine { 10 } else { 5 };
    limb(parts.mesh(Surface::Bark), Vec3::Y * -0.3, fork, 0.26, segments);
    let clusters = if fine { 11 } else { 4 };
    for i in 0..clusters {
        let turn = i as f32 * 2.4 + rng.random::<f32>();
        let lift = i as f32 / (clusters - 1) as f32;
        let spread = 1.9 * (1.0 - 0.75 * lift * lift);
        let tip = fork + Vec3::new(spread * turn.cos(), 0.9 + 3.4 * lift, spread * turn.sin());
        limb(parts.mesh(Surface::Bark), fork - Vec3::Y * 0.1, tip, 0.1, 5);
        let size = Vec3::new(1.5, 1.15, 1.5) * (0.85 + 0.3 * rng.random::<f32>());
        let (leaves, length) = if fine { (160, 0.4) } else { (18, 1.1) };
        for _ in 0..leaves {
            let out = direction(rng);
            let depth = rng.random::<f32>().powf(0.4);
            leaf(parts.mesh(surface), rng, tip + out * size * depth, out, length);
        }
    }
    parts
}

/// A conifer some 10 m tall.
pub(super) fn conifer(rng: &mut Pcg64Mcg, fine: bool) -> Parts {
    let mut parts = Parts::default();
    limb(parts.mesh(Surface::Bark), Vec3::Y * -0.3, Vec3::Y * 9.6, 0.2, if fine { 8 } else { 4 });
    let whorls = if fine { 18 } else { 5 };
    for whorl in 0..whorls {
        let t = whorl as f32 / whorls as f32;
        let (foot, reach) = (1.2 + 8.4 * t, 2.1 * (1.0 - t).powf(0.8) + 0.15);
        let boughs = if fine { 9 } else { 6 };
        for i in 0..boughs {
            let turn = TAU * (i as f32 + rng.random::<f32>()) / boughs as f32;
            let out = Vec3::new(turn.cos(), 0.0, turn.sin());
            let side = Vec3::new(-turn.sin(), 0.0, turn.cos());
            let (steps, wide) = if fine { (4, 0.5) } else { (1, 1.2) };
            for step in 0..steps {
                let (from, to) = (step as f32 / steps as f32, (step + 1) as f32 / steps as f32);
                let at = |s: f32| Vec3::Y * (foot - 0.45 * reach * s * s) + out * (reach * s);
                let width = wide * reach * (1.0 - 0.75 * from);
                let along = at(to) - at(from);
                // Seen from above, the side x along points up.
                let up = along.cross(side).normalize_or(Vec3::Y);
                let normal = (up + 0.7 * out).normalize();
                let corner = at(from) - 0.5 * width * side;
                parts.mesh(Surface::LeafDark).card(corner, along, side * width, normal);
            }
        }
    }
    parts
}

/// A bush about a metre tall.
pub(super) fn bush(rng: &mut Pcg64Mcg, fine: bool) -> Parts {
    let mut parts = Parts::default();
    let (leaves, length) = if fine { (150, 0.22) } else { (10, 0.6) };
    for i in 0..leaves {
        let out = direction(rng);
        let out = Vec3::new(out.x, out.y.abs(), out.z);
        let center = out * Vec3::new(0.7, 0.9, 0.7) * rng.random::<f32>().powf(0.3);
        let surface = if fine && i % 9 == 0 { Surface::Petal } else { Surface::Leaf };
        leaf(parts.mesh(surface), rng, center, out, length);
    }
    parts
}

/// Grass over a square of that side around the origin, as blades in tufts.
pub(super) fn tufts(rng: &mut Pcg64Mcg, side: f32, count: u32) -> Builder {
    let mut b = Builder::default();
    for _ in 0..count {
        let foot = Vec3::new(rng.random::<f32>() - 0.5, 0.0, rng.random::<f32>() - 0.5) * side;
        for _ in 0..3 {
            let turn = PI * rng.random::<f32>();
            let across = Vec3::new(turn.cos(), 0.0, turn.sin()) * 0.1;
            let tip = Vec3::new(0.2 * rng.random::<f32>(), 0.3, 0.2 * rng.random::<f32>());
            b.gable([foot - across, foot + across, foot + tip]);
        }
    }
    b
}
