//! The shape of tiles, slices and cells against that of lights: scenarios 1 to 10.

use assign::Light;
use glam::Vec3;

use super::{
    Figure, Group, Scenario,
    kit::{CLAY, GLAZE, Kit, SLATE, STONE},
};
use crate::Aabb;

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Scenario {
        figure: Figure::FalsePositives,
        ..Group::Geometry.row(
            1,
            "tile-corner-light",
            "Large balls that cross no plane of a tile's frustum and still miss it at a corner are listed by tests \
             of planes alone.",
            tile_corner_light,
        )
    },
    Scenario {
        figure: Figure::ListedOverContributing,
        ..Group::Geometry.row(
            2,
            "depth-discontinuity",
            "Between a fence and a far wall, a tile's depth range holds every light of the void.",
            depth_discontinuity,
        )
    },
    Group::Geometry.row(
        3,
        "thin-near-slices",
        "With the near plane at 1 mm, exponential slices near the eye are thinner than rounding.",
        thin_near_slices,
    ),
    Group::Geometry.row(
        4,
        "far-slices",
        "Slices that are hundreds of metres long list every light of a district.",
        far_slices,
    ),
    Group::Geometry.row(
        5,
        "infinite-far",
        "Without a far plane, the logarithm of a slice's end is infinite or not a number.",
        infinite_far,
    ),
    Group::Geometry.row(
        6,
        "beyond-far-lights",
        "Lights beyond the far plane that reach in are cut away with the plane.",
        beyond_far_lights,
    ),
    Group::Geometry.row(
        7,
        "inside-lights",
        "Methods that draw front faces of light volumes lose lights that hold the eye.",
        inside_lights,
    ),
    Group::Geometry.row(
        8,
        "behind-camera",
        "Lights behind the eye have no outline on screen, but reach what is before it.",
        behind_camera,
    ),
    Group::Geometry.row(
        9,
        "light-at-eye",
        "At distance 0, directions and fall-off become infinite or not a number.",
        light_at_eye,
    ),
    Group::Geometry.row(
        10,
        "one-covers-all",
        "One light that covers everything spoils the boxes of a hierarchy, and the cells of a grid.",
        one_covers_all,
    ),
];

/// Each light barely reaches one point of the floor, from any side.
fn tile_corner_light(kit: &mut Kit) {
    kit.hall();
    for _ in 0..160 {
        let on_floor =
            kit.point_in(Aabb::new(Vec3::new(-4.0, 0.0, -14.0), Vec3::new(4.0, 0.0, 0.0)));
        let range_m = kit.log_range(1.0, 12.0);
        let mut away = kit.direction();
        away.y = away.y.abs();
        let light = kit.point_light(on_floor + away * (0.97 * range_m), range_m);
        kit.lights.push(light);
    }
    // Without them, nearly all would be black.
    kit.scatter(12, Kit::hall_box(), (2.0, 4.0));
}

fn depth_discontinuity(kit: &mut Kit) {
    kit.add("wall", CLAY, |b| {
        let corner = Vec3::new(-30.0, -16.0, -40.0);
        b.quad(corner, 60.0 * Vec3::X, 34.0 * Vec3::Y);
    });
    kit.add("fence", SLATE, |b| {
        for bar in -12..=12 {
            let x = 0.34 * bar as f32;
            b.block(Vec3::new(x - 0.06, -3.0, -3.06), Vec3::new(x + 0.06, 3.0, -2.94));
        }
        for y in [-1.2, 1.1] {
            b.block(Vec3::new(-5.0, y - 0.05, -3.02), Vec3::new(5.0, y + 0.05, -2.98));
        }
    });
    kit.look(Vec3::ZERO, Vec3::new(0.0, 0.0, -40.0));
    for _ in 0..300 {
        let depth_m = kit.range(5.0, 36.0);
        let aside = Vec3::new(kit.range(-0.9, 0.9), kit.range(-0.5, 0.5), -1.0);
        let range_m = kit.range(0.4, 1.8);
        let light = kit.point_light(aside * depth_m, range_m);
        kit.lights.push(light);
    }
    let near_fence = Aabb::new(Vec3::new(-4.0, -2.0, -3.6), Vec3::new(4.0, 2.0, -2.4));
    kit.scatter(40, near_fence, (0.3, 1.2));
    let near_wall = Aabb::new(Vec3::new(-28.0, -15.0, -39.5), Vec3::new(28.0, 15.0, -37.0));
    kit.scatter(60, near_wall, (3.0, 9.0));
}

fn thin_near_slices(kit: &mut Kit) {
    kit.add("wall beside the eye", CLAY, |b| {
        b.quad(Vec3::new(-0.03, -0.5, 0.5), -7.0 * Vec3::Z, 3.0 * Vec3::Y);
    });
    kit.add("floor", STONE, |b| {
        b.quad(Vec3::new(-0.03, -0.06, 0.5), 5.0 * Vec3::X, -7.0 * Vec3::Z);
    });
    kit.add("far wall", SLATE, |b| {
        b.quad(Vec3::new(-0.03, -0.06, -6.0), 5.0 * Vec3::X, 3.0 * Vec3::Y);
    });
    kit.look(Vec3::ZERO, Vec3::new(0.3, -0.1, -6.0));
    kit.planes(0.001, Some(20.0));
    for _ in 0..200 {
        let depth_m = kit.log_range(0.02, 5.0);
        let place = Vec3::new(
            -0.03 + 0.3 * depth_m * kit.range(0.02, 1.0),
            -0.06 + 0.3 * depth_m * kit.range(0.02, 1.0),
            -depth_m,
        );
        let range_m = depth_m * kit.range(0.1, 0.5);
        let light = kit.point_light(place, range_m);
        kit.lights.push(light);
    }
}

/// A plain with houses of 20 to 40 m, `reach_m` long.
fn plain_with_houses(kit: &mut Kit, reach_m: f32) {
    kit.floor(STONE, [-reach_m, -reach_m], [reach_m, 50.0]);
    for _ in 0..90 {
        let z = -kit.log_range(70.0, 0.95 * reach_m);
        // A street leads to the horizon.
        let side = if kit.range(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
        let x = side * (30.0 + kit.range(0.0, 0.8) * -z);
        let size = Vec3::new(kit.range(12.0, 30.0), kit.range(15.0, 45.0), kit.range(12.0, 30.0));
        let material = if x > 0.0 { CLAY } else { GLAZE };
        kit.block(material, Vec3::new(x, 0.0, z), size);
    }
    kit.look(Vec3::new(4.0, 22.0, 0.0), Vec3::new(0.0, 8.0, -200.0));
}

/// Lights over the plain: the farther, the larger.
fn lights_over_plain(kit: &mut Kit, count: usize, reach_m: f32) {
    for _ in 0..count {
        let z = -kit.log_range(10.0, reach_m);
        let place = Vec3::new(kit.range(-0.9, 0.9) * -z, kit.range(1.0, 25.0), z);
        let range_m = kit.range(0.1, 0.35) * -z + 5.0;
        let light = kit.point_light(place, range_m);
        kit.lights.push(light);
    }
}

fn far_slices(kit: &mut Kit) {
    plain_with_houses(kit, 1_200.0);
    kit.planes(0.3, Some(2_000.0));
    lights_over_plain(kit, 260, 1_100.0);
}

fn infinite_far(kit: &mut Kit) {
    plain_with_houses(kit, 9_000.0);
    kit.planes(0.1, None);
    lights_over_plain(kit, 260, 8_500.0);
}

/// All surfaces lie within the far plane at 9 m, and all lights beyond it.
fn beyond_far_lights(kit: &mut Kit) {
    kit.floor(STONE, [-8.0, -8.9], [8.0, 2.0]);
    for ix in 0..6 {
        let foot = Vec3::new(-4.5 + 1.8 * ix as f32, 0.0, -3.5 - (ix % 3) as f32 * 2.2);
        kit.block(GLAZE, foot, Vec3::new(0.7, 1.0 + 0.3 * ix as f32, 0.7));
        kit.ball(CLAY, foot + Vec3::new(0.9, 0.45, 0.3), 0.45);
    }
    kit.look(Vec3::new(0.0, 1.5, 0.0), Vec3::new(0.0, 1.5, -9.0));
    kit.planes(0.05, Some(9.0));
    for _ in 0..120 {
        let range_m = kit.log_range(2.0, 12.0);
        let beyond_m = 9.0 + range_m * kit.range(0.05, 0.7);
        let place = Vec3::new(kit.range(-5.0, 5.0), kit.range(0.2, 4.0), -beyond_m);
        let light = kit.point_light(place, range_m);
        kit.lights.push(light);
    }
}

fn inside_lights(kit: &mut Kit) {
    kit.hall();
    for _ in 0..90 {
        let range_m = kit.log_range(1.5, 14.0);
        let away = kit.direction() * range_m * kit.range(0.05, 0.9);
        let light = kit.point_light(kit.eye() + away, range_m);
        kit.lights.push(light);
    }
}

fn behind_camera(kit: &mut Kit) {
    kit.hall();
    for _ in 0..120 {
        let range_m = kit.log_range(3.0, 18.0);
        let behind = Vec3::new(
            range_m * kit.range(-0.5, 0.5),
            range_m * kit.range(-0.1, 0.4),
            -range_m * kit.range(0.02, 0.7),
        );
        let place = kit.ahead(behind);
        let light = kit.point_light(place, range_m);
        kit.lights.push(light);
    }
}

/// Lights exactly at the eye, and exactly on the floor and on corners of blocks.
fn light_at_eye(kit: &mut Kit) {
    kit.hall();
    for range_m in [0.5, 2.0, 6.0, 15.0] {
        let mut light = kit.point_light(kit.eye(), range_m);
        light.intensity *= 0.01;
        kit.lights.push(light);
    }
    let eye = kit.eye();
    let axis = kit.ahead(Vec3::Z) - eye;
    let mut spot = kit.spot(eye, axis, (0.2, 0.4), 12.0);
    spot.intensity *= 0.1;
    kit.lights.push(spot);
    for _ in 0..80 {
        let on_floor =
            kit.point_in(Aabb::new(Vec3::new(-5.0, 0.0, -15.0), Vec3::new(5.0, 0.0, 1.0)));
        let range_m = kit.log_range(0.2, 2.0);
        let light = kit.point_light(on_floor, range_m);
        kit.lights.push(light);
    }
    // The upper corners of the first row of columns.
    for (x, z) in [(-3.1, -1.2), (-3.1, -1.8), (3.1, -1.2), (3.1, -1.8)] {
        let light = kit.point_light(Vec3::new(x, 3.6, z), 2.5);
        kit.lights.push(light);
    }
}

fn one_covers_all(kit: &mut Kit) {
    kit.hall();
    kit.scatter(600, Kit::hall_box(), (0.1, 0.6));
    let intensity = Vec3::splat(0.03);
    // In the middle of the list, so that neither end of it is special.
    kit.lights.insert(300, Light::point(Vec3::new(0.0, 4.0, -6.0), 5_000.0, intensity));
}
