//! The lighting function in f64 on the CPU. Tests compare the shaders with it.

mod area;
mod brdf;
mod outline;

use area::SeenArea;
use assign::{Light, LightShape, MIN_DISTANCE_2, Sun, fall_off, specular_reach};
pub(crate) use brdf::{MIN_COS_VIEW, MIN_ROUGHNESS, f0_of, f90_of, ggx, lobes_of};
pub use brdf::{Reflectance, Surface, reflect_light};
use glam::DVec3;

use crate::ltc;

/// Radiance that one light adds at `position`. For an area light, the BRDF is integrated over its
/// emitter, to a relative error of 1e-4.
pub fn light_contribution(
    light: &Light,
    position: DVec3,
    surface: &Surface,
    to_eye: DVec3,
) -> DVec3 {
    if let LightShape::Area(emitter) = &light.shape {
        let seen = SeenArea::new(light, emitter, position, surface, to_eye);
        return seen.map_or(DVec3::ZERO, |seen| seen.truth());
    }
    point_contribution(light, position, surface, to_eye)
}

/// Radiance that one light adds at `position` if its specular term reaches up to `most` ranges, where the surface is
/// polished ([`assign::specular_reach`]). Area lights keep their ranges.
pub fn reaching_contribution(
    light: &Light,
    position: DVec3,
    surface: &Surface,
    to_eye: DVec3,
    most: f64,
) -> DVec3 {
    if matches!(light.shape, LightShape::Area(_)) {
        return light_contribution(light, position, surface, to_eye);
    }
    let f0 = Surface { dielectric: Reflectance::default(), ..*surface };
    let cos_v = surface.normal.dot(to_eye).abs().max(MIN_COS_VIEW);
    let reach = specular_reach(surface.roughness, f0_of(&f0).max_element(), cos_v, most);
    let farther = Light { range_m: (f64::from(light.range_m) * reach) as f32, ..*light };
    let (near, to_light) = arriving(light, position);
    let (far, _) = arriving(&farther, position);
    let lobes = lobes_of(surface, to_eye, to_light);
    (near * lobes.diffuse + far * lobes.specular) * surface.normal.dot(to_light).max(0.0)
}

/// Radiance that a sun adds to a surface.
pub fn sun_contribution(sun: &Sun, surface: &Surface, to_eye: DVec3) -> DVec3 {
    let to_sun = -sun.direction.as_dvec3().normalize();
    sun.irradiance.as_dvec3() * reflect_light(surface, to_eye, to_sun)
}

/// Radiance that an area light adds at `position` by linearly transformed cosines. For other lights
/// it is that of [`light_contribution`].
pub fn ltc_contribution(
    table: &ltc::Table,
    light: &Light,
    position: DVec3,
    surface: &Surface,
    to_eye: DVec3,
) -> DVec3 {
    let LightShape::Area(emitter) = &light.shape else {
        return light_contribution(light, position, surface, to_eye);
    };
    let entry = table.look_up(surface.roughness, surface.normal.dot(to_eye).abs());
    let seen = SeenArea::new(light, emitter, position, surface, to_eye);
    seen.map_or(DVec3::ZERO, |seen| seen.ltc(&entry))
}

/// Radiance of a point, a spot or a VPL. An area light counts as a point at its middle that faces
/// all ways.
fn point_contribution(light: &Light, position: DVec3, surface: &Surface, to_eye: DVec3) -> DVec3 {
    let (arriving, to_light) = arriving(light, position);
    arriving * reflect_light(surface, to_eye, to_light)
}

/// Diffuse radiance of a surface that acts as a virtual point light. It is the same in all
/// directions, because Fresnel's term is replaced by its mean over them. An area light counts as a
/// point.
pub(crate) fn matte_contribution(light: &Light, position: DVec3, surface: &Surface) -> DVec3 {
    let (arriving, to_light) = arriving(light, position);
    let cos = surface.normal.dot(to_light).clamp(0.0, 1.0);
    let fresnel = ltc::diffuse_fresnel(cos);
    let kept = (DVec3::ONE - f0_of(surface)) * (1.0 - fresnel)
        + DVec3::splat((1.0 - f90_of(surface)) * fresnel);
    let albedo = (1.0 - surface.metallic) * surface.base_color * kept;
    arriving * albedo * cos / std::f64::consts::PI
}

/// Irradiance perpendicular to the way from a light to a position, and the unit vector to the
/// light.
fn arriving(light: &Light, position: DVec3) -> (DVec3, DVec3) {
    let offset = light.position.as_dvec3() - position;
    let to_light = offset.normalize_or_zero();
    let mut weight = fall_off(offset.length_squared(), f64::from(light.range_m), MIN_DISTANCE_2);
    if let LightShape::Spot { direction, inner_angle, outer_angle } = light.shape {
        let cos_outer = f64::from(outer_angle).cos();
        // Equal angles end the light abruptly.
        let scale = 1.0 / (f64::from(inner_angle).cos() - cos_outer).max(1e-30);
        let cos = direction.as_dvec3().normalize().dot(-to_light);
        weight *= ((cos - cos_outer) * scale).clamp(0.0, 1.0).powi(2);
    }
    if let LightShape::Vpl { normal, min_distance_m } = light.shape {
        let least_2 = f64::from(min_distance_m).powi(2).max(MIN_DISTANCE_2);
        weight = fall_off(offset.length_squared(), f64::from(light.range_m), least_2)
            * normal.as_dvec3().normalize().dot(-to_light).max(0.0);
    }
    (light.intensity.as_dvec3() * weight, to_light)
}
