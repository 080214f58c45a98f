//! The grid of hybrid lighting, Archer 2019 (`assign-clustered`).

use assign_clustered::HybridGrid;

use super::super::{Axis, Colour, Method, Role, Row, Sizes, row::NEEDS_DEPTH};
use super::clusters::FEW;

pub(super) const ROWS: &[Row] = &[Row {
    family: "HG",
    name: "hybrid grid of Archer 2019",
    about: "each light adds itself to the lists of the sparse clusters that it reaches. With /raster, the \
            rasteriser finds the tiles that each light covers (Örtegren and Persson 2016)",
    role: Role::OtherPaper,
    source: "Archer 2019, section 3.2",
    krate: "assign-clustered",
    parameters: &["tile_width_px", "tile_height_px", "slices"],
    default: "48x48x40",
    axes: &[Axis::Scatter, Axis::Order, Axis::Cap, Axis::Reuse, Axis::Keep, Axis::Exit],
    sizes: Sizes { few: FEW, many: &["32x32x40", "48x48x40", "64x64x40"] },
    has_groups: true,
    needs: NEEDS_DEPTH,
    colour: Colour { light: "#6e4a26", dark: "#c79b6b" },
    make: |gpu, options| {
        let size = options.parameters.parse()?;
        Ok(Method::lists(HybridGrid::with_scatter(gpu, size, options.scatter)?))
    },
    ..Row::PLAIN
}];
