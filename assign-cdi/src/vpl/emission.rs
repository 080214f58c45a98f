//! The share of light that a surface reflects diffusely: the Rust twin of `lambertian_albedo` in `vpl_mips.wesl`.

use glam::Vec3;

/// Reflectance of a dielectric at normal incidence.
const DIELECTRIC_F0: f32 = 0.04;

/// The polynomial C of the cosine of incidence, lowest power first. It approximates the integral of
/// `cos (1 - v.h)^5 / pi` over the hemisphere of directions `v`, within 1.2e-5.
const DIFFUSE_FRESNEL: [f32; 5] =
    [0.028_163_14, -0.079_932_24, 0.086_807_13, -0.044_172_812, 0.009_218_425];

/// The share of arriving light that diffuse reflection sends out over the whole hemisphere. Light arrives at the given
/// cosine to the normal. A VPL emits this share by Lambert's law.
///
/// The renderer's diffuse term is `base_color (1 - metallic) (1 - F) / pi`, where F is Schlick's term at the half
/// vector. Its integral over all outgoing directions is `base_color (1 - metallic) (1 - f0) (1 - C)`. Without the last
/// two factors the VPL of a dielectric would be 4 to 7 % too bright.
pub fn lambertian_albedo(base_color: Vec3, metallic: f32, cos_incidence: f32) -> Vec3 {
    let f0 = Vec3::splat(DIELECTRIC_F0).lerp(base_color, metallic);
    let c = DIFFUSE_FRESNEL.iter().rev().fold(0.0, |sum, next| sum * cos_incidence + next);
    base_color * (1.0 - metallic) * (Vec3::ONE - f0) * (1.0 - c)
}
