//! Draws directions about in proportion to the light that a surface reflects from them.
//!
//! Each direction comes from one of two lobes: the cosine, or GGX's visible normals (Heitz 2018).
//! Metals use only the latter. The density is that of the mixture, so neither lobe's tail is
//! divided by a density near 0. Where GGX's lobe is hardly narrower than the cosine, all directions
//! come from the cosine, because one smooth map from the square to directions gives less noise than
//! two.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use crate::{
    ltc::lobe::Lobe,
    reference::{MIN_COS_VIEW, Surface},
};

/// The probability with which a dielectric's specular lobe is chosen.
const SPECULAR_SHARE: f64 = 0.5;

/// Up to this ratio of densities in the mirror direction, the cosine replaces GGX's lobe.
const WIDE: f64 = 4.0;

/// Samples the BRDF of one surface seen from one direction.
pub(super) struct BrdfSampler {
    /// From the shading frame (z is the normal, the eye lies in the plane of x and z) to world
    /// space.
    to_world: DMat3,
    lobe: Lobe,
    specular_share: f64,
}

impl BrdfSampler {
    pub(super) fn new(surface: &Surface, to_eye: DVec3) -> Self {
        let normal = surface.normal;
        let x = to_eye.reject_from_normalized(normal).try_normalize();
        let x = x.unwrap_or_else(|| normal.any_orthonormal_vector());
        let to_world = DMat3::from_cols(x, normal.cross(x), normal);
        let local = to_world.transpose() * to_eye;
        // An eye below the shading horizon sees no microfacet.
        let is_seen = local.z > MIN_COS_VIEW;
        let lobe = Lobe::new(surface.roughness, DVec3::new(local.x, 0.0, local.z));
        let is_wide = lobe.density(mirror(&lobe)) < WIDE * local.z / PI;
        let specular_share = if is_seen && !is_wide {
            SPECULAR_SHARE + (1.0 - SPECULAR_SHARE) * surface.metallic
        } else {
            0.0
        };
        Self { to_world, lobe, specular_share }
    }

    /// A world-space vector in the shading frame.
    pub(super) fn to_shading(&self, world: DVec3) -> DVec3 {
        self.to_world.transpose() * world
    }

    /// A unit direction in world space, from coordinates in 0..1. It may lie below the horizon.
    pub(super) fn sample(&self, [u, v, choice]: [f64; 3]) -> DVec3 {
        let local = if choice < self.specular_share {
            self.lobe.sample(u, v)
        } else {
            // Uniform on the disc, projected up to the hemisphere (Malley).
            let (sin, cos) = (u * TAU).sin_cos();
            DVec3::new(v.sqrt() * cos, v.sqrt() * sin, (1.0 - v).sqrt())
        };
        self.to_world * local
    }

    /// Approximately the largest density of [`Self::sample`], per steradian: that of the mirror
    /// direction.
    pub(super) fn peak_density(&self) -> f64 {
        self.density(self.to_world * mirror(&self.lobe))
    }

    /// Density of [`Self::sample`] above the horizon, per steradian.
    pub(super) fn density(&self, direction: DVec3) -> f64 {
        let local = self.to_shading(direction);
        let cosine = local.z.max(0.0) / PI;
        let specular = if self.specular_share > 0.0 { self.lobe.density(local) } else { 0.0 };
        self.specular_share * specular + (1.0 - self.specular_share) * cosine
    }
}

/// The direction in which a mirror would reflect the eye.
fn mirror(lobe: &Lobe) -> DVec3 {
    lobe.to_eye * DVec3::new(-1.0, -1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traced::Numbers;

    #[test]
    fn direction_counts_match_densities() {
        let normal = DVec3::new(0.3, 0.8, -0.5).normalize();
        for (roughness, metallic) in [(0.3, 0.0), (0.6, 1.0), (1.0, 0.4)] {
            let dielectric = Default::default();
            let surface =
                Surface { base_color: DVec3::ONE, metallic, normal, roughness, dielectric };
            let to_eye = (normal + DVec3::X).normalize();
            let sampler = BrdfSampler::new(&surface, to_eye);
            // The solid angle of a cone: the sum over its directions of one over their density.
            let axis = (normal - 0.6 * DVec3::X).normalize();
            let count = 65_536;
            let mut solid_angle = 0.0;
            for ix in 0..count {
                let direction = sampler.sample(Numbers::new(3).point(0, ix).at(0));
                if direction.dot(axis) > 0.9 {
                    solid_angle += 1.0 / sampler.density(direction) / f64::from(count);
                }
            }
            let expected = TAU * 0.1;
            let off = (solid_angle / expected - 1.0).abs();
            assert!(
                off < 0.02,
                "roughness {roughness}, metallic {metallic}: {solid_angle}, expected {expected}"
            );
        }
    }
}
