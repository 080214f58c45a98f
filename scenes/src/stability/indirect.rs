//! Virtual point lights, and walls between rooms: scenarios 33 and 34.

use assign::{Light, LightShape};
use glam::Vec3;

use super::{
    Group, Scenario,
    kit::{CLAY, GLAZE, Kit, SLATE, STONE},
};
use crate::Aabb;

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Group::Indirect.row(
        33,
        "vpl-on-surface",
        "A virtual point light lies on the surface that it lights, where inverse-square fall-off has no bound.",
        vpl_on_surface,
    ),
    Group::Indirect.row(
        34,
        "thin-wall",
        "Light leaks through a wall of 2 cm, because lights without shadows reach what lies behind it.",
        thin_wall,
    ),
];

/// Virtual point lights on floor, walls and balls. Half of them have no least distance.
fn vpl_on_surface(kit: &mut Kit) {
    kit.hall();
    for ix in 0..300 {
        let place = kit.point_in(Kit::hall_box());
        let (position, normal) = match ix % 4 {
            0 => (place.with_x(-6.0), Vec3::X),
            1 => (place.with_x(6.0), Vec3::NEG_X),
            2 => {
                // On the first ball.
                let out = kit.direction();
                (Vec3::new(-1.1, 0.7, -2.7) + 0.7 * out, out)
            }
            _ => (place.with_y(0.0), Vec3::Y),
        };
        let range_m = kit.log_range(0.5, 5.0);
        let intensity = 0.2 * kit.intensity(range_m);
        let min_distance_m = if ix % 2 == 0 { 0.0 } else { 0.05 };
        let shape = LightShape::Vpl { normal, min_distance_m };
        kit.lights.push(Light { position, range_m, intensity, shape });
    }
}

/// Two rooms share a wall. All lights are in the right one, and the left one shows what leaks.
fn thin_wall(kit: &mut Kit) {
    kit.floor(STONE, [-5.0, -9.0], [5.0, 3.0]);
    kit.add("back wall", CLAY, |b| {
        b.quad(Vec3::new(-5.0, 0.0, -9.0), 10.0 * Vec3::X, 3.5 * Vec3::Y);
    });
    kit.add("side walls", CLAY, |b| {
        b.quad(Vec3::new(-5.0, 0.0, 3.0), -12.0 * Vec3::Z, 3.5 * Vec3::Y);
        b.quad(Vec3::new(5.0, 0.0, -9.0), 12.0 * Vec3::Z, 3.5 * Vec3::Y);
    });
    kit.add("thin wall", SLATE, |b| {
        b.block(Vec3::new(-0.01, 0.0, -9.0), Vec3::new(0.01, 3.5, 0.5));
    });
    for x in [-2.6, 2.6] {
        kit.ball(GLAZE, Vec3::new(x, 0.6, -3.5), 0.6);
        kit.block(GLAZE, Vec3::new(1.2 * x, 0.0, -6.5), Vec3::new(0.8, 1.6, 0.8));
    }
    kit.look(Vec3::new(0.0, 1.7, 4.2), Vec3::new(0.0, 1.1, -5.0));
    let room = Aabb::new(Vec3::new(0.05, 0.2, -8.5), Vec3::new(4.8, 3.2, 0.0));
    kit.scatter(60, room, (1.0, 4.0));
}
