//! The directions of deep images: spread over the upper hemisphere, found in constant time.

use std::f64::consts::{FRAC_PI_4, TAU};

use assign::{AssignError, Shader};
use glam::{DVec2, DVec3, Mat3, Vec3};

/// How directions are spread over the hemisphere around +z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Spread {
    /// Spherical coordinates (Archer et al. 2019, section 3.1 and figure 2): stacks of equal solid
    /// angle, each cut into slices of equal azimuth.
    #[default]
    StacksAndSlices,
    /// A square cut into `stacks` times `slices`, mapped to the disc (Shirley and Chiu 1997) and on
    /// to the hemisphere with equal areas: cells are about as wide as high everywhere, and of an odd
    /// number the middle one is +z.
    Squares,
}

impl Spread {
    /// `stacks` or `squares`.
    pub fn name(self) -> &'static str {
        match self {
            Self::StacksAndSlices => "stacks",
            Self::Squares => "squares",
        }
    }
}

/// The most directions.
pub const MAX_DIRECTIONS: u32 = 1024;

/// Directions `stack * slices + slice`, unit vectors with z > 0. Each stands for a cell of the
/// hemisphere, all of the same solid angle, and its opposite for the opposite cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Directions {
    spread: Spread,
    stacks: u32,
    slices: u32,
}

impl Default for Directions {
    /// 13 stacks of 13 slices, as the paper.
    fn default() -> Self {
        Self { spread: Spread::default(), stacks: 13, slices: 13 }
    }
}

impl Directions {
    /// Directions in `stacks` rows of `slices`, together at most [`MAX_DIRECTIONS`].
    pub fn new(spread: Spread, stacks: u32, slices: u32) -> Result<Self, AssignError> {
        let count = u64::from(stacks) * u64::from(slices);
        if count == 0 || count > u64::from(MAX_DIRECTIONS) {
            return Err(AssignError::Parameter {
                field: "stacks x slices".into(),
                value: format!("{stacks} x {slices}"),
                accepted: format!("1 to {MAX_DIRECTIONS} together"),
            });
        }
        Ok(Self { spread, stacks, slices })
    }

    /// How they are spread.
    pub fn spread(&self) -> Spread {
        self.spread
    }

    /// Number of directions.
    pub fn count(&self) -> u32 {
        self.stacks * self.slices
    }

    /// Unit direction of an index, in f64; indices wrap around.
    pub fn direction_f64(&self, ix: u32) -> DVec3 {
        let (stack, slice) = (ix / self.slices % self.stacks, ix % self.slices);
        let along = (f64::from(stack) + 0.5) / f64::from(self.stacks);
        let across = (f64::from(slice) + 0.5) / f64::from(self.slices);
        match self.spread {
            Spread::StacksAndSlices => {
                let (sin, cos) = (TAU * across).sin_cos();
                let radius = (1.0 - along * along).sqrt();
                DVec3::new(radius * cos, radius * sin, along)
            }
            Spread::Squares => of_square(DVec2::new(2.0 * across - 1.0, 2.0 * along - 1.0)),
        }
    }

    /// Unit direction of an index; indices wrap around.
    pub fn direction(&self, ix: u32) -> Vec3 {
        self.direction_f64(ix).as_vec3()
    }

    /// Columns right, up and forward of a direction's image: world to image is the transpose.
    pub fn frame(&self, ix: u32) -> Mat3 {
        let forward = self.direction_f64(ix);
        let (right, up) = forward.any_orthonormal_pair();
        Mat3::from_cols(right.as_vec3(), up.as_vec3(), forward.as_vec3())
    }

    /// The direction whose cell holds a unit vector, and whether it is to be reversed: `directions.wesl`,
    /// `nearest_direction`. It is at most [`max_angle`](Self::max_angle) away.
    pub fn nearest(&self, direction: Vec3) -> (u32, bool) {
        let is_reversed = direction.z < 0.0;
        let d = if is_reversed { -direction } else { direction }.as_dvec3();
        let (along, across) = match self.spread {
            Spread::StacksAndSlices => {
                let turn = d.y.atan2(d.x) / TAU;
                (d.z, turn - turn.floor())
            }
            Spread::Squares => {
                let square = to_square(d);
                (0.5 + 0.5 * square.y, 0.5 + 0.5 * square.x)
            }
        };
        let cell = |at: f64, cells: u32| ((at * f64::from(cells)) as u32).min(cells - 1);
        (cell(along, self.stacks) * self.slices + cell(across, self.slices), is_reversed)
    }

    /// The largest angle, radians, between a unit vector and what [`nearest`](Self::nearest) gives
    /// for it: measured at a fine mesh of each cell's rim, rounded up.
    pub fn max_angle(&self) -> f64 {
        let of_cell = |ix: u32| {
            let centre = self.direction_f64(ix);
            self.rim(ix).map(|at| centre.dot(at).clamp(-1.0, 1.0).acos()).fold(0.0, f64::max)
        };
        1.01 * (0..self.count()).map(of_cell).fold(0.0, f64::max)
    }

    /// Unit vectors along the border of a cell.
    fn rim(&self, ix: u32) -> impl Iterator<Item = DVec3> {
        let (stack, slice) = (f64::from(ix / self.slices), f64::from(ix % self.slices));
        let (stacks, slices) = (f64::from(self.stacks), f64::from(self.slices));
        let spread = self.spread;
        (0..=32).flat_map(move |step| {
            let t = f64::from(step) / 32.0;
            [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)].map(|(x, y)| {
                let (along, across) = ((stack + y) / stacks, (slice + x) / slices);
                match spread {
                    Spread::StacksAndSlices => {
                        let (sin, cos) = (TAU * across).sin_cos();
                        let radius = (1.0 - along * along).max(0.0).sqrt();
                        DVec3::new(radius * cos, radius * sin, along)
                    }
                    Spread::Squares => of_square(DVec2::new(2.0 * across - 1.0, 2.0 * along - 1.0)),
                }
            })
        })
    }

    /// Mounts `package::directions` with these counts.
    pub fn mount<'a>(&self, shader: Shader<'a>) -> Shader<'a> {
        let counts = format!(
            "const STACKS: u32 = {}u;\nconst SLICES: u32 = {}u;\n",
            self.stacks, self.slices
        );
        shader
            .module("package::direction_counts", counts)
            .module("package::directions", include_str!("shaders/directions.wesl"))
            .flag("squares", self.spread == Spread::Squares)
    }
}

/// A point of the square [-1, 1]^2 on the hemisphere, areas in proportion: Shirley and Chiu's map to
/// the disc, then Lambert's azimuthal one.
fn of_square(at: DVec2) -> DVec3 {
    if at == DVec2::ZERO {
        return DVec3::Z;
    }
    let disc = if at.x.abs() > at.y.abs() {
        let (sin, cos) = (FRAC_PI_4 * at.y / at.x).sin_cos();
        at.x * DVec2::new(cos, sin)
    } else {
        let (sin, cos) = (FRAC_PI_4 * at.x / at.y).sin_cos();
        at.y * DVec2::new(sin, cos)
    };
    let square = disc.length_squared();
    (disc * (2.0 - square).sqrt()).extend(1.0 - square)
}

/// The inverse of [`of_square`].
fn to_square(d: DVec3) -> DVec2 {
    let disc = d.truncate() / (1.0 + d.z).sqrt();
    let radius = disc.length();
    let (x, y) = (disc.x.abs(), disc.y.abs());
    // The angle from the nearer axis, as a share of an eighth turn.
    let share = (x.min(y) / x.max(y).max(f64::MIN_POSITIVE)).atan() / FRAC_PI_4;
    let (x, y) = if x > y { (radius, radius * share) } else { (radius * share, radius) };
    DVec2::new(x.copysign(disc.x), y.copysign(disc.y))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    fn all() -> impl Iterator<Item = Directions> {
        [Spread::StacksAndSlices, Spread::Squares].into_iter().flat_map(|spread| {
            let of = move |(stacks, slices)| Directions::new(spread, stacks, slices).unwrap();
            [(1, 1), (2, 4), (4, 4), (4, 8), (8, 8), (8, 16), (13, 13)].map(of)
        })
    }

    fn unit(rng: &mut Pcg64Mcg) -> DVec3 {
        loop {
            let at = DVec3::from_array([0; 3].map(|_| rng.random_range(-1.0..1.0)));
            if (0.01..1.0).contains(&at.length()) {
                return at.normalize();
            }
        }
    }

    #[test]
    fn directions_are_their_own_nearest() {
        for directions in all() {
            for ix in 0..directions.count() {
                let direction = directions.direction_f64(ix);
                assert!((direction.length() - 1.0).abs() < 1e-12 && direction.z > 0.0);
                assert_eq!(directions.nearest(direction.as_vec3()), (ix, false), "{directions:?}");
                assert_eq!(directions.nearest(-direction.as_vec3()), (ix, true), "{directions:?}");
                let frame = directions.frame(ix);
                assert!((frame.transpose() * frame).abs_diff_eq(Mat3::IDENTITY, 1e-5));
                assert!((frame.determinant() - 1.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn nearest_is_within_its_bound_and_cells_are_alike() {
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        for directions in all() {
            let bound = directions.max_angle();
            let mut counts = vec![0_u32; directions.count() as usize];
            let (mut farthest, mut sum, mut best) = (0.0_f64, 0.0, 0.0);
            let tries = 20_000;
            for _ in 0..tries {
                let ray = unit(&mut rng);
                let (ix, is_reversed) = directions.nearest(ray.as_vec3());
                let sign = if is_reversed { -1.0 } else { 1.0 };
                let angle = (sign * directions.direction_f64(ix)).dot(ray).min(1.0).acos();
                counts[ix as usize] += 1;
                farthest = farthest.max(angle);
                sum += angle;
                best += (0..directions.count())
                    .map(|ix| directions.direction_f64(ix).dot(ray).abs().min(1.0).acos())
                    .fold(f64::INFINITY, f64::min);
            }
            assert!(farthest <= bound, "{directions:?}: {farthest} of {bound}");
            assert!(farthest > 0.9 * bound, "{directions:?}: {farthest} of {bound}");
            // Not the nearest of all, but hardly farther on average.
            assert!(sum < 1.3 * best || directions.count() == 1, "{directions:?}: {sum} of {best}");
            let mean = f64::from(tries) / f64::from(directions.count());
            let alike = counts.iter().all(|&c| (f64::from(c) - mean).abs() < 6.0 * mean.sqrt());
            assert!(alike, "{directions:?}: {counts:?}");
            println!(
                "{directions:?}: at most {:.1} degrees, {:.1} on average, {:.1} by search",
                bound.to_degrees(),
                sum.to_degrees() / 2e4,
                best.to_degrees() / 2e4
            );
        }
    }

    #[test]
    fn counts_are_checked() {
        for (stacks, slices) in [(0, 3), (3, 0), (33, 32), (u32::MAX, u32::MAX)] {
            assert!(Directions::new(Spread::Squares, stacks, slices).is_err());
        }
        assert!(Directions::new(Spread::Squares, 32, 32).is_ok());
    }
}
