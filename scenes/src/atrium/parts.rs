//! The atrium's repeated parts, each around its own origin.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::builder::{Builder, Frame, arc, sharp};

/// Thickness of the arcade walls, metres.
pub(super) const WALL_M: f32 = 0.56;

/// A column from the floor to `height`: plinth, torus mouldings, shaft with entasis, bell
/// capital with two rings of leaves, abacus.
pub(super) fn column(height: f32, radius: f32) -> Builder {
    let mut b = Builder::default();
    let wide = 2.9 * radius;
    b.block_on(Vec3::ZERO, Vec3::new(wide, 0.14, wide));
    let top = height - 0.55;
    let mut profile = arc([1.12 * radius, 0.21], [0.3 * radius, 0.07], -90.0, 90.0, 8);
    profile.extend(arc([1.12 * radius, 0.31], [0.12 * radius, 0.03], 270.0, 180.0, 4));
    profile.extend(arc([1.08 * radius, 0.38], [0.16 * radius, 0.04], -90.0, 90.0, 6));
    let last = profile.len() - 1;
    profile.push(profile[last]);
    let shaft = |i: u32| {
        // The shaft tapers by a sixth along the classical curve: full up to a third, then a quarter
        // sine.
        let t = i as f32 / 10.0;
        let taper = (((t - 0.3) / 0.7).max(0.0) * 0.5 * PI).sin().powi(2);
        Vec2::new(radius * (1.0 - 0.16 * taper), 0.42 + (top - 0.42) * t)
    };
    profile.extend((0..=10).map(shaft));
    let neck = 0.84 * radius;
    profile.push(Vec2::new(neck, top));
    profile.extend(arc([neck, top + 0.03], [0.16 * radius, 0.03], -90.0, 90.0, 6));
    profile.push(Vec2::new(neck, top + 0.06));
    let bell = |i: u32| {
        let t = i as f32 / 8.0;
        Vec2::new(neck + 0.5 * radius * t * t * t, top + 0.06 + 0.37 * t)
    };
    profile.extend((0..=8).map(bell));
    b.lathe(Vec3::ZERO, 24, &profile);
    for (row, count) in [(0.0, 8), (0.14, 8)] {
        for i in 0..count {
            let turn = TAU * (i as f32 + row / 0.28) / count as f32;
            leaf(&mut b, turn, top + 0.07 + row, neck);
        }
    }
    let abacus = 2.75 * radius;
    b.block_on(Vec3::Y * (height - 0.12), Vec3::new(abacus, 0.12, abacus));
    b
}

/// An acanthus-like leaf that curls outwards at its tip.
fn leaf(b: &mut Builder, turn: f32, foot: f32, radius: f32) {
    let (sin, cos) = turn.sin_cos();
    let (out, side) = (Vec3::new(cos, 0.0, sin), Vec3::new(sin, 0.0, -cos));
    let at = move |u: f32, v: f32| {
        let across = 2.0 * u - 1.0;
        let width = 0.36 * radius * (1.0 - 0.75 * v * v * v) * (1.0 + 0.06 * (v * 40.0).sin());
        let curl = 0.02 + 0.16 * v * v * v - 0.02 * across * across;
        let rise = 0.26 * v - 0.07 * v.powi(6);
        Vec3::Y * (foot + rise) + out * (radius + curl) + side * (across * width)
    };
    b.surface(4, 6, at);
}

/// One bay of an arcade wall between columns at `x = +-width / 2`, in the plane z = 0: piers,
/// spandrels, soffit and moulded archivolts, from `spring` to `top`.
pub(super) fn arch_bay(width: f32, spring: f32, top: f32) -> Builder {
    let mut b = Builder::default();
    let radius = 0.5 * width - 0.3;
    let steps = 28;
    let on_arc = |t: f32| {
        let (sin, cos) = (PI * (1.0 - t)).sin_cos();
        Vec2::new(radius * cos, spring + radius * sin)
    };
    for side in [1.0, -1.0] {
        let z = 0.5 * WALL_M * side;
        let face = |u: f32, v: f32| {
            let low = on_arc(u);
            let x = low.x * side;
            Vec3::new(x, low.y + (top - low.y) * v, z)
        };
        b.surface(steps, 1, face);
        for pier in [-1.0, 1.0] {
            let from = if pier * side < 0.0 { 0.5 * width } else { radius } * pier;
            let to = if pier * side < 0.0 { radius } else { 0.5 * width } * pier;
            let corner = Vec3::new(from, spring, z);
            b.quad(corner, Vec3::X * (to - from), Vec3::Y * (top - spring));
        }
        archivolt(&mut b, radius, spring, side, steps);
        keystone(&mut b, radius, spring, side);
    }
    b.surface(steps, 2, |u, v| {
        let p = on_arc(u);
        Vec3::new(p.x, p.y, WALL_M * (v - 0.5))
    });
    for pier in [-1.0, 1.0] {
        let from = if pier < 0.0 { -0.5 * width } else { radius };
        let corner = Vec3::new(from, spring, -0.5 * WALL_M);
        b.quad(corner, Vec3::X * (0.5 * width - radius), Vec3::Z * WALL_M);
    }
    b
}

/// A moulding of three fasciae and a roll around the arch, on one face of the wall.
fn archivolt(b: &mut Builder, radius: f32, spring: f32, side: f32, steps: u32) {
    let mut profile = sharp(&[[0.0, 0.0], [0.0, 0.04], [0.06, 0.04], [0.06, 0.065], [0.12, 0.065]]);
    profile.push(Vec2::new(0.12, 0.065));
    profile.extend(arc([0.155, 0.065], [0.035, 0.035], 180.0, 0.0, 6));
    profile.push(Vec2::new(0.19, 0.065));
    profile.extend(sharp(&[[0.19, 0.065], [0.22, 0.05], [0.22, 0.0]]));
    // The profile's a runs outwards from the arch, and b off the wall. Seen that way, the outside
    // is on its left, and on the sweep's right.
    profile.reverse();
    let frames: Vec<_> = (0..=steps)
        .map(|i| {
            let (sin, cos) = (PI * i as f32 / steps as f32).sin_cos();
            let x = Vec3::new(cos, sin, 0.0);
            Frame {
                origin: Vec3::new(radius * cos, spring + radius * sin, 0.5 * WALL_M * side),
                x,
                y: Vec3::Z * side,
                normal_x: x,
            }
        })
        .collect();
    b.sweep(&frames, &profile);
}

fn keystone(b: &mut Builder, radius: f32, spring: f32, side: f32) {
    let z = 0.5 * WALL_M * side;
    let (low, high) = (spring + radius - 0.04, spring + radius + 0.34);
    let min = Vec3::new(-0.11, low, z.min(z + 0.13 * side));
    b.block(min, Vec3::new(0.11, high, z.max(z + 0.13 * side)));
}

/// A length of balustrade along x around the origin: plinth, turned balusters, rail.
pub(super) fn balustrade(length: f32) -> Builder {
    let mut b = Builder::default();
    b.block_on(Vec3::ZERO, Vec3::new(length, 0.1, 0.26));
    b.block_on(Vec3::Y * 0.86, Vec3::new(length, 0.07, 0.24));
    b.block_on(Vec3::Y * 0.93, Vec3::new(length, 0.06, 0.32));
    let count = (length / 0.24) as u32;
    let mut profile = vec![Vec2::new(0.05, 0.14)];
    profile.extend((0..=11).map(|i| {
        let t = i as f32 / 11.0;
        let belly = (PI * t.powf(0.55)).sin().max(0.0);
        Vec2::new(0.03 + 0.055 * belly, 0.15 + 0.55 * t)
    }));
    profile.extend(arc([0.034, 0.74], [0.024, 0.025], -90.0, 90.0, 4));
    profile.push(Vec2::new(0.034, 0.82));
    for i in 0..count {
        let x = ((i as f32 + 0.5) / count as f32 - 0.5) * length;
        b.block_on(Vec3::new(x, 0.1, 0.0), Vec3::new(0.13, 0.04, 0.13));
        b.lathe(Vec3::X * x, 10, &profile);
        b.block_on(Vec3::new(x, 0.82, 0.0), Vec3::new(0.12, 0.04, 0.12));
    }
    b
}

/// A coffer of a ceiling, `width` by `depth`, hanging down from y = 0: three stepped frames.
pub(super) fn coffer(width: f32, depth: f32) -> Builder {
    let mut b = Builder::default();
    let half = Vec2::new(0.5 * width, 0.5 * depth);
    let steps = sharp(&[[0.0, -0.34], [0.16, -0.34], [0.16, -0.24], [0.26, -0.2], [0.26, -0.08]]);
    let mut profile = steps;
    let last = profile[profile.len() - 1];
    profile.push(last);
    profile.extend(arc([0.32, -0.08], [0.06, 0.06], 180.0, 90.0, 6));
    for (out, along, reach, run) in [
        (Vec3::X, Vec3::NEG_Z, half.x, half.y),
        (Vec3::NEG_X, Vec3::Z, half.x, half.y),
        (Vec3::Z, Vec3::X, half.y, half.x),
        (Vec3::NEG_Z, Vec3::NEG_X, half.y, half.x),
    ] {
        let edge = -out * reach;
        b.moulding(edge - along * run, edge + along * run, out, -1.0, &profile);
    }
    let inner = half - 0.32;
    let corner = Vec3::new(-inner.x, -0.02, -inner.y);
    b.quad(corner, Vec3::X * (2.0 * inner.x), Vec3::Z * (2.0 * inner.y));
    let rose = [[0.0, -0.09], [0.07, -0.085], [0.13, -0.05], [0.16, -0.02]];
    b.lathe(Vec3::ZERO, 16, &rose.map(Vec2::from));
    b
}

/// A cloth that hangs from y = 0 between x = +-width / 2, `drop` metres long, with folds that grow
/// downwards. Each banner has its own `phase`.
pub(super) fn banner(width: f32, drop: f32, phase: f32) -> Builder {
    let mut b = Builder::default();
    b.surface(32, 36, |u, v| {
        let (x, t) = (u - 0.5, 1.0 - v);
        let depth = 0.015 + 0.075 * t.powf(0.7);
        let fold = (x * 30.0 + phase + 0.9 * (3.0 * t + phase).sin()).sin();
        let wide = (x * 11.0 - 1.7 * phase + 1.5 * t).sin();
        let sway = 0.12 * t * t * (phase * 2.3).sin();
        let hem = 0.06 * (x * x * 4.0) + 0.02 * fold * t;
        let narrow = 1.0 - 0.07 * t;
        Vec3::new(x * width * narrow, -drop * t + hem * t, depth * (fold + 0.6 * wide) + sway)
    });
    b
}

/// A vase: foot, belly, neck and lip, open at the top.
pub(super) fn vase(height: f32) -> Builder {
    let mut b = Builder::default();
    let at = |r: f32, y: f32| Vec2::new(r, y) * height;
    let mut profile = sharp(&[[0.0, 0.0], [0.2, 0.0], [0.2, 0.04]].map(|p| p.map(|x| x * height)));
    profile.push(at(0.2, 0.04));
    profile.extend((0..=20).map(|i| {
        let t = i as f32 / 20.0;
        let belly = (PI * t.powf(1.5)).sin().max(0.0);
        at(0.12 + 0.26 * belly + 0.06 * (t - 0.8).max(0.0) * 5.0, 0.06 + 0.86 * t)
    }));
    profile.extend(arc([0.19 * height, 0.95 * height], [0.03 * height; 2], -60.0, 180.0, 6));
    profile.extend([at(0.13, 0.86), at(0.12, 0.7), at(0.0, 0.66)]);
    b.lathe(Vec3::ZERO, 28, &profile);
    b
}

/// The metal of a lantern that hangs `chain` metres below y = 0, and its glowing glass.
pub(super) fn lantern(chain: f32) -> (Builder, Builder) {
    let (mut metal, mut glass) = (Builder::default(), Builder::default());
    let low = Vec3::Y * -chain;
    metal.lathe(low, 8, &[Vec2::new(0.012, 0.0), Vec2::new(0.012, chain)]);
    let cap = sharp(&[[0.0, -0.07], [0.19, -0.08], [0.16, -0.05], [0.07, 0.02], [0.012, 0.12]]);
    metal.lathe(low, 24, &cap);
    let tray = sharp(&[[0.0, -0.56], [0.07, -0.53], [0.13, -0.47], [0.19, -0.43], [0.0, -0.42]]);
    metal.lathe(low, 24, &tray);
    for i in 0..6 {
        let (sin, cos) = (TAU * i as f32 / 6.0).sin_cos();
        let foot = low + Vec3::new(0.165 * cos, -0.44, 0.165 * sin);
        metal.block_on(foot, Vec3::new(0.014, 0.37, 0.014));
    }
    let bulb = arc([0.0, -0.25], [0.13, 0.17], -89.0, 89.0, 20);
    glass.lathe(low, 32, &bulb);
    (metal, glass)
}

/// The fountain: stone basin and pedestal with a bowl, its water, and the bronze knot above.
pub(super) fn fountain() -> [Builder; 3] {
    let (mut stone, mut water, mut bronze) =
        (Builder::default(), Builder::default(), Builder::default());
    let mut rim = sharp(&[[2.3, 0.0], [2.3, 0.12], [2.12, 0.16], [2.05, 0.42]]);
    rim.push(rim[rim.len() - 1]);
    rim.extend(arc([2.05, 0.5], [0.13, 0.08], -90.0, 90.0, 10));
    rim.extend(sharp(&[[1.9, 0.58], [1.9, 0.1], [0.0, 0.1]]));
    stone.lathe(Vec3::ZERO, 96, &rim);
    let mut foot = sharp(&[[0.5, 0.1], [0.5, 0.3], [0.4, 0.34]]);
    foot.extend((0..=16).map(|i| {
        let t = i as f32 / 16.0;
        Vec2::new(0.2 + 0.18 * (1.0 - t).powi(2) + 0.06 * (PI * t).sin(), 0.34 + 0.76 * t)
    }));
    foot.extend((0..=16).map(|i| {
        let t = i as f32 / 16.0;
        Vec2::new(0.2 + 0.85 * t.powf(0.7), 1.1 + 0.34 * t * t)
    }));
    foot.extend(arc([1.05, 1.48], [0.06, 0.04], -60.0, 120.0, 8));
    foot.extend([Vec2::new(0.9, 1.42), Vec2::new(0.3, 1.3), Vec2::new(0.0, 1.28)]);
    stone.lathe(Vec3::ZERO, 64, &foot);
    water.lathe(Vec3::Y * 0.44, 64, &[Vec2::new(1.9, 0.0), Vec2::ZERO]);
    water.lathe(Vec3::Y * 1.42, 48, &[Vec2::new(0.9, 0.0), Vec2::ZERO]);
    bronze.lathe(Vec3::Y * 1.28, 32, &arc([0.0, 0.0], [0.2, 0.3], 0.0, 85.0, 12));
    bronze.surface(256, 24, knot);
    [stone, water, bronze]
}

/// A (2, 3) torus knot standing on the pedestal.
fn knot(u: f32, v: f32) -> Vec3 {
    let curve = |u: f32| {
        let t = TAU * u;
        let r = 0.40 + 0.17 * (3.0 * t).cos();
        let (sin, cos) = (2.0 * t).sin_cos();
        Vec3::new(r * cos, 2.16 + r * sin, 0.2 * (3.0 * t).sin())
    };
    let along = (curve(u + 1e-3) - curve(u - 1e-3)).normalize();
    let side = along.cross(Vec3::Z).normalize();
    let up = side.cross(along);
    let (sin, cos) = (TAU * v).sin_cos();
    curve(u) + 0.085 * (side * cos + up * sin)
}

/// A slab around the court: between `inner` and `outer` half sizes, from `low` to `high`.
pub(super) fn ring(low: f32, high: f32, inner: Vec2, outer: Vec2) -> Builder {
    let mut b = Builder::default();
    for side in [-1.0, 1.0] {
        let (near, far) = (inner.y * side, outer.y * side);
        b.block(Vec3::new(-outer.x, low, near.min(far)), Vec3::new(outer.x, high, near.max(far)));
        let (near, far) = (inner.x * side, outer.x * side);
        b.block(Vec3::new(near.min(far), low, -inner.y), Vec3::new(near.max(far), high, inner.y));
    }
    b
}

/// A paver whose top is at y = 0 and whose edges are bevelled.
pub(super) fn paver(b: &mut Builder, top: Vec3, size: f32, bevel: f32) {
    let half = 0.5 * size;
    let profile = [Vec2::new(half, -bevel), Vec2::new(half - bevel, 0.0)];
    for (out, along) in [
        (Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_X, Vec3::Z),
        (Vec3::Z, Vec3::X),
        (Vec3::NEG_Z, Vec3::NEG_X),
    ] {
        // The ends meet at the corners, so each is shorter by half a side per metre of the
        // profile's reach.
        b.moulding(top, top + along * 1e-4, out, 1.0, &profile);
    }
    let inner = half - bevel;
    let corner = top - Vec3::new(inner, 0.0, inner);
    b.quad(corner, Vec3::Z * (2.0 * inner), Vec3::X * (2.0 * inner));
}
