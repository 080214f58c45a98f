//! The look-up, linked without a GPU: every variant validates, and its uniform has the same layout in Rust and
//! in WESL.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    CullUniform, FIRST_STRATEGY_BINDING, LightKinds, LightSource, Shader, Team,
    conformance::LinkedModule, struct_layout,
};
use assign_walk::walk_wesl;

/// A shader that counts the lights of a sample.
const READER: &str = "
import package::look_up::{next_light, open_lights};
import package::sample::sample_at;
@group(2) @binding(0) var<storage, read_write> sums: array<u32>;
@compute @workgroup_size(64) fn count(@builtin(global_invocation_id) id: vec3u) {
  var cursor = open_lights(sample_at(vec2f(id.xy), 0.5, vec3f(0.0), 0u));
  while next_light(&cursor) {
    sums[id.x] += cursor.entry;
  }
}";

fn linked(team: Team, source: LightSource, kinds: LightKinds) -> LinkedModule {
    let shader = Shader::new(1)
        .module("package::reader", READER)
        .strategy(walk_wesl(team, source))
        .light_kinds(kinds);
    let what = format!("{team:?}, {source:?}, {kinds:?}");
    let source = shader.link("package::reader").unwrap();
    match team {
        Team::Subgroup => LinkedModule::with_subgroups(&what, &source),
        Team::Lane => LinkedModule::new(&what, &source),
    }
}

#[test]
fn look_ups_validate() {
    for kinds in LightKinds::ALL {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            linked(Team::Subgroup, source, kinds);
        }
        linked(Team::Lane, LightSource::Hierarchy, kinds);
    }
}

#[test]
fn lights_uniform() {
    let rust = struct_layout!(CullUniform: light_count, group_count, pool_first, pool_capacity,
        guard_cursor, list_cap, first_parent, first_grandparent, mask_stride, mask_summary);
    let module = linked(Team::Lane, LightSource::Hierarchy, LightKinds::default());
    assert_eq!(module.uniform_at(FIRST_STRATEGY_BINDING), rust, "WESL, then Rust");
}
