//! The shaders of tiles, linked without a GPU: they validate, and their uniform has the same size and offsets
//! in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use assign::{Bounds, CullSettings, Culler, GroupShape, LightKinds, LightSource};
use assign_tiled::{EXPLICIT_WESL, IMPLICIT_WESL, TilesUniform, bounds_source};

fn validated(what: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    // What WebGPU has without any optional feature.
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    module
}

/// The culling kernel of tiles, validated.
fn kernel(bounds: Bounds, settings: CullSettings, kinds: LightKinds) -> naga::Module {
    let module = match bounds {
        Bounds::Implicit => IMPLICIT_WESL,
        Bounds::Explicit => EXPLICIT_WESL,
    };
    let what = format!("{bounds:?}, {settings:?}, {kinds:?}");
    let source = Culler::kernel_source(GroupShape::Frustum, settings, false, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    validated(&what, &source)
}

#[test]
fn kernels_validate() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            for union in ["hs+sat-n", "hs", "sat-e+sat-p+sat-v"] {
                for kinds in LightKinds::ALL {
                    let tests = union.parse().unwrap();
                    let settings = CullSettings { tests, source, ..CullSettings::default() };
                    kernel(bounds, settings, kinds);
                }
            }
        }
    }
}

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field), offset_of!($name, $field))),+]
    };
}

/// Checks the uniform at the first binding that is a strategy's own.
fn check_tiles(module: &naga::Module) {
    let variable = module
        .global_variables
        .iter()
        .map(|(_, variable)| variable)
        .find(|v| v.space == naga::AddressSpace::Uniform && v.binding.is_some_and(is_first))
        .expect("the uniform of the tiles");
    let naga::TypeInner::Struct { members, span } = &module.types[variable.ty].inner else {
        panic!("not a struct");
    };
    let wesl: Vec<_> =
        members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    let rust = fields!(TilesUniform: counts, tile_px, origin_px, near_m, far_m, surfaces_only);
    assert_eq!(wesl, rust, "fields of WESL, then of Rust");
    assert_eq!(*span as usize, size_of::<TilesUniform>());
}

fn is_first(at: naga::ResourceBinding) -> bool {
    at.binding == assign::FIRST_STRATEGY_BINDING
}

#[test]
fn tiles_have_one_layout_in_wesl_and_rust() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        check_tiles(&kernel(bounds, CullSettings::default(), LightKinds::default()));
    }
}

#[test]
fn the_pass_bounds_validates_and_reads_the_same_layout() {
    check_tiles(&validated("tile bounds", &bounds_source().unwrap()));
}
