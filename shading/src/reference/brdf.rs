//! The BRDF in f64 on the CPU: `brdf.wesl`.

use glam::DVec3;
use scenes::Dielectric;

/// A point of a surface, as in `brdf.wesl`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear RGB.
    pub base_color: DVec3,
    /// 0 dielectric to 1 metal.
    pub metallic: f64,
    /// Unit shading normal, world space.
    pub normal: DVec3,
    /// Perceptual roughness.
    pub roughness: f64,
    /// Reflectance of its dielectric share.
    pub dielectric: Reflectance,
}

/// Reflectance of a dielectric at normal and at grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectance {
    /// At normal incidence, linear RGB.
    pub f0: DVec3,
    /// At grazing incidence.
    pub f90: f64,
}

impl Default for Reflectance {
    fn default() -> Self {
        Self { f0: DVec3::splat(DIELECTRIC_F0), f90: 1.0 }
    }
}

impl From<Dielectric> for Reflectance {
    fn from(dielectric: Dielectric) -> Self {
        if dielectric == Dielectric::default() {
            return Self::default();
        }
        Self { f0: dielectric.f0.as_dvec3(), f90: f64::from(dielectric.f90) }
    }
}

/// Below this perceptual roughness GGX's peak overflows single precision: `brdf.wesl`.
pub(crate) const MIN_ROUGHNESS: f64 = 0.045;
/// Least cosine between the normal and the direction to the eye.
pub(crate) const MIN_COS_VIEW: f64 = 1e-4;
/// Reflectance of a dielectric at normal incidence.
const DIELECTRIC_F0: f64 = 0.04;

/// The two terms of the BRDF, per steradian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lobes {
    pub(crate) diffuse: DVec3,
    pub(crate) specular: DVec3,
}

/// Radiance reflected to `to_eye` for unit irradiance from `to_light`, times cos of incidence:
/// Lambert and Cook-Torrance with GGX, height-correlated Smith and Schlick.
pub fn reflect_light(surface: &Surface, to_eye: DVec3, to_light: DVec3) -> DVec3 {
    let lobes = lobes_of(surface, to_eye, to_light);
    (lobes.diffuse + lobes.specular) * surface.normal.dot(to_light).max(0.0)
}

/// Reflectance at normal incidence.
pub(crate) fn f0_of(surface: &Surface) -> DVec3 {
    surface.dielectric.f0.lerp(surface.base_color, surface.metallic)
}

/// Reflectance at grazing incidence.
pub(crate) fn f90_of(surface: &Surface) -> f64 {
    surface.dielectric.f90 + (1.0 - surface.dielectric.f90) * surface.metallic
}

/// The BRDF for light from a direction.
pub(crate) fn lobes_of(surface: &Surface, to_eye: DVec3, to_light: DVec3) -> Lobes {
    let cos_l = surface.normal.dot(to_light).max(0.0);
    let cos_v = surface.normal.dot(to_eye).abs().max(MIN_COS_VIEW);
    let half_way = (to_eye + to_light).normalize_or_zero();
    let cos_vh = to_eye.dot(half_way).clamp(0.0, 1.0);
    let alpha_2 = surface.roughness.max(MIN_ROUGHNESS).powi(4);
    let distribution = ggx(alpha_2, surface.normal, half_way);
    let smith = |a: f64, b: f64| a * (b * b * (1.0 - alpha_2) + alpha_2).sqrt();
    let visibility = 0.5 / (smith(cos_l, cos_v) + smith(cos_v, cos_l)).max(1e-6);
    let f0 = f0_of(surface);
    let f90 = DVec3::splat(f90_of(surface));
    let fresnel = f0 + (f90 - f0) * (1.0 - cos_vh).powi(5);
    let diffuse = (DVec3::ONE - fresnel) * (1.0 - surface.metallic) * surface.base_color
        / std::f64::consts::PI;
    Lobes { diffuse, specular: distribution * visibility * fresnel }
}

/// GGX's distribution of half vectors (Walter et al. 2007, equation 33), for alpha squared and unit
/// vectors. Its denominator is `cos^2 (alpha^2 - 1) + 1`. In highlights, where the cosine is nearly
/// 1 and alpha is small, this loses its digits. So the squared sine is computed from the distance q
/// of the two vectors' ends: `sin^2 = q^2 (1 - q^2 / 4)`. A half vector below the horizon counts as
/// one on it.
pub(crate) fn ggx(alpha_2: f64, normal: DVec3, half_way: DVec3) -> f64 {
    let q_2 = normal.distance_squared(half_way).min(2.0);
    let sin_2 = q_2 * (1.0 - 0.25 * q_2);
    let peak = sin_2 * (1.0 - alpha_2) + alpha_2;
    alpha_2 / (std::f64::consts::PI * peak * peak)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White metal, or a black dielectric: only the specular term reflects.
    fn surface(roughness: f64, metallic: f64) -> Surface {
        let base_color = DVec3::splat(metallic);
        let dielectric = Reflectance::default();
        Surface { base_color, metallic, normal: DVec3::Z, roughness, dielectric }
    }

    /// Light reflected from the whole hemisphere for unit irradiance, by the midpoint rule.
    fn albedo(surface: &Surface, to_eye: DVec3) -> f64 {
        let (rings, sectors) = (400, 400);
        let mut sum = 0.0;
        for ring in 0..rings {
            let cos = (f64::from(ring) + 0.5) / f64::from(rings);
            let sin = (1.0 - cos * cos).sqrt();
            for sector in 0..sectors {
                let angle = (f64::from(sector) + 0.5) / f64::from(sectors) * std::f64::consts::TAU;
                let to_light = DVec3::new(sin * angle.cos(), sin * angle.sin(), cos);
                sum += reflect_light(surface, to_eye, to_light).x;
            }
        }
        sum * std::f64::consts::TAU / f64::from(rings * sectors)
    }

    #[test]
    fn no_specular_term_reflects_more_than_it_receives() {
        for roughness in [0.2, 0.5, 1.0] {
            for metallic in [0.0, 1.0] {
                for cos in [0.2_f64, 0.7, 1.0] {
                    let to_eye = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                    let albedo = albedo(&surface(roughness, metallic), to_eye);
                    assert!(
                        albedo > 0.01 && albedo < 1.01,
                        "roughness {roughness}, metallic {metallic}, cos {cos}: {albedo}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_smooth_mirror_keeps_almost_all_light() {
        let albedo = albedo(&surface(0.2, 1.0), DVec3::new(0.6, 0.0, 0.8));
        assert!((albedo - 1.0).abs() < 0.02, "{albedo}");
    }
}
