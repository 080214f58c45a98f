//! Structs shared by Rust and WESL have the same size and the same offsets on both sides, by
//! reflection of the linked kernel.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::mem::offset_of;

use assign::{
    Counters, CullSettings, CullUniform, Culler, GroupShape, LightEmission, LightKinds, LightList,
    LightNode, LightSource, LightSphere, ViewUniform,
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

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field), offset_of!($name, $field))),+]
    };
}

fn kernel() -> naga::Module {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    let source =
        Culler::kernel_source(GroupShape::Box, settings, false, STRATEGY, LightKinds::ALL[3])
            .unwrap();
    naga::front::wgsl::parse_str(&source).unwrap()
}

/// Checks a WESL struct: its size, its fields and their offsets, and, where it is the element of
/// an array, the array's stride. Returns the size that WESL gives it.
fn check(name: &str, bytes: usize, fields: &[(&str, usize)], stride: Option<usize>) -> usize {
    let module = kernel();
    // The linker prefixes names with their module.
    let is_named = |n: &str| n == name || n.ends_with(&format!("_{name}"));
    let (handle, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref().is_some_and(is_named))
        .unwrap_or_else(|| panic!("{name}: not in the kernel"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name}: not a struct");
    };
    let wesl: Vec<_> =
        members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    assert_eq!(wesl, fields, "{name}: fields of WESL, then of Rust");
    assert_eq!(*span as usize, bytes, "{name}: size");
    let strides: Vec<usize> = module
        .types
        .iter()
        .filter_map(|(_, ty)| match ty.inner {
            naga::TypeInner::Array { base, stride, .. } if base == handle => Some(stride as usize),
            _ => None,
        })
        .collect();
    assert_eq!(strides, Vec::from_iter(stride), "{name}: array stride");
    *span as usize
}

#[test]
fn view() {
    let fields = fields!(ViewUniform: world_to_view, view_to_world, view_to_clip, ray_scale,
        ray_offset, viewport_origin, viewport_size, near_m, far_m, perspective, position_error,
        depth_clear);
    check("View", size_of::<ViewUniform>(), &fields, None);
}

#[test]
fn light_sphere() {
    let fields = fields!(LightSphere: position_world, radius_m);
    let bytes = size_of::<LightSphere>();
    check("LightSphere", bytes, &fields, Some(bytes));
}

#[test]
fn light_emission() {
    let fields = fields!(LightEmission: intensity, kind_and_shape);
    let bytes = size_of::<LightEmission>();
    check("LightEmission", bytes, &fields, Some(bytes));
}

#[test]
fn light_node() {
    let fields = fields!(LightNode: min_world, max_world);
    let bytes = size_of::<LightNode>();
    check("LightNode", bytes, &fields, Some(bytes));
}

#[test]
fn light_list() {
    let fields = fields!(LightList: first, count);
    let bytes = size_of::<LightList>();
    check("LightList", bytes, &fields, Some(bytes));
}

#[test]
fn counters() {
    let fields = fields!(Counters: cursor, requested_low, requested_high, overflowed_groups,
        occupied_groups, longest);
    check("Counters", size_of::<Counters>(), &fields, None);
}

#[test]
fn cull() {
    let fields = fields!(CullUniform: light_count, group_count, pool_first, pool_capacity,
        guard_cursor, list_cap);
    // The fields that pad are not told in WESL; a uniform takes up a multiple of 16 bytes.
    let bytes = check("Cull", offset_of!(CullUniform, padding), &fields, None);
    assert_eq!(bytes.next_multiple_of(16), size_of::<CullUniform>());
}
