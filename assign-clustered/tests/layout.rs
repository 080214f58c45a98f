//! DC-I's module, linked without a GPU: it validates, and its uniform has the same size and the
//! same offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use assign::{Culler, FrustumTests, GroupShape};
use assign_clustered::{ClustersUniform, DENSE_IMPLICIT_WESL};

/// The culling kernel around DC-I's module, validated.
fn kernel(sat_n: bool, spots: bool) -> naga::Module {
    let what = format!("sat_n {sat_n}, spots {spots}");
    let shape = GroupShape::Frustum(FrustumTests { sat_n });
    let source = Culler::kernel_source(shape, DENSE_IMPLICIT_WESL, spots)
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
fn kernel_validates() {
    for sat_n in [false, true] {
        for spots in [false, true] {
            kernel(sat_n, spots);
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
fn clusters() {
    let module = kernel(true, false);
    let variable = module
        .global_variables
        .iter()
        .map(|(_, variable)| variable)
        .find(|v| v.space == naga::AddressSpace::Uniform && v.binding.is_some_and(is_first))
        .expect("the uniform of the clusters");
    let naga::TypeInner::Struct { members, span } = &module.types[variable.ty].inner else {
        panic!("not a struct");
    };
    let wesl: Vec<_> =
        members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    let rust = fields!(ClustersUniform: counts, slices_per_unit, tile_px, origin_px, first_m,
        near_m, far_m, exponential);
    assert_eq!(wesl, rust, "fields of WESL, then of Rust");
    assert_eq!(*span as usize, size_of::<ClustersUniform>());
}

/// The first binding that is a strategy's own.
fn is_first(at: naga::ResourceBinding) -> bool {
    at.binding == assign::FIRST_STRATEGY_BINDING
}
