//! Moving cameras and lights: scenarios 26 to 29.

use glam::Vec3;

use super::{Figure, Group, Move, Scenario, kit::Kit};
use crate::Aabb;

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Scenario {
        figure: Figure::TemporalError,
        moves: &[Move::Dolly, Move::Rotation],
        ..Group::Time.row(
            26,
            "sub-pixel-moves",
            "A light that is lost in some frames pops, although neither the camera nor the light moves by a pixel.",
            small_lights,
        )
    },
    Scenario {
        moves: &[Move::Teleport],
        ..Group::Time.row(
            27,
            "camera-teleports",
            "After a cut, lists and bounds of the last frame are those of another place.",
            camera_teleports,
        )
    },
    Scenario {
        moves: &[
            Move::Lights("drift"),
            Move::Lights("teleport"),
            Move::Lights("births"),
            Move::Lights("all"),
        ],
        ..Group::Time.row(
            27,
            "every-light-moves",
            "When every light moves in every frame, lists, hierarchies and orders of the last frame are stale.",
            every_light_moves,
        )
    },
    Scenario {
        moves: &[Move::Teleport],
        ..Group::Time.row(
            28,
            "same-frame-twice",
            "Lists in the order of atomics differ between two runs of one frame, and the last bits of the image too.",
            same_frame_twice,
        )
    },
    Scenario {
        figure: Figure::FrameTime,
        moves: &[Move::Teleport, Move::Rotation, Move::Lights("drift")],
        ..Group::Time.row(
            29,
            "uneven-load",
            "Frame times jump where the camera turns from an empty part to a crowded one.",
            uneven_load,
        )
    },
];

/// Lights whose edges lie on surfaces all over the hall.
fn small_lights(kit: &mut Kit) {
    kit.hall();
    kit.scatter(500, Kit::hall_box(), (0.3, 1.8));
}

/// Four places of the hall, one of them with a view out of it.
fn four_places(kit: &mut Kit) {
    kit.cut([0.3, 1.7, 3.2], [0.0, 1.2, -7.0]);
    kit.cut([4.8, 3.4, -14.0], [-2.0, 0.8, -2.0]);
    kit.cut([-1.0, 0.4, -5.0], [3.4, 1.6, -9.1]);
    kit.cut([-5.2, 2.0, 1.0], [0.0, 1.0, 9.0]);
}

fn camera_teleports(kit: &mut Kit) {
    kit.hall();
    kit.scatter(250, Kit::hall_box(), (0.5, 4.0));
    four_places(kit);
}

fn every_light_moves(kit: &mut Kit) {
    kit.hall();
    kit.scatter(220, Kit::hall_box(), (0.5, 3.0));
    kit.scatter_spots(40, Kit::hall_box(), (0.3, 1.0), 0.6);
}

/// Every pose is shown in two frames in a row.
fn same_frame_twice(kit: &mut Kit) {
    camera_teleports(kit);
    kit.cuts = kit.cuts.iter().flat_map(|pose| [*pose, *pose]).collect();
}

/// Three of four lights stand in the last quarter of the hall.
fn uneven_load(kit: &mut Kit) {
    kit.hall();
    let end = Aabb::new(Vec3::new(-5.8, 0.1, -15.8), Vec3::new(5.8, 4.2, -11.0));
    kit.scatter(600, end, (0.6, 3.0));
    kit.scatter(200, Kit::hall_box(), (0.5, 1.5));
    four_places(kit);
    kit.cut([0.0, 2.0, -9.5], [0.0, 1.5, -16.0]);
    kit.cut([0.0, 3.8, -1.0], [0.0, 0.0, 1.5]);
}
