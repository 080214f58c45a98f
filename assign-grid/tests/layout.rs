//! The cells' module, linked without a GPU: it validates, and its uniform has the same size and
//! the same offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use assign::{CullSettings, Culler, GroupShape, LightKinds, LightSource};
use assign_grid::{CellsUniform, GRID_WESL};

/// The culling kernel around the module of cells, validated.
fn kernel(source: LightSource, kinds: LightKinds) -> naga::Module {
    let what = format!("{source:?}, {kinds:?}");
    let settings = CullSettings { source, ..CullSettings::default() };
    let source = Culler::kernel_source(GroupShape::Box, settings, false, GRID_WESL, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    let module = naga::front::wgsl::parse_str(&source)
        .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(&source)));
    // What WebGPU has without any optional feature.
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(&source)));
    module
}

#[test]
fn kernels_validate() {
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            kernel(source, kinds);
        }
    }
}

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field), offset_of!($name, $field))),+]
    };
}

#[test]
fn cells() {
    let module = kernel(LightSource::Linear, LightKinds::default());
    let variable = module
        .global_variables
        .iter()
        .map(|(_, variable)| variable)
        .find(|v| v.space == naga::AddressSpace::Uniform && v.binding.is_some_and(is_first))
        .expect("the uniform of the cells");
    let naga::TypeInner::Struct { members, span } = &module.types[variable.ty].inner else {
        panic!("not a struct");
    };
    let wesl: Vec<_> =
        members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    let rust = fields!(CellsUniform: min_world, slack_m, cell_m, counts, lights_min, lights_max);
    assert_eq!(wesl, rust, "fields of WESL, then of Rust");
    assert_eq!(*span as usize, size_of::<CellsUniform>());
}

/// The first binding that is a strategy's own.
fn is_first(at: naga::ResourceBinding) -> bool {
    at.binding == assign::FIRST_STRATEGY_BINDING
}
