//! The fall-off of a spot between its two cones, accurate in f32 at every angle.
//!
//! KHR_lights_punctual ramps by `(cos θ - cos outer) / (cos inner - cos outer)`, clamped to 0..1
//! and squared. In a narrow cone these cosines are too close for f32: those of 0 and 0.05 degrees
//! differ by 4e-7. The squared chord between two unit vectors, `|u - v|^2 = 2 - 2 cos θ`, keeps
//! full precision there. The ramp is the same ratio of squared chords: `(outer^2 - chord^2) /
//! (outer^2 - inner^2)`.

/// A spot's two angles in the form that shaders read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotRamp {
    /// Squared chord of the outer angle, where the light ends.
    pub outer_chord_2: f32,
    /// 1 over the difference to the squared chord of the inner angle; [`STEP`](Self::STEP) if both
    /// angles are equal, so that the light ends at once.
    pub scale: f32,
}

impl SpotRamp {
    /// The steepest ramp. Its product with any difference of squared chords is finite.
    pub const STEP: f32 = 1e30;

    /// The ramp between two half angles, radians, `0 <= inner <= outer <= π`.
    pub fn new(inner_angle: f32, outer_angle: f32) -> Self {
        let [inner, outer] = [inner_angle, outer_angle].map(chord_2);
        let scale = 1.0 / (outer - inner).max(1.0 / f64::from(Self::STEP));
        Self { outer_chord_2: outer as f32, scale: scale as f32 }
    }

    /// The fall-off at a squared chord, as shaders compute it: 1 inside the inner cone.
    pub fn at(self, chord_2: f32) -> f32 {
        let ramp = ((self.outer_chord_2 - chord_2) * self.scale).clamp(0.0, 1.0);
        ramp * ramp
    }
}

/// Squared chord between unit vectors at an angle, radians: `4 sin^2(θ / 2)`.
fn chord_2(angle: f32) -> f64 {
    4.0 * (0.5 * f64::from(angle)).sin().powi(2)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use glam::Vec3;

    use super::*;

    /// Inner angle as a share of the outer one.
    const INNER: [f32; 4] = [0.0, 0.5, 0.99, 1.0];

    #[test]
    fn every_cone_has_full_intensity_inside_and_none_outside() {
        for degrees in [0.01_f32, 0.05, 0.5, 5.0, 45.0, 90.0, 120.0, 179.0] {
            for share in INNER {
                let outer = degrees.to_radians();
                let ramp = SpotRamp::new(share * outer, outer);
                let at = |angle: f32| {
                    let (sin, cos) = angle.sin_cos();
                    ramp.at((Vec3::new(sin, 0.0, cos) - Vec3::Z).length_squared())
                };
                for inside in [0.0, 0.5, 0.995] {
                    let full = at(inside * share * outer);
                    assert!(
                        full > 1.0 - 1e-6,
                        "fall-off {full} inside the inner cone: {degrees} degrees, inner share {share}, at {inside}"
                    );
                }
                assert_eq!(
                    at(1.002 * outer),
                    0.0,
                    "light outside the cone: {degrees} degrees, inner share {share}"
                );
            }
        }
        assert_eq!(SpotRamp::new(PI, PI).at(3.9), 1.0);
    }
}
