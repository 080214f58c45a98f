//! A grid in world space (`assign-grid`).

use assign_grid::{Grid, GridBox};

use super::super::{Axis, Colour, Method, Role, Row, Sizes, StandIn};

pub(super) const ROWS: &[Row] = &[Row {
    family: "G",
    name: "a grid of cells in world space",
    about: "every cell has a list of the lights that reach it. By default, the cells divide the \
            box around the lights' positions. With /supports, they divide the box around all that \
            the lights reach. With /surfaces, they divide the overlap of the /supports box and \
            the box around the surfaces",
    role: Role::ComparisonPaper,
    source: "Enhuber 2019, section 3.3, table 4.3",
    krate: "assign-grid",
    parameters: &["cells_x", "cells_y", "cells_z"],
    default: "20x20x20",
    axes: &[
        Axis::Box,
        Axis::Source,
        Axis::AreaBounds,
        Axis::Storage,
        Axis::Fewer,
        Axis::Stochastic,
        Axis::Cap,
        Axis::Reuse,
        Axis::Keep,
        Axis::Touched,
        Axis::Exit,
    ],
    sizes: Sizes {
        few: &["12x12x12", "16x16x16", "28x28x28", "40x40x40"],
        many: &["12x12x12", "16x16x16", "20x20x20", "24x24x24", "28x28x28", "40x12x20"],
    },
    has_groups: true,
    stand_ins: &[StandIn {
        segment: "supports",
        what: "G over supports",
        told_by: ("box", "lights"),
        needs_no_planes: false,
        to_today: |options| options.grid_box = GridBox::Supports,
        to_then: |options| options.grid_box = GridBox::default(),
    }],
    colour: Colour { light: "#c25a66", dark: "#ee949e" },
    make: |gpu, options| {
        let counts = options.parameters.parse()?;
        Ok(Method::lists(Grid::new(gpu, counts, options.grid_box, options.settings())?))
    },
    ..Row::PLAIN
}];
