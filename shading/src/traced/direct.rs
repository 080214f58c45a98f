//! Direct light: light that comes straight from lights.

use assign::{Light, LightShape, Sun};
use glam::DVec3;

use super::{Estimate, Numbers, SurfaceSample, TracedScene, area::SeenEmitter, numbers::Point};
use crate::{
    LightBvh,
    reference::{light_contribution, matte_contribution, sun_contribution},
};

/// The default number of pairs of directions to an area light with shadows.
pub const AREA_SAMPLES: u32 = 64;

/// Radiance that one light adds to a sample. With a scene, the light has shadows, and an area light
/// is sampled by `area_samples` pairs of directions.
pub fn direct_light(
    light: &Light,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
    area_samples: u32,
    numbers: Numbers,
) -> Estimate {
    match (&light.shape, visibility) {
        (LightShape::Area(emitter), Some(scene)) => SeenEmitter::new(light, emitter, sample)
            .map_or(Estimate::default(), |seen| seen.shadowed(scene, area_samples, numbers)),
        _ => Estimate::exact(exact_light(light, sample, visibility)),
    }
}

/// What surfaces leave of the radiance that one light adds to a sample, if they hid its diffuse and its specular light
/// alike: the radiance without shadows times the share of the light that the sample sees. A share of an area light is
/// sampled by `area_samples` points. It is the best that any model of visible shares can show.
pub fn separated_light(
    light: &Light,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    area_samples: u32,
    numbers: Numbers,
) -> Estimate {
    match &light.shape {
        LightShape::Area(emitter) => SeenEmitter::new(light, emitter, sample)
            .map_or(Estimate::default(), |seen| seen.separated(scene, area_samples, numbers)),
        _ => Estimate::exact(exact_light(light, sample, Some(scene))),
    }
}

/// Radiance that all suns add to a sample, and then all lights in ascending index, each as [`separated_light`].
pub(super) fn separated_radiance(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    area_samples: u32,
    numbers: Numbers,
) -> Estimate {
    let suns = Estimate::exact(direct_suns(lights, sample, Some(scene)));
    reaching(lights, sample).into_iter().fold(suns, |sum, light_ix| {
        let light = &lights.lights()[light_ix as usize];
        sum + separated_light(light, sample, scene, area_samples, numbers.part(light_ix.into()))
    })
}

/// Radiance that needs no samples: that of a light without an emitter, or without shadows.
fn exact_light(
    light: &Light,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
) -> DVec3 {
    let radiance = light_contribution(light, sample.position, &sample.surface, sample.to_eye);
    let is_seen = radiance != DVec3::ZERO
        && visibility.is_none_or(|scene| scene.sees(sample, light.position.as_dvec3()));
    if is_seen { radiance } else { DVec3::ZERO }
}

/// Radiance that a sun adds to a sample, with shadows if there is a scene.
pub fn direct_sun(
    sun: &Sun,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
) -> DVec3 {
    let radiance = sun_contribution(sun, &sample.surface, sample.to_eye);
    let to_sun = -sun.direction.as_dvec3().normalize();
    let is_seen =
        radiance != DVec3::ZERO && visibility.is_none_or(|scene| scene.sees_sky(sample, to_sun));
    if is_seen { radiance } else { DVec3::ZERO }
}

/// Radiance that all suns add to a sample.
fn direct_suns(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
) -> DVec3 {
    lights.suns().iter().map(|sun| direct_sun(sun, sample, visibility)).sum()
}

/// Radiance that all suns add to a sample, and then all lights in ascending index.
pub fn direct_radiance(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    visibility: Option<&TracedScene<'_>>,
    area_samples: u32,
    numbers: Numbers,
) -> Estimate {
    let suns = Estimate::exact(direct_suns(lights, sample, visibility));
    reaching(lights, sample).into_iter().fold(suns, |sum, light_ix| {
        let light = &lights.lights()[light_ix as usize];
        sum + direct_light(light, sample, visibility, area_samples, numbers.part(light_ix.into()))
    })
}

/// The same with shadows. Each area light is sampled by one pair of directions, drawn by the
/// coordinates of a point from `first` on.
pub(super) fn direct_radiance_once(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    point: Point,
    first: u32,
) -> DVec3 {
    let from_light = |light_ix: u32| {
        let light = &lights.lights()[light_ix as usize];
        match &light.shape {
            LightShape::Area(emitter) => SeenEmitter::new(light, emitter, sample)
                .map(|seen| seen.shadowed_once(scene, point.scrambled(light_ix).at(first)))
                .unwrap_or_default(),
            _ => exact_light(light, sample, Some(scene)),
        }
    };
    let suns = direct_suns(lights, sample, Some(scene));
    reaching(lights, sample).into_iter().map(from_light).fold(suns, |sum, light| sum + light)
}

/// The radiance of all lights that a sample reflects as a virtual point light emits, with shadows.
pub(super) fn matte_radiance(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
) -> DVec3 {
    let from_light = |light_ix: u32| {
        let light = &lights.lights()[light_ix as usize];
        let radiance = matte_contribution(light, sample.position, &sample.surface);
        let is_seen = radiance != DVec3::ZERO && scene.sees(sample, light.position.as_dvec3());
        if is_seen { radiance } else { DVec3::ZERO }
    };
    reaching(lights, sample).into_iter().map(from_light).sum()
}

/// The lights that reach a sample, ascending.
fn reaching(lights: &LightBvh<'_>, sample: &SurfaceSample) -> Vec<u32> {
    let mut reaching = Vec::new();
    lights.lights_at(sample.position.as_vec3().to_array(), |light, _| reaching.push(light));
    // The hierarchy finds them in its own order.
    reaching.sort_unstable();
    reaching
}
