//! Houses: plinth, storeys with windows, gabled roof.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat4, Vec3};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::{
    kit::Parts,
    materials::Surface,
    roof::{Roof, chimney},
    window::{Opening, Trim, storey},
};

/// The parameters of a house. Its front faces +z, and its middle stands on the origin.
#[derive(Clone, Copy)]
pub(super) struct Design {
    /// Size along x and z, metres.
    pub(super) size_m: [f32; 2],
    pub(super) storeys: u32,
    pub(super) trim: Trim,
    pub(super) roof: Surface,
    /// Timber frame on the upper storeys.
    pub(super) framed: bool,
    /// Gable over the front, not over the sides.
    pub(super) gable_front: bool,
    pub(super) dormers: bool,
    /// Whether it has windows on the side +x as well, because it stands at a corner.
    pub(super) corner: bool,
}

/// Height of the ground floor above the ground, metres.
const PLINTH_M: f32 = 0.45;
const GROUND_FLOOR_M: f32 = 3.1;
const STOREY_M: f32 = 2.75;

impl Design {
    /// A random house.
    pub(super) fn random(rng: &mut Pcg64Mcg, size_m: [f32; 2], corner: bool, fine: bool) -> Self {
        use Surface::{Blue, Brick, Cream, Green, Grey, Ochre, Oxblood, Rose};
        let pick = |rng: &mut Pcg64Mcg, from: &[Surface]| from[rng.random_range(0..from.len())];
        let framed = rng.random::<f32>() < 0.3;
        let wall = if framed {
            pick(rng, &[Cream, Cream, Grey])
        } else {
            pick(rng, &[Cream, Ochre, Rose, Grey, Ochre, Rose, Brick, Brick])
        };
        let trim = Trim {
            wall,
            paint: pick(rng, &[Green, Blue, Oxblood]),
            shutters: !framed && rng.random::<f32>() < 0.75,
            lintel: if framed { Surface::Timber } else { Surface::Stone },
            fine,
        };
        let gable_front = !corner && rng.random::<f32>() < 0.4;
        Self {
            size_m,
            storeys: rng.random_range(2..=3) + u32::from(rng.random::<f32>() < 0.12),
            trim,
            roof: pick(
                rng,
                &[Surface::TileRed, Surface::TileRed, Surface::TileBrown, Surface::Slate],
            ),
            framed,
            gable_front,
            dormers: !gable_front && rng.random::<f32>() < 0.6,
            corner,
        }
    }

    /// The house.
    pub(super) fn build(&self, rng: &mut Pcg64Mcg) -> Parts {
        let mut parts = Parts::default();
        let [width, depth] = self.size_m;
        let mut low = PLINTH_M;
        for floor in 0..self.storeys {
            let high = low + if floor == 0 { GROUND_FLOOR_M } else { STOREY_M };
            self.storey(&mut parts, rng, floor, [low, high]);
            low = high;
        }
        let plinth = Vec3::new(width + 0.1, PLINTH_M + 1.6, depth + 0.1);
        parts.mesh(Surface::Stone).block_on(Vec3::Y * -1.6, plinth);
        self.cap(&mut parts, rng, low);
        parts
    }

    /// Four walls of one storey.
    fn storey(&self, parts: &mut Parts, rng: &mut Pcg64Mcg, floor: u32, heights: [f32; 2]) {
        let [width, depth] = self.size_m;
        let sides = [
            (0.0, width, depth, true),
            (FRAC_PI_2, depth, width, self.corner),
            (PI, width, depth, true),
            (-FRAC_PI_2, depth, width, false),
        ];
        for (ix, (turn, length, across, open)) in sides.into_iter().enumerate() {
            let face =
                Mat4::from_rotation_y(turn) * Mat4::from_translation(Vec3::Z * (0.5 * across));
            let bays = if open { (length / 2.3) as u32 } else { 0 };
            let door = (ix == 0 && floor == 0).then(|| rng.random_range(0..bays.max(1)));
            let openings: Vec<Opening> = (0..bays)
                .map(|bay| {
                    let middle_m = length * ((bay as f32 + 0.5) / bays as f32 - 0.5);
                    let is_door = door == Some(bay);
                    let (foot_m, height_m) = match (is_door, floor) {
                        (true, _) => (heights[0], 2.3),
                        (_, 0) => (heights[0] + 0.85, 1.65),
                        _ => (heights[0] + 0.8, 1.45),
                    };
                    let width_m = if is_door { 1.1 } else { 0.95 };
                    let has_flowers = floor > 0 && ix < 2 && rng.random::<f32>() < 0.3;
                    Opening { middle_m, foot_m, width_m, height_m, is_door, has_flowers }
                })
                .collect();
            let trim = Trim { shutters: self.trim.shutters && ix < 2, ..self.trim };
            storey(parts, &face, length, heights, &openings, trim);
            if self.framed && floor > 0 {
                self.timbers(parts, &face, length, heights, &openings);
            }
            if !self.framed && floor > 0 && open {
                let band = Vec3::new(0.5 * length, heights[0] + 0.12, 0.05);
                let mut stone = crate::builder::Builder::default();
                stone.block(Vec3::new(-0.5 * length, heights[0] - 0.06, -0.02), band);
                parts.append_to(Surface::Stone, &stone, &face);
            }
        }
    }

    /// Posts beside the openings, rails, and braces in the outer bays.
    fn timbers(
        &self,
        parts: &mut Parts,
        face: &Mat4,
        length: f32,
        [low, high]: [f32; 2],
        openings: &[Opening],
    ) {
        let mut beams = crate::builder::Builder::default();
        let half = 0.5 * length;
        let (back, front) = (-0.05, 0.06);
        for y in [low + 0.09, high - 0.09] {
            let (from, to) = (Vec3::new(-half, y - 0.09, back), Vec3::new(half, y + 0.09, front));
            beams.block(from, to);
        }
        let mut posts = vec![-half + 0.09, half - 0.09];
        for opening in openings {
            let reach = 0.5 * opening.width_m + 0.09;
            posts.extend([opening.middle_m - reach, opening.middle_m + reach]);
        }
        if openings.is_empty() {
            posts.extend([-0.3 * half, 0.3 * half]);
        }
        for x in posts {
            let low = Vec3::new(x - 0.08, low + 0.18, back);
            beams.block(low, Vec3::new(x + 0.08, high - 0.18, front - 0.01));
        }
        let end =
            openings.first().map_or(0.5 * half, |o| half + o.middle_m - 0.5 * o.width_m - 0.1);
        let rise = high - low - 0.36;
        let (angle, reach) = (end.atan2(rise), end.hypot(rise));
        for side in [-1.0, 1.0] {
            let mut brace = crate::builder::Builder::default();
            brace.block(Vec3::new(-0.07, 0.0, back), Vec3::new(0.07, reach, front - 0.02));
            let foot = Vec3::new(side * (half - 0.1), low + 0.18, 0.0);
            let at = Mat4::from_translation(foot) * Mat4::from_rotation_z(side * angle * 0.85);
            beams.append(&brace, &at);
        }
        parts.append_to(Surface::Timber, &beams, face);
    }

    /// Roof, dormers and chimneys on walls of that height.
    fn cap(&self, parts: &mut Parts, rng: &mut Pcg64Mcg, eaves_m: f32) {
        let [width, depth] = self.size_m;
        let turn = Mat4::from_rotation_y(if self.gable_front { FRAC_PI_2 } else { 0.0 });
        let [length_m, depth_m] = if self.gable_front { [depth, width] } else { [width, depth] };
        let roof = Roof {
            length_m,
            depth_m,
            eaves_m,
            pitch: 0.72 + 0.2 * rng.random::<f32>(),
            over_m: if self.gable_front { [0.12, 0.35] } else { [0.4, 0.06] },
            surface: self.roof,
            fine: self.trim.fine,
        };
        parts.append(&roof.build(self.trim.wall), &turn);
        if self.dormers {
            for share in [-0.24, 0.24] {
                roof.dormer(parts, share * width, self.trim);
            }
        }
        let (x, z) = (0.3 * length_m * if rng.random() { 1.0 } else { -1.0 }, -0.7);
        let foot = Vec3::new(x, roof.ridge_m() - 0.4, z);
        let stack = chimney(1.5, self.trim.fine);
        parts.append(&stack, &(turn * Mat4::from_translation(foot)));
    }
}
