//! The shaders of tiles, linked without a GPU: they validate, and their uniform has the same size and offsets
//! in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Bounds, CullSettings, Culler, FIRST_STRATEGY_BINDING, GroupShape, LightKinds, LightSource,
    conformance::LinkedModule, struct_layout,
};
use assign_tiled::{EXPLICIT_WESL, IMPLICIT_WESL, TilesUniform, bounds_source};

/// The culling kernel of tiles, validated.
fn kernel(bounds: Bounds, settings: CullSettings, kinds: LightKinds) -> LinkedModule {
    let module = match bounds {
        Bounds::Implicit => IMPLICIT_WESL,
        Bounds::Explicit => EXPLICIT_WESL,
    };
    let what = format!("{bounds:?}, {settings:?}, {kinds:?}");
    let source = Culler::kernel_source(GroupShape::Frustum, settings, false, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    LinkedModule::new(&what, &source)
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

/// Checks the uniform at the strategy's first binding.
fn check_tiles(module: &LinkedModule) {
    let rust = struct_layout!(TilesUniform: counts, tile_px, origin_px, near_m, far_m,
        surfaces_only);
    assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING), rust, "WESL, then Rust");
}

#[test]
fn tiles_have_one_layout_in_wesl_and_rust() {
    for bounds in [Bounds::Implicit, Bounds::Explicit] {
        check_tiles(&kernel(bounds, CullSettings::default(), LightKinds::default()));
    }
}

#[test]
fn the_pass_bounds_validates_and_reads_the_same_layout() {
    check_tiles(&LinkedModule::new("tile bounds", &bounds_source().unwrap()));
}
