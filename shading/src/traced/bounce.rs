//! Light that comes by a detour: off other surfaces, or from surfaces that emit.
//!
//! # The idea
//!
//! A path starts at the sample and follows directions drawn as the BRDF reflects, one per bounce. At
//! every surface that it meets, it takes up what the lights add there directly, by rays to them, and
//! what the surface emits. Each is multiplied by what all surfaces before it reflect.
//!
//! Emission is found in two ways: the path meets a triangle that emits, or one is drawn
//! ([`emissive`](super::emissive)) and a ray finds whether it is seen. Both are weighted by the balance
//! heuristic, so that neither small emitters nor mirrors make rare, large values.
//!
//! Paths end after the given number of bounces: what takes more is missing.

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
    /// How many.
    pub count: u32,
    /// Surfaces that each may meet, at most [`MAX_BOUNCES`].
    pub bounces: u32,
    /// Whether those surfaces reflect lights as virtual point lights emit: diffusely, and no area lights, no
    /// suns and no emission.
    /// Then a path ends at the first.
    pub is_matte: bool,
}

/// Dimensions that the way to the next surface takes.
const TURN: u32 = 3;
/// Dimensions of each surface of a path: the way on, emission, and the lights.
const DIMENSIONS: u32 = TURN + DRAW_DIMENSIONS + PAIR_DIMENSIONS;

/// Radiance that a sample reflects of what other surfaces, one after another, emit and reflect of the
/// lights, shadows on all ways, diffuse and specular.
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
    // What reaches the eye of light that leaves the path's last surface.
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

/// Emitted radiance that a sample reflects, where the emitter is seen.
fn from_direction(at: &SurfaceSample, emission: &Emission, scene: &TracedScene<'_>) -> DVec3 {
    if !is_above(at, emission.direction) || !scene.sees(at, emission.point) {
        return DVec3::ZERO;
    }
    emission.radiance * reflect_light(&at.surface, at.to_eye, emission.direction)
}
