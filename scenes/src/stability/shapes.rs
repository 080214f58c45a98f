//! Spots, rectangles and transforms: scenarios 17 to 20.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use assign::{LightShape, MIN_SPOT_ANGLE};
use glam::{Mat4, Quat, Vec3};

use super::{
    Group, Scenario,
    kit::{CLAY, GLAZE, Kit, POLISH, SLATE, STONE},
};
use crate::builder::arc;

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Group::Shapes.row(
        17,
        "spot-angles",
        "Cones near 0 degrees vanish in rounding, and beyond 90 degrees a cone's box lies behind its apex too.",
        spot_angles,
    ),
    Group::Shapes.row(
        18,
        "rectangle-at-horizon",
        "A rectangle that is half below a surface's horizon, or in its plane, lights with what is left or not at \
         all.",
        rectangle_at_horizon,
    ),
    Group::Shapes.row(
        19,
        "long-rectangle",
        "A 100:1 rectangle whose range is shorter than its half length is dark at its ends if it is culled as a \
         ball of its range.",
        long_rectangle,
    ),
    Group::Shapes.row(
        20,
        "odd-transforms",
        "Under uneven scales, shears and mirrors, boxes and normals of models are wrong if they are only rotated.",
        odd_transforms,
    ),
];

/// The half angles of the spots, radians.
const HALF_ANGLES: [f32; 10] =
    [MIN_SPOT_ANGLE, 0.001, 0.02, 0.25, FRAC_PI_4, 1.2, FRAC_PI_2, 2.0, 2.6, PI];

/// A row of spots for each half angle, close to the floor and to a wall, so that apexes lie inside of groups.
fn spot_angles(kit: &mut Kit) {
    kit.hall();
    for (ix, outer) in HALF_ANGLES.into_iter().enumerate() {
        for step in 0..10 {
            let x = -4.6 + 1.0 * ix as f32;
            let place = Vec3::new(x, kit.range(0.4, 2.6), -1.0 - 1.4 * step as f32);
            let aside = kit.direction() * 0.7;
            let range_m = kit.range(1.5, 4.0);
            let inner = outer * kit.range(0.3, 0.9);
            let spot = kit.spot(place, Vec3::NEG_Y + aside, (inner, outer), range_m);
            kit.lights.push(spot);
        }
    }
}

/// Rectangles that stand in the floor to their middle, lie in it, and hang before the walls, one-sided and
/// two-sided.
fn rectangle_at_horizon(kit: &mut Kit) {
    kit.hall();
    for ix in 0..5 {
        let z = -1.0 - 2.6 * ix as f32;
        // Half of it lies below the floor.
        let half = [0.5 * Vec3::X, 0.6 * Vec3::Y];
        let standing = kit.rectangle(Vec3::new(-2.0, 0.0, z), half, 3.0);
        // It lies in the plane of the floor and shines upwards.
        let half = [0.5 * Vec3::Z, 0.4 * Vec3::X];
        let lying = kit.rectangle(Vec3::new(0.6, 0.0, z - 0.8), half, 3.0);
        // It leaves the wall at a right angle.
        let half = [0.7 * Vec3::X, 0.4 * Vec3::Y];
        let mut at_wall = kit.rectangle(Vec3::new(5.6, 1.4, z), half, 3.0);
        if let LightShape::Area(emitter) = &mut at_wall.shape {
            *emitter = emitter.two_sided();
        }
        kit.lights.extend([standing, lying, at_wall]);
    }
}

/// Tubes of 20 m by 20 cm, with ranges of 1 to 3 m.
fn long_rectangle(kit: &mut Kit) {
    kit.hall();
    for (x, y, range_m) in [(-5.2, 0.5, 1.0), (-1.6, 1.9, 2.2), (1.7, 1.1, 1.6), (5.0, 2.6, 3.0)] {
        // It faces down.
        let half = [0.1 * Vec3::X, 10.0 * Vec3::Z];
        let mut tube = kit.rectangle(Vec3::new(x, y, -6.0), half, range_m);
        tube.intensity *= 20.0;
        kit.lights.push(tube);
    }
}

/// A ball of radius 0.5 m around the origin, and a block of 1 m, under a transform.
fn pair(kit: &mut Kit, material: u32, at: Vec3, linear: Mat4) {
    let to_world = Mat4::from_translation(at) * linear;
    kit.place("ball", material, to_world, |b| {
        b.lathe(Vec3::ZERO, 18, &arc([0.0, 0.0], [0.5, 0.5], -90.0, 90.0, 10));
    });
    let beside = to_world * Mat4::from_translation(Vec3::new(0.0, -1.1, 0.0));
    kit.place("block", material, beside, |b| b.block(Vec3::splat(-0.4), Vec3::splat(0.4)));
}

fn odd_transforms(kit: &mut Kit) {
    kit.floor(STONE, [-7.0, -9.0], [7.0, 3.0]);
    kit.add("wall", SLATE, |b| {
        b.quad(Vec3::new(-7.0, 0.0, -9.0), 14.0 * Vec3::X, 5.0 * Vec3::Y);
    });
    let mut shear = Mat4::IDENTITY;
    shear.y_axis.x = 0.9;
    let turn = Mat4::from_quat(Quat::from_axis_angle(Vec3::new(0.3, 0.5, 0.8).normalize(), 0.9));
    let linear = [
        Mat4::from_scale(Vec3::new(1.6, 0.5, 0.7)),
        Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
        shear,
        Mat4::from_scale(Vec3::new(0.05, 1.2, 1.2)) * turn,
        turn * Mat4::from_scale(Vec3::new(0.7, -1.3, 0.9)) * shear,
    ];
    for (ix, linear) in linear.into_iter().enumerate() {
        let x = -4.4 + 2.2 * ix as f32;
        let material = [CLAY, GLAZE, POLISH][ix % 3];
        pair(kit, material, Vec3::new(x, 2.2, -3.0), linear);
        pair(kit, material, Vec3::new(1.2 * x, 2.0, -6.5), linear * turn);
    }
    kit.look(Vec3::new(0.0, 2.2, 3.0), Vec3::new(0.0, 1.5, -5.0));
    let room = crate::Aabb::new(Vec3::new(-6.0, 0.2, -8.5), Vec3::new(6.0, 4.0, 1.0));
    kit.scatter(140, room, (0.6, 3.0));
}
