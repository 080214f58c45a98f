//! Tests reflectances of dielectrics, vertex colours and unlit materials, in both modes and against
//! the reference on the CPU.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{EncoderPasses, Everything, Gpu, Light, LightBuffer};
use glam::{DVec3, Vec3, Vec4};
use scenes::{Dielectric, Scene};
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, Renderer, record_before_lighting,
    reference::light_contribution,
    traced::{GBufferSamples, TracedScene},
};

const SIZE: [u32; 2] = [64, 48];

/// The showcase with a floor of another reflectance, an unlit wall and a coloured sheet.
fn scene() -> Scene {
    let mut scene = common::showcase();
    let floor = &mut scene.materials[0];
    floor.dielectric = Dielectric { f0: Vec3::new(0.3, 0.15, 0.05), f90: 0.5 };
    floor.roughness = 0.3;
    let wall = &mut scene.materials[1];
    wall.unlit = true;
    wall.emissive = Vec3::splat(0.5);
    wall.base_color = Vec4::new(0.0, 0.0, 0.0, 1.0);
    (wall.metallic, wall.metallic_roughness_texture) = (0.0, None);
    wall.dielectric = Dielectric::BLACK;
    for (mesh, color) in [(1, [1.0, 0.5, 0.25, 1.0]), (3, [0.25, 0.5, 1.0, 1.0])] {
        scene.meshes[mesh].colors = vec![color; scene.meshes[mesh].vertices.len()];
    }
    // Half of the mask's vertices are transparent.
    scene.meshes[2].colors = [1.0, 1.0, 0.0, 0.0].map(|a| [1.0, 1.0, 1.0, a]).to_vec();
    scene
}

fn draw(gpu: &Gpu, scene: &Scene, lights: &[Light], mode: Mode) -> (HdrImage, GBufferSamples) {
    let view = common::view(SIZE);
    let lights = LightBuffer::new(gpu, lights).unwrap();
    let mut renderer = Renderer::new(gpu, scene, &view).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let mut strategy = Everything::new(gpu).unwrap();
    let options = LightingOptions { kinds: lights.kinds(), ..LightingOptions::default() };
    let lighting = Lighting::new(&renderer, &strategy, mode, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(&view, &lights);
    assign::Assignment::prepare(&mut strategy, gpu, &frame).unwrap();
    record_before_lighting(&renderer, mode, &mut strategy, &frame, &mut passes);
    lighting.record(&renderer, &view, &strategy, &mut passes).unwrap();
    if mode.is_forward() {
        renderer.record_gbuffer(&view, &mut passes);
    }
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap();
    (image, GBufferSamples::read(&renderer, &view).unwrap())
}

/// The difference between two images, as a share of the brightness.
fn off(image: &HdrImage, other: &HdrImage) -> f64 {
    let pairs = || image.pixels.iter().flatten().zip(other.pixels.iter().flatten());
    let sum: f64 = pairs().map(|(a, _)| f64::from(*a)).sum();
    pairs().map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / sum
}

#[test]
fn images_match_the_reference() {
    let gpu = common::gpu();
    let scene = scene();
    let lights = common::lights(12);
    let (deferred, samples) = draw(&gpu, &scene, &lights, Mode::Deferred);
    let (ids, _) = draw(&gpu, &scene, &lights, Mode::DeferredIds);
    assert_eq!(ids.difference(&deferred).unwrap().differing_channels, 0);
    let (forward, _) = draw(&gpu, &scene, &lights, Mode::ForwardNoPrepass);
    assert!(off(&forward, &deferred) < 0.02, "{}", off(&forward, &deferred));
    let traced = TracedScene::new(&scene);
    let (mut sum, mut error, mut seen, mut floors) = (0.0, 0.0, 0, 0);
    for (ix, pixel) in deferred.pixels.iter().enumerate() {
        let Some(sample) = samples.sample(ix, &traced) else { continue };
        let lit =
            |light| light_contribution(light, sample.position, &sample.surface, sample.to_eye);
        let expected = sample.emission + lights.iter().map(lit).sum::<DVec3>();
        sum += expected.element_sum();
        error += (Vec3::from_slice(&pixel[..3]).as_dvec3() - expected).abs().element_sum();
        seen += 1;
        // The surface that a ray hits has the reflectances and colours of the drawn one.
        let [x, y] = [ix as u32 % SIZE[0], ix as u32 / SIZE[0]];
        let Some(met) = traced.primary(&common::view(SIZE), [x, y]) else { continue };
        if (met.position - sample.position).length() > 1e-3 {
            continue;
        }
        let (a, b) = (met.surface, sample.surface);
        assert!((a.dielectric.f0 - b.dielectric.f0).length() < 1e-3, "{a:?} {b:?}");
        assert!((a.dielectric.f90 - b.dielectric.f90).abs() < 1e-3, "{a:?} {b:?}");
        floors += i32::from(b.dielectric.f90 == 0.5);
    }
    assert!(seen > 1_000 && floors > 100, "{seen} samples, {floors} of the floor");
    assert!(error < 2e-3 * sum, "error {error}, sum {sum}");
    // Without the reflectances or without the colours, the image differs.
    for change in [
        (|scene| scene.materials[0].dielectric = Dielectric::default()) as fn(&mut Scene),
        |scene| scene.meshes[3].colors.clear(),
    ] {
        let mut changed = scene.clone();
        change(&mut changed);
        let (other, _) = draw(&gpu, &changed, &lights, Mode::Deferred);
        assert!(off(&deferred, &other) > 5e-4, "{}", off(&deferred, &other));
    }
}

#[test]
fn unlit_surfaces_show_their_colour_under_any_light() {
    let gpu = common::gpu();
    let scene = scene();
    let traced = TracedScene::new(&scene);
    for mode in [Mode::Deferred, Mode::Forward] {
        let (dark, samples) = draw(&gpu, &scene, &[], mode);
        let (lit, _) = draw(&gpu, &scene, &common::lights(12), mode);
        let mut walls = 0;
        for (ix, (dark, lit)) in dark.pixels.iter().zip(&lit.pixels).enumerate() {
            let emission = samples.sample(ix, &traced).map_or(DVec3::ZERO, |s| s.emission);
            if emission == DVec3::ZERO {
                continue;
            }
            assert_eq!(dark, lit, "pixel {ix}");
            // The checker is brown and blue; the vertices' colour halves its green.
            assert!(dark[1] < 0.5 * dark[0] || dark[2] > 0.03, "{dark:?}");
            walls += 1;
        }
        assert!(walls > 300, "{walls} pixels of the wall");
    }
}
