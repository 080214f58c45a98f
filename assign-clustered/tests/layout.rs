//! The clusters' modules, linked without a GPU: they validate, and their uniform has the same size and the
//! same offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use assign::{Bounds, CullSettings, Culler, Facing, GroupShape, LightKinds, LightSource};
use assign_clustered::{
    BINS_WESL, ClustersUniform, EXPLICIT_WESL, GLOSSY_BINS_WESL, IMPLICIT_WESL, Normals, Occupancy,
    gather_source,
};

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

/// The culling kernel around a module of clusters, validated.
fn kernel(bounds: Bounds, sparse: bool, source: LightSource, kinds: LightKinds) -> naga::Module {
    let (shape, module) = match bounds {
        Bounds::Implicit => (GroupShape::Frustum, IMPLICIT_WESL),
        Bounds::Explicit => (GroupShape::Box, EXPLICIT_WESL),
    };
    let what = format!("{bounds:?}, sparse {sparse}, {source:?}, {kinds:?}");
    let settings = CullSettings { source, ..CullSettings::default() };
    let source = Culler::kernel_source(shape, settings, sparse, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    validated(&what, &source)
}

#[test]
fn kernels_validate() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            for kinds in LightKinds::ALL {
                kernel(bounds, false, source, kinds);
                kernel(bounds, true, source, kinds);
            }
        }
    }
}

#[test]
fn kernels_that_know_normals_validate() {
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            let settings = CullSettings { source, ..CullSettings::default() };
            for (facing, module) in [
                (Facing::Horizon, BINS_WESL),
                (Facing::HorizonAndGloss, GLOSSY_BINS_WESL),
                (Facing::ReflectedCone, BINS_WESL),
                (Facing::WhereDiffuse, EXPLICIT_WESL),
            ] {
                let source = Culler::facing_kernel_source(settings, facing, module, kinds);
                validated(&format!("{facing:?}, {settings:?}, {kinds:?}"), &source.unwrap());
            }
        }
    }
}

#[test]
fn gathering_validates() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for occupancy in [Occupancy::Dense, Occupancy::Sparse] {
            let what = format!("{bounds:?}, {occupancy:?}");
            validated(&what, &gather_source(bounds, occupancy, Normals::None, false).unwrap());
        }
    }
    for glossy in [false, true] {
        let what = format!("with normals, glossy {glossy}");
        let (bounds, occupancy, normals) = (Bounds::Explicit, Occupancy::Sparse, Normals::Bins(6));
        validated(&what, &gather_source(bounds, occupancy, normals, glossy).unwrap());
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
    let module = kernel(Bounds::Implicit, false, LightSource::Linear, LightKinds::default());
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
        near_m, far_m, exponential, surfaces_only, bin_side,
        specular_limit);
    assert_eq!(wesl, rust, "fields of WESL, then of Rust");
    assert_eq!(*span as usize, size_of::<ClustersUniform>());
}

/// The first binding that is a strategy's own.
fn is_first(at: naga::ResourceBinding) -> bool {
    at.binding == assign::FIRST_STRATEGY_BINDING
}
