//! Gabled roofs of tiles or slates, with dormers and chimneys.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat4, Vec2, Vec3};

use super::{
    kit::Parts,
    materials::Surface,
    window::{Opening, Trim, storey},
};
use crate::builder::Builder;

/// A gabled roof whose ridge runs along x.
#[derive(Clone, Copy)]
pub(super) struct Roof {
    /// Length of the walls below it along x, and depth along z, metres.
    pub(super) length_m: f32,
    pub(super) depth_m: f32,
    /// Height of the eaves, metres.
    pub(super) eaves_m: f32,
    /// Slope, radians.
    pub(super) pitch: f32,
    /// How far it overhangs the walls at the eaves and at the gables, metres.
    pub(super) over_m: [f32; 2],
    pub(super) surface: Surface,
    /// Tiles as geometry.
    pub(super) fine: bool,
}

impl Roof {
    /// Height of the ridge's underside, metres.
    pub(super) fn ridge_m(&self) -> f32 {
        self.eaves_m + 0.5 * self.depth_m * self.pitch.tan()
    }

    /// Slopes, their boards, the ridge, and the gables in `wall`.
    pub(super) fn build(&self, wall: Surface) -> Parts {
        let mut parts = Parts::default();
        let half = Mat4::from_rotation_y(PI);
        self.slope(&mut parts, &Mat4::IDENTITY);
        self.slope(&mut parts, &half);
        let (x, z) = (0.5 * self.length_m, 0.5 * self.depth_m);
        let gable = [
            Vec3::new(x, self.eaves_m, z),
            Vec3::new(x, self.eaves_m, -z),
            Vec3::new(x, self.ridge_m(), 0.0),
        ];
        for turn in [Mat4::IDENTITY, half] {
            parts.mesh(wall).gable(gable.map(|p| turn.transform_point3(p)));
        }
        let ridge = self.ridge_m() + 0.02;
        let reach = x + self.over_m[1];
        let steps = if self.fine { 24 } else { 1 };
        parts.mesh(self.surface).surface(steps, if self.fine { 6 } else { 2 }, |u, v| {
            let (sin, cos) = (PI * v).sin_cos();
            let swell = if self.fine { 0.02 * (u * steps as f32 * PI).sin().abs() } else { 0.0 };
            let r = 0.16 + swell;
            Vec3::new((2.0 * u - 1.0) * reach, ridge + r * sin, r * cos)
        });
        parts
    }

    /// The slope towards +z, turned.
    fn slope(&self, parts: &mut Parts, turn: &Mat4) {
        let (sin, cos) = self.pitch.sin_cos();
        let run = 0.5 * self.depth_m + self.over_m[0];
        let (length, reach) = (run / cos, 0.5 * self.length_m + self.over_m[1]);
        let foot = Vec3::new(0.0, self.eaves_m - self.over_m[0] * sin / cos, run);
        let up = Vec3::new(0.0, sin, -cos);
        let out = Vec3::new(0.0, cos, sin);
        let frame = turn
            * Mat4::from_cols(
                Vec3::X.extend(0.0),
                up.extend(0.0),
                out.extend(0.0),
                foot.extend(1.0),
            );
        let mut tiles = Builder::default();
        if self.fine {
            courses(&mut tiles, self.surface == Surface::Slate, reach, length);
        } else {
            let corner = Vec3::new(-reach, 0.0, 0.06);
            tiles.quad(corner, Vec3::X * (2.0 * reach), Vec3::Y * length);
        }
        parts.append_to(self.surface, &tiles, &frame);
        // Boards: soffit, eaves, and the two verges.
        let mut boards = Builder::default();
        let soffit = Vec3::new(-reach, 0.0, -0.06);
        boards.quad(soffit, Vec3::Y * length, Vec3::X * (2.0 * reach));
        boards.quad(soffit, Vec3::X * (2.0 * reach), Vec3::Z * 0.14);
        for side in [-1.0, 1.0] {
            let (near, far) = (reach * side, (reach + 0.05) * side);
            let low = Vec3::new(near.min(far), -0.05, -0.12);
            boards.block(low, Vec3::new(near.max(far), length + 0.05, 0.13));
        }
        parts.append_to(Surface::Timber, &boards, &frame);
    }

    /// A dormer on the slope towards +z, its middle at `x`.
    pub(super) fn dormer(&self, parts: &mut Parts, x: f32, trim: Trim) {
        let (width, height, front) = (1.5, 1.5, 0.5 * self.depth_m - 0.5);
        let low = self.eaves_m + 0.5 * self.pitch.tan();
        let depth = 1.1 * height / self.pitch.tan() + 0.8;
        let mut dormer = Parts::default();
        let window = Opening {
            middle_m: 0.0,
            foot_m: 0.25,
            width_m: 0.8,
            height_m: 1.05,
            is_door: false,
            has_flowers: false,
        };
        let trim = Trim { shutters: false, ..trim };
        storey(&mut dormer, &Mat4::IDENTITY, width, [-0.4, height], &[window], trim);
        let cheeks = dormer.mesh(trim.wall);
        let half = 0.5 * width;
        let sides = Vec3::Y * (height + 0.4);
        cheeks.quad(Vec3::new(half, -0.4, 0.0), Vec3::NEG_Z * depth, sides);
        cheeks.quad(Vec3::new(-half, -0.4, -depth), Vec3::Z * depth, sides);
        let roof = Roof {
            length_m: depth,
            depth_m: width,
            eaves_m: height,
            pitch: 0.7,
            over_m: [0.15, 0.15],
            fine: false,
            ..*self
        };
        let turn =
            Mat4::from_translation(Vec3::Z * (-0.5 * depth)) * Mat4::from_rotation_y(FRAC_PI_2);
        dormer.append(&roof.build(trim.wall), &turn);
        parts.append(&dormer, &Mat4::from_translation(Vec3::new(x, low, front)));
    }
}

/// Courses of tiles in the plane z = 0, from y = 0 to `length`, between x = +-`reach`. Each
/// overlaps the one below.
fn courses(b: &mut Builder, slates: bool, reach: f32, length: f32) {
    let (tile, course) = if slates { (0.34, 0.3) } else { (0.36, 0.42) };
    let count = (length / course).ceil().max(1.0);
    let step = length / count;
    let across = (2.0 * reach / tile).ceil().max(1.0);
    let columns = if slates { across as u32 } else { 3 * across as u32 };
    for i in 0..count as u32 {
        let low = i as f32 * step - 0.04;
        let shift = 0.5 * (i % 2) as f32;
        let wave = |u: f32| {
            let phase = (u * across + if slates { shift } else { 0.0 }).fract();
            if slates { 0.006 * (phase - 0.5) } else { 0.035 * (PI * phase).sin() }
        };
        let at = |u: f32, height: f32, y: f32| {
            Vec3::new((2.0 * u - 1.0) * reach, y, height + wave(u.clamp(0.0, 1.0)))
        };
        let lower = if slates { 0.05 } else { 0.085 };
        b.surface(columns, 1, |u, v| at(u, lower + (0.02 - lower) * v, low + (step + 0.04) * v));
        b.surface(columns, 1, |u, v| at(u, 0.01 + (lower - 0.01) * v, low));
    }
}

/// A chimney of `height`, standing on y = 0 with some more below.
pub(super) fn chimney(height: f32, fine: bool) -> Parts {
    let mut parts = Parts::default();
    let brick = parts.mesh(Surface::Brick);
    brick.block_on(Vec3::Y * -1.5, Vec3::new(0.7, height + 1.5, 0.55));
    brick.block_on(Vec3::Y * (height - 0.25), Vec3::new(0.84, 0.14, 0.69));
    parts.mesh(Surface::Stone).block_on(Vec3::Y * height, Vec3::new(0.8, 0.08, 0.65));
    if fine {
        let pot = [[0.1, 0.0], [0.13, 0.1], [0.1, 0.4], [0.12, 0.45], [0.07, 0.45], [0.07, 0.2]];
        for x in [-0.17, 0.17] {
            let foot = Vec3::new(x, height + 0.08, 0.0);
            parts.mesh(Surface::TileRed).lathe(foot, 12, &pot.map(Vec2::from));
        }
    }
    parts
}
