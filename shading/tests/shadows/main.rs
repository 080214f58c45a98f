//! Tests shadow maps against the truth on the CPU, and where they must show nothing.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod adaptive;
#[path = "../common/mod.rs"]
mod common;
mod errors;
mod layers;
mod moved;
mod occlusion;
mod paraboloids;
mod pcss;
mod rays;
mod strategies;
mod suns;
mod truth;
mod walls;

use std::sync::Arc;

use assign::{
    Assignment, Emitter, EncoderPasses, Everything, Gpu, Light, LightBuffer, LightShape, View,
};
use assign_cdi::{Directions, Spread};
use glam::Vec3;
use scenes::Scene;
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, Renderer, ShadowModel, WorldTriangles,
    record_before_lighting, shadow_images, traced::GBufferSamples,
};

fn maps(maps: u32, px: u32, taps: u32) -> ShadowModel {
    ShadowModel::Maps { maps, px, taps }
}

/// Has rays of shadows cross images of so many directions along each axis and pixels along each side.
fn cast_rays_through(renderer: &mut Renderer, scene: &Scene, directions: u32, size_px: u32) {
    let triangles = WorldTriangles::new(renderer.gpu(), scene).unwrap();
    let directions = Directions::new(Spread::Squares, directions, directions).unwrap();
    renderer.cast_rays_through(Arc::new(triangles), shadow_images(directions, size_px));
}

/// One frame of a strategy on a renderer whose view and lights are prepared.
fn draw(
    renderer: &Renderer,
    view: &View,
    lights: &LightBuffer,
    strategy: &mut dyn Assignment,
    mode: Mode,
    shadows: ShadowModel,
) -> HdrImage {
    let options = LightingOptions { kinds: lights.kinds(), shadows, ..LightingOptions::default() };
    draw_with(renderer, view, lights, strategy, mode, options)
}

/// The same with any options.
fn draw_with(
    renderer: &Renderer,
    view: &View,
    lights: &LightBuffer,
    strategy: &mut dyn Assignment,
    mode: Mode,
    options: LightingOptions,
) -> HdrImage {
    let gpu = renderer.gpu();
    let lighting = Lighting::new(renderer, strategy, mode, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(view, lights);
    strategy.prepare(gpu, &frame).unwrap();
    record_before_lighting(renderer, mode, strategy, &frame, &mut passes);
    lighting.record(renderer, view, strategy, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
}

/// The images of a scene without culling, one for each model, and its G-buffer.
fn images(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    lights: &[Light],
    models: &[ShadowModel],
) -> (Vec<HdrImage>, GBufferSamples) {
    let lights = LightBuffer::new(gpu, lights).unwrap();
    let mut renderer = Renderer::new(gpu, scene, view).unwrap();
    if models.iter().any(|model| model.casts_rays()) {
        cast_rays_through(&mut renderer, scene, 6, 256);
    }
    let mut strategy = Everything::new(gpu).unwrap();
    let images = models.iter().map(|model| {
        renderer.cast_shadows(&lights, *model).unwrap();
        renderer.prepare(view, &lights).unwrap();
        draw(&renderer, view, &lights, &mut strategy, Mode::Deferred, *model)
    });
    let images = images.collect();
    (images, GBufferSamples::read(&renderer, view).unwrap())
}

/// Mean absolute difference over the mean of the reference.
fn off(image: &HdrImage, reference: &HdrImage) -> f64 {
    let sum = |values: &mut dyn Iterator<Item = f32>| values.map(f64::from).sum::<f64>();
    let pairs = image.pixels.iter().flatten().zip(reference.pixels.iter().flatten());
    let all = sum(&mut reference.pixels.iter().flatten().copied());
    assert!(all > 0.0, "the reference is black");
    sum(&mut pairs.map(|(a, b)| (a - b).abs())) / all
}

/// A lamp of a square metre, facing down.
fn lamp(position: Vec3) -> Light {
    let emitter = Emitter::rectangle(Vec3::X * 0.5, Vec3::Z * 0.5);
    assert!(emitter.normal().y < -0.9, "{}", emitter.normal());
    Light::area(emitter, position, 30.0, Vec3::splat(4.0))
}

/// A spot that shines down.
fn spot(position: Vec3, outer_angle: f32) -> Light {
    let inner_angle = 0.8 * outer_angle;
    let shape = LightShape::Spot { direction: Vec3::NEG_Y, inner_angle, outer_angle };
    Light { shape, ..Light::point(position, 30.0, Vec3::splat(4.0)) }
}
