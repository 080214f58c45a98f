//! Structs shared by Rust and WESL have the same size and the same offsets on both sides, by
//! reflection of a linked shader.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    conformance::{LinkedModule, StructLayout},
    struct_layout,
};
use shading::{
    FogRecord, InstanceRecord, LightingRecord, MaterialRecord, ParticleRecord, PixelGroupsRecord,
    PixelSurface, SunMapRecord, SunMapsRecord, SunRecord, SunsRecord,
};

/// A shader that reads instances and materials.
fn geometry() -> LinkedModule {
    let shader = shading::lighting_shader().flag("gbuffer", true).flag("uv_transforms", true);
    LinkedModule::new("geometry", &shader.link("package::geometry").unwrap())
}

/// A shader that lights by samples, and by suns.
fn lighting() -> LinkedModule {
    let look_up = include_str!("../../assign/src/shaders/everything.wesl");
    let shader = shading::lighting_shader()
        .flag("areas", true)
        .flag("area_monte_carlo", true)
        .flag("suns", true);
    let shader = shader.module("package::strategy", look_up);
    LinkedModule::new("deferred", &shader.link("package::deferred").unwrap())
}

/// Checks the element of an array: its layout, and that elements lie side by side.
fn check_element(name: &str, rust: &StructLayout) {
    let geometry = geometry();
    assert_eq!(&geometry.layout_of(name), rust, "{name}: WESL, then Rust");
    assert_eq!(geometry.strides_of(name), [rust.bytes], "{name}: array stride");
}

#[test]
fn instance() {
    let rust = struct_layout!(InstanceRecord: object_to_world, normal_x, model_ix, normal_y,
        material_ix, normal_z, handedness);
    check_element("Instance", &rust);
}

#[test]
fn material() {
    let rust = struct_layout!(MaterialRecord: base_color, emissive, metallic, roughness,
        normal_scale, alpha_cutoff, transmission, dielectric, uv_transforms);
    check_element("Material", &rust);
}

#[test]
fn lighting_uniform() {
    let rust = struct_layout!(LightingRecord: exit_weight, area_samples, applicable_lights, random_threshold,
        specular_reach, area_lod);
    assert_eq!(lighting().layout_of("LightingUniform"), rust, "WESL, then Rust");
}

#[test]
fn suns() {
    let rust = struct_layout!(SunsRecord: suns, count);
    assert_eq!(lighting().layout_of("Suns"), rust, "WESL, then Rust");
    let rust = struct_layout!(SunRecord: to_sun, irradiance);
    assert_eq!(lighting().layout_of("Sun"), rust, "WESL, then Rust");
    let look_up = include_str!("../../assign/src/shaders/everything.wesl");
    let shader = shading::lighting_shader().flag("suns", true).flag("shadows", true);
    let shader = shader.module("package::strategy", look_up);
    let shadowed = LinkedModule::new("deferred", &shader.link("package::deferred").unwrap());
    let rust = struct_layout!(SunMapsRecord: maps, taps, px, slack);
    assert_eq!(shadowed.layout_of("SunMaps"), rust, "WESL, then Rust");
    let rust = struct_layout!(SunMapRecord: right, down, away, origin, texel_m, offset_m);
    assert_eq!(shadowed.layout_of("SunMap"), rust, "WESL, then Rust");
}

#[test]
fn records_of_one_pixel() {
    let look_up = include_str!("../../assign/src/shaders/everything.wesl");
    let shader = shading::lighting_shader().module("package::strategy", look_up);
    let linked = |root: &str| LinkedModule::new(root, &shader.link(root).unwrap());
    let rust = struct_layout!(PixelGroupsRecord: is_surface, group, second, depth_mask, bounds);
    let wesl = linked("package::pixel_group").layout_of("PixelGroups");
    assert_eq!(wesl, rust, "WESL, then Rust");
    let rust = struct_layout!(PixelSurface: position_world, normal_roughness, base_color, dielectric,
        emission, from_suns);
    let wesl = linked("package::contributions").layout_of("PixelSurface");
    assert_eq!(wesl, rust, "WESL, then Rust");
}

#[test]
fn fog_and_particles() {
    let shader = shading::lighting_shader().flag("captures", true).link("package::fog_light");
    let fog = LinkedModule::new("fog", &shader.unwrap());
    let rust = struct_layout!(FogRecord: counts, density, near_m, far_m, froxel_px, unused);
    assert_eq!(fog.layout_of("Fog"), rust, "WESL, then Rust");
    let shader = shading::lighting_shader().flag("captures", true).link("package::particles");
    let particles = LinkedModule::new("particles", &shader.unwrap());
    let rust = struct_layout!(ParticleRecord: center_world, radius_m, color, opacity);
    assert_eq!(particles.layout_of("Particle"), rust, "WESL, then Rust");
    assert_eq!(particles.strides_of("Particle"), [rust.bytes], "array stride");
    // The pass that looks captured samples up reads what was captured.
    let look_up = include_str!("../../assign/src/shaders/everything.wesl");
    let shader = shading::lighting_shader().flag("captured", true);
    let asked = shader.module("package::strategy", look_up).link("package::probe").unwrap();
    let asked = LinkedModule::new("probe", &asked);
    assert_eq!(asked.layout_of("CapturedSample"), particles.layout_of("CapturedSample"));
    assert_eq!(asked.strides_of("CapturedSample"), [32]);
}
