//! The church on the square.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Mat4, Vec2, Vec3};

use super::{
    kit::Parts,
    materials::Surface,
    roof::Roof,
    window::{Opening, Trim, storey},
};
use crate::builder::{Builder, arc};

const TRIM: Trim = Trim {
    wall: Surface::Stone,
    paint: Surface::Timber,
    shutters: false,
    lintel: Surface::Stone,
    fine: true,
};

/// A row of `count` tall windows, evenly over a wall of `length`.
fn windows(length: f32, count: u32, foot_m: f32, size: [f32; 2]) -> Vec<Opening> {
    let at = |i: u32| Opening {
        middle_m: length * ((i as f32 + 0.5) / count as f32 - 0.5),
        foot_m,
        width_m: size[0],
        height_m: size[1],
        is_door: false,
        has_flowers: false,
    };
    (0..count).map(at).collect()
}

/// The church: a tower at +z with the door, the nave towards -z, around 8 by 26 metres.
pub(super) fn church(fine: bool) -> Parts {
    let trim = Trim { fine, ..TRIM };
    let mut parts = Parts::default();
    nave(&mut parts, trim);
    tower(&mut parts, trim);
    parts
}

fn nave(parts: &mut Parts, trim: Trim) {
    let (width, length, high) = (9.0, 18.0, 9.0);
    let middle = Mat4::from_translation(Vec3::Z * -4.0);
    let mut added = Parts::default();
    for (turn, side, across, count) in
        [(FRAC_PI_2, length, width, 5), (PI, width, length, 1), (-FRAC_PI_2, length, width, 5)]
    {
        let face = Mat4::from_rotation_y(turn) * Mat4::from_translation(Vec3::Z * (0.5 * across));
        let rows = windows(side, count, 2.6, [1.3, 4.6]);
        storey(&mut added, &face, side, [-1.0, high], &rows, trim);
        let mut piers = Builder::default();
        for i in 0..=count {
            let x = side * (i as f32 / count as f32 - 0.5);
            piers.block(Vec3::new(x - 0.35, -1.0, -0.1), Vec3::new(x + 0.35, 5.0, 1.1));
            piers.block(Vec3::new(x - 0.35, 5.0, -0.1), Vec3::new(x + 0.35, 7.6, 0.6));
        }
        added.append_to(Surface::Stone, &piers, &face);
    }
    let roof = Roof {
        length_m: length,
        depth_m: width,
        eaves_m: high,
        pitch: 0.95,
        over_m: [0.4, 0.2],
        surface: Surface::Slate,
        fine: trim.fine,
    };
    added.append(&roof.build(Surface::Stone), &Mat4::from_rotation_y(FRAC_PI_2));
    parts.append(&added, &middle);
}

fn tower(parts: &mut Parts, trim: Trim) {
    let (side, high) = (6.4, 23.0);
    let middle = Mat4::from_translation(Vec3::Z * 7.0);
    let mut added = Parts::default();
    for quarter in 0..4 {
        let turn = Mat4::from_rotation_y(FRAC_PI_2 * quarter as f32);
        let face = turn * Mat4::from_translation(Vec3::Z * (0.5 * side));
        let door = [Opening { is_door: true, ..windows(side, 1, 0.3, [2.0, 3.4])[0] }];
        let low: &[Opening] = if quarter == 0 { &door } else { &[] };
        storey(&mut added, &face, side, [-1.0, 6.0], low, trim);
        storey(&mut added, &face, side, [6.0, 13.0], &windows(side, 1, 7.5, [0.9, 3.0]), trim);
        storey(&mut added, &face, side, [13.0, high], &windows(side, 2, 17.5, [1.2, 3.6]), trim);
        let mut trims = Builder::default();
        for y in [6.0, 13.0, high - 0.5] {
            trims.block(
                Vec3::new(-0.5 * side - 0.2, y, -0.1),
                Vec3::new(0.5 * side + 0.2, y + 0.4, 0.2),
            );
        }
        added.append_to(Surface::Stone, &trims, &face);
        let dial = arc([0.0, 0.0], [1.2, 0.06], 0.0, 89.0, 6);
        let mut clock = Builder::default();
        clock.lathe(Vec3::ZERO, 32, &dial);
        let at = face * Mat4::from_translation(Vec3::Y * 15.2) * Mat4::from_rotation_x(FRAC_PI_2);
        added.append_to(Surface::White, &clock, &at);
        let mut hands = Builder::default();
        hands.block(Vec3::new(-0.05, 15.2, 0.06), Vec3::new(0.05, 16.2, 0.1));
        hands.block(Vec3::new(0.0, 15.15, 0.06), Vec3::new(0.7, 15.25, 0.1));
        for hour in 0..12 {
            let (sin, cos) = (TAU * hour as f32 / 12.0).sin_cos();
            hands.block_on(Vec3::new(1.0 * sin, 15.14 + cos, 0.07), Vec3::new(0.1, 0.1, 0.06));
        }
        added.append_to(Surface::Gold, &hands, &face);
        spire(&mut added, &turn, high, 0.5 * side + 0.35, trim.fine);
    }
    let ball = arc([0.0, high + 13.3], [0.35, 0.35], -88.0, 88.0, 8);
    added.mesh(Surface::Gold).lathe(Vec3::ZERO, 16, &ball);
    let mast = [Vec2::new(0.06, high + 12.8), Vec2::new(0.06, high + 15.6)];
    added.mesh(Surface::Iron).lathe(Vec3::ZERO, 8, &mast);
    added.mesh(Surface::Gold).block_on(Vec3::Y * (high + 14.6), Vec3::new(1.0, 0.12, 0.1));
    parts.append(&added, &middle);
}

/// A quarter of the spire, the one above +z: courses that end in the tip.
fn spire(parts: &mut Parts, turn: &Mat4, foot: f32, half: f32, fine: bool) {
    let rise = 13.0;
    let courses = if fine { 44 } else { 1 };
    let mut slates = Builder::default();
    for i in 0..courses {
        let (a, b) = (i as f32 / courses as f32, (i + 1) as f32 / courses as f32);
        // Flared at the foot.
        let reach = |t: f32| half * (1.0 - t) * (1.0 - 0.25 * (PI * t).sin());
        let lip = if fine { 0.04 } else { 0.0 };
        let (low, high) = (reach(a) + lip, reach(b));
        let corner = |x: f32, t: f32, r: f32| Vec3::new(x, foot + rise * t, r);
        let [p, q] = [-low, low].map(|x| corner(x, a, low));
        let [r, s] = [high, -high].map(|x| corner(x, b, high));
        slates.gable([p, q, r]);
        if i + 1 < courses {
            slates.gable([p, r, s]);
        }
    }
    slates.quad(Vec3::new(-half, foot, 0.0), Vec3::X * (2.0 * half), Vec3::Z * half);
    parts.append_to(Surface::Slate, &slates, turn);
}
