//! Where scattered lights lie in their box.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

/// Where scattered lights lie in their box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Places {
    /// Uniformly (Enhuber 2019, section 4.2).
    #[default]
    Box,
    /// In seven upright cylinders as high as the box: one in the middle and six around it (after
    /// Watrous 2024, whose seven lie where its scene has room).
    Cylinders,
}

/// The number of cylinders of [`Places::Cylinders`].
const CYLINDERS: usize = 7;

/// The radius of a cylinder, and the distance of the outer ones from the middle, as shares of the
/// box's sides.
const CYLINDER_SHARES: (f64, f64) = (0.09, 0.36);

impl Places {
    /// A random point in the box. Each coordinate is a share of its side.
    pub(crate) fn sample(self, rng: &mut impl Rng) -> [f64; 3] {
        let [x, y, z] = std::array::from_fn(|_| rng.random::<f64>());
        if self == Self::Box {
            return [x, y, z];
        }
        let cylinder = rng.random_range(0..CYLINDERS);
        let (radius, away) = CYLINDER_SHARES;
        let around = TAU * cylinder as f64 / (CYLINDERS - 1) as f64;
        let away = if cylinder == CYLINDERS - 1 { 0.0 } else { away };
        let (sin, cos) = (TAU * x).sin_cos();
        let out = radius * z.sqrt();
        [0.5 + away * around.cos() + out * cos, y, 0.5 + away * around.sin() + out * sin]
    }
}
