//! Polished and bumpy surfaces: scenarios 30 to 32.

use assign::LightShape;
use glam::{Vec2, Vec3};

use super::{
    Group, Scenario,
    kit::{CLAY, Kit, SLATE, plain},
};
use crate::{
    Aabb, Encoding, Material, TextureRef,
    noise::{fractal, normal, render_all},
};

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Group::Gloss.row(
        30,
        "mirror-floor",
        "A polished floor shows lights far outside of their diffuse radius, so a threshold or a specular radius cuts \
         highlights off.",
        mirror_floor,
    ),
    Group::Gloss.row(
        31,
        "curved-normals",
        "Normal maps and strong curvature turn the shading normal away from the surface, out of the cone of its \
         triangle.",
        curved_normals,
    ),
    Group::Gloss.row(
        32,
        "mixed-roughness",
        "One group holds polished and rough samples, so one specular radius for all is too short or too long.",
        mixed_roughness,
    ),
];

/// A floor of polished stone before a dark wall. Panels and lamps hang at the far end, and their reflections come
/// towards the eye.
fn mirror_floor(kit: &mut Kit) {
    let polished = kit.material(plain("polished stone", [0.3, 0.3, 0.32], 0.08, 0.0));
    kit.floor(polished, [-9.0, -24.0], [9.0, 4.0]);
    kit.add("wall", SLATE, |b| {
        b.quad(Vec3::new(-9.0, 0.0, -24.0), 18.0 * Vec3::X, 6.0 * Vec3::Y);
    });
    for ix in 0..5 {
        let x = -5.0 + 2.5 * ix as f32;
        kit.ball(CLAY, Vec3::new(x, 0.5, -8.0 - ix as f32), 0.5);
    }
    kit.look(Vec3::new(0.0, 1.5, 3.0), Vec3::new(0.0, 0.6, -8.0));
    for ix in 0..7 {
        let x = -7.5 + 2.5 * ix as f32;
        // It faces the camera. Its diffuse light ends at a sixth of its range.
        let half = [0.5 * Vec3::X, 0.3 * Vec3::Y];
        let mut panel = kit.rectangle(Vec3::new(x, 2.2, -19.0), half, 24.0);
        if let LightShape::Area(emitter) = &mut panel.shape {
            *emitter = emitter.with_diffuse_share(1.0 / 6.0);
        }
        kit.lights.push(panel);
    }
    for _ in 0..50 {
        let place = kit.point_in(Aabb::new(Vec3::new(-8.0, 0.3, -22.0), Vec3::new(8.0, 3.5, -6.0)));
        let range_m = kit.log_range(1.0, 20.0);
        let light = kit.point_light(place, range_m);
        kit.lights.push(light);
    }
}

/// Balls of a few pixels to half a metre, a corrugated sheet, and a floor with a normal map.
fn curved_normals(kit: &mut Kit) {
    kit.images = render_all(vec![(
        "bumps",
        Encoding::Linear,
        Box::new(|uv: Vec2| normal(uv, 6.0, |uv| fractal(uv, 9, 3, 77))),
    )]);
    let bumpy = kit.material(Material {
        normal_texture: Some(TextureRef::new(0)),
        ..plain("bumpy", [0.5, 0.5, 0.48], 0.35, 0.0)
    });
    let sheet = kit.material(Material {
        double_sided: true,
        ..plain("corrugated sheet", [0.6, 0.62, 0.65], 0.35, 0.0)
    });
    kit.floor(bumpy, [-6.0, -12.0], [6.0, 3.0]);
    kit.add("corrugated sheet", sheet, |b| {
        b.surface(120, 2, |u, v| {
            let wave = 0.25 * (u * 24.0 * std::f32::consts::TAU).sin();
            Vec3::new(-6.0 + 12.0 * u, 4.0 * v, -10.0 + wave)
        });
    });
    for _ in 0..26 {
        let radius_m = kit.log_range(0.06, 0.5);
        let place = Vec3::new(kit.range(-4.5, 4.5), radius_m, kit.range(-8.0, 0.0));
        kit.ball(if radius_m > 0.2 { bumpy } else { CLAY }, place, radius_m);
    }
    kit.look(Vec3::new(0.0, 1.6, 3.0), Vec3::new(0.0, 0.7, -5.0));
    let room = Aabb::new(Vec3::new(-5.5, 0.1, -9.5), Vec3::new(5.5, 3.5, 2.0));
    kit.scatter(180, room, (0.8, 4.0));
}

/// Tiles of 25 cm, polished and rough in turn.
fn mixed_roughness(kit: &mut Kit) {
    let polished = kit.material(plain("polished tile", [0.25, 0.25, 0.27], 0.05, 0.0));
    let rough = kit.material(plain("rough tile", [0.5, 0.48, 0.45], 0.95, 0.0));
    for (material, odd) in [(polished, 0), (rough, 1)] {
        kit.add("tiles", material, |b| {
            for (x, z) in (0..32).flat_map(|x| (0..32).map(move |z| (x, z))) {
                if (x + z) % 2 == odd {
                    let corner = Vec3::new(-4.0 + 0.25 * x as f32, 0.0, 2.0 - 0.25 * z as f32);
                    b.quad(corner, 0.25 * Vec3::X, -0.25 * Vec3::Z);
                }
            }
        });
    }
    kit.add("wall", SLATE, |b| {
        b.quad(Vec3::new(-4.0, 0.0, -6.0), 8.0 * Vec3::X, 3.0 * Vec3::Y);
    });
    kit.look(Vec3::new(0.0, 1.3, 2.6), Vec3::new(0.0, 0.3, -3.0));
    let room = Aabb::new(Vec3::new(-3.8, 0.2, -5.8), Vec3::new(3.8, 2.4, 1.5));
    kit.scatter(120, room, (0.7, 5.0));
}
