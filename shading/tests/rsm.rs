//! Tests reflective shadow maps: a second view beside the first, and the triangles in world space.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{EncoderPasses, Gpu, Light, LightBuffer, Projection, View};
use assign_cdi::{Rsm, VplBuffer, VplSettings, lambertian_albedo};
use glam::{DVec3, Vec3};
use scenes::{Scene, TownSize, atrium, primary_light, town};
use shading::{
    HdrImage, Renderer, WorldTriangles, ltc,
    reference::{Surface, reflect_light},
    rsm_view,
    traced::TracedScene,
};

/// The control: geometry and normals without lights.
fn clay(gpu: &Gpu, renderer: &mut Renderer, view: &View, lights: &LightBuffer) -> HdrImage {
    renderer.prepare(view, lights).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    renderer.record_gbuffer(view, &mut passes);
    renderer.record_clay(view, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
}

/// A renderer beside another draws what it would draw alone, and does not disturb the first.
#[test]
fn a_renderer_beside_another_does_not_disturb_it() {
    let gpu = common::gpu();
    let scene = common::showcase();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let first = common::view([64, 64]);
    let light = primary_light(&scene);
    let second = rsm_view(&light, 64, (scene.bounds.min, scene.bounds.max)).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene, &first).unwrap();
    let mut beside = renderer.beside(&second).unwrap();
    let mut alone = Renderer::new(&gpu, &scene, &second).unwrap();
    let before = clay(&gpu, &mut renderer, &first, &lights);
    let map = clay(&gpu, &mut beside, &second, &lights);
    assert!(map.pixels == clay(&gpu, &mut alone, &second, &lights).pixels);
    assert!(before.pixels == clay(&gpu, &mut renderer, &first, &lights).pixels);
    assert!(map.pixels != before.pixels);
    let drawn = map.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
    assert!(drawn * 8 > 64 * 64, "{drawn} pixels");
}

#[test]
fn world_triangles_match_the_scene() {
    let gpu = common::gpu();
    let scene = town(1, TownSize::Small);
    let triangles = WorldTriangles::new(&gpu, &scene).unwrap();
    let expected: Vec<[Vec3; 3]> = scene.world_triangles().collect();
    let bytes = gpu.read(&triangles.positions, expected.len() as u64 * 36).unwrap();
    let positions: Vec<[Vec3; 3]> = bytemuck::pod_collect_to_vec(&bytes);
    assert_eq!(triangles.count as usize, expected.len());
    assert!(positions == expected);
    let (low, high) = triangles.bounds_world;
    // The box contains every corner and is no larger than necessary.
    let corners = || positions.iter().flatten().copied();
    let least = corners().reduce(Vec3::min).unwrap();
    let most = corners().reduce(Vec3::max).unwrap();
    assert!(low.cmple(least).all() && high.cmpge(most).all(), "{low} {high}");
    let off = (least - low).max(high - most).max_element();
    assert!(off < 1e-4 * (most - least).length(), "the box is {off} m too large: {low} {high}");
}

/// VPLs of a scene's own map. Nearly all lie where a ray from the light hits the scene, and
/// together they reflect the light that rays compute.
#[test]
fn vpls_lie_on_the_scene_and_reflect_its_light() {
    let gpu = common::gpu();
    for scene in [atrium(1), town(1, TownSize::Small)] {
        let light = primary_light(&scene);
        let view = rsm_view(&light, 128, (scene.bounds.min, scene.bounds.max)).unwrap();
        let vpls = vpls(&gpu, &scene, &light, &view);
        let traced = TracedScene::new(&scene);
        let tolerance_m = f64::from(1e-4 * scene.bounds.diagonal());
        let near = vpls.iter().filter(|vpl| {
            let to = (vpl.position - light.position).as_dvec3();
            let met = traced.distance_m(light.position.as_dvec3(), to.normalize());
            met.is_some_and(|distance_m| (distance_m - to.length()).abs() < tolerance_m)
        });
        let near = near.count();
        assert!(near * 100 > vpls.len() * 97, "{}: {near} of {}", scene.name, vpls.len());
        let sum: DVec3 = vpls.iter().map(|vpl| vpl.intensity.as_dvec3()).sum();
        let off = sum / reflected(&traced, &light, &view) - DVec3::ONE;
        assert!(off.abs().max_element() < 0.01, "{}: {off}", scene.name);
    }
}

/// The VPLs of every texel.
fn vpls(gpu: &Gpu, scene: &Scene, light: &Light, view: &View) -> Vec<Light> {
    let lights = LightBuffer::new(gpu, &[]).unwrap();
    let mut renderer = Renderer::new(gpu, scene, view).unwrap();
    renderer.prepare(view, &lights).unwrap();
    let mut buffer = VplBuffer::new(gpu, VplSettings::default()).unwrap();
    let targets = renderer.targets();
    let rsm = Rsm {
        depth: &targets.depth,
        normals: &targets.normal,
        base_color: &targets.base_color,
        view,
        light,
    };
    buffer.prepare(gpu, &rsm).unwrap();
    let ranges = vec![1.0_f32; buffer.capacity() as usize];
    gpu.queue.write_buffer(buffer.ranges_m(), 0, bytemuck::cast_slice(&ranges));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    renderer.record_gbuffer(view, &mut passes);
    buffer.record_choose(&mut passes);
    buffer.record_keep(&mut passes);
    gpu.queue.submit([encoder.finish()]);
    buffer.read(gpu).unwrap()
}

/// The sum of the intensities that the texels reflect, computed by rays.
fn reflected(scene: &TracedScene<'_>, light: &Light, view: &View) -> DVec3 {
    let Projection::Perspective { min, max } = view.projection else { panic!("perspective") };
    let size = view.viewport.width;
    let texel = (max - min).as_dvec2() / f64::from(size);
    let sum = (0..size * size).filter_map(|ix| {
        let pixel = [ix % size, ix / size];
        let surface = scene.primary(view, pixel)?;
        let across = min.x as f64 + (f64::from(pixel[0]) + 0.5) * texel.x;
        let down = max.y as f64 - (f64::from(pixel[1]) + 0.5) * texel.y;
        let solid_angle = texel.element_product() / (1.0 + across * across + down * down).powf(1.5);
        // The map is drawn from the light.
        let cos = surface.surface.normal.dot(surface.to_eye);
        let Surface { base_color, metallic, .. } = surface.surface;
        let albedo = lambertian_albedo(base_color.as_vec3(), metallic as f32, cos as f32);
        Some(albedo.as_dvec3() * solid_angle)
    });
    // The cone's full intensity contains the scene, and the window dims nothing.
    sum.sum::<DVec3>() * light.intensity.as_dvec3() / std::f64::consts::PI
}

/// The share of light, from a direction at a cosine to the normal, that the reference's diffuse
/// term reflects over the hemisphere.
fn diffuse_albedo(base_color: DVec3, metallic: f64, cos: f64) -> DVec3 {
    let to_light = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let dielectric = Default::default();
    let all = Surface { base_color, metallic, normal: DVec3::Z, roughness: 1.0, dielectric };
    // A metal with the same reflectance at normal incidence has only the specular term.
    let f0 = DVec3::splat(0.04).lerp(base_color, metallic);
    let specular = Surface { base_color: f0, metallic: 1.0, ..all };
    let steps = 200;
    let middle = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
    let mut sum = DVec3::ZERO;
    for ix in 0..steps * steps {
        let z = middle(ix / steps);
        let (sin, cos) = (std::f64::consts::TAU * middle(ix % steps)).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        let out = DVec3::new(flat * cos, flat * sin, z);
        // Reflection is the same in both directions. The cosine is that of the last direction.
        sum += reflect_light(&all, to_light, out) - reflect_light(&specular, to_light, out);
    }
    sum * (std::f64::consts::TAU / f64::from(steps * steps))
}

/// A virtual point light emits what the renderer's BRDF reflects diffusely, by the reference and by
/// the polynomial that shading uses.
#[test]
fn a_vpls_albedo_matches_the_renderers_brdf() {
    for cos in [0.1_f64, 0.4, 0.7, 1.0] {
        for (color, metallic) in
            [(Vec3::ONE, 0.0), (Vec3::new(0.8, 0.4, 0.1), 0.0), (Vec3::new(0.9, 0.5, 0.2), 0.4)]
        {
            let expected = diffuse_albedo(color.as_dvec3(), metallic, cos);
            let found = lambertian_albedo(color, metallic as f32, cos as f32).as_dvec3();
            let off = (found - expected).abs().max_element();
            assert!(off < 2e-4, "{cos}, {color}, {metallic}: {found}, not {expected}");
            // The albedo without Fresnel's term must fail.
            let lambert = color.as_dvec3() * (1.0 - metallic);
            assert!((lambert - expected).max_element() > 0.02, "{cos}: {lambert}, {expected}");
        }
        let white = f64::from(lambertian_albedo(Vec3::ONE, 0.0, cos as f32).x);
        let expected = 0.96 * (1.0 - ltc::diffuse_fresnel(cos));
        assert!((white - expected).abs() < 1e-6, "{cos}: {white}, not {expected}");
    }
}
