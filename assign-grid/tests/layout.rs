//! The modules of G and HC, linked without a GPU: every kernel validates, and what Rust and WESL share has the
//! same layout in both.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    CullSettings, Culler, FIRST_STRATEGY_BINDING, GroupShape, LightKinds, LightSource,
    conformance::LinkedModule, struct_layout,
};
use assign_grid::{
    AskedCells, CellsUniform, GRID_WESL, HASHED_WESL, HashCellsUniform, TableUse, fill_source,
    visible_source,
};

/// The culling kernel over the grid's cells.
fn kernel(source: LightSource, kinds: LightKinds) -> LinkedModule {
    let settings = CullSettings { source, ..CullSettings::default() };
    let source = Culler::kernel_source(GroupShape::Box, settings, false, GRID_WESL, kinds).unwrap();
    LinkedModule::new(&format!("{settings:?}, {kinds:?}"), &source)
}

#[test]
fn kernels_validate() {
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            kernel(source, kinds);
        }
    }
}

#[test]
fn cells_uniform() {
    let rust = struct_layout!(CellsUniform: min_world, slack_m, cell_m, counts, lights_min,
        lights_max, reach_min, reach_max);
    let kernel = kernel(LightSource::Linear, LightKinds::default());
    assert_eq!(kernel.uniform_at(FIRST_STRATEGY_BINDING), rust, "WESL, then Rust");
    // The GPU makes them too, in a storage buffer.
    let bounds = LinkedModule::new("bounds", &visible_source(false).unwrap());
    assert_eq!(bounds.layout_of("Cells"), rust, "WESL, then Rust");
}

#[test]
fn asked_cells() {
    let rust = struct_layout!(AskedCells: lights_min, lights_max, counts);
    let bounds = LinkedModule::new("bounds", &visible_source(false).unwrap());
    assert_eq!(bounds.uniform_at(2), rust, "WESL, then Rust");
    LinkedModule::new("bounds of several samples", &visible_source(true).unwrap());
}

#[test]
fn hash_cells_and_their_table() {
    let rust = struct_layout!(HashCellsUniform: eye_world, edge_m, edge_per_m, base_exponent,
        slot_count);
    let fill = LinkedModule::new("fill", &fill_source(false).unwrap());
    assert_eq!(fill.uniform_at(2), rust, "WESL, then Rust");
    LinkedModule::new("fill of several samples", &fill_source(true).unwrap());
    let table_use = struct_layout!(TableUse: slots, filled, lost);
    assert_eq!(fill.layout_of("TableUse"), table_use, "WESL, then Rust");
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            let settings = CullSettings { source, ..CullSettings::default() };
            let cull =
                Culler::kernel_source(GroupShape::Box, settings, true, HASHED_WESL, kinds).unwrap();
            let cull = LinkedModule::new(&format!("{settings:?}, {kinds:?}"), &cull);
            assert_eq!(cull.layout_of("HashCells"), rust, "WESL, then Rust");
            // One kernel fills the table and the other one reads it.
            assert_eq!(cull.layout_of("CellTable"), fill.layout_of("FilledTable"));
        }
    }
}
