//! How finely a rectangle is divided before any frame was tested: an analytic choice on the CPU (Dobetsberger 2025,
//! section 6.5 proposes one without a formula).
//!
//! A quad of side `a` draws a band as wide as itself where the shadow's edge lies halfway between the light and the
//! surface. Seen at the distance `d` of the light, the band is `a f / d` pixels wide, with `f` the pixels of one unit of
//! tangent: half the viewport's height over the tangent of half the field of view. The test of bands needs three
//! pixels of its grid in a row. So the first level is the smallest `L` with
//!
//! ```text
//! longest side * f / d <= 3 * down * 2^L
//! ```
//!
//! No number in it is tuned. Shadows nearer to their casters have narrower bands, so the choice is rather too fine, and
//! pruning takes back what shows no bands.

use assign::{Emitter, Projection, View};
use glam::Vec3;

use super::quadtree::LEVELS;

/// Pixels of the test's grid that a band must cover: one, and its neighbours on both sides.
const BAND_PX: f64 = 3.0;

/// The level at which a rectangle's tree begins in a view.
pub(super) fn start_level(view: &View, emitter: &Emitter, position: Vec3, down: u32) -> u32 {
    let eye = view.eye().as_dvec3() - position.as_dvec3();
    let distance_m = match view.projection {
        Projection::Perspective { .. } => emitter.closest(eye).distance(eye),
        // Its pixels show as many metres at all distances.
        Projection::Orthographic { .. } => 1.0,
    };
    let px_per_unit =
        0.5 * f64::from(view.viewport.height) * f64::from(view.view_to_clip().y_axis.y).abs();
    let side_m = emitter.half_axes().map(|half| 2.0 * half.as_dvec3().length());
    let side_px = side_m[0].max(side_m[1]) * px_per_unit;
    let widest = |level: u32| BAND_PX * f64::from(down << level) * distance_m;
    (0..LEVELS).find(|level| side_px <= widest(*level)).unwrap_or(LEVELS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearer_larger_and_magnified_lights_begin_finer() {
        let emitter = |half: f32| Emitter::rectangle(Vec3::X * half, Vec3::Y * 0.1);
        // 90 degrees and 200 rows: 100 pixels per unit of tangent.
        let view =
            |z: f32, angle: f32| View::look_at(Vec3::Z * z, Vec3::ZERO, angle, 0.1, [320, 200]);
        let right = std::f32::consts::FRAC_PI_2;
        let level =
            |z, half, angle, down| start_level(&view(z, angle), &emitter(half), Vec3::ZERO, down);
        // A metre at 10 m is 10 pixels wide.
        assert_eq!(level(10.0, 0.5, right, 4), 0);
        assert_eq!(level(10.0, 0.5, right, 2), 1);
        assert_eq!(level(10.0, 0.5, right, 1), 2);
        assert_eq!(level(5.0, 0.5, right, 2), 2);
        assert_eq!(level(10.0, 1.0, right, 2), 2);
        assert_eq!(level(10.0, 0.5, 0.1, 4), 4);
        assert_eq!(level(1000.0, 0.5, right, 1), 0);
        assert_eq!(level(0.0, 0.5, right, 16), LEVELS, "the camera touches the light");
    }
}
