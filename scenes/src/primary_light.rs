//! Chooses the light from which a reflective shadow map is drawn.

use std::f32::consts::PI;

use assign::{Light, LightShape, MAX_RANGE_M};
use glam::Vec3;

use crate::{Aabb, Scene};

/// The distance of the sun, in radii of the scene's core.
const SUN_DISTANCE: f32 = 50.0;

/// The farthest distance of the sun, metres. Its intensity then stays well below the greatest
/// accepted.
const FARTHEST_SUN_M: f32 = 1e7;

/// Height of the sun above the horizon, degrees. It shines into a court as deep as it is wide.
const ELEVATION_DEG: f32 = 60.0;

/// Angle between the sun's azimuth and the scene's longer side, degrees. The sun lights the floor
/// of a long court even if it is as narrow as Sponza's, and one of its long walls.
const AZIMUTH_DEG: f32 = 20.0;

/// Irradiance of a wall that faces the sun. A white wall then has radiance 1.
const SUN_IRRADIANCE: f32 = PI;

/// Range of the sun, in distances to the farthest point. The window is above 0.9997 there.
const SUN_RANGE: f32 = 10.0;

/// The difference of the cosines of the sun's inner and outer cone.
const RAMP: f32 = 1.01 * 1e-3;

/// The scene's primary light: the brightest of its own suns, otherwise of its own spots, otherwise
/// an added sun.
///
/// A shadow map is drawn from a point, so the sun is a spot some fifty scene radii from the middle
/// of [`Scene::core_bounds`]. The cone of its full intensity just contains the core. Its range is
/// so long that the window dims nothing. In the middle, its irradiance is that of the scene's own
/// sun. The added sun is white, 60 degrees above the horizon; a white wall that faces it has
/// radiance 1.
pub fn primary_light(scene: &Scene) -> Light {
    const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);
    let suns = scene.suns.iter().filter(|sun| sun.check().is_ok());
    let brightest =
        suns.max_by(|a, b| a.irradiance.dot(LUMINANCE).total_cmp(&b.irradiance.dot(LUMINANCE)));
    if let Some(sun) = brightest {
        let to_sun = -sun.direction.normalize();
        return distant_spot(scene.core_bounds, scene.bounds, to_sun, sun.irradiance);
    }
    let spots = scene
        .lights
        .iter()
        .filter(|light| matches!(light.shape, LightShape::Spot { .. }) && light.check().is_ok());
    let brightness = |light: &Light| light.intensity.dot(LUMINANCE);
    spots
        .max_by(|a, b| brightness(a).total_cmp(&brightness(b)))
        .copied()
        .unwrap_or_else(|| sun(scene.core_bounds, scene.bounds))
}

/// A sun for a scene without suns and spots.
fn sun(core: Aabb, whole: Aabb) -> Light {
    let core = sound(core);
    let (rise, level) = ELEVATION_DEG.to_radians().sin_cos();
    let (across, along) = AZIMUTH_DEG.to_radians().sin_cos();
    let to_sun = if core.size().x >= core.size().z {
        Vec3::new(-along * level, rise, across * level)
    } else {
        Vec3::new(-across * level, rise, along * level)
    };
    distant_spot(core, whole, to_sun, Vec3::splat(SUN_IRRADIANCE))
}

/// A sun as a spot. It lights a scene's `core` in full, has the given irradiance in the core's
/// middle, and has all of `whole` in range.
fn distant_spot(core: Aabb, whole: Aabb, to_sun: Vec3, irradiance: Vec3) -> Light {
    let (core, whole) = (sound(core), sound(whole));
    let radius = (0.5 * core.diagonal()).clamp(1e-3, FARTHEST_SUN_M / SUN_DISTANCE);
    let distance = SUN_DISTANCE * radius;
    let position = core.center() + distance * to_sun;
    let direction = -to_sun.normalize();
    let angle = |corner: Vec3| direction.angle_between(corner - position);
    let widest = core.corners().map(angle).into_iter().fold(0.0, f32::max);
    // A hundredth wider, so that rounding keeps the corners inside.
    let inner_angle = (1.01 * widest).min(1.0);
    let outer_angle = (inner_angle.cos() - RAMP).acos();
    let farthest =
        whole.corners().map(|corner| corner.distance(position)).into_iter().fold(0.0, f32::max);
    Light {
        position,
        range_m: (SUN_RANGE * farthest).min(MAX_RANGE_M),
        intensity: irradiance * distance * distance,
        shape: LightShape::Spot { direction, inner_angle, outer_angle },
    }
}

/// The box, or a small one around the origin if it is empty or not finite.
fn sound(bounds: Aabb) -> Aabb {
    if bounds.is_empty() || !bounds.min.is_finite() || !bounds.max.is_finite() {
        Aabb::new(Vec3::NEG_ONE, Vec3::ONE)
    } else {
        bounds
    }
}

#[cfg(test)]
mod tests {
    use assign::{SpotRamp, Sun};

    use super::*;
    use crate::{TownSize, atrium, town};

    /// The fall-off of a spot as the lighting shader computes it, in f32, without the cosine of
    /// incidence.
    fn irradiance(light: &Light, point: Vec3) -> f32 {
        let LightShape::Spot { direction, inner_angle, outer_angle } = light.shape else {
            panic!("not a spot");
        };
        let to_point = point - light.position;
        let distance_2 = to_point.length_squared();
        let ratio_2 = distance_2 / (light.range_m * light.range_m);
        let window = (1.0 - ratio_2 * ratio_2).max(0.0).powi(2);
        assert!(window > 0.999, "window {window}");
        let chord = to_point / distance_2.sqrt() - direction;
        let ramp = SpotRamp::new(inner_angle, outer_angle).at(chord.length_squared());
        light.intensity.x * window * ramp / distance_2
    }

    #[test]
    fn the_sun_lights_the_core_evenly() {
        for scene in [atrium(1), town(1, TownSize::Small)] {
            for factor in [1e-3, 1.0, 1e3] {
                let scene = scene.clone().scaled(factor).expect("in range");
                let light = primary_light(&scene);
                assert_eq!(light.check(), Ok(()));
                for corner in scene.core_bounds.corners() {
                    let ratio = irradiance(&light, corner) / PI;
                    assert!((ratio - 1.0).abs() < 0.05, "{} x {factor}: {ratio}", scene.name);
                }
                let ratio = irradiance(&light, scene.core_bounds.center()) / PI;
                assert!((ratio - 1.0).abs() < 1e-3, "{} x {factor}: {ratio}", scene.name);
            }
        }
    }

    #[test]
    fn the_scenes_brightest_sun_is_chosen_first() {
        let mut scene = atrium(1);
        let sun =
            |x: f32, irradiance| Sun { direction: Vec3::new(x, -1.0, 0.2).normalize(), irradiance };
        scene.suns = vec![sun(0.1, Vec3::splat(2.0)), sun(-0.5, Vec3::new(3.0, 6.0, 1.0))];
        let light = primary_light(&scene);
        assert_eq!(light.check(), Ok(()));
        let LightShape::Spot { direction, .. } = light.shape else { panic!("not a spot") };
        assert!(direction.distance(scene.suns[1].direction) < 1e-6);
        let ratio = irradiance(&light, scene.core_bounds.center()) / 3.0;
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    }

    #[test]
    fn degenerate_scenes_have_a_sun() {
        let point = Aabb::new(Vec3::ONE, Vec3::ONE);
        let huge = Aabb::new(Vec3::splat(-1e8), Vec3::splat(1e8));
        let bad = Aabb::new(Vec3::splat(f32::NAN), Vec3::splat(f32::INFINITY));
        for bounds in [Aabb::EMPTY, point, huge, bad] {
            assert_eq!(sun(bounds, bounds).check(), Ok(()), "{bounds:?}");
        }
    }

    #[test]
    fn the_scenes_brightest_spot_is_chosen_next() {
        let mut scene = atrium(1);
        let spot = |intensity: f32| Light {
            shape: LightShape::Spot { direction: Vec3::X, inner_angle: 0.1, outer_angle: 0.5 },
            ..Light::point(Vec3::Y, 5.0, Vec3::splat(intensity))
        };
        let bright = Light::point(Vec3::Y, 5.0, Vec3::splat(99.0));
        scene.lights = vec![bright, spot(1.0), spot(3.0), spot(f32::NAN), spot(2.0)];
        assert_eq!(primary_light(&scene), spot(3.0));
    }
}
