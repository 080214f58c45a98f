//! How scattered lights fill their box.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

/// How scattered lights fill their box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Places {
    /// Uniformly (Enhuber 2019, section 4.2).
    #[default]
    Box,
    /// In seven upright cylinders, one in the middle and six around it, as high as the box (after
    /// Watrous 2024, whose seven lie where its scene has room).
    Cylinders,
}

/// Cylinders of [`Places::Cylinders`].
const CYLINDERS: usize = 7;

/// Their radius, and the distance of the outer ones from the middle, as shares of the box's sides.
const CYLINDER_SHARES: (f64, f64) = (0.09, 0.36);

impl Places {
    /// A point in the box: each coordinate a share of its side.
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
