//! The shaders of clusters, linked without a GPU: they validate, and the uniforms that they share with Rust
//! have the same size and offsets. The froxels' uniform is checked in the shaders of HG too.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Bounds, CullSettings, Culler, FIRST_STRATEGY_BINDING, Facing, GroupShape, LightKinds,
    LightSource, conformance::LinkedModule, struct_layout,
};
use assign_clustered::{
    BINS_WESL, EXPLICIT_WESL, FroxelsUniform, GLOSSY_BINS_WESL, HybridShader, IMPLICIT_WESL,
    NormalBinsUniform, Normals, Occupancy, gather_source, marks_words,
};

/// The culling kernel of clusters, validated.
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
fn kernels_with_normals_or_cuts_validate() {
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
fn the_pass_bounds_validates() {
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

/// Every shader that reads the froxels: kernels and passes of clusters, and those of HG.
fn froxel_shaders() -> Vec<(String, LinkedModule)> {
    let mut shaders = Vec::new();
    for kinds in [LightKinds::ALL[0], LightKinds::ALL[3]] {
        let module = kernel(Bounds::Implicit, false, LightSource::Linear, kinds);
        shaders.push((format!("cull, {kinds:?}"), module));
    }
    let (explicit, sparse) = (Bounds::Explicit, Occupancy::Sparse);
    for normals in [Normals::None, Normals::Bins(6)] {
        let what = format!("bounds, {normals:?}");
        let source = gather_source(explicit, sparse, normals, false).unwrap();
        let module = LinkedModule::new(&what, &source);
        shaders.push((what, module));
    }
    // `sort` reads only lists.
    for shader in [HybridShader::Occupancy, HybridShader::Scatter, HybridShader::Reserve] {
        let what = format!("HG, {shader:?}");
        let module = LinkedModule::new(&what, &shader.source(LightKinds::ALL[3]).unwrap());
        shaders.push((what, module));
    }
    shaders
}

#[test]
fn froxels_have_one_layout_in_all_shaders_and_in_rust() {
    let rust = struct_layout!(FroxelsUniform: counts, slices_per_unit, tile_px, origin_px, first_m,
        near_m, far_m, exponential, surfaces_only, own_slices);
    for (what, module) in froxel_shaders() {
        assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING), rust, "{what}: WESL, then Rust");
    }
}

#[test]
fn normal_bins_have_one_layout_in_wesl_and_rust() {
    let rust = struct_layout!(NormalBinsUniform: side, specular_limit);
    let (bounds, occupancy, normals) = (Bounds::Explicit, Occupancy::Sparse, Normals::Bins(6));
    let source = gather_source(bounds, occupancy, normals, true).unwrap();
    let module = LinkedModule::new("bounds", &source);
    assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING + 2), rust, "WESL, then Rust");
}

/// Rust sizes the buffer of marks, WESL indexes it.
#[test]
fn marks_have_as_many_words_in_wesl_as_in_rust() {
    for (bounds, normals, glossy) in [
        (Bounds::Implicit, Normals::None, false),
        (Bounds::Explicit, Normals::None, false),
        (Bounds::Explicit, Normals::Bins(6), false),
        (Bounds::Explicit, Normals::Bins(6), true),
    ] {
        let what = format!("{bounds:?}, {normals:?}, glossy {glossy}");
        let source = gather_source(bounds, Occupancy::Sparse, normals, glossy).unwrap();
        let wesl = LinkedModule::new(&what, &source).constant("WORDS");
        assert_eq!(wesl, marks_words(bounds, normals, glossy), "{what}: WESL, then Rust");
    }
}
