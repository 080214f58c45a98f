//! Indirect light: light that other surfaces reflect or emit.
//!
//! # The idea
//!
//! A path starts at the sample and follows directions drawn as the BRDF reflects, one per bounce.
//! At every surface that it hits, it adds the direct light of the lights, by rays to them, and the
//! surface's emission. Each is multiplied by the reflection of all surfaces before it.
//!
//! Emission is found in two ways: the path hits an emitting triangle, or a point on one is drawn
//! ([`emissive`](super::emissive)) and a ray tests whether it is visible. The balance heuristic
//! weights both, so neither small emitters nor mirrors give rare, large values.
//!
//! Paths end after the given number of bounces. Light of further bounces is missing.

use glam::DVec3;

use super::{
    Estimate, Numbers, SurfaceSample, TracedScene,
    area::PAIR_DIMENSIONS,
    brdf_sampler::BrdfSampler,
    direct::{direct_radiance_once, matte_radiance},
    emissive::{DRAW_DIMENSIONS, Emission},
    numbers::Point,
};
use crate::{LightBvh, reference::reflect_light};

/// The most bounces of a path: Sobol sequences have 256 dimensions.
pub const MAX_BOUNCES: u32 = 16;

/// The paths of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// The number of paths.
    pub count: u32,
    /// The number of surfaces that each path may hit, at most [`MAX_BOUNCES`].
    pub bounces: u32,
    /// Whether those surfaces reflect lights as virtual point lights emit: only diffusely, and
    /// without area lights, suns and emission. Then a path ends at the first surface.
    pub is_matte: bool,
}

/// The number of dimensions that the way to the next surface uses.
const TURN: u32 = 3;
/// The number of dimensions per surface of a path: the way to the next one, emission, and the
/// lights.
const DIMENSIONS: u32 = TURN + DRAW_DIMENSIONS + PAIR_DIMENSIONS;

/// The radiance that a sample reflects of other surfaces' light: their emission, and the lights
/// that they reflect, one surface after another. All ways have shadows, and all reflections are
/// diffuse and specular.
pub fn bounced_light(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    paths: Paths,
    numbers: Numbers,
) -> Estimate {
    Estimate::of_points(paths.count, numbers, |point| path(lights, sample, scene, paths, point))
}

/// Radiance along one path.
fn path(
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    scene: &TracedScene<'_>,
    paths: Paths,
    point: Point,
) -> DVec3 {
    let bounces = if paths.is_matte { 1 } else { paths.bounces.min(MAX_BOUNCES) };
    let mut radiance = DVec3::ZERO;
    // The share of light leaving the path's last surface that reaches the eye.
    let mut share = DVec3::ONE;
    let mut at = *sample;
    for bounce in 0..bounces {
        let first = bounce * DIMENSIONS;
        let brdf = BrdfSampler::new(&at.surface, at.to_eye);
        if !paths.is_matte
            && let Some(emission) = scene.draw_emission(&at, point.at(first + TURN))
        {
            let weight = 1.0 / (emission.density + brdf.density(emission.direction));
            radiance += share * weight * from_direction(&at, &emission, scene);
        }
        let direction = brdf.sample(point.at(first));
        if !is_above(&at, direction) {
            break;
        }
        let Some((hit, drawn_density)) = scene.bounce(&at, direction) else { break };
        let density = brdf.density(direction);
        share *= reflect_light(&at.surface, at.to_eye, direction) / density;
        if share == DVec3::ZERO {
            break;
        }
        let weight = density / (density + drawn_density);
        let lit = DIMENSIONS + first + TURN + DRAW_DIMENSIONS;
        let reflected = if paths.is_matte {
            matte_radiance(lights, &hit, scene)
        } else {
            direct_radiance_once(lights, &hit, scene, point, lit)
        };
        let emitted = if paths.is_matte { DVec3::ZERO } else { hit.emission * weight };
        radiance += share * (emitted + reflected);
        at = hit;
    }
    radiance
}

/// A direction above the shading normal's horizon may lie below the triangle.
fn is_above(at: &SurfaceSample, direction: DVec3) -> bool {
    at.surface.normal.dot(direction) > 0.0 && at.geometric_normal.dot(direction) > 0.0
}

/// The emitted radiance that a sample reflects, if the emitter is visible.
fn from_direction(at: &SurfaceSample, emission: &Emission, scene: &TracedScene<'_>) -> DVec3 {
    if !is_above(at, emission.direction) || !scene.sees(at, emission.point) {
        return DVec3::ZERO;
    }
    emission.radiance * reflect_light(&at.surface, at.to_eye, emission.direction)
}
