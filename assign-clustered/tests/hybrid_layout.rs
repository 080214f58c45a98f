//! The shaders of HG, linked without a GPU: they validate, and structs that they share with Rust or with
//! each other have the same size and offsets.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    FIRST_STRATEGY_BINDING, LightKinds, LiveGroups,
    conformance::{LinkedModule, StructLayout},
    struct_layout,
};
use assign_clustered::{HybridParts, HybridShader};

fn validated(shader: HybridShader, kinds: LightKinds) -> LinkedModule {
    let source = shader.source(kinds).unwrap_or_else(|e| panic!("{shader:?}, {kinds:?}: {e}"));
    LinkedModule::new(&format!("{shader:?}, {kinds:?}"), &source)
}

#[test]
fn all_permutations_validate() {
    for shader in HybridShader::ALL {
        for kinds in LightKinds::ALL {
            validated(shader, kinds);
        }
    }
}

/// A pool has at most 2^30 entries. Each lane of 65,535 workgroups may add one list of up to `CAREFUL` to a
/// full pool before it sees that the pool is full.
#[test]
fn reservations_at_once_cannot_wrap_the_cursor() {
    let module = validated(HybridShader::Reserve, LightKinds::default());
    let careful = module.constant("CAREFUL");
    let entry_point =
        module.module().entry_points.iter().find(|e| e.name == "reserve_lists").unwrap();
    let lanes: u32 = entry_point.workgroup_size.iter().product();
    let most = 65_535 * u64::from(lanes) * u64::from(careful) + (1 << 30);
    assert!(careful > 0 && most < 1 << 32, "{lanes} lanes of {careful}: {most}");
}

/// `reserve` writes the live cells by the struct of `package::live`, `sort` reads them by one of its own.
#[test]
fn live_cells_have_one_layout() {
    assert!(LiveGroups::WESL.contains("struct LiveGroups"));
    let kinds = LightKinds::default();
    let layout = |shader| validated(shader, kinds).layout_of("LiveGroups");
    let (written, read) = (layout(HybridShader::Reserve), layout(HybridShader::Sort));
    let offsets = |layout: StructLayout| {
        let known = ["dispatch", "dispatch_x", "count", "ids"];
        let known = layout.fields.into_iter().filter(|(name, _)| known.contains(&name.as_str()));
        known.map(|(_, offset)| offset).collect::<Vec<_>>()
    };
    assert_eq!(offsets(written), [0, 12, 16]);
    assert_eq!(offsets(read), [0, 12, 16]);
}

/// `occupancy` and `scatter` read the words of a mask and the tiles of a part from one uniform.
#[test]
fn parts_have_one_layout_in_wesl_and_rust() {
    let rust = struct_layout!(HybridParts: mask_words, tiles_per_part);
    for shader in [
        HybridShader::Occupancy { multisampled: false },
        HybridShader::Scatter,
        HybridShader::Raster,
    ] {
        let module = validated(shader, LightKinds::default());
        let wesl = module.uniform_at(FIRST_STRATEGY_BINDING + 4);
        assert_eq!(wesl, rust, "{shader:?}: WESL, then Rust");
    }
}
