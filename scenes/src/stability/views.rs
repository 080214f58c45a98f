//! Projections, viewports and coordinates: scenarios 21 to 25.

use assign::DepthMapping;
use glam::{DVec3, Vec2, Vec3};

use super::{
    Group, Move, Scenario,
    kit::{Kit, plain},
};
use crate::Lens;

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Group::Views.row(
        21,
        "orthographic-near-0",
        "An orthographic view has a near plane at 0, where exponential slices have no beginning.",
        orthographic_near_0,
    ),
    Group::Views.row(
        22,
        "off-centre-window",
        "Tiles are bounded wrongly if the viewing axis is taken for the middle of the image.",
        |kit| {
            lit_hall(kit);
            kit.framing(|framing| framing.shift = Vec2::new(0.45, -0.3));
        },
    ),
    Scenario {
        moves: &[Move::Rotation],
        ..Group::Views.row(
            22,
            "sub-pixel-jitter",
            "Temporal anti-aliasing moves the window by parts of a pixel, which bounds made without it do not hold.",
            |kit| {
                lit_hall(kit);
                kit.framing(|framing| framing.jitter_px = Vec2::new(-0.5, 0.33));
            },
        )
    },
    Group::Views.row(
        22,
        "viewport-offset",
        "Tiles count from the corner of the target instead of the corner of the viewport.",
        |kit| {
            lit_hall(kit);
            kit.framing(|framing| framing.before_px = [21, 13]);
        },
    ),
    Group::Views.row(
        23,
        "odd-size",
        "The last tile of a row is cut by the image's edge, so its bounds and its mean depth are not those of a whole \
         tile.",
        |kit| {
            lit_hall(kit);
            kit.framing(|framing| framing.less_px = [5, 3]);
        },
    ),
    Group::Views.row(
        22,
        "standard-depth",
        "Depth that is not reversed has few bits far from the eye, so distant samples move by metres.",
        standard_depth,
    ),
    Group::Views.row(
        24,
        "far-from-origin",
        "A thousand kilometres from a file's origin, single precision is 6 cm coarse, unless the scene moves to the \
         camera.",
        |kit| {
            lit_hall(kit);
            kit.origin = AWAY;
        },
    ),
    Group::Views.row(
        24,
        "huge-coordinates",
        "A hundred kilometres from the world's origin, rounding moves samples out of the bounds of their group.",
        |kit| {
            lit_hall(kit);
            kit.shift((0.1 * AWAY).as_vec3());
        },
    ),
    Scenario {
        options: &["--transparent"],
        ..Group::Views.row(
            25,
            "transparent-layers",
            "Glass is lit at depths that hold no opaque surface, for which explicit bounds and sparse lists hold \
             nothing.",
            transparent_layers,
        )
    },
    Scenario {
        options: &["--particles", "150"],
        ..Group::Views.row(
            25,
            "particles",
            "Particles float where no opaque surface is, so lists made from the depth of surfaces lack their lights.",
            lit_hall,
        )
    },
    Scenario {
        options: &["--fog", "0.05"],
        ..Group::Views.row(
            25,
            "fog",
            "Fog is lit in the whole depth of the view, in clusters and in tiles' voids that hold no surface.",
            lit_hall,
        )
    },
];

/// A thousand kilometres from the origin.
const AWAY: DVec3 = DVec3::new(800_000.0, 1_000.0, -600_000.0);

/// The hall with points and spots of all sizes.
fn lit_hall(kit: &mut Kit) {
    kit.hall();
    kit.scatter(200, Kit::hall_box(), (0.5, 4.0));
    kit.scatter_spots(40, Kit::hall_box(), (0.3, 1.2), 0.5);
}

/// The floor crosses the near plane, which holds the eye.
fn orthographic_near_0(kit: &mut Kit) {
    lit_hall(kit);
    kit.look(Vec3::new(0.0, 2.6, 1.0), Vec3::new(0.0, 0.2, -7.0));
    kit.lens(Lens::Orthographic { half_width: 5.0, half_height: 2.8 });
    kit.planes(0.0, Some(30.0));
}

fn standard_depth(kit: &mut Kit) {
    lit_hall(kit);
    kit.planes(0.005, Some(1_000.0));
    kit.framing(|framing| framing.depth = DepthMapping::Standard);
}

/// Sheets of glass in the middle of the hall, with lights that reach nothing but them.
fn transparent_layers(kit: &mut Kit) {
    kit.hall();
    let mut glass = plain("glass", [0.7, 0.85, 0.8], 0.1, 0.0);
    glass.base_color.w = 0.3;
    glass.is_blended = true;
    glass.double_sided = true;
    let glass = kit.material(glass);
    for layer in 0..5 {
        let z = -2.0 - 1.7 * layer as f32;
        let x = if layer % 2 == 0 { -1.6 } else { -0.2 };
        kit.add("glass", glass, |b| {
            b.quad(Vec3::new(x, 0.6, z), 1.9 * Vec3::X, 1.8 * Vec3::Y);
        });
        for _ in 0..8 {
            let place = Vec3::new(x + kit.range(0.2, 1.7), kit.range(0.9, 2.2), z + 0.15);
            let light = kit.point_light(place, 0.35);
            kit.lights.push(light);
        }
    }
    kit.scatter(80, Kit::hall_box(), (1.0, 3.5));
}
