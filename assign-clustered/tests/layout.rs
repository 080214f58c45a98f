//! The shaders of clusters, linked without a GPU: they validate, and the uniforms that they share with Rust
//! have the same size and offsets. The froxels' uniform is checked in the shaders of HG too.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Bounds, CullSettings, Culler, FIRST_STRATEGY_BINDING, Facing, GroupShape, LightKinds,
    LightSource, conformance::LinkedModule, struct_layout,
};
use assign_clustered::{
    BINS_WESL, ClusterOptions, EXPLICIT_CASCADES_WESL, EXPLICIT_WESL, FroxelsUniform,
    GLOSSY_BINS_WESL, HybridShader, IMPLICIT_CASCADES_WESL, IMPLICIT_WESL, NormalBinsUniform,
    Normals, Occupancy, POLISHED_CASCADES_WESL, POLISHED_WESL, Slices, SpecularCut, gather_source,
    marks_words,
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

/// The same with cascades.
fn cascaded_kernel(bounds: Bounds, source: LightSource, kinds: LightKinds) -> LinkedModule {
    let (shape, module) = match bounds {
        Bounds::Implicit => (GroupShape::Frustum, IMPLICIT_CASCADES_WESL),
        Bounds::Explicit => (GroupShape::Box, EXPLICIT_CASCADES_WESL),
    };
    let settings = CullSettings { source, ..CullSettings::default() };
    let linked = Culler::kernel_source(shape, settings, true, module, kinds).unwrap();
    LinkedModule::new(&format!("cascades, {bounds:?}, {source:?}, {kinds:?}"), &linked)
}

#[test]
fn kernels_validate() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            for kinds in LightKinds::ALL {
                kernel(bounds, false, source, kinds);
                kernel(bounds, true, source, kinds);
                cascaded_kernel(bounds, source, kinds);
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
                (Facing::SpecularReach, POLISHED_WESL),
                (Facing::SpecularReach, POLISHED_CASCADES_WESL),
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
        for occupancy in [Occupancy::Dense, Occupancy::Sparse, Occupancy::DepthAware] {
            gather(options(bounds, occupancy));
        }
        gather(ClusterOptions {
            slices: Slices::Cascaded(3),
            ..options(bounds, Occupancy::Sparse)
        });
    }
    for glossy in [false, true] {
        gather(split(glossy));
    }
    for slices in [Slices::Exponential, Slices::Cascaded(3)] {
        gather(ClusterOptions { slices, ..polished() });
    }
}

fn options(bounds: Bounds, occupancy: Occupancy) -> ClusterOptions {
    ClusterOptions::new("8x8x8".parse().unwrap(), bounds, occupancy, CullSettings::default())
}

/// SC-E split by six bins of normals.
fn split(glossy: bool) -> ClusterOptions {
    let cut = if glossy { SpecularCut::Below(0.001) } else { SpecularCut::None };
    ClusterOptions {
        normals: Normals::Bins(6),
        cut,
        ..options(Bounds::Explicit, Occupancy::Sparse)
    }
}

/// SC-E with a specular reach.
fn polished() -> ClusterOptions {
    ClusterOptions { reach: Some(8.0), ..options(Bounds::Explicit, Occupancy::Sparse) }
}

/// The pass `bounds`, validated with one and with several samples per pixel.
fn gather(options: ClusterOptions) -> LinkedModule {
    let linked = |multisampled| {
        LinkedModule::new(&format!("{options:?}"), &gather_source(&options, multisampled).unwrap())
    };
    linked(true);
    linked(false)
}

/// Every shader that reads the froxels: kernels and passes of clusters, and those of HG.
fn froxel_shaders() -> Vec<(String, LinkedModule)> {
    let mut shaders = Vec::new();
    for kinds in [LightKinds::ALL[0], LightKinds::ALL[3]] {
        let module = kernel(Bounds::Implicit, false, LightSource::Linear, kinds);
        shaders.push((format!("cull, {kinds:?}"), module));
    }
    for options in [options(Bounds::Explicit, Occupancy::Sparse), split(false)] {
        shaders.push((format!("bounds, {:?}", options.normals), gather(options)));
    }
    let module = gather(options(Bounds::Explicit, Occupancy::DepthAware));
    assert_eq!(module.constant("SLICES_MAX"), Occupancy::MAX_SLICES);
    assert_eq!(
        module.constant("SIDE") * 64,
        Occupancy::MAX_TILE_PX,
        "at most 64 x 64 pixels per lane"
    );
    shaders.push(("bounds, by tile".to_owned(), module));
    // `sort` reads only lists.
    let hybrid = [
        HybridShader::Occupancy { multisampled: false },
        HybridShader::Occupancy { multisampled: true },
        HybridShader::Scatter,
        HybridShader::Raster,
        HybridShader::Reserve,
    ];
    for shader in hybrid {
        let what = format!("HG, {shader:?}");
        let module = LinkedModule::new(&what, &shader.source(LightKinds::ALL[3]).unwrap());
        shaders.push((what, module));
    }
    shaders
}

#[test]
fn froxels_have_one_layout_in_all_shaders_and_in_rust() {
    let rust = struct_layout!(FroxelsUniform: counts, slices_per_unit, tile_px, origin_px, first_m,
        near_m, far_m, exponential, surfaces_only, own_slices, cascade_count, specular_reach, cascades);
    for (what, module) in froxel_shaders() {
        assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING), rust, "{what}: WESL, then Rust");
    }
}

#[test]
fn normal_bins_have_one_layout_in_wesl_and_rust() {
    let rust = struct_layout!(NormalBinsUniform: side, specular_limit);
    let module = gather(split(true));
    assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING + 2), rust, "WESL, then Rust");
}

/// Rust sizes the buffer of marks, WESL indexes it.
#[test]
fn marks_have_as_many_words_in_wesl_as_in_rust() {
    let plain = |bounds| options(bounds, Occupancy::Sparse);
    let [implicit, explicit] = [Bounds::Implicit, Bounds::Explicit].map(plain);
    for options in [implicit, explicit, split(false), split(true), polished()] {
        let wesl = gather(options).constant("WORDS");
        assert_eq!(wesl, marks_words(&options), "{options:?}: WESL, then Rust");
    }
}
