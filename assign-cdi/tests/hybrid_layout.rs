//! The shaders of the hybrid-lighting grid, linked without a GPU: they validate, and what they share
//! with Rust has the same size and the same offsets there.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    LightKinds, LiveGroups,
    conformance::{LinkedModule, StructLayout},
    struct_layout,
};
use assign_cdi::{CellsUniform, HybridShader};

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

#[test]
fn cells() {
    let rust = struct_layout!(CellsUniform: counts, slices_per_unit, tile_px, origin_px, first_m, near_m,
        exponential, surfaces_only, mask_words, tiles_per_part);
    for shader in HybridShader::ALL {
        // `sort` knows lists alone.
        if shader == HybridShader::Sort {
            continue;
        }
        let wesl = validated(shader, LightKinds::ALL[3]).layout_of("Cells");
        assert_eq!(wesl, rust, "{shader:?}: WESL, then Rust");
    }
}

/// Of a pool of 2^30 entries and 65,535 workgroups, each lane of which adds one list up to `CAREFUL`.
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

/// The live cells as `reserve` writes them, and as `sort` reads them.
#[test]
fn live_cells() {
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
