//! The plan of the town: streets and blocks on a slope.
//!
//! Blocks of 24 m lie between streets of 8 m. The ground's height is the sum of a function of x and
//! a function of z, both linear across each block and each street. So the ground of every block,
//! street or crossing is one plane, and pieces sheared onto it meet without gaps.

use glam::{Mat4, Vec3};

/// Side of a block, metres.
pub(super) const BLOCK_M: f32 = 24.0;
/// Width of a street between its kerbs, metres.
pub(super) const STREET_M: f32 = 8.0;
/// Distance between the middles of neighbouring streets, metres.
pub(super) const PITCH_M: f32 = BLOCK_M + STREET_M;
/// Width of the meadow around the town, metres.
pub(super) const MEADOW_M: f32 = 24.0;

/// The plan: `blocks` by `blocks` blocks around the origin, and the ground under them.
pub(super) struct Land {
    /// Blocks along each side.
    pub(super) blocks: u32,
    /// Knots along x and along z: coordinate and height, metres.
    knots: [Vec<[f32; 2]>; 2],
}

/// A rectangle of the plan, from its smallest to its largest x and z, metres.
#[derive(Clone, Copy)]
pub(super) struct Lot {
    pub(super) min: [f32; 2],
    pub(super) max: [f32; 2],
}

impl Lot {
    pub(super) fn center(&self) -> [f32; 2] {
        [0, 1].map(|axis| 0.5 * (self.min[axis] + self.max[axis]))
    }

    pub(super) fn size(&self) -> [f32; 2] {
        [0, 1].map(|axis| self.max[axis] - self.min[axis])
    }
}

impl Land {
    /// A plan whose ground rises towards -z, falls off to both sides, and is level at the square.
    pub(super) fn new(blocks: u32) -> Self {
        let mut land = Self { blocks, knots: [Vec::new(), Vec::new()] };
        let half = 0.5 * land.side_m();
        let (first, count) = land.square();
        let level = [land.block(first), land.block(first + count - 1)];
        let (low, high) = (level.map(|(from, _)| from)[0], level.map(|(_, to)| to)[1]);
        let mut at = vec![-half - MEADOW_M];
        at.extend((0..=blocks).flat_map(|s| [land.street(s) - 4.0, land.street(s) + 4.0]));
        at.push(half + MEADOW_M);
        // Signed distance from the level part.
        let off = |x: f32| if x < low { x - low } else { (x - high).max(0.0) };
        let side = |x: &f32| [*x, -0.018 * off(*x).abs() + 1e-4 * off(*x).powi(2)];
        let climb = |z: &f32| [*z, -0.035 * off(*z)];
        land.knots = [at.iter().map(side).collect(), at.iter().map(climb).collect()];
        land
    }

    /// Length of the town's side, metres.
    pub(super) fn side_m(&self) -> f32 {
        self.blocks as f32 * PITCH_M + STREET_M
    }

    /// The middle line of street `ix`, 0 to `blocks`, along x or z.
    pub(super) fn street(&self, ix: u32) -> f32 {
        ix as f32 * PITCH_M + 0.5 * STREET_M - 0.5 * self.side_m()
    }

    /// Where block `ix` begins and ends, along x or z.
    pub(super) fn block(&self, ix: u32) -> (f32, f32) {
        let start = self.street(ix) + 0.5 * STREET_M;
        (start, start + BLOCK_M)
    }

    /// The index of the square's first block, along x and z alike, and the number of its blocks.
    pub(super) fn square(&self) -> (u32, u32) {
        ((self.blocks.saturating_sub(1)) / 2, if self.blocks >= 6 { 2 } else { 1 })
    }

    /// Whether that block is part of the square.
    pub(super) fn is_square(&self, x: u32, z: u32) -> bool {
        let (first, count) = self.square();
        [x, z].iter().all(|ix| (first..first + count).contains(ix))
    }

    /// Height of the ground, metres.
    pub(super) fn height(&self, x: f32, z: f32) -> f32 {
        interpolated(&self.knots[0], x) + interpolated(&self.knots[1], z)
    }

    /// Coordinates at which the ground's slope changes, along x (0) or z (1).
    pub(super) fn knots(&self, axis: usize) -> impl Iterator<Item = f32> + '_ {
        self.knots[axis].iter().map(|[at, _]| *at)
    }

    /// Places a thing upright at a point of the ground.
    pub(super) fn at(&self, x: f32, z: f32) -> Mat4 {
        Mat4::from_translation(Vec3::new(x, self.height(x, z), z))
    }

    /// Places a thing on the middle of a lot and shears it to the lot's slope; upright lines stay
    /// upright.
    pub(super) fn on(&self, lot: Lot) -> Mat4 {
        let [x, z] = lot.center();
        let [width, depth] = lot.size();
        let along_x = self.height(lot.max[0], z) - self.height(lot.min[0], z);
        let along_z = self.height(x, lot.max[1]) - self.height(x, lot.min[1]);
        let mut shear = self.at(x, z);
        shear.x_axis.y = along_x / width;
        shear.z_axis.y = along_z / depth;
        shear
    }
}

fn interpolated(knots: &[[f32; 2]], at: f32) -> f32 {
    let after = knots.iter().position(|[x, _]| *x > at).unwrap_or(knots.len() - 1).max(1);
    let ([x0, y0], [x1, y1]) = (knots[after - 1], knots[after]);
    y0 + (y1 - y0) * ((at - x0) / (x1 - x0)).clamp(0.0, 1.0)
}
