//! The clusters' modules, linked without a GPU: they validate, and their uniform has the same size and the
//! same offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Bounds, CullSettings, Culler, FIRST_STRATEGY_BINDING, Facing, GroupShape, LightKinds,
    LightSource, conformance::LinkedModule, struct_layout,
};
use assign_clustered::{
    BINS_WESL, ClustersUniform, EXPLICIT_WESL, GLOSSY_BINS_WESL, IMPLICIT_WESL, Normals, Occupancy,
    gather_source,
};

/// The culling kernel around a module of clusters, validated.
fn kernel(bounds: Bounds, sparse: bool, source: LightSource, kinds: LightKinds) -> LinkedModule {
    let (shape, module) = match bounds {
        Bounds::Implicit => (GroupShape::Frustum, IMPLICIT_WESL),
        Bounds::Explicit => (GroupShape::Box, EXPLICIT_WESL),
    };
    let what = format!("{bounds:?}, sparse {sparse}, {source:?}, {kinds:?}");
    let settings = CullSettings { source, ..CullSettings::default() };
    let source = Culler::kernel_source(shape, settings, sparse, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    LinkedModule::new(&what, &source)
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
                LinkedModule::new(
                    &format!("{facing:?}, {settings:?}, {kinds:?}"),
                    &source.unwrap(),
                );
            }
        }
    }
}

#[test]
fn gathering_validates() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for occupancy in [Occupancy::Dense, Occupancy::Sparse] {
            let what = format!("{bounds:?}, {occupancy:?}");
            LinkedModule::new(
                &what,
                &gather_source(bounds, occupancy, Normals::None, false).unwrap(),
            );
        }
    }
    for glossy in [false, true] {
        let what = format!("with normals, glossy {glossy}");
        let (bounds, occupancy, normals) = (Bounds::Explicit, Occupancy::Sparse, Normals::Bins(6));
        LinkedModule::new(&what, &gather_source(bounds, occupancy, normals, glossy).unwrap());
    }
}

#[test]
fn clusters_uniform() {
    let rust = struct_layout!(ClustersUniform: counts, slices_per_unit, tile_px, origin_px, first_m,
        near_m, far_m, exponential, surfaces_only, bin_side, specular_limit);
    let kernel = kernel(Bounds::Implicit, false, LightSource::Linear, LightKinds::default());
    assert_eq!(kernel.uniform_at(FIRST_STRATEGY_BINDING), rust, "WESL, then Rust");
}
