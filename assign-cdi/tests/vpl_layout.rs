//! The shaders of VPLs, linked without a GPU: they validate, and their structs have the same size and offsets in Rust
//! and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{LightEmission, LightSphere, Shader, conformance::LinkedModule, struct_layout};
use assign_cdi::{KeepUniform, RsmUniform, VplCounts, choose_shader, keep_shader};

/// A module, validated with what WebGPU has without any optional feature.
fn module(shader: &Shader<'_>, root: &str) -> LinkedModule {
    LinkedModule::new(root, &shader.link(root).unwrap())
}

/// Asserts that a WESL struct is laid out as a Rust one.
macro_rules! assert_same {
    ($module:expr, $wesl:literal, $($rust:tt)+) => {
        assert_eq!($module.layout_of($wesl), struct_layout!($($rust)+), "WESL, then Rust: {}", $wesl);
    };
}

#[test]
fn the_map_has_one_layout_in_wesl_and_rust() {
    for root in ["package::vpl_mips", "package::vpl_choose"] {
        let module = module(&choose_shader(), root);
        assert_same!(module, "Rsm", RsmUniform: intensity, range_m, direction, outer_chord_2,
            light_world, ramp_scale, size, level_count, capacity, spacing_m, index_count, levels);
    }
}

#[test]
fn kept_lights_have_one_layout_in_wesl_and_rust() {
    let module = module(&keep_shader(), "package::vpl_keep");
    assert_same!(module, "Keep", KeepUniform: range_scale, min_range_m, max_range_m, min_distance_2,
        capacity, clamps);
    assert_same!(module, "Counts", VplCounts: chosen, kept, too_small, too_large);
    assert_same!(module, "LightSphere", LightSphere: position_world, radius_m);
    assert_same!(module, "LightEmission", LightEmission: intensity, kind_and_shape);
}
