//! The shaders of clusters, linked without a GPU: they validate, and the uniforms that they share with Rust
//! have the same size and offsets. The froxels' uniform is checked in the shaders of HG too.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod linked;

use std::mem::offset_of;

use assign::{Bounds, CullSettings, Culler, Facing, GroupShape, LightKinds, LightSource};
use assign_clustered::{
    BINS_WESL, EXPLICIT_WESL, FroxelsUniform, GLOSSY_BINS_WESL, HybridShader, IMPLICIT_WESL,
    NormalBinsUniform, Normals, Occupancy, gather_source,
};
use linked::{members, validated};

/// The culling kernel of clusters, validated.
fn kernel(bounds: Bounds, sparse: bool, source: LightSource, kinds: LightKinds) -> naga::Module {
    let (shape, module) = match bounds {
        Bounds::Implicit => (GroupShape::Frustum, IMPLICIT_WESL),
        Bounds::Explicit => (GroupShape::Box, EXPLICIT_WESL),
    };
    let what = format!("{bounds:?}, sparse {sparse}, {source:?}, {kinds:?}");
    let settings = CullSettings { source, ..CullSettings::default() };
    let source = Culler::kernel_source(shape, settings, sparse, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    validated(&source, &what)
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
                validated(&source.unwrap(), &format!("{facing:?}, {settings:?}, {kinds:?}"));
            }
        }
    }
}

#[test]
fn the_pass_bounds_validates() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        for occupancy in [Occupancy::Dense, Occupancy::Sparse] {
            let what = format!("{bounds:?}, {occupancy:?}");
            validated(&gather_source(bounds, occupancy, Normals::None, false).unwrap(), &what);
        }
    }
    for glossy in [false, true] {
        let what = format!("with normals, glossy {glossy}");
        let (bounds, occupancy, normals) = (Bounds::Explicit, Occupancy::Sparse, Normals::Bins(6));
        validated(&gather_source(bounds, occupancy, normals, glossy).unwrap(), &what);
    }
}

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field).to_owned(), offset_of!($name, $field))),+]
    };
}

/// Every shader that reads the froxels: kernels and passes of clusters, and those of HG.
fn froxel_shaders() -> Vec<(String, naga::Module)> {
    let mut shaders = Vec::new();
    for kinds in [LightKinds::ALL[0], LightKinds::ALL[3]] {
        let module = kernel(Bounds::Implicit, false, LightSource::Linear, kinds);
        shaders.push((format!("cull, {kinds:?}"), module));
    }
    let (explicit, sparse) = (Bounds::Explicit, Occupancy::Sparse);
    for normals in [Normals::None, Normals::Bins(6)] {
        let what = format!("bounds, {normals:?}");
        let source = gather_source(explicit, sparse, normals, false).unwrap();
        let module = validated(&source, &what);
        shaders.push((what, module));
    }
    // `sort` reads only lists.
    for shader in [HybridShader::Occupancy, HybridShader::Scatter, HybridShader::Reserve] {
        let what = format!("HG, {shader:?}");
        let module = validated(&shader.source(LightKinds::ALL[3]).unwrap(), &what);
        shaders.push((what, module));
    }
    shaders
}

#[test]
fn froxels_have_one_layout_in_all_shaders_and_in_rust() {
    let rust = fields!(FroxelsUniform: counts, slices_per_unit, tile_px, origin_px, first_m, near_m,
        far_m, exponential, surfaces_only);
    for (what, module) in froxel_shaders() {
        let (wesl, bytes) = members(&module, "Froxels");
        assert_eq!(wesl, rust, "{what}: fields of WESL, then of Rust");
        // A vector of three makes the struct a multiple of 16 bytes.
        assert_eq!(bytes, size_of::<FroxelsUniform>(), "{what}: bytes of WESL, then of Rust");
        assert_eq!(uniform_at(&module, assign::FIRST_STRATEGY_BINDING), "Froxels", "{what}");
    }
}

#[test]
fn normal_bins_have_one_layout_in_wesl_and_rust() {
    let rust = fields!(NormalBinsUniform: side, specular_limit);
    let (bounds, occupancy, normals) = (Bounds::Explicit, Occupancy::Sparse, Normals::Bins(6));
    let module = validated(&gather_source(bounds, occupancy, normals, true).unwrap(), "bounds");
    let (wesl, bytes) = members(&module, "NormalBins");
    assert_eq!(wesl, rust, "fields of WESL, then of Rust");
    assert_eq!(bytes, size_of::<NormalBinsUniform>(), "bytes of WESL, then of Rust");
    assert_eq!(uniform_at(&module, assign::FIRST_STRATEGY_BINDING + 2), "NormalBins");
}

/// The struct of the uniform at a binding, without the module that the linker puts before its name.
fn uniform_at(module: &naga::Module, binding: u32) -> String {
    let mut variables = module.global_variables.iter().map(|(_, variable)| variable);
    let found = variables.find(|v| {
        v.space == naga::AddressSpace::Uniform && v.binding.is_some_and(|b| b.binding == binding)
    });
    let name = found.and_then(|v| module.types[v.ty].name.clone()).unwrap_or_default();
    name.rsplit('_').next().unwrap_or_default().to_owned()
}
