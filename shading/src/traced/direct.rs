//! Light that comes from lights without a detour.

use assign::{Light, LightShape, Sun};
use glam::DVec3;
use rand_pcg::Pcg64Mcg;

use super::{Estimate, SurfaceSample, TracedScene, area::SeenEmitter};
use crate::{
    LightBvh,
    reference::{light_contribution, sun_contribution},
};

/// Pairs of directions to an area light with shadows, unless told otherwise.
pub const AREA_SAMPLES: u32 = 64;

/// Radiance that one light adds to a sample; with shadows where there is a scene to cast them, an
/// area light's by `area_samples` pairs of directions.
pub fn direct_light(
    light: &Light,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
    area_samples: u32,
    rng: &mut Pcg64Mcg,
) -> Estimate {
    match (&light.shape, visibility) {
        (LightShape::Area(emitter), Some(scene)) => SeenEmitter::new(light, emitter, sample)
            .map_or(Estimate::default(), |seen| seen.shadowed(scene, area_samples, rng)),
        _ => {
            let radiance =
                light_contribution(light, sample.position, &sample.surface, sample.to_eye);
            let is_seen = radiance != DVec3::ZERO
                && visibility.is_none_or(|scene| scene.sees(sample, light.position.as_dvec3()));
            Estimate::exact(if is_seen { radiance } else { DVec3::ZERO })
        }
    }
}

/// Radiance that a sun adds to a sample; with shadows where there is a scene to cast them.
pub fn direct_sun(
    sun: &Sun,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
) -> Estimate {
    let radiance = sun_contribution(sun, &sample.surface, sample.to_eye);
    let to_sun = -sun.direction.as_dvec3().normalize();
    let is_seen =
        radiance != DVec3::ZERO && visibility.is_none_or(|scene| scene.sees_sky(sample, to_sun));
    Estimate::exact(if is_seen { radiance } else { DVec3::ZERO })
}

/// Radiance that all suns add to a sample, and then all lights in ascending index.
pub fn direct_radiance(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
    area_samples: u32,
    rng: &mut Pcg64Mcg,
) -> Estimate {
    let mut reaching = Vec::new();
    lights.lights_at(sample.position.as_vec3().to_array(), |light, _| reaching.push(light));
    // The hierarchy finds them in an order of its own.
    reaching.sort_unstable();
    let all = lights.lights();
    let suns = lights.suns().iter().map(|sun| direct_sun(sun, sample, visibility));
    let suns = suns.fold(Estimate::default(), |sum, sun| sum + sun);
    reaching.into_iter().fold(suns, |sum, light| {
        sum + direct_light(&all[light as usize], sample, visibility, area_samples, rng)
    })
}
