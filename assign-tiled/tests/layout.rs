//! The shaders of tiles, linked without a GPU: they validate, and their uniform has the same size and offsets
//! in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    CullSettings, Culler, FIRST_STRATEGY_BINDING, GroupShape, LightKinds, LightSource,
    conformance::LinkedModule, struct_layout,
};
use assign_tiled::{TileDepths, TilesUniform, bounds_source, tile_wesl};

const ALL: [TileDepths; 6] = [
    TileDepths::Implicit,
    TileDepths::Explicit,
    TileDepths::ExplicitAtOnce,
    TileDepths::HalfZ,
    TileDepths::ModifiedHalfZ,
    TileDepths::Sliced,
];

/// The culling kernel of tiles, validated.
fn kernel(depths: TileDepths, settings: CullSettings, kinds: LightKinds) -> LinkedModule {
    let module = tile_wesl(depths);
    let shape = match depths {
        TileDepths::Sliced => GroupShape::MaskedFrustum,
        _ => GroupShape::Frustum,
    };
    let what = format!("{depths:?}, {settings:?}, {kinds:?}");
    let source = Culler::kernel_source(shape, settings, false, module, kinds)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    LinkedModule::new(&what, &source)
}

#[test]
fn kernels_validate() {
    for depths in ALL {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            for union in ["hs+sat-n", "hs", "sat-e+sat-p+sat-v"] {
                for kinds in LightKinds::ALL {
                    let tests = union.parse().unwrap();
                    let settings = CullSettings { tests, source, ..CullSettings::default() };
                    kernel(depths, settings, kinds);
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
    for depths in ALL {
        check_tiles(&kernel(depths, CullSettings::default(), LightKinds::default()));
    }
}

#[test]
fn the_pass_bounds_validates_and_reads_the_same_layout() {
    for depths in ALL {
        if matches!(depths, TileDepths::Implicit | TileDepths::ExplicitAtOnce) {
            // They have no such pass.
            continue;
        }
        for multisampled in [false, true] {
            let source = bounds_source(depths, multisampled).unwrap();
            check_tiles(&LinkedModule::new("tile bounds", &source));
        }
    }
}
