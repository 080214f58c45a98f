//! Lights aimed at samples: some contain the sample, some miss it, and some barely reach it, where
//! a test that is too tight fails.

use glam::{DVec3, Vec3};

use super::stage::{Rng, Stage};
use crate::{Emitter, Light, LightShape};

/// Kinds of lights in a mix.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kinds {
    /// Points.
    Points,
    /// Spots with half angles between two values, radians, clamped to pi.
    Spots(f64, f64),
    /// Rectangles and polygons of every size, one- and two-sided.
    Areas,
    /// All kinds, with all half angles; half of the emitters are discs, spheres and lines.
    Mixed,
}

/// Lights around random samples, with ranges from `range_m.0` to `range_m.1`. A third barely reach
/// their sample, a third contain it, and a third are anywhere near.
pub(super) fn mix(
    rng: &mut Rng,
    stage: &Stage,
    count: usize,
    range_m: (f64, f64),
    kinds: Kinds,
) -> Vec<Light> {
    let one = |ix: usize| {
        let share = match ix % 3 {
            0 => 1.0 - edge(rng),
            1 => rng.range(0.0, 1.0),
            _ => rng.range(0.0, 3.0),
        };
        at_sample(rng, stage, range_m, kinds, share)
    };
    (0..count).map(one).collect()
}

/// Lights at `share` times their range from a sample. At 1 they barely reach it.
pub(super) fn lights_at(
    rng: &mut Rng,
    stage: &Stage,
    count: usize,
    range_m: (f64, f64),
    kinds: Kinds,
    share: f64,
) -> Vec<Light> {
    let one = |_| {
        let share = (1.0 - edge(rng)).min(share);
        at_sample(rng, stage, range_m, kinds, share)
    };
    (0..count).map(one).collect()
}

/// Lights that barely rise above a sample's horizon, or barely do not: points, and emitters whose
/// highest vertex is there.
pub(super) fn at_horizon(rng: &mut Rng, stage: &Stage, count: usize) -> Vec<Light> {
    let one = |ix: usize| {
        let sample = &stage.samples[rng.below(stage.on_surfaces)];
        let normal = sample.normal_world.as_dvec3().normalize_or(DVec3::Y);
        let along = normal.cross(rng.direction()).normalize_or(normal.any_orthonormal_vector());
        let range = rng.log_range(0.5, 8.0);
        let rise = edge(rng) * if ix.is_multiple_of(3) { -1.0 } else { 1.0 };
        let highest = sample.point + (along + normal * rise) * range * rng.range(0.05, 0.9);
        let light = Light::point(highest.as_vec3(), range as f32, Vec3::ONE);
        if ix.is_multiple_of(2) {
            return light;
        }
        // A rectangle that hangs down from that point, along the horizon and away from the sample.
        let half_x = normal.cross(along) * range * rng.log_range(0.02, 0.5);
        let half_y = (along * rng.range(0.0, 1.0) - normal) * range * rng.log_range(0.02, 0.5);
        let emitter = Emitter::rectangle(half_x.as_vec3(), half_y.as_vec3()).two_sided();
        Light::area(emitter, (highest + half_y).as_vec3(), range as f32, Vec3::ONE)
    };
    (0..count).map(one).collect()
}

/// A point light that reaches `point`, with a range up to `range_m`.
pub(super) fn reaching(rng: &mut Rng, point: DVec3, range_m: f64) -> Light {
    let range = rng.range(0.3, 1.0) * range_m;
    let center = point + rng.direction() * range * rng.range(0.0, 0.99);
    Light::point(center.as_vec3(), range as f32, Vec3::ONE)
}

/// A small random share, 1e-5 to 1e-1, by which a case misses its edge.
fn edge(rng: &mut Rng) -> f64 {
    rng.log_range(1e-5, 1e-1)
}

fn at_sample(rng: &mut Rng, stage: &Stage, range_m: (f64, f64), kinds: Kinds, share: f64) -> Light {
    let point = stage.samples[rng.below(stage.samples.len())].point;
    let range = rng.log_range(range_m.0, range_m.1);
    let center = point + rng.direction() * range * share;
    let light = Light::point(center.as_vec3(), range as f32, Vec3::ONE);
    match kinds {
        Kinds::Points => light,
        Kinds::Spots(low, high) => aimed(rng, light, point, low, high),
        Kinds::Areas => spread(rng, light, point),
        Kinds::Mixed => match rng.below(4) {
            0 => light,
            3 => half(rng, light, point),
            1 => aimed(rng, light, point, 0.02, std::f64::consts::PI),
            _ if rng.below(2) == 0 => curved(rng, light, point),
            _ => spread(rng, light, point),
        },
    }
}

/// Spreads a light over an emitter. The emitter's closest point to `point` is the light's position.
/// It lies on a face that looks at `point`, or at a corner of an emitter seen almost edge-on.
fn spread(rng: &mut Rng, light: Light, point: DVec3) -> Light {
    let corner = light.position.as_dvec3();
    let away = (corner - point).normalize_or(DVec3::Y);
    let about = away.cross(rng.direction()).normalize_or(DVec3::X);
    let faces = rng.below(2) == 0;
    // Angle between the normal and the direction back to the point, up to a right angle.
    let turn = match rng.below(2) {
        _ if faces => 0.0,
        0 => std::f64::consts::FRAC_PI_2 * (1.0 - edge(rng)),
        _ => rng.range(0.0, 1.5),
    };
    let normal = -away * turn.cos() + about * turn.sin();
    let size = f64::from(light.range_m) * rng.log_range(0.01, 3.0);
    let size = size.clamp(2e-4, 1e4);
    let x = normal.cross(rng.direction()).normalize_or(normal.any_orthonormal_vector());
    let y = normal.cross(x) * size * rng.log_range(0.05, 1.0);
    let x = x * size;
    let farther = |axis: DVec3| if axis.dot(away) < 0.0 { -axis } else { axis };
    let (emitter, position) = if rng.below(2) == 0 {
        let offset = match faces {
            true => x * rng.range(-1.0, 1.0) + y * rng.range(-1.0, 1.0),
            false => farther(x) + farther(y),
        };
        (Emitter::rectangle(x.as_vec3(), y.as_vec3()), (corner + offset).as_vec3())
    } else {
        let count = 3 + rng.below(8);
        let vertex = |ix: usize| {
            let (sin, cos) = (std::f64::consts::TAU * ix as f64 / count as f64).sin_cos();
            (corner + x * cos + y * sin).as_vec3()
        };
        let vertices: Vec<Vec3> = (0..count).map(vertex).collect();
        match Emitter::polygon(&vertices) {
            Ok(polygon) => polygon,
            Err(_) => return light,
        }
    };
    let emitter = match rng.below(3) {
        0 => emitter.two_sided(),
        1 => emitter.with_diffuse_share(rng.range(0.2, 1.0) as f32),
        _ => emitter,
    };
    let spread = Light::area(emitter, position, light.range_m, light.intensity);
    // Far from the origin, rounding bends the smallest emitters.
    if spread.check().is_ok() { spread } else { light }
}

/// Turns a light into a disc, a sphere or a line whose closest point to `point` is the light's position, or nearly
/// for a disc.
fn curved(rng: &mut Rng, light: Light, point: DVec3) -> Light {
    let surface = light.position.as_dvec3();
    let away = (surface - point).normalize_or(DVec3::Y);
    let size = f64::from(light.range_m) * rng.log_range(0.01, 3.0);
    let size = size.clamp(2e-4, 1e4);
    let across = away.cross(rng.direction()).normalize_or(away.any_orthonormal_vector());
    let (emitter, position) = match rng.below(3) {
        0 => {
            // Faces the point, or is seen almost edge-on.
            let turn = [0.0, rng.range(0.0, 1.5)][rng.below(2)];
            let normal = -away * f64::cos(turn) + across * f64::sin(turn);
            let inward = (away + normal * normal.dot(-away)).normalize_or(across);
            let disc = Emitter::disc(normal.as_vec3(), size as f32);
            let disc = if rng.below(3) == 0 { disc.two_sided() } else { disc };
            (disc, surface + inward * size * if turn == 0.0 { rng.range(0.0, 1.0) } else { 1.0 })
        }
        1 => (Emitter::sphere(size as f32), surface + away * size),
        _ => {
            let radius = size * rng.log_range(0.01, 1.0);
            let axis = (across + away * rng.range(0.0, 1.0)).normalize();
            let nearest = surface + away * radius;
            (Emitter::line((axis * size).as_vec3(), radius as f32), nearest + axis * size)
        }
    };
    let emitter = emitter.with_diffuse_share([1.0, rng.range(0.2, 1.0)][rng.below(2)] as f32);
    let curved = Light::area(emitter, position.as_vec3(), light.range_m, light.intensity);
    if curved.check().is_ok() { curved } else { light }
}

/// Turns a light into a spot whose cone contains `point`. Half of the cones barely do.
fn aimed(rng: &mut Rng, light: Light, point: DVec3, low: f64, high: f64) -> Light {
    let outer = rng.range(low, high).min(std::f64::consts::PI);
    let to_point = (point - light.position.as_dvec3()).normalize_or(DVec3::NEG_Y);
    let across = to_point.cross(rng.direction()).normalize_or(DVec3::X);
    let off = outer
        * match rng.below(2) {
            0 => 1.0 - edge(rng),
            _ => rng.range(0.0, 1.0),
        };
    let direction = to_point * off.cos() + across * off.sin();
    // Clamped, so that pi stays within the accepted angles.
    let outer_angle = (outer as f32).min(std::f32::consts::PI);
    Light {
        shape: LightShape::Spot {
            direction: direction.normalize().as_vec3(),
            inner_angle: outer_angle * rng.range(0.0, 1.0) as f32,
            outer_angle,
        },
        ..light
    }
}

/// Turns a light into a virtual point light whose half ball contains `point`. Half of them barely
/// do.
fn half(rng: &mut Rng, light: Light, point: DVec3) -> Light {
    let quarter = std::f64::consts::FRAC_PI_2;
    let aimed = aimed(rng, light, point, quarter, quarter);
    let LightShape::Spot { direction, .. } = aimed.shape else { return light };
    let min_distance_m = light.range_m * rng.range(0.0, 0.5) as f32;
    Light { shape: LightShape::Vpl { normal: direction, min_distance_m }, ..light }
}

/// One light with each fault, otherwise like the first of `lights`.
pub(super) fn bad_lights(lights: &[Light]) -> Vec<Light> {
    let Some(&sound) = lights.first() else {
        return Vec::new();
    };
    let spot = |direction, inner_angle, outer_angle| Light {
        shape: LightShape::Spot { direction, inner_angle, outer_angle },
        ..sound
    };
    let vpl = |normal, min_distance_m| Light {
        shape: LightShape::Vpl { normal, min_distance_m },
        ..sound
    };
    let ranged = |range_m| Light { range_m, ..sound };
    let lit = |intensity| Light { intensity, ..sound };
    let moved = |position| Light { position, ..sound };
    vec![
        moved(Vec3::new(f32::NAN, 0.0, 0.0)),
        moved(Vec3::new(0.0, f32::NEG_INFINITY, 0.0)),
        ranged(0.0),
        ranged(-3.0),
        ranged(f32::NAN),
        ranged(f32::INFINITY),
        lit(Vec3::ZERO),
        lit(Vec3::new(1.0, -1.0, 1.0)),
        lit(Vec3::new(1.0, f32::NAN, 1.0)),
        spot(Vec3::ZERO, 0.1, 0.5),
        spot(Vec3::X, 0.1, f32::NAN),
        spot(Vec3::X, 0.0, 0.0),
        vpl(Vec3::ZERO, 0.0),
        vpl(Vec3::Y, -1.0),
        vpl(Vec3::Y, f32::NAN),
        Light { shape: LightShape::Area(Emitter::rectangle(Vec3::X, Vec3::ZERO)), ..sound },
        Light { shape: LightShape::Area(Emitter::rectangle(Vec3::X, Vec3::X)), ..sound },
        Light { shape: LightShape::Area(Emitter::disc(Vec3::ZERO, 1.0)), ..sound },
        Light { shape: LightShape::Area(Emitter::sphere(-1.0)), ..sound },
        Light { shape: LightShape::Area(Emitter::line(Vec3::X, f32::NAN)), ..sound },
        Light {
            shape: LightShape::Area(Emitter::rectangle(Vec3::X, Vec3::Y).with_diffuse_share(2.0)),
            ..sound
        },
    ]
}
