//! How far a light's specular term reaches on a surface, beyond its range.
//!
//! # Idea
//!
//! A light ends at a range at which its *diffuse* light is negligible. Polished surfaces concentrate light, so they
//! show a light far beyond that range, and culling by range cuts highlights off (Watrous 2024, "Failure Modes:
//! Reflective Surfaces", figure 3a). The survey proposes to summarise the materials of each cluster and to adjust light
//! volumes by the summary ("Mitigating Reflective Surfaces"). Here is how far they must grow.
//!
//! # Derivation
//!
//! A light of intensity `I` without a window has the irradiance `I / d^2` at distance `d`. At its range `R`, the
//! brightest diffuse surface, white and facing the light, shows the radiance `I / (pi R^2)`. This is what the light's
//! range declares negligible. A surface's specular term shows at most `P I / d^2`, with `P` the peak of its lobe
//! `D V F cos`. It falls to the same radiance at
//!
//! ```text
//! d = R sqrt(pi P)
//! ```
//!
//! So the reach is a factor of the range, and depends on the sample's material and its angle to the eye only. It is at
//! least 1, and at most a number that the user gives, because a mirror shows lights at any distance and lists must end.
//!
//! The peak has the bound
//!
//! ```text
//! P = 1 / (2 pi alpha^2 (root_v + cos_v)) * max(F(near), F(least) / (2 - alpha^2)^2)
//! ```
//!
//! - `D <= 1 / (pi alpha^2)`. Where the half vector is tilted off the normal by `t` with `sin t = alpha`, `D` has
//!   fallen to `1 / (2 - alpha^2)^2` of that, and it falls further beyond.
//! - `V cos = cos / (2 (cos root_v + cos_v root_l))`, with `root = sqrt(cos^2 (1 - alpha^2) + alpha^2)`. Since
//!   `root_l >= cos`, it is at most `1 / (2 (root_v + cos_v))`.
//! - `F` grows as the half vector turns away from the eye. For tilts up to `t`, that angle is at most that of normal and
//!   eye, plus `t` (`near`). For a light on the horizon, it is 45 degrees plus half the angle of normal and eye
//!   (`least`), and never more.
//!
//! # Where it fails
//!
//! - Dielectrics count as of reflectance 0.04 at normal incidence, and as 1 at grazing incidence. Other ones
//!   (KHR_materials_ior, KHR_materials_specular) get the same reach, though their lobe may be brighter.
//! - Area lights keep their ranges; they have a range for each term already.
//! - The lobe's peak decides, though a polished surface shows a light only near its mirror direction. Lists are longer
//!   than a test of directions would make them.

use std::f64::consts::PI;

use crate::{AssignError, Assignment};

/// The most that a specular term may reach, in ranges of its light.
pub const MAX_SPECULAR_REACH: f32 = 64.0;

/// Below this perceptual roughness the lobe grows no more: `brdf.wesl`.
const MIN_ROUGHNESS: f64 = 0.045;

/// Checks the most that specular terms may reach, in ranges of their lights.
///
/// # Errors
///
/// [`AssignError::Parameter`] if it is not from 1 to [`MAX_SPECULAR_REACH`].
pub fn check_specular_reach(most: f32) -> Result<(), AssignError> {
    if (1.0..=MAX_SPECULAR_REACH).contains(&most) {
        return Ok(());
    }
    Err(AssignError::Parameter {
        field: "specular reach".into(),
        value: most.to_string(),
        accepted: format!("1 to {MAX_SPECULAR_REACH}, in ranges of a light"),
    })
}

/// Checks that a strategy lists lights as far as specular terms may reach, in ranges of their lights.
///
/// # Errors
///
/// As [`check_specular_reach`], and [`AssignError::Unsupported`] if its lists end before.
pub fn check_listed_reach(strategy: &dyn Assignment, most: f32) -> Result<(), AssignError> {
    check_specular_reach(most)?;
    let listed = strategy.specular_reach();
    if most <= listed {
        return Ok(());
    }
    let end = if listed == 1.0 { "their range".to_owned() } else { format!("{listed} ranges") };
    Err(AssignError::Unsupported {
        strategy: strategy.id(),
        asked: format!("specular terms that reach {most} ranges of their lights"),
        reason: format!("its lists hold lights out to {end}"),
    })
}

/// An upper bound of the specular lobe `D V F cos` over all directions to a light, per steradian: GGX, height-correlated
/// Smith, and Schlick with 1 at grazing incidence.
///
/// `roughness` is perceptual, `f0` the reflectance at normal incidence, and `cos_v` the cosine of normal and eye.
pub fn lobe_peak(roughness: f64, f0: f64, cos_v: f64) -> f64 {
    let cos_v = cos_v.min(1.0);
    let alpha = roughness.max(MIN_ROUGHNESS).powi(2);
    let alpha_2 = alpha * alpha;
    let sin_v = (1.0 - cos_v * cos_v).max(0.0).sqrt();
    let root_v = (cos_v * cos_v * (1.0 - alpha_2) + alpha_2).sqrt();
    let least = (0.5 - 0.5 * sin_v).max(0.0).sqrt();
    let near = (cos_v * (1.0 - alpha_2).max(0.0).sqrt() - sin_v * alpha).max(least);
    let schlick = |cos: f64| f0 + (1.0 - f0) * (1.0 - cos).powi(5);
    let fresnel = schlick(near).max(schlick(least) / (2.0 - alpha_2).powi(2));
    0.5 * fresnel / (PI * alpha_2 * (root_v + cos_v))
}

/// How far a light's specular term reaches on a surface, in ranges of the light: from 1 to `most`. The parameters are
/// those of [`lobe_peak`].
///
/// A renderer with such terms multiplies the range by it, in the window of the specular term only.
pub fn specular_reach(roughness: f64, f0: f64, cos_v: f64, most: f64) -> f64 {
    (PI * lobe_peak(roughness, f0, cos_v)).sqrt().max(1.0).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_surfaces_reach_no_farther_and_mirrors_as_far_as_they_may() {
        // Matte paint from above and from the side; a polished floor; a mirror.
        assert_eq!(specular_reach(0.9, 0.04, 1.0, 8.0), 1.0);
        assert_eq!(specular_reach(0.9, 0.04, 0.5, 8.0), 1.0);
        let floor = specular_reach(0.3, 0.04, 0.5, 64.0);
        assert!(floor > 1.5 && floor < 3.0, "{floor}");
        assert_eq!(specular_reach(0.0, 1.0, 0.7, 8.0), 8.0);
        assert!(specular_reach(0.0, 1.0, 0.7, f64::INFINITY) > 100.0);
    }

    #[test]
    fn numbers_that_are_no_reach_are_refused() {
        for most in [1.0, 4.0, 64.0] {
            check_specular_reach(most).unwrap();
        }
        for most in [0.5, -1.0, 65.0, f32::NAN, f32::INFINITY] {
            let error = check_specular_reach(most).unwrap_err().to_string();
            assert!(error.ends_with("it must be 1 to 64, in ranges of a light"), "{error}");
        }
    }
}
