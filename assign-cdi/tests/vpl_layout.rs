//! The VPL passes' modules, linked without a GPU: they validate, and their structs have the same sizes
//! and offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod linked;

use std::mem::offset_of;

use assign::{LightEmission, LightSphere, Shader};
use assign_cdi::{KeepUniform, RsmUniform, VplCounts, choose_shader, keep_shader};
use linked::members;

/// A module, validated with what WebGPU has without any optional feature.
fn module(shader: &Shader<'_>, root: &str) -> naga::Module {
    let source = shader.link(root).unwrap();
    linked::validated(&source, root)
}

macro_rules! same {
    ($module:expr, $wesl:literal, $rust:ty: $($field:ident),+) => {{
        let fields = vec![$((stringify!($field).to_owned(), offset_of!($rust, $field))),+];
        assert_eq!(members($module, $wesl), (fields, size_of::<$rust>()), "WESL, then Rust");
    }};
}

#[test]
fn the_map() {
    for root in ["package::vpl_mips", "package::vpl_choose"] {
        let module = module(&choose_shader(), root);
        let (mut fields, size) = members(&module, "Rsm");
        let rust = vec![
            ("intensity", offset_of!(RsmUniform, intensity)),
            ("range_m", offset_of!(RsmUniform, range_m)),
            ("direction", offset_of!(RsmUniform, direction)),
            ("outer_chord_2", offset_of!(RsmUniform, outer_chord_2)),
            ("light_world", offset_of!(RsmUniform, light_world)),
            ("ramp_scale", offset_of!(RsmUniform, ramp_scale)),
            ("size", offset_of!(RsmUniform, size)),
            ("level_count", offset_of!(RsmUniform, level_count)),
            ("capacity", offset_of!(RsmUniform, capacity)),
            ("spacing_m", offset_of!(RsmUniform, spacing_m)),
            ("index_count", offset_of!(RsmUniform, index_count)),
            ("levels", offset_of!(RsmUniform, levels)),
        ];
        let wesl: Vec<_> = fields.iter_mut().map(|(name, at)| (name.as_str(), *at)).collect();
        assert_eq!(wesl, rust, "{root}: WESL, then Rust");
        assert_eq!(size, size_of::<RsmUniform>());
    }
}

#[test]
fn what_is_kept() {
    let module = module(&keep_shader(), "package::vpl_keep");
    same!(&module, "Keep", KeepUniform:
        range_scale, min_range_m, max_range_m, min_distance_2, capacity, clamps);
    same!(&module, "Counts", VplCounts: chosen, kept, too_small, too_large);
    same!(&module, "LightSphere", LightSphere: position_world, radius_m);
    same!(&module, "LightEmission", LightEmission: intensity, kind_and_shape);
}
