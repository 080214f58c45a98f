//! How far lights have moved.

use glam::Vec3;

use super::given::Given;

/// A bound on how far the lights' balls have moved and grown since the buffer was made.
///
/// Between two values with the same number of jumps, each light's later ball lies inside its earlier ball,
/// grown by the difference of the metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Travel {
    /// The sum of the frames' largest steps, metres.
    pub metres: f64,
    /// How often there was no bound: a light jumped, was born, or became bright.
    pub jumps: u32,
}

impl Travel {
    /// Metres since an earlier value; 0 after a jump.
    pub fn since(&self, earlier: &Self) -> f64 {
        if self.jumps == earlier.jumps { self.metres - earlier.metres } else { 0.0 }
    }

    /// Adds a frame's step; `None` is a jump.
    pub(super) fn add(&mut self, step_m: Option<f32>) {
        match step_m {
            Some(step_m) => self.metres += f64::from(step_m),
            None => self.jumps = self.jumps.wrapping_add(1),
        }
    }
}

impl Given {
    /// How far the balls of later lights reach beyond these at the most, light by light, metres; `None` if
    /// one was not there or dark before.
    pub(super) fn step_to(&self, later: &Self) -> Option<f32> {
        if self.indices != later.indices {
            return None;
        }
        let mut most_m = 0.0_f32;
        for (before, after) in self.lights.iter().zip(&later.lights) {
            if before == after {
                continue;
            }
            if before.intensity == Vec3::ZERO && after.intensity != Vec3::ZERO {
                return None;
            }
            let radii_m = [before.radius_m(), after.radius_m()];
            let way_m = before.position.distance(after.position) + radii_m[1] - radii_m[0];
            // Each of the terms is rounded.
            let rounding_m = 4e-7 * (way_m.abs() + radii_m[0] + radii_m[1]);
            most_m = most_m.max(way_m + rounding_m);
        }
        Some(most_m)
    }
}
