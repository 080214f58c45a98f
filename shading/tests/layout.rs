//! Structs shared by Rust and WESL have the same size and the same offsets on both sides, by
//! reflection of a linked shader.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use shading::{InstanceRecord, LightingRecord, MaterialRecord, SunRecord, SunsRecord};

/// Name and offset of every field of a Rust struct, in its order.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field), offset_of!($name, $field))),+]
    };
}

/// A shader that reads instances and materials.
fn geometry() -> naga::Module {
    let shader = shading::lighting_shader().flag("gbuffer", true).flag("uv_transforms", true);
    naga::front::wgsl::parse_str(&shader.link("package::geometry").unwrap()).unwrap()
}

/// A shader that lights by samples, and by suns.
fn lighting() -> naga::Module {
    let look_up = include_str!("../../assign/src/shaders/everything.wesl");
    let shader = shading::lighting_shader()
        .flag("areas", true)
        .flag("area_monte_carlo", true)
        .flag("suns", true);
    let shader = shader.module("package::strategy", look_up);
    naga::front::wgsl::parse_str(&shader.link("package::deferred").unwrap()).unwrap()
}

/// Checks a struct: its size, its fields and their offsets.
fn check(
    module: &naga::Module,
    name: &str,
    bytes: usize,
    fields: &[(&str, usize)],
) -> naga::Handle<naga::Type> {
    // The linker prefixes names with their module.
    let is_named = |n: &str| n == name || n.ends_with(&format!("_{name}"));
    let (handle, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref().is_some_and(is_named))
        .unwrap_or_else(|| panic!("{name}: not in the shader"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name}: not a struct");
    };
    let wesl: Vec<_> =
        members.iter().map(|m| (m.name.as_deref().unwrap(), m.offset as usize)).collect();
    assert_eq!(wesl, fields, "{name}: fields of WESL, then of Rust");
    assert_eq!(*span as usize, bytes, "{name}: size");
    handle
}

/// Checks the element of an array of structs, and the array's stride.
fn check_element(name: &str, bytes: usize, fields: &[(&str, usize)]) {
    let module = geometry();
    let element = check(&module, name, bytes, fields);
    let strides: Vec<usize> = module
        .types
        .iter()
        .filter_map(|(_, ty)| match ty.inner {
            naga::TypeInner::Array { base, stride, .. } if base == element => Some(stride as usize),
            _ => None,
        })
        .collect();
    assert_eq!(strides, [bytes], "{name}: array stride");
}

#[test]
fn instance() {
    let fields = fields!(InstanceRecord: object_to_world, normal_x, model_ix, normal_y,
        material_ix, normal_z, handedness);
    check_element("Instance", size_of::<InstanceRecord>(), &fields);
}

#[test]
fn material() {
    let fields = fields!(MaterialRecord: base_color, emissive, metallic, roughness, normal_scale,
        alpha_cutoff, unused, dielectric, uv_transforms);
    check_element("Material", size_of::<MaterialRecord>(), &fields);
}

#[test]
fn lighting_uniform() {
    let fields = fields!(LightingRecord: exit_weight, area_samples, applicable_lights);
    check(&lighting(), "LightingUniform", size_of::<LightingRecord>(), &fields);
}

#[test]
fn suns() {
    let fields = fields!(SunsRecord: suns, count);
    check(&lighting(), "Suns", size_of::<SunsRecord>(), &fields);
    let fields = fields!(SunRecord: to_sun, irradiance);
    check(&lighting(), "Sun", size_of::<SunRecord>(), &fields);
}
