//! The grid's module, linked without a GPU: every kernel validates, and its uniform has the same layout in
//! Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    CullSettings, Culler, FIRST_STRATEGY_BINDING, GroupShape, LightKinds, LightSource,
    conformance::LinkedModule, struct_layout,
};
use assign_grid::{CellsUniform, GRID_WESL};

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
        lights_max);
    let kernel = kernel(LightSource::Linear, LightKinds::default());
    assert_eq!(kernel.uniform_at(FIRST_STRATEGY_BINDING), rust, "WESL, then Rust");
}
