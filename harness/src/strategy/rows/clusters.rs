//! Tiles of the screen cut into depth slices (`assign-clustered`).

use assign::{
    AssignError,
    Bounds::{self, Explicit, Implicit},
    Gpu,
};
use assign_clustered::{
    ClusterOptions, Clustered,
    Occupancy::{self, Dense, DepthAware, Sparse},
    ZBins,
};

use super::super::{Axis, Colour, Method, Options, Role, Row, Sizes, row::NEEDS_DEPTH};

pub(super) const ROWS: &[Row] = &[
    Row {
        family: "DC-I",
        name: "dense clusters, implicit bounds",
        about: "every depth slice of every tile has a list of the lights that reach it",
        source: "Enhuber 2019, section 3.2.2, table 4.3",
        default: "128x128x64",
        in_default: Some("DC-I"),
        axes: FRUSTA,
        sizes: Sizes { many: AROUND_128, ..CLUSTERS.sizes },
        colour: Colour { light: "#8a8420", dark: "#c7c05a" },
        make: |gpu, options| make(gpu, options, Implicit, Dense),
        ..CLUSTERS
    },
    Row {
        family: "DC-E",
        name: "dense clusters, explicit bounds",
        about: "every cluster has a list of the lights that reach the box around its samples",
        source: "Enhuber 2019, section 3.2.2, table 4.3",
        default: "64x64x40",
        axes: BOXES,
        sizes: Sizes { many: AROUND_64, ..CLUSTERS.sizes },
        needs: NEEDS_DEPTH,
        colour: Colour { light: "#882255", dark: "#e07aa6" },
        make: |gpu, options| make(gpu, options, Explicit, Dense),
        ..CLUSTERS
    },
    Row {
        family: "SC-I",
        name: "sparse clusters, implicit bounds",
        about: "every cluster that holds samples has a list of the lights that reach the cluster",
        axes: FRUSTA,
        needs: NEEDS_DEPTH,
        colour: Colour { light: "#332288", dark: "#9a8bf0" },
        make: |gpu, options| make(gpu, options, Implicit, Sparse),
        ..CLUSTERS
    },
    Row {
        family: "SC-E",
        name: "sparse clusters, explicit bounds",
        about: "every cluster that holds samples has a list of the lights that reach the box around them",
        in_default: Some("SC-E/bvh"),
        axes: &[
            Axis::Slices,
            Axis::Normals,
            Axis::Specular,
            Axis::Reach,
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
        needs: NEEDS_DEPTH,
        colour: Colour { light: "#117733", dark: "#63bd80" },
        make: |gpu, options| make(gpu, options, Explicit, Sparse),
        ..CLUSTERS
    },
    Row {
        family: "DA-I",
        name: "depth-aware clusters, implicit bounds",
        about: "makes the same lists as SC-I, but one workgroup per tile finds the slices that hold samples",
        axes: FRUSTA,
        colour: Colour { light: "#aa77cc", dark: "#8855aa" },
        make: |gpu, options| make(gpu, options, Implicit, DepthAware),
        ..DEPTH_AWARE
    },
    Row {
        family: "DA-E",
        name: "depth-aware clusters, explicit bounds",
        about: "makes the same lists as SC-E, but one workgroup per tile finds the slices that hold samples, and \
                the box around the samples of each",
        axes: BOXES,
        colour: Colour { light: "#5500dd", dark: "#33ffcc" },
        make: |gpu, options| make(gpu, options, Explicit, DepthAware),
        ..DEPTH_AWARE
    },
    Z_BINS,
];

const Z_BINS: Row = Row {
    family: "ZB",
    name: "z-bins",
    about: "a bit mask per tile and one per depth slice of the whole view; a sample evaluates the lights that are in both",
    role: Role::Engine,
    source: "Drobot 2017, \"Improved Culling for Tiled and Clustered Rendering\", SIGGRAPH Advances in Real-Time \
             Rendering",
    default: "32x32x64",
    sizes: Sizes {
        few: &["16x16x64", "24x24x64", "48x48x64", "64x64x64"],
        many: &[
            "16x16x64",
            "24x24x64",
            "32x32x32",
            "32x32x64",
            "32x32x128",
            "48x48x64",
            "64x64x64",
        ],
    },
    axes: &[
        Axis::Slices,
        Axis::Tests,
        Axis::Rectangle,
        Axis::Source,
        Axis::AreaBounds,
        Axis::Half,
        Axis::Fewer,
        Axis::Stochastic,
        Axis::Keep,
        Axis::Touched,
        Axis::Exit,
    ],
    colour: Colour { light: "#0057b8", dark: "#8d99ae" },
    make: |gpu, options| {
        let z_bins = ZBins::new(gpu, options.parameters.parse()?, options.settings())?;
        Ok(Method::lists(z_bins.with_slices(options.slices)?))
    },
    ..CLUSTERS
};

const DEPTH_AWARE: Row = Row {
    role: Role::OtherPaper,
    source: "Olsson, Billeter and Assarsson 2012, \"Clustered Deferred and Forward Shading\", High Performance \
             Graphics: unique clusters per tile",
    needs: NEEDS_DEPTH,
    ..CLUSTERS
};

const CLUSTERS: Row = Row {
    role: Role::ComparisonPaper,
    source: "Enhuber 2019, section 3.2.3, table 4.3",
    krate: "assign-clustered",
    parameters: &["tile_width_px", "tile_height_px", "slices"],
    default: "48x48x40",
    sizes: Sizes { few: FEW, many: AROUND_48 },
    has_groups: true,
    ..Row::PLAIN
};

const FRUSTA: &[Axis] = &[
    Axis::Slices,
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
    Axis::Touched,
    Axis::Exit,
];
const BOXES: &[Axis] = &[
    Axis::Slices,
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
];

/// Sizes that `advise` tries for all clusters.
pub(super) const FEW: &[&str] =
    &["32x32x40", "32x32x64", "40x40x64", "48x48x64", "64x64x64", "96x96x64", "128x128x32"];

// Nine sizes around each of the paper, wide enough that the best found so far lie inside.
const AROUND_128: &[&str] = &[
    "96x96x24",
    "96x96x40",
    "96x96x64",
    "128x128x24",
    "128x128x40",
    "128x128x64",
    "192x192x24",
    "192x192x40",
    "192x192x64",
];
const AROUND_64: &[&str] = &[
    "48x48x24", "48x48x40", "48x48x64", "64x64x24", "64x64x40", "64x64x64", "96x96x24", "96x96x40",
    "96x96x64",
];
const AROUND_48: &[&str] = &[
    "32x32x40", "32x32x64", "32x32x96", "48x48x40", "48x48x64", "48x48x96", "64x64x40", "64x64x64",
    "64x64x96",
];

fn make(
    gpu: &Gpu,
    options: &Options,
    bounds: Bounds,
    occupancy: Occupancy,
) -> Result<Method, AssignError> {
    let size = options.parameters.parse()?;
    let Options { slices, normals, specular: cut, reach, .. } = *options;
    let settings = options.settings();
    let clusters =
        ClusterOptions { size, bounds, occupancy, slices, normals, cut, reach, settings };
    Ok(Method::lists(Clustered::with_options(gpu, clusters)?))
}
