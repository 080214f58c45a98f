//! Furniture of streets, gardens and the square.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Mat4, Vec2, Vec3};

use super::{kit::Parts, materials::Surface};
use crate::builder::{Builder, arc, sharp};

/// A street lamp.
pub(super) fn lamp(fine: bool) -> Parts {
    let mut parts = Parts::default();
    let segments = if fine { 12 } else { 5 };
    let post = [[0.16, 0.0], [0.16, 0.3], [0.07, 0.5], [0.05, 2.9], [0.09, 2.95], [0.16, 3.1]];
    parts.mesh(Surface::Iron).lathe(Vec3::ZERO, segments, &post.map(Vec2::from));
    let cap = [[0.26, 3.62], [0.2, 3.72], [0.05, 3.85], [0.0, 4.0]];
    parts.mesh(Surface::Iron).lathe(Vec3::ZERO, segments, &cap.map(Vec2::from));
    let glass = [[0.0, 3.1], [0.14, 3.1], [0.22, 3.62], [0.0, 3.64]];
    parts.mesh(Surface::Glow).lathe(Vec3::ZERO, segments, &glass.map(Vec2::from));
    parts
}

/// A bench that faces +z.
pub(super) fn bench(fine: bool) -> Parts {
    let mut parts = Parts::default();
    let slats = if fine { 5 } else { 1 };
    for i in 0..slats {
        let step = 0.5 / slats as f32;
        let (y, z) = (0.45, -0.25 + step * i as f32);
        let corner = Vec3::new(0.9, y + 0.04, z + 0.85 * step);
        parts.mesh(Surface::Timber).block(Vec3::new(-0.9, y, z), corner);
        let (y, z) = (0.55 + step * i as f32, -0.3);
        let corner = Vec3::new(0.9, y + 0.85 * step, z + 0.04);
        parts.mesh(Surface::Timber).block(Vec3::new(-0.9, y, z), corner);
    }
    for x in [-0.75, 0.75] {
        parts.mesh(Surface::Iron).block(Vec3::new(x, 0.0, -0.34), Vec3::new(x + 0.05, 1.0, -0.3));
        parts.mesh(Surface::Iron).block(Vec3::new(x, 0.0, -0.3), Vec3::new(x + 0.05, 0.45, 0.25));
    }
    parts
}

/// A fence along x, `length` metres, in panels: rails and pointed pickets.
pub(super) fn fence(length: f32, fine: bool) -> Parts {
    let mut parts = Parts::default();
    let b = parts.mesh(Surface::White);
    let half = 0.5 * length;
    for y in [0.3, 0.8] {
        b.block(Vec3::new(-half, y, -0.04), Vec3::new(half, y + 0.08, 0.0));
    }
    let count = (length / if fine { 0.16 } else { 2.0 }) as u32;
    for i in 0..count {
        let x = ((i as f32 + 0.5) / count as f32 - 0.5) * length;
        b.block(Vec3::new(x - 0.045, -0.3, 0.0), Vec3::new(x + 0.045, 1.0, 0.025));
        if fine {
            let [a, c] = [-0.045, 0.045].map(|d| Vec3::new(x + d, 1.0, 0.0125));
            let tip = Vec3::new(x, 1.08, 0.0125);
            b.gable([a, c, tip]);
            b.gable([c, a, tip]);
        }
    }
    parts
}

/// A market stall that faces +z: a table of goods under a striped awning.
pub(super) fn stall(fine: bool) -> Parts {
    let mut parts = Parts::default();
    for (x, z) in [(-1.4, -0.8), (1.4, -0.8), (-1.4, 0.8), (1.4, 0.8)] {
        let height = if z > 0.0 { 2.2 } else { 2.6 };
        parts
            .mesh(Surface::Timber)
            .block_on(Vec3::new(x, -0.3, z), Vec3::new(0.09, height + 0.3, 0.09));
    }
    parts.mesh(Surface::Timber).block(Vec3::new(-1.4, 0.85, -0.6), Vec3::new(1.4, 0.92, 0.75));
    let stripes = 12;
    for i in 0..stripes {
        let surface = if i % 2 == 0 { Surface::Awning } else { Surface::Oxblood };
        let (x0, step) = (-1.6, 3.2 / stripes as f32);
        let rows = if fine { 6 } else { 1 };
        let awning = parts.mesh(surface);
        let at = |u: f32, v: f32| {
            let z = 1.1 - 2.1 * v;
            let sag = 0.12 * (v * (1.0 - v)) * 4.0;
            Vec3::new(x0 + step * (i as f32 + u), 2.15 + 0.5 * v - sag, z)
        };
        awning.surface(1, rows, at);
        // The underside, a finger's breadth lower.
        awning.surface(1, rows, |u, v| at(1.0 - u, v) - Vec3::Y * 0.02);
        awning.surface(1, 1, |u, v| at(u, 0.0) - Vec3::Y * (0.3 * (1.0 - v)) + Vec3::Z * 0.01);
    }
    if fine {
        let ball = arc([0.0, 0.0], [0.09, 0.09], -88.0, 88.0, 6);
        for i in 0..60 {
            let surface = [Surface::Petal, Surface::Ochre, Surface::Leaf][i / 20];
            let (column, row) = (i % 20 / 4, i % 4);
            let x = -1.2 + 0.85 * (i / 20) as f32 + 0.17 * column as f32;
            let foot = Vec3::new(x, 1.01, -0.1 + 0.19 * row as f32);
            parts.mesh(surface).lathe(foot, 8, &ball);
        }
    }
    parts
}

/// A fountain in the middle of the square: basin, pillar, bowl and a gilded ball.
pub(super) fn fountain(fine: bool) -> Parts {
    let mut parts = Parts::default();
    let segments = if fine { 64 } else { 16 };
    let mut rim = sharp(&[[3.2, -0.5], [3.2, 0.2], [2.95, 0.25], [2.9, 0.6], [3.05, 0.65]]);
    rim.extend(sharp(&[[3.05, 0.78], [2.65, 0.78], [2.65, 0.2], [0.0, 0.2]]));
    parts.mesh(Surface::Stone).lathe(Vec3::ZERO, segments, &rim);
    let pillar = [[0.6, 0.2], [0.45, 0.6], [0.3, 1.0], [0.35, 1.6], [0.9, 2.0], [1.25, 2.1]];
    parts.mesh(Surface::Stone).lathe(Vec3::ZERO, segments / 2, &pillar.map(Vec2::from));
    let bowl = sharp(&[[1.25, 2.1], [1.3, 2.2], [1.1, 2.2], [0.2, 2.0]]);
    parts.mesh(Surface::Stone).lathe(Vec3::ZERO, segments / 2, &bowl);
    let spire = [[0.22, 2.0], [0.16, 2.9], [0.26, 3.0], [0.1, 3.1], [0.0, 3.1]];
    parts.mesh(Surface::Stone).lathe(Vec3::ZERO, segments / 2, &spire.map(Vec2::from));
    let ball = arc([0.0, 3.34], [0.28, 0.28], -88.0, 88.0, if fine { 12 } else { 5 });
    parts.mesh(Surface::Gold).lathe(Vec3::ZERO, segments / 2, &ball);
    parts.mesh(Surface::Water).lathe(Vec3::Y * 0.6, segments, &[Vec2::new(2.65, 0.0), Vec2::ZERO]);
    parts.mesh(Surface::Water).lathe(
        Vec3::Y * 2.15,
        segments / 2,
        &[Vec2::new(1.15, 0.0), Vec2::ZERO],
    );
    parts
}

/// A barrel on its end.
pub(super) fn barrel(fine: bool) -> Parts {
    let mut parts = Parts::default();
    let segments = if fine { 16 } else { 6 };
    let staves = [[0.27, 0.0], [0.33, 0.25], [0.34, 0.45], [0.33, 0.65], [0.27, 0.9]];
    parts.mesh(Surface::Timber).lathe(Vec3::ZERO, segments, &staves.map(Vec2::from));
    parts.mesh(Surface::Timber).lathe(
        Vec3::Y * 0.87,
        segments,
        &[Vec2::new(0.28, 0.0), Vec2::ZERO],
    );
    if fine {
        for y in [0.12, 0.7] {
            let hoop = sharp(&[[0.3, y], [0.335, y], [0.335, y + 0.06], [0.3, y + 0.06]]);
            parts.mesh(Surface::Iron).lathe(Vec3::ZERO, segments, &hoop);
        }
    }
    parts
}

/// A cart with two spoked wheels, its shaft along +x.
pub(super) fn cart() -> Parts {
    let mut parts = Parts::default();
    let wood = parts.mesh(Surface::Timber);
    for z in [-0.6, 0.55] {
        wood.block(Vec3::new(-1.1, 0.75, z), Vec3::new(1.1, 1.15, z + 0.05));
        wood.block(Vec3::new(1.1, 0.72, 0.6 * z), Vec3::new(2.6, 0.8, 0.6 * z + 0.07));
    }
    wood.block(Vec3::new(-1.1, 0.68, -0.6), Vec3::new(1.1, 0.75, 0.6));
    let mut wheel = Builder::default();
    let rim = sharp(&[[0.52, -0.04], [0.6, -0.04], [0.6, 0.04], [0.52, 0.04], [0.52, -0.04]]);
    wheel.lathe(Vec3::ZERO, 24, &rim);
    wheel.lathe(Vec3::ZERO, 8, &sharp(&[[0.0, -0.1], [0.08, -0.1], [0.08, 0.1], [0.0, 0.1]]));
    for spoke in 0..8 {
        let mut bar = Builder::default();
        bar.block(Vec3::new(0.05, -0.02, -0.025), Vec3::new(0.53, 0.02, 0.025));
        wheel.append(&bar, &Mat4::from_rotation_y(TAU * spoke as f32 / 8.0));
    }
    for z in [-0.72, 0.72] {
        let at = Mat4::from_translation(Vec3::new(-0.1, 0.6, z));
        wood.append(&wheel, &(at * Mat4::from_rotation_x(FRAC_PI_2)));
    }
    parts
}
