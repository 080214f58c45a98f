//! The shaders of the hybrid-lighting grid, linked without a GPU: they validate, and what they share
//! with Rust has the same size and the same offsets there.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod linked;

use std::mem::offset_of;

use assign::{LightKinds, LiveGroups};
use assign_cdi::{CellsUniform, HybridShader};
use linked::members;

fn validated(shader: HybridShader, kinds: LightKinds) -> naga::Module {
    let source = shader.source(kinds).unwrap_or_else(|e| panic!("{shader:?}, {kinds:?}: {e}"));
    linked::validated(&source, &format!("{shader:?}, {kinds:?}"))
}

#[test]
fn all_permutations_validate() {
    for shader in HybridShader::ALL {
        for kinds in LightKinds::ALL {
            validated(shader, kinds);
        }
    }
}

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field).to_owned(), offset_of!($name, $field))),+]
    };
}

#[test]
fn cells() {
    let rust = fields!(CellsUniform: counts, slices_per_unit, tile_px, origin_px, first_m, near_m,
        exponential, surfaces_only, mask_words, tiles_per_part);
    for shader in HybridShader::ALL {
        // `sort` knows lists alone.
        if shader == HybridShader::Sort {
            continue;
        }
        let (wesl, bytes) = members(&validated(shader, LightKinds::ALL[3]), "Cells");
        assert_eq!(wesl, rust, "{shader:?}: fields of WESL, then of Rust");
        // A vector of three makes the struct a multiple of 16 bytes.
        assert_eq!(bytes, size_of::<CellsUniform>(), "{shader:?}");
    }
}

/// Of a pool of 2^30 entries and 65,535 workgroups, each lane of which adds one list up to `CAREFUL`.
#[test]
fn reservations_at_once_cannot_wrap_the_cursor() {
    let module = validated(HybridShader::Reserve, LightKinds::default());
    let is_it = |name: &Option<String>| name.as_deref().is_some_and(|n| n.ends_with("CAREFUL"));
    let (_, careful) = module.constants.iter().find(|(_, c)| is_it(&c.name)).unwrap();
    let init = &module.global_expressions[careful.init];
    let naga::Expression::Literal(naga::Literal::U32(careful)) = *init else {
        panic!("{init:?}: not a number");
    };
    let entry_point = module.entry_points.iter().find(|e| e.name == "reserve_lists").unwrap();
    let lanes: u32 = entry_point.workgroup_size.iter().product();
    let most = 65_535 * u64::from(lanes) * u64::from(careful) + (1 << 30);
    assert!(careful > 0 && most < 1 << 32, "{lanes} lanes of {careful}: {most}");
}

/// The live cells as `reserve` writes them, and as `sort` reads them.
#[test]
fn live_cells() {
    assert!(LiveGroups::WESL.contains("struct LiveGroups"));
    let kinds = LightKinds::default();
    let (written, _) = members(&validated(HybridShader::Reserve, kinds), "LiveGroups");
    let (read, _) = members(&validated(HybridShader::Sort, kinds), "LiveGroups");
    let offsets = |fields: Vec<(String, usize)>| {
        let known = ["dispatch", "dispatch_x", "count", "ids"];
        let known = fields.into_iter().filter(|(name, _)| known.contains(&name.as_str()));
        known.map(|(_, offset)| offset).collect::<Vec<_>>()
    };
    assert_eq!(offsets(written), [0, 12, 16]);
    assert_eq!(offsets(read), [0, 12, 16]);
}
