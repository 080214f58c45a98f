//! Light that comes from lights by one detour: off another surface.

use glam::DVec3;
use rand_pcg::Pcg64Mcg;

use super::{Estimate, SurfaceSample, TracedScene, brdf_sampler::BrdfSampler, direct_radiance};
use crate::{LightBvh, reference::reflect_light};

/// Radiance that a sample reflects of what other surfaces reflect of the lights, shadows on both
/// ways, diffuse and specular: an estimate from `count` directions drawn as the BRDF reflects. What
/// surfaces emit by themselves is not in it.
pub fn bounced_light(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    count: u32,
    rng: &mut Pcg64Mcg,
) -> Estimate {
    let brdf = BrdfSampler::new(&sample.surface, sample.to_eye);
    Estimate::of_samples(count, || {
        let direction = brdf.sample(rng);
        // A direction above the shading normal's horizon may lie below the triangle.
        let is_above = sample.surface.normal.dot(direction) > 0.0
            && sample.geometric_normal.dot(direction) > 0.0;
        let Some(hit) = is_above.then(|| scene.bounce(sample, direction)).flatten() else {
            return DVec3::ZERO;
        };
        // One pair of directions to each area light: its spread is part of this sample's.
        let radiance = direct_radiance(lights, &hit, Some(scene), 1, rng).mean;
        let reflected = reflect_light(&sample.surface, sample.to_eye, direction);
        radiance * reflected / brdf.density(direction)
    })
}
