//! The pipeline's WESL modules.

use assign::Shader;

/// Bind group of the lists in lighting shaders.
pub(crate) const LISTS_GROUP: u32 = 1;

/// The contract's modules and the pipeline's, for your own shader: `package::lighting` and
/// `package::brdf` among them. All flags are off. Add a look-up with `Shader::strategy`.
pub fn lighting_shader<'a>() -> Shader<'a> {
    lighting_modules(LISTS_GROUP)
}

/// The contract's modules and the pipeline's, with all flags off.
pub(crate) fn lighting_modules<'a>(lists_group: u32) -> Shader<'a> {
    let flags = [
        "gbuffer",
        "forward",
        "clay",
        "write_model_ids",
        "sheets",
        "fogged",
        "captures",
        "captured",
        "model_ids",
        "hard_cut",
        "no_cut",
        "compensation",
        "stochastic",
        "specular_reach",
        "suns",
        "shadows",
        "shadow_rays",
        "pcss",
        "paraboloids",
        "to_paraboloid",
        "area_lod",
        "area_point",
        "area_mrp",
        "area_mrp_published",
        "area_monte_carlo",
        "area_reflected",
        "area_ltc_table",
        "area_ltc_polynomial",
        "ltc_per_light",
        "ltc_unsplit",
        "mask",
        "forward_mask",
        "gbuffer_ids",
        "emissive",
        "dielectrics",
        "unlit",
        "vertex_colors",
        "uv_transforms",
        "base_color_texture",
        "metallic_roughness_texture",
        "normal_texture",
        "emissive_texture",
        "frustum_bounds",
        "masked_bounds",
        "box_bounds",
        "oriented_bounds",
        "second_group",
    ];
    let shader = Shader::new(lists_group)
        .module("package::brdf", include_str!("shaders/brdf.wesl"))
        .module("package::area", include_str!("shaders/area.wesl"))
        .module("package::area_curved", include_str!("shaders/area_curved.wesl"))
        .module("package::area_point", include_str!("shaders/area_point.wesl"))
        .module("package::area_lod", include_str!("shaders/area_lod.wesl"))
        .module("package::area_mrp", include_str!("shaders/area_mrp.wesl"))
        .module("package::area_mrp_published", include_str!("shaders/area_mrp_published.wesl"))
        .module("package::solid_angle", include_str!("shaders/solid_angle.wesl"))
        .module("package::spherical_rectangle", include_str!("shaders/spherical_rectangle.wesl"))
        .module("package::reflected_region", include_str!("shaders/reflected_region.wesl"))
        .module("package::area_monte_carlo", include_str!("shaders/area_monte_carlo.wesl"))
        .module("package::lighting_uniform", include_str!("shaders/lighting_uniform.wesl"))
        .module("package::area_ltc", include_str!("shaders/area_ltc.wesl"))
        .module("package::area_ltc_curved", include_str!("shaders/area_ltc_curved.wesl"))
        .module("package::ltc_table", include_str!("shaders/ltc_table.wesl"))
        .module("package::ltc_polynomial", crate::ltc::LTC_POLYNOMIAL_WESL)
        .module("package::suns", include_str!("shaders/suns.wesl"))
        .module("package::shadow", include_str!("shaders/shadow.wesl"))
        .module("package::paraboloid", include_str!("shaders/paraboloid.wesl"))
        .module("package::pcss", include_str!("shaders/pcss.wesl"))
        .module("package::sun_shadow", include_str!("shaders/sun_shadow.wesl"))
        .module("package::shadow_open", include_str!("shaders/shadow_open.wesl"))
        .module("package::shadow_banding", include_str!("shaders/shadow_banding.wesl"))
        .module("package::lighting", include_str!("shaders/lighting.wesl"))
        .module("package::scene", include_str!("shaders/scene.wesl"))
        .module("package::material", include_str!("shaders/material.wesl"))
        .module("package::geometry", include_str!("shaders/geometry.wesl"))
        .module("package::gbuffer", include_str!("shaders/gbuffer.wesl"))
        .module("package::deferred", include_str!("shaders/deferred.wesl"))
        .module("package::layer_fog", include_str!("shaders/layer_fog.wesl"))
        .module("package::scattered_light", include_str!("shaders/scattered_light.wesl"))
        .module("package::fog_light", include_str!("shaders/fog_light.wesl"))
        .module("package::fog_sum", include_str!("shaders/fog_sum.wesl"))
        .module("package::fog_apply", include_str!("shaders/fog_apply.wesl"))
        .module("package::resolve", include_str!("shaders/resolve.wesl"))
        .module("package::particles", include_str!("shaders/particles.wesl"))
        .module("package::capture", include_str!("shaders/capture.wesl"))
        .module("package::asked", include_str!("shaders/asked.wesl"))
        .module("package::operations", include_str!("shaders/operations.wesl"))
        .module("package::probe", include_str!("shaders/probe.wesl"))
        .module("package::dump", include_str!("shaders/dump.wesl"))
        .module("package::pixel_group", include_str!("shaders/pixel_group.wesl"))
        .module("package::contributions", include_str!("shaders/contributions.wesl"))
        .module("package::surfaces", include_str!("shaders/surfaces.wesl"))
        .module("package::raster_spheres", include_str!("shaders/raster_spheres.wesl"));
    flags.into_iter().fold(shader, |shader, flag| shader.flag(flag, false))
}
