//! What engine users report, beyond the numbered situations.

use glam::{Mat4, Vec3, Vec4};

use super::{
    Figure, Group, Move, Scenario,
    kit::{CLAY, GLAZE, Kit, SLATE, STONE},
};
use crate::{Aabb, builder::arc};

const fn row(name: &'static str, breaks: &'static str, make: fn(&mut Kit)) -> Scenario {
    Scenario { number: None, ..Group::Reported.row(0, name, breaks, make) }
}

/// The scenarios.
pub(super) const ROWS: &[Scenario] = &[
    row(
        "split-screen",
        "One player's half of a larger target is culled as if it were the whole target.",
        |kit| {
            lit_hall(kit);
            kit.framing(|framing| (framing.before_px, framing.after_px) = ([64, 0], [7, 36]));
        },
    ),
    row(
        "mirrored-view",
        "The flipped window of a planar mirror turns the planes of tiles inside out, so that every light is culled.",
        |kit| {
            lit_hall(kit);
            kit.framing(|framing| framing.is_mirrored = true);
        },
    ),
    row(
        "oblique-near-plane",
        "A mirror's oblique near plane tilts clip depth, so that slices made from it hold other samples.",
        oblique_near_plane,
    ),
    Scenario {
        moves: &[Move::Teleport],
        ..row(
            "two-cameras",
            "Two cameras share one strategy in turn, and each finds the lists and the sizes of the other.",
            two_cameras,
        )
    },
    row(
        "range-beyond-far",
        "A light whose range exceeds the far plane has a box that no slice bounds.",
        range_beyond_far,
    ),
    row(
        "lights-at-cell-corner",
        "Many equal lights at the corner of cells and tiles belong to all of their neighbours, or to none.",
        lights_at_cell_corner,
    ),
    row(
        "negative-scale",
        "Models of negative scale show their back faces, and a box from their corners is empty.",
        negative_scale,
    ),
    Scenario {
        options: &["--msaa", "4"],
        ..row(
            "msaa-depth",
            "With several depths per pixel, bounds from the first one lose the lights of the others.",
            fine_fence,
        )
    },
    Scenario {
        figure: Figure::ListedOverContributing,
        ..row(
            "huge-ranges",
            "Ranges larger than the scene put every light into every list, so that culling is pure cost.",
            huge_ranges,
        )
    },
];

fn lit_hall(kit: &mut Kit) {
    kit.hall();
    kit.scatter(220, Kit::hall_box(), (0.5, 4.0));
}

/// The hall as its floor mirrors it: the eye lies below the floor, and the near plane on it hides the pillars and the
/// rubble under the floor.
fn oblique_near_plane(kit: &mut Kit) {
    lit_hall(kit);
    for row in 0..5 {
        let z = 1.4 - 2.1 * row as f32;
        for x in [-1.7, 0.2, 2.2] {
            kit.block(SLATE, Vec3::new(x, -1.6, z), Vec3::new(0.5, 1.59, 0.5));
        }
        kit.ball(CLAY, Vec3::new(0.9 - 0.4 * row as f32, -0.4, z - 1.0), 0.35);
    }
    kit.look(Vec3::new(0.3, -1.2, 3.2), Vec3::new(0.0, 0.9, -4.5));
    kit.framing(|framing| {
        framing.is_mirrored = true;
        framing.clip_plane = Some(Vec4::new(0.0, 1.0, 0.0, -0.002));
    });
}

/// A view down the hall and one across it, in turn.
fn two_cameras(kit: &mut Kit) {
    lit_hall(kit);
    kit.cut([0.3, 1.7, 3.2], [0.0, 1.2, -7.0]);
    kit.cut([-5.5, 3.8, -6.0], [4.0, 0.2, -7.0]);
}

/// The far plane lies at 20 m, and ranges are 30 to 3,000 m. Lights lie in the view, beside it and beyond it.
fn range_beyond_far(kit: &mut Kit) {
    kit.hall();
    kit.planes(0.05, Some(20.0));
    for ix in 0..24 {
        let range_m = kit.log_range(30.0, 3_000.0);
        let place = match ix % 3 {
            0 => kit.point_in(Kit::hall_box()),
            1 => kit.direction() * 0.5 * range_m,
            _ => Vec3::new(kit.range(-20.0, 20.0), 10.0, -25.0 - 0.5 * range_m),
        };
        let mut light = kit.point_light(place, range_m);
        // Far ones are as bright in the hall as near ones.
        light.intensity *= place.distance_squared(kit.eye()).max(9.0) / (range_m * range_m);
        kit.lights.push(light);
    }
    kit.scatter(60, Kit::hall_box(), (0.5, 2.0));
}

/// 400 equal lights in the middle of the scene's box, which is also the middle of the image. With an even number of
/// cells or tiles along each side, four tiles and eight cells meet there.
fn lights_at_cell_corner(kit: &mut Kit) {
    kit.floor(STONE, [-8.0, -16.0], [8.0, 0.0]);
    kit.add("walls", CLAY, |b| {
        b.quad(Vec3::new(-8.0, 0.0, -16.0), 16.0 * Vec3::X, 4.0 * Vec3::Y);
        b.quad(Vec3::new(-8.0, 0.0, 0.0), -16.0 * Vec3::Z, 4.0 * Vec3::Y);
        b.quad(Vec3::new(8.0, 0.0, -16.0), 16.0 * Vec3::Z, 4.0 * Vec3::Y);
    });
    let corner = Vec3::new(0.0, 2.0, -8.0);
    for (x, y) in [(-0.8, 1.3), (0.8, 1.3), (-0.8, 2.7), (0.8, 2.7)] {
        kit.ball(GLAZE, Vec3::new(x, y, -8.0), 0.45);
    }
    kit.ball(SLATE, corner - Vec3::Z, 0.5);
    kit.look(Vec3::new(0.0, 2.0, -0.5), corner);
    let mut light = kit.point_light(corner, 2.5);
    light.intensity /= 60.0;
    kit.lights = vec![light; 400];
    let room = Aabb::new(Vec3::new(-7.0, 0.2, -15.0), Vec3::new(7.0, 3.8, -3.0));
    kit.scatter(40, room, (1.0, 3.0));
}

/// Blocks and balls of scale -1 along one, two and three axes.
fn negative_scale(kit: &mut Kit) {
    kit.floor(STONE, [-7.0, -9.0], [7.0, 3.0]);
    kit.add("wall", SLATE, |b| {
        b.quad(Vec3::new(-7.0, 0.0, -9.0), 14.0 * Vec3::X, 5.0 * Vec3::Y);
    });
    let scales = [[-1.0, 1.0, 1.0], [1.0, -1.2, -0.8], [-1.0, -1.0, -1.0], [-0.5, -1.5, 0.7]];
    for (ix, scale) in scales.into_iter().enumerate() {
        for (row, z) in [-2.5, -5.5].into_iter().enumerate() {
            let at = Vec3::new(-4.2 + 2.8 * ix as f32, 1.8, z);
            let to_world = Mat4::from_translation(at) * Mat4::from_scale(scale.into());
            let material = if row == 0 { GLAZE } else { CLAY };
            // Off the model's origin, so that the scale moves them.
            kit.place("block", material, to_world, |b| {
                b.block(Vec3::new(0.1, -0.9, -0.3), Vec3::new(0.8, 0.2, 0.4));
            });
            kit.place("ball", material, to_world, |b| {
                let profile = arc([0.0, 0.0], [0.45, 0.45], -90.0, 90.0, 10);
                b.lathe(Vec3::new(-0.4, 0.5, 0.0), 18, &profile);
            });
        }
    }
    kit.look(Vec3::new(0.0, 2.0, 3.0), Vec3::new(0.0, 1.4, -5.0));
    let room = Aabb::new(Vec3::new(-6.0, 0.2, -8.5), Vec3::new(6.0, 4.0, 1.0));
    kit.scatter(140, room, (0.6, 3.0));
}

/// Bars of a pixel's width before a far wall, so that most pixels of the fence hold two depths.
fn fine_fence(kit: &mut Kit) {
    kit.add("wall", CLAY, |b| {
        b.quad(Vec3::new(-20.0, -12.0, -25.0), 40.0 * Vec3::X, 24.0 * Vec3::Y);
    });
    kit.add("fence", SLATE, |b| {
        for bar in -60..=60 {
            let x = 0.07 * bar as f32;
            b.block(Vec3::new(x - 0.008, -2.5, -3.01), Vec3::new(x + 0.008, 2.5, -2.99));
        }
    });
    kit.look(Vec3::ZERO, Vec3::new(0.0, 0.0, -25.0));
    let near_fence = Aabb::new(Vec3::new(-3.0, -1.8, -3.4), Vec3::new(3.0, 1.8, -2.6));
    kit.scatter(70, near_fence, (0.2, 0.6));
    let near_wall = Aabb::new(Vec3::new(-18.0, -10.0, -24.5), Vec3::new(18.0, 10.0, -23.0));
    kit.scatter(70, near_wall, (2.0, 6.0));
}

fn huge_ranges(kit: &mut Kit) {
    kit.hall();
    for _ in 0..150 {
        let place = kit.point_in(Kit::hall_box());
        let range_m = kit.log_range(50.0, 5_000.0);
        let mut light = kit.point_light(place, range_m);
        light.intensity *= 1.0 / (range_m * range_m);
        kit.lights.push(light);
    }
}
