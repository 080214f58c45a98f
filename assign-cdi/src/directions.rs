//! The directions of deep images. They are spread over the upper hemisphere, and the nearest is found in constant
//! time.

use std::f64::consts::{FRAC_PI_4, TAU};

use assign::{AssignError, Shader};
use glam::{DVec2, DVec3, Mat3, Vec3};

/// How directions are spread over the hemisphere around +z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Spread {
    /// Spherical coordinates (Archer et al. 2019, section 3.1 and figure 2): stacks of equal solid angle, each cut
    /// into slices of equal azimuth.
    #[default]
    StacksAndSlices,
    /// A square cut into `stacks` times `slices` cells. It is mapped to the disc (Shirley and Chiu 1997) and from
    /// there to the hemisphere, with equal areas. Cells are about as wide as high everywhere. If both counts are
    /// odd, the middle direction is +z.
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

/// Directions `stack * slices + slice`: unit vectors with z > 0. Each stands for a cell of the hemisphere, and its
/// opposite for the opposite cell. All cells have the same solid angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Directions {
    spread: Spread,
    stacks: u32,
    slices: u32,
}

impl Default for Directions {
    /// The paper's 13 stacks of 13 slices.
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
                field: "directions (stacks x slices)".into(),
                value: format!("{stacks} x {slices}"),
                accepted: format!("1 to {MAX_DIRECTIONS} in all"),
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

    /// Unit direction of an index, in f64. Indices wrap around.
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
            Spread::Squares => {
                square_to_hemisphere(DVec2::new(2.0 * across - 1.0, 2.0 * along - 1.0))
            }
        }
    }

    /// Unit direction of an index. Indices wrap around.
    pub fn direction(&self, ix: u32) -> Vec3 {
        self.direction_f64(ix).as_vec3()
    }

    /// Axes of a direction's image in world space: columns right, up and forward. Its transpose turns world space to
    /// the image's.
    pub fn frame(&self, ix: u32) -> Mat3 {
        let forward = self.direction_f64(ix);
        let (right, up) = forward.any_orthonormal_pair();
        Mat3::from_cols(right.as_vec3(), up.as_vec3(), forward.as_vec3())
    }

    /// The direction whose cell holds a unit vector, and whether the vector runs against it: the twin of
    /// `nearest_direction` in `directions.wesl`. The two are at most [`max_angle`](Self::max_angle) apart.
    pub fn nearest(&self, direction: Vec3) -> (u32, bool) {
        let is_reversed = direction.z < 0.0;
        let d = if is_reversed { -direction } else { direction }.as_dvec3();
        let (along, across) = match self.spread {
            Spread::StacksAndSlices => {
                let turn = d.y.atan2(d.x) / TAU;
                (d.z, turn - turn.floor())
            }
            Spread::Squares => {
                let square = hemisphere_to_square(d);
                (0.5 + 0.5 * square.y, 0.5 + 0.5 * square.x)
            }
        };
        let cell = |at: f64, cells: u32| ((at * f64::from(cells)) as u32).min(cells - 1);
        (cell(along, self.stacks) * self.slices + cell(across, self.slices), is_reversed)
    }

    /// The largest angle between a unit vector and its [`nearest`](Self::nearest) direction, radians. It is measured
    /// at points along each cell's border, and rounded up by 1 %.
    pub fn max_angle(&self) -> f64 {
        let cell_angle = |ix: u32| {
            let centre = self.direction_f64(ix);
            self.rim(ix).map(|at| centre.dot(at).clamp(-1.0, 1.0).acos()).fold(0.0, f64::max)
        };
        1.01 * (0..self.count()).map(cell_angle).fold(0.0, f64::max)
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
                    Spread::Squares => {
                        square_to_hemisphere(DVec2::new(2.0 * across - 1.0, 2.0 * along - 1.0))
                    }
                }
            })
        })
    }

    /// Mounts `package::directions` with these counts of stacks and slices.
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

/// Maps the square [-1, 1]^2 to the hemisphere with equal areas: Shirley and Chiu's map to the disc, then Lambert's
/// azimuthal map.
fn square_to_hemisphere(at: DVec2) -> DVec3 {
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

/// The inverse of [`square_to_hemisphere`].
fn hemisphere_to_square(d: DVec3) -> DVec2 {
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
            let make = move |(stacks, slices)| Directions::new(spread, stacks, slices).unwrap();
            [(1, 1), (2, 4), (4, 4), (4, 8), (8, 8), (8, 16), (13, 13)].map(make)
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
    fn the_nearest_direction_of_a_direction_is_itself() {
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
    fn the_nearest_direction_is_within_its_bound_and_cells_have_equal_shares() {
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
            assert!(farthest <= bound, "{directions:?}: {farthest} exceeds the bound {bound}");
            assert!(
                farthest > 0.9 * bound,
                "{directions:?}: the bound {bound} is loose, {farthest}"
            );
            // A cell's direction is not always the nearest one, but hardly farther on average.
            assert!(
                sum < 1.3 * best || directions.count() == 1,
                "{directions:?}: sum of angles {sum}, by search {best}"
            );
            let mean = f64::from(tries) / f64::from(directions.count());
            let are_equal = counts.iter().all(|&c| (f64::from(c) - mean).abs() < 6.0 * mean.sqrt());
            assert!(are_equal, "{directions:?}: vectors per cell {counts:?}");
            println!(
                "{directions:?}: at most {:.1} degrees, {:.1} on average, {:.1} by search",
                bound.to_degrees(),
                sum.to_degrees() / 2e4,
                best.to_degrees() / 2e4
            );
        }
    }

    #[test]
    fn counts_out_of_range_are_refused() {
        for (stacks, slices) in [(0, 3), (3, 0), (33, 32), (u32::MAX, u32::MAX)] {
            assert!(Directions::new(Spread::Squares, stacks, slices).is_err());
        }
        assert!(Directions::new(Spread::Squares, 32, 32).is_ok());
    }
}
