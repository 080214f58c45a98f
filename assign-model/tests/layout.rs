//! The models' module, linked without a GPU: every kernel validates, and its record has the same layout in
//! Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    CullSettings, Culler, GroupShape, LightKinds, LightSource, conformance::LinkedModule,
    struct_layout,
};
use assign_model::{MODELS_WESL, ModelRecord};

#[test]
fn kernels_validate_and_model_records_match() {
    let rust = struct_layout!(ModelRecord: center_world, first_group, axis_x, parts_x, axis_y,
        parts_y, axis_z, parts_z, half_extents_m, slack_m);
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            let settings = CullSettings { source, ..CullSettings::default() };
            let shape = GroupShape::OrientedBox;
            let source = Culler::kernel_source(shape, settings, false, MODELS_WESL, kinds).unwrap();
            let kernel = LinkedModule::new(&format!("{settings:?}, {kinds:?}"), &source);
            assert_eq!(kernel.layout_of("Model"), rust, "WESL, then Rust");
        }
    }
}
