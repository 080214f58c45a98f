//! No lists: a sample's lights are found while it is shaded (`assign-walk`).

use assign::{LightSource, Needs, Team};
use assign_walk::Walk;

use super::super::{Axis, Colour, Method, Role, Row, row::NEEDS_NOTHING};

pub(super) const ROWS: &[Row] = &[
    Row {
        family: "W",
        name: "culling while shading",
        about: "no lists: the lanes of a subgroup, 8 x 4 pixels on most GPUs, test the lights together while they \
                shade",
        role: Role::Own,
        source: "this workspace, crate assign-walk",
        axes: &[Axis::Source, Axis::Exit],
        colour: Colour { light: "#2b2b2b", dark: "#e8e8e8" },
        make: |gpu, options| {
            Ok(Method::lists(Walk::new(gpu, Team::Subgroup, options.settings().source)?))
        },
        ..WALK
    },
    Row {
        family: "W1",
        name: "samples that walk the hierarchy",
        about: "no lists: each sample finds its lights in the hierarchy over them",
        source: "Enhuber 2019, outlook (direct light data)",
        axes: &[Axis::Exit],
        needs: Needs { hierarchy: true, ..NEEDS_NOTHING },
        colour: Colour { light: "#ff3b30", dark: "#ffe08a" },
        make: |gpu, _| Ok(Method::lists(Walk::new(gpu, Team::Lane, LightSource::Hierarchy)?)),
        ..WALK
    },
];

const WALK: Row = Row { role: Role::OtherPaper, krate: "assign-walk", ..Row::PLAIN };
