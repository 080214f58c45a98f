//! Structs that Rust and WESL share have the same layout on both sides, by reflection of the linked kernel.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    CullSettings, CullUniform, Culler, GroupShape, LightEmission, LightKinds, LightList, LightNode,
    LightSource, LightSphere, Shader, ViewUniform,
    conformance::{LinkedModule, StructLayout},
    struct_layout,
};

const STRATEGY: &str = "
import package::bounds::GroupBounds;
import package::sample::ViewSample;
fn group_of(sample: ViewSample) -> u32 {
  return 0u;
}
fn group_bounds(group: u32) -> GroupBounds {
  return GroupBounds(vec3f(0.0), vec3f(1.0));
}
";

fn kernel() -> LinkedModule {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    let kinds = LightKinds::EVERY;
    let source = Culler::kernel_source(GroupShape::Box, settings, false, STRATEGY, kinds).unwrap();
    LinkedModule::new("the culling kernel", &source)
}

/// Checks the element of an array: its layout, and that elements lie side by side.
fn check_element(name: &str, rust: &StructLayout) {
    let kernel = kernel();
    assert_eq!(&kernel.layout_of(name), rust, "{name}: WESL, then Rust");
    assert_eq!(kernel.strides_of(name), [rust.bytes], "{name}: array stride");
}

#[test]
fn view_uniform() {
    let rust = struct_layout!(ViewUniform: world_to_view, view_to_world, view_to_clip, ray_scale,
        ray_offset, viewport_origin, viewport_size, near_m, far_m, perspective, position_error,
        depth_clear, seed, depth_tilt);
    assert_eq!(size_of::<ViewUniform>(), 272, "as its documentation says");
    assert_eq!(kernel().layout_of("View"), rust, "WESL, then Rust");
}

#[test]
fn light_sphere() {
    check_element("LightSphere", &struct_layout!(LightSphere: position_world, radius_m));
}

#[test]
fn light_emission() {
    check_element("LightEmission", &struct_layout!(LightEmission: intensity, kind_and_shape));
}

#[test]
fn light_node() {
    check_element("LightNode", &struct_layout!(LightNode: min_world, max_world));
}

#[test]
fn light_list() {
    let rust = struct_layout!(LightList: first, count);
    assert_eq!(kernel().layout_of("LightList"), rust, "WESL, then Rust");
    // Kernels write records word by word; look-ups read them as an array.
    let root = "import package::lists::list_of;
        @compute @workgroup_size(1) fn run() { _ = list_of(0u); }";
    let look_up = Shader::new(1).module("package::root", root).link("package::root").unwrap();
    let look_up = LinkedModule::new("a look-up", &look_up);
    assert_eq!(look_up.layout_of("LightList"), rust, "WESL, then Rust");
    assert_eq!(look_up.strides_of("LightList"), [rust.bytes], "array stride");
}

#[test]
fn cull_uniform() {
    let rust = struct_layout!(CullUniform: light_count, group_count, pool_first, pool_capacity,
        guard_cursor, list_cap, first_parent, first_grandparent, mask_stride, mask_summary);
    assert_eq!(kernel().layout_of("Cull"), rust, "WESL, then Rust");
}
