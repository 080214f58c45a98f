//! Tiles of the screen (`assign-tiled`).

use assign::{AssignError, FrustumTests, Gpu};
use assign_tiled::{
    TileDepths::{self, Explicit, ExplicitAtOnce, HalfZ, Implicit, ModifiedHalfZ, Sliced},
    Tiled,
};

use super::super::{Axis, Colour, Method, Options, Role, Row, Sizes, StandIn, row::NEEDS_DEPTH};

pub(super) const ROWS: &[Row] = &[
    Row {
        family: "T-I",
        name: "tiles, implicit bounds",
        about: "every tile has a list of the lights that reach it, from the near to the far plane",
        stand_ins: &[StandIn {
            segment: "hs",
            what: "T-I by HS only",
            told_by: ("tests", "hs+sat-n"),
            needs_no_planes: true,
            to_today: |options| options.tests = Some(HS),
            to_then: |options| options.tests = None,
        }],
        colour: Colour { light: "#0f8a77", dark: "#45bda9" },
        make: |gpu, options| make(gpu, options, Implicit),
        ..TILES
    },
    Row {
        family: "T-E",
        name: "tiles, explicit bounds",
        about: "every tile has a list of the lights that reach it from its nearest to its farthest sample",
        needs: NEEDS_DEPTH,
        colour: Colour { light: "#8b3a8f", dark: "#cf84d2" },
        make: |gpu, options| make(gpu, options, Explicit),
        ..TILES
    },
    Row {
        family: "T-E1",
        name: "tiles, explicit bounds, in one pass",
        about: "as T-E, but the workgroup that culls a tile first finds its nearest and farthest samples, which \
                saves a pass",
        role: Role::Engine,
        default: "32x32",
        sizes: Sizes {
            few: &["16x16", "24x24", "28x28", "48x48", "64x64"],
            many: &["16x16", "24x24", "28x28", "32x32", "40x40", "48x48", "64x64"],
        },
        source: "Andersson 2009, \"Parallel Graphics in Frostbite\", SIGGRAPH Beyond Programmable Shading course",
        needs: NEEDS_DEPTH,
        axes: &[
            Axis::Tests,
            Axis::Rectangle,
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
            Axis::Exit,
        ],
        colour: Colour { light: "#e600e6", dark: "#ff66ff" },
        make: |gpu, options| make(gpu, options, ExplicitAtOnce),
        ..TILES
    },
    Row {
        family: "HalfZ",
        name: "tiles in two halves",
        about: "as T-E, but the depths of a tile are cut in the middle, and each half has a list",
        colour: Colour { light: "#7a9a00", dark: "#b5d633" },
        make: |gpu, options| make(gpu, options, HalfZ),
        ..HALVES
    },
    Row {
        family: "ModifiedHalfZ",
        name: "tiles in two tight halves",
        about: "as HalfZ, but each half shrinks to the samples in it",
        colour: Colour { light: "#00809c", dark: "#3fd0ee" },
        make: |gpu, options| make(gpu, options, ModifiedHalfZ),
        ..HALVES
    },
    Row {
        family: "T-25D",
        name: "tiles with depth masks (2.5D)",
        about: "as T-E, but the depths of a tile are cut into 32 slices, and lights that reach only empty slices are \
                left out",
        source: "Harada 2012, \"A 2.5D Culling for Forward+\", SIGGRAPH Asia Technical Briefs",
        colour: Colour { light: "#b3006b", dark: "#ff6fb5" },
        make: |gpu, options| make(gpu, options, Sliced),
        ..HALVES
    },
];

const HALVES: Row = Row {
    role: Role::OtherPaper,
    source: "Thomas 2015, \"Advancements in Tiled-Based Compute Rendering\", GDC",
    needs: NEEDS_DEPTH,
    ..TILES
};

/// The only test of earlier versions, whose stages had no far plane and so no far corners.
const HS: FrustumTests =
    FrustumTests { hs: true, sat_e: false, sat_n: false, sat_p: false, sat_v: false };

const TILES: Row = Row {
    role: Role::ComparisonPaper,
    source: "Enhuber 2019, section 3.1, table 4.3",
    krate: "assign-tiled",
    parameters: &["tile_width_px", "tile_height_px"],
    default: "28x28",
    axes: &[
        Axis::Tests,
        Axis::Rectangle,
        Axis::Source,
        Axis::AreaBounds,
        Axis::Storage,
        Axis::Occlusion,
        Axis::Half,
        Axis::PlainDepth,
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
        few: &["16x16", "24x24", "32x32", "48x48", "64x64"],
        many: &["16x16", "20x20", "24x24", "28x28", "32x32", "40x40", "48x48", "64x64"],
    },
    has_groups: true,
    ..Row::PLAIN
};

fn make(gpu: &Gpu, options: &Options, depths: TileDepths) -> Result<Method, AssignError> {
    let size = options.parameters.parse()?;
    Ok(Method::lists(Tiled::new(gpu, size, depths, options.settings())?))
}
