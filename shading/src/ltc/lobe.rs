//! The BRDF's specular lobe for one view, in the shading frame.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::reference::{MIN_COS_VIEW, MIN_ROUGHNESS, ggx};

/// GGX's alpha of a perceptual roughness.
pub(crate) fn alpha_of(roughness: f64) -> f64 {
    roughness.max(MIN_ROUGHNESS).powi(2)
}

/// How microfacets mask each other, divided by `4 cos cos`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Masking {
    /// Height-correlated Smith (Heitz 2014, equation 99). The BRDF here and the published tables of
    /// linearly transformed cosines use it.
    #[default]
    Correlated,
    /// Its approximation without roots (Hammon 2017), which engines use. Dobetsberger 2025, section
    /// 5.4.2, fits a second table to it.
    Hammon,
}

impl Masking {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Correlated, Self::Hammon];
}

/// GGX seen from one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lobe {
    pub(crate) to_eye: DVec3,
    masking: Masking,
    alpha: f64,
    alpha_2: f64,
    cos_view: f64,
    root_view: f64,
}

impl Lobe {
    /// The BRDF's lobe of a perceptual roughness and a unit direction to the eye.
    pub(crate) fn new(roughness: f64, to_eye: DVec3) -> Self {
        let alpha = alpha_of(roughness);
        let alpha_2 = alpha * alpha;
        let cos_view = to_eye.z.abs().max(MIN_COS_VIEW);
        let root_view = (cos_view * cos_view * (1.0 - alpha_2) + alpha_2).sqrt();
        Self { to_eye, masking: Masking::Correlated, alpha, alpha_2, cos_view, root_view }
    }

    /// The lobe seen from the x-z plane under a cosine of 0 to 1.
    pub(crate) fn seen_under(roughness: f64, cos_view: f64) -> Self {
        let cos = cos_view.clamp(MIN_COS_VIEW, 1.0);
        Self::new(roughness, DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos))
    }

    /// The same with another masking.
    pub(crate) fn masked(self, masking: Masking) -> Self {
        Self { masking, ..self }
    }

    pub(crate) fn alpha(&self) -> f64 {
        self.alpha
    }

    pub(crate) fn cos_view(&self) -> f64 {
        self.cos_view
    }

    fn half_way(&self, to_light: DVec3) -> DVec3 {
        (self.to_eye + to_light).normalize_or_zero()
    }

    /// D V cos (the BRDF at a Fresnel term of 1, times the cosine of incidence), and Schlick's `(1
    /// - v.h)^5`.
    pub(crate) fn evaluate(&self, to_light: DVec3) -> (f64, f64) {
        let cos_light = to_light.z.max(0.0);
        let half_way = self.half_way(to_light);
        let smith = match self.masking {
            Masking::Correlated => {
                let root_light =
                    (cos_light * cos_light * (1.0 - self.alpha_2) + self.alpha_2).sqrt();
                cos_light * self.root_view + self.cos_view * root_light
            }
            Masking::Hammon => {
                let (product, sum) = (2.0 * cos_light * self.cos_view, cos_light + self.cos_view);
                product + self.alpha * (sum - product)
            }
        };
        let lobe = ggx(self.alpha_2, DVec3::Z, half_way) * 0.5 * cos_light / smith.max(1e-6);
        (lobe, (1.0 - self.to_eye.dot(half_way).clamp(0.0, 1.0)).powi(5))
    }

    /// The probability density per steradian with which [`Self::sample`] draws a direction.
    pub(crate) fn density(&self, to_light: DVec3) -> f64 {
        let distribution = ggx(self.alpha_2, DVec3::Z, self.half_way(to_light));
        distribution * 0.5 / (self.cos_view + self.root_view)
    }

    /// A direction that mirrors the eye in a microfacet normal visible from it (Heitz 2018). It may
    /// lie below the horizon. Samples of `u` and `1 - u` are mirrored in the x-z plane.
    pub(crate) fn sample(&self, u: f64, v: f64) -> DVec3 {
        let stretched = DVec3::new(self.alpha * self.to_eye.x, 0.0, self.cos_view).normalize();
        let up = DVec3::new(-stretched.z, 0.0, stretched.x);
        let (sin, cos) = ((u - 0.5) * TAU).sin_cos();
        let (across, along) = (v.sqrt() * sin, v.sqrt() * cos);
        let share = 0.5 * (1.0 + stretched.z);
        let along = (1.0 - share) * (1.0 - across * across).max(0.0).sqrt() + share * along;
        let rest = (1.0 - across * across - along * along).max(0.0).sqrt();
        let normal = across * DVec3::Y + along * up + rest * stretched;
        let normal = DVec3::new(self.alpha * normal.x, self.alpha * normal.y, normal.z.max(0.0));
        let normal = normal.normalize_or(DVec3::Z);
        2.0 * self.to_eye.dot(normal) * normal - self.to_eye
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::reference::{Surface, reflect_light};

    /// On a mirror both maskings are 1 / (4 cos cos), and they are equal where both cosines are 1.
    #[test]
    fn the_approximate_masking_agrees_on_mirrors_and_at_the_normal() {
        for (roughness, cos_view, same) in [(0.0, 0.7, true), (0.6, 1.0, true), (0.6, 0.3, false)] {
            let exact = Lobe::seen_under(roughness, cos_view);
            let mirror = exact.to_eye * DVec3::new(-1.0, 1.0, 1.0);
            let ratio = exact.masked(Masking::Hammon).evaluate(mirror).0 / exact.evaluate(mirror).0;
            assert_eq!((ratio - 1.0).abs() < 5e-3, same, "{roughness}, {cos_view}: {ratio}");
        }
    }

    #[test]
    fn the_lobe_matches_the_references_specular_term() {
        for roughness in [0.0, 0.2, 0.7] {
            for cos_view in [0.02, 0.5, 1.0] {
                let lobe = Lobe::seen_under(roughness, cos_view);
                let to_light = DVec3::new(-0.6, 0.3, 0.7).normalize();
                let (specular, schlick) = lobe.evaluate(to_light);
                let surface = |metallic, base_color| Surface {
                    base_color: DVec3::splat(base_color),
                    metallic,
                    normal: DVec3::Z,
                    roughness,
                    dielectric: Default::default(),
                };
                let reflected = reflect_light(&surface(1.0, 0.3), lobe.to_eye, to_light).x;
                let expected = specular * (0.3 * (1.0 - schlick) + schlick);
                assert!((reflected - expected).abs() <= 1e-12 * expected, "{reflected} {expected}");
                let diffuse = reflect_light(&surface(0.0, 1.0), lobe.to_eye, to_light).x
                    - reflect_light(&surface(0.0, 0.0), lobe.to_eye, to_light).x;
                let expected = 0.96 * (1.0 - schlick) * to_light.z / PI;
                assert!((diffuse - expected).abs() < 1e-9 * expected, "{diffuse} {expected}");
            }
        }
    }
}
