//! The boxes around all lights.

use glam::Vec3;

use super::{LightBuffer, Living, living::Source};

impl LightBuffer {
    /// World-space box around all supports, metres; `None` without lights. For lights from the GPU
    /// it is the stated box, extended by the largest range.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        match self.living.as_ref().and_then(Living::source) {
            Some(Source::Gpu { bounds: (low, high), radius_max_m, .. }) => {
                Some((*low - *radius_max_m, *high + *radius_max_m))
            }
            _ => self.given.bounds,
        }
    }

    /// World-space box around all positions, metres, without the ranges; `None` without lights.
    pub fn position_bounds(&self) -> Option<(Vec3, Vec3)> {
        match self.living.as_ref().and_then(Living::source) {
            Some(Source::Gpu { bounds, .. }) => Some(*bounds),
            _ => self.given.position_bounds,
        }
    }
}
