//! Windows, doors and the walls around them.

use std::f32::consts::PI;

use glam::{Mat4, Vec3};

use super::{kit::Parts, materials::Surface};
use crate::builder::Builder;

/// How far panes lie behind the wall's face, metres.
const REVEAL_M: f32 = 0.2;

/// Size and trim of the openings of a wall.
#[derive(Clone, Copy)]
pub(super) struct Trim {
    /// The wall itself and the sides of openings.
    pub(super) wall: Surface,
    /// Shutters and door.
    pub(super) paint: Surface,
    pub(super) shutters: bool,
    /// Stone or timber around openings.
    pub(super) lintel: Surface,
    /// Slats, mullions and flowers.
    pub(super) fine: bool,
}

/// An opening: the middle of its lower edge and its size, metres, in the wall's plane.
#[derive(Clone, Copy)]
pub(super) struct Opening {
    pub(super) middle_m: f32,
    pub(super) foot_m: f32,
    pub(super) width_m: f32,
    pub(super) height_m: f32,
    pub(super) is_door: bool,
    pub(super) has_flowers: bool,
}

/// One storey of a wall in the plane z = 0 that faces +z. It reaches from x = -`width_m` / 2 to
/// `width_m` / 2 and from `low_m` to `high_m`. Its openings are given from left to right and do not
/// overlap. `face` moves it to its place.
pub(super) fn storey(
    parts: &mut Parts,
    face: &Mat4,
    width_m: f32,
    [low_m, high_m]: [f32; 2],
    openings: &[Opening],
    trim: Trim,
) {
    let mut added = Parts::default();
    let wall = added.mesh(trim.wall);
    let mut quad = |x0: f32, x1: f32, y0: f32, y1: f32| {
        if x1 > x0 + 1e-3 && y1 > y0 + 1e-3 {
            wall.quad(Vec3::new(x0, y0, 0.0), Vec3::X * (x1 - x0), Vec3::Y * (y1 - y0));
        }
    };
    let mut x = -0.5 * width_m;
    for opening in openings {
        let half = 0.5 * opening.width_m;
        let (left, right) = (opening.middle_m - half, opening.middle_m + half);
        quad(x, left, low_m, high_m);
        quad(left, right, low_m, opening.foot_m);
        quad(left, right, opening.foot_m + opening.height_m, high_m);
        x = right;
    }
    quad(x, 0.5 * width_m, low_m, high_m);
    for opening in openings {
        let at = Mat4::from_translation(Vec3::new(opening.middle_m, opening.foot_m, 0.0));
        let parts = if opening.is_door { door(*opening, trim) } else { window(*opening, trim) };
        added.append(&parts, &at);
    }
    parts.append(&added, face);
}

/// The sides of an opening, seen from the front: left, right, top, and bottom.
fn reveal(b: &mut Builder, width: f32, height: f32) {
    let (half, depth) = (0.5 * width, REVEAL_M);
    let back = |x: f32, y: f32| Vec3::new(x, y, -depth);
    b.quad(back(-half, 0.0), Vec3::Y * height, Vec3::Z * depth);
    b.quad(back(half, 0.0), Vec3::Z * depth, Vec3::Y * height);
    b.quad(back(-half, height), Vec3::X * width, Vec3::Z * depth);
    b.quad(back(-half, 0.0), Vec3::Z * depth, Vec3::X * width);
}

/// A frame of four bars in an opening.
fn frame(b: &mut Builder, width: f32, height: f32, bar: f32, [back, front]: [f32; 2]) {
    let half = 0.5 * width;
    b.block(Vec3::new(-half, 0.0, back), Vec3::new(-half + bar, height, front));
    b.block(Vec3::new(half - bar, 0.0, back), Vec3::new(half, height, front));
    b.block(Vec3::new(bar - half, 0.0, back), Vec3::new(half - bar, bar, front));
    b.block(Vec3::new(bar - half, height - bar, back), Vec3::new(half - bar, height, front));
}

/// A window around the middle of its lower edge.
fn window(opening: Opening, trim: Trim) -> Parts {
    let (width, height) = (opening.width_m, opening.height_m);
    let half = 0.5 * width;
    let mut parts = Parts::default();
    reveal(parts.mesh(trim.wall), width, height);
    let pane = Vec3::new(-half, 0.0, -REVEAL_M);
    parts.mesh(Surface::Glass).quad(pane, Vec3::X * width, Vec3::Y * height);
    let sill = Vec3::new(half + 0.1, 0.0, 0.12);
    parts.mesh(Surface::Stone).block(Vec3::new(-half - 0.1, -0.1, -0.02), sill);
    let white = parts.mesh(Surface::White);
    let depth = [-REVEAL_M, -REVEAL_M + 0.08];
    if trim.fine {
        frame(white, width, height, 0.06, depth);
        let bar = 0.5 * 0.05;
        let top = height - 0.06;
        let (back, front) = (depth[0], depth[1] - 0.02);
        white.block(Vec3::new(-bar, 0.06, back), Vec3::new(bar, top, front));
        for share in [0.36, 0.68] {
            let y = share * height;
            let low = Vec3::new(0.06 - half, y - bar, back);
            white.block(low, Vec3::new(half - 0.06, y + bar, front - 0.01));
        }
        let lintel = Vec3::new(half + 0.14, height + 0.2, 0.05);
        parts.mesh(trim.lintel).block(Vec3::new(-half - 0.14, height, -0.02), lintel);
    } else {
        let low = Vec3::new(-0.03, 0.0, depth[0]);
        white.quad(low + Vec3::Z * 0.05, Vec3::X * 0.06, Vec3::Y * height);
    }
    if trim.shutters {
        let panel = shutter(half, height, trim);
        let side = |x: f32, turn: f32| {
            Mat4::from_translation(Vec3::new(x, 0.0, 0.03)) * Mat4::from_rotation_y(turn)
        };
        parts.append_to(trim.paint, &panel, &side(half, 0.03));
        let left = side(-half, -0.03) * Mat4::from_translation(Vec3::X * -half);
        parts.append_to(trim.paint, &panel, &left);
    }
    if opening.has_flowers && trim.fine {
        flower_box(&mut parts, width);
    }
    parts
}

/// A shutter whose hinge is the line x = 0 and which reaches to `width`.
fn shutter(width: f32, height: f32, trim: Trim) -> Builder {
    let mut b = Builder::default();
    if !trim.fine {
        b.block(Vec3::new(0.02, 0.0, 0.0), Vec3::new(width, height, 0.05));
        return b;
    }
    let mut bars = Builder::default();
    frame(&mut bars, width - 0.02, height, 0.06, [0.0, 0.05]);
    b.append(&bars, &Mat4::from_translation(Vec3::X * (0.5 * width + 0.01)));
    let count = (height / 0.14) as u32;
    for i in 0..count {
        let y = 0.06 + (height - 0.12) * (i as f32 + 0.5) / count as f32;
        let mut slat = Builder::default();
        slat.quad(Vec3::new(0.06, -0.05, 0.012), Vec3::X * (width - 0.1), Vec3::Y * 0.11);
        slat.quad(Vec3::new(width - 0.04, -0.05, 0.0), Vec3::X * (0.1 - width), Vec3::Y * 0.11);
        let at = Mat4::from_translation(Vec3::new(0.0, y, 0.02)) * Mat4::from_rotation_x(-0.35);
        b.append(&slat, &at);
    }
    b
}

/// A box of flowers on a sill.
fn flower_box(parts: &mut Parts, width: f32) {
    let half = 0.42 * width;
    let corner = Vec3::new(half, 0.18, 0.26);
    parts.mesh(Surface::Timber).block(Vec3::new(-half, 0.0, 0.04), corner);
    for i in 0..26 {
        let t = (i as f32 + 0.5) / 26.0;
        let turn = i as f32 * 2.4;
        let (sin, cos) = turn.sin_cos();
        let center = Vec3::new((2.0 * t - 1.0) * half, 0.2 + 0.07 * (1.0 + sin), 0.16 + 0.08 * cos);
        let surface = if i % 3 == 0 { Surface::Petal } else { Surface::Leaf };
        let size = if i % 3 == 0 { 0.09 } else { 0.13 };
        let out = Vec3::new(0.4 * cos, 0.5, 0.7 + 0.3 * sin).normalize();
        let u = out.any_orthonormal_vector() * size;
        let v = out.cross(u);
        parts.mesh(surface).card(center - 0.5 * (u + v), u, v, out);
    }
}

/// A door around the middle of its threshold.
fn door(opening: Opening, trim: Trim) -> Parts {
    let (width, height) = (opening.width_m, opening.height_m);
    let half = 0.5 * width;
    let mut parts = Parts::default();
    reveal(parts.mesh(trim.wall), width, height);
    let leaf = parts.mesh(trim.paint);
    leaf.quad(Vec3::new(-half, 0.0, -REVEAL_M), Vec3::X * width, Vec3::Y * height);
    let (low, mid) = (0.5 * height - 0.25, 0.5 * height - 0.1);
    for (x, y, top) in
        [(-half, 0.15, low), (0.0, 0.15, low), (-half, mid, height - 0.5), (0.0, mid, height - 0.5)]
    {
        let corner = Vec3::new(x + half - 0.08, top, -REVEAL_M + 0.03);
        leaf.block(Vec3::new(x + 0.08, y, -REVEAL_M - 0.02), corner);
    }
    let light = Vec3::new(0.08 - half, height - 0.4, -REVEAL_M + 0.01);
    parts.mesh(Surface::Glass).quad(light, Vec3::X * (width - 0.16), Vec3::Y * 0.3);
    let stone = parts.mesh(Surface::Stone);
    for side in [-1.0, 1.0] {
        let (near, far) = (half * side, (half + 0.16) * side);
        let corner = Vec3::new(near.max(far), height + 0.2, 0.06);
        stone.block(Vec3::new(near.min(far), -0.3, -0.02), corner);
    }
    stone.block(Vec3::new(-half, height, -0.02), Vec3::new(half, height + 0.2, 0.06));
    // Two steps that reach below the ground, in case it falls away.
    stone.block(Vec3::new(-half - 0.2, -1.2, -0.1), Vec3::new(half + 0.2, -0.02, 0.35));
    stone.block(Vec3::new(-half - 0.35, -1.2, 0.3), Vec3::new(half + 0.35, -0.2, 0.65));
    if trim.fine {
        let knob =
            [glam::Vec2::new(0.0, -0.03), glam::Vec2::new(0.035, 0.0), glam::Vec2::new(0.0, 0.03)];
        let mut brass = Builder::default();
        brass.lathe(Vec3::ZERO, 8, &knob);
        let at =
            Mat4::from_translation(Vec3::new(0.3 * width, 0.5 * height - 0.18, 0.05 - REVEAL_M));
        parts.append_to(Surface::Gold, &brass, &(at * Mat4::from_rotation_x(0.5 * PI)));
    }
    parts
}
