//! Cells in world space (`assign-grid`).

use assign::AssignError;
use assign_grid::{Grid, GridBox, HashedCells};

use super::super::{Axis, Colour, Method, Role, Row, Sizes, StandIn, row::NEEDS_DEPTH};

pub(super) const ROWS: &[Row] = &[GRID, HASHED];

const GRID: Row = Row {
    family: "G",
    name: "a grid of cells in world space",
    about: "every cell has a list of the lights that reach it. By default, the cells divide the \
            box around the lights' positions. With /supports, they divide the box around all that \
            the lights reach. With /surfaces, /frustum and /visible, they divide the overlap of the \
            /supports box and the box around the surfaces, the view's frustum or the visible samples",
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
        Axis::Occlusion,
        Axis::Half,
        Axis::Fewer,
        Axis::Stochastic,
        Axis::Order,
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
};

const HASHED: Row = Row {
    family: "HC",
    name: "hashed cells",
    about: "cells in world space that grow with the distance to the eye; every cell that holds samples has a \
            list of the lights that reach it. A hash table finds a sample's cell",
    role: Role::Own,
    source: "this workspace, crate assign-grid; cells after Binder 2018, \"Fast Path Space Filtering by Jittered \
             Spatial Hashing\", SIGGRAPH Talks",
    krate: "assign-grid",
    parameters: &["cell_px"],
    default: "48",
    axes: &[
        Axis::Source,
        Axis::AreaBounds,
        Axis::Storage,
        Axis::Occlusion,
        Axis::Half,
        Axis::Fewer,
        Axis::Stochastic,
        Axis::Order,
        Axis::Cap,
        Axis::Reuse,
        Axis::Keep,
        Axis::Touched,
        Axis::Exit,
    ],
    sizes: Sizes { few: &["24", "32", "64", "96"], many: &["24", "32", "48", "64", "96", "128"] },
    has_groups: true,
    needs: NEEDS_DEPTH,
    colour: Colour { light: "#9600f0", dark: "#b04bff" },
    make: |gpu, options| {
        let cell_px = options.parameters.parse().map_err(|_| AssignError::Parameter {
            field: "cell edge".into(),
            value: options.parameters.clone(),
            accepted: "a whole number of pixels, such as 48".into(),
        })?;
        Ok(Method::lists(HashedCells::new(gpu, cell_px, options.settings())?))
    },
    ..Row::PLAIN
};
