//! Stochastic light culling: lists lose nothing that shading keeps, a low threshold changes nothing, and the mean of
//! many frames is the image of no culling.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Everything, Gpu, Light, LightBuffer,
    LightShape, LightSource, Stochastic, View,
};
use assign_clustered::{Clustered, Occupancy};
use glam::Vec3;
use shading::{HdrImage, Lighting, LightingOptions, Mode, Renderer, record_before_lighting};

/// Points, spots and virtual point lights that reach far.
fn lights() -> Vec<Light> {
    let mut lights = common::lights(90);
    for (ix, light) in lights.iter_mut().enumerate() {
        light.range_m *= 3.0;
        match ix % 3 {
            0 => {
                light.shape = LightShape::Spot {
                    direction: Vec3::new(0.3, -1.0, 0.2).normalize(),
                    inner_angle: 0.3,
                    outer_angle: 1.2,
                }
            }
            1 => light.shape = LightShape::Vpl { normal: Vec3::NEG_Y, min_distance_m: 0.2 },
            _ => {}
        }
    }
    lights
}

fn everything(gpu: &Gpu) -> Box<dyn Assignment> {
    Box::new(Everything::new(gpu).unwrap())
}

/// Sparse clusters through the hierarchy.
fn clusters(gpu: &Gpu) -> Box<dyn Assignment> {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    let size = "16x16x8".parse().unwrap();
    Box::new(Clustered::new(gpu, size, Bounds::Explicit, Occupancy::Sparse, settings).unwrap())
}

/// What draws frames.
struct Scene {
    gpu: Gpu,
    view: View,
    lights: LightBuffer,
    renderer: Renderer,
}

impl Scene {
    fn new() -> Self {
        let gpu = common::gpu();
        let view = common::view([48, 32]);
        let lights = LightBuffer::new(&gpu, &lights()).unwrap();
        let renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
        Self { gpu, view, lights, renderer }
    }

    /// Images of some frames. Without a threshold nothing is random.
    fn images(
        &mut self,
        strategy: Box<dyn Assignment>,
        threshold: Option<f32>,
        mode: Mode,
        seeds: std::ops::Range<u32>,
    ) -> Vec<HdrImage> {
        let Self { gpu, view, lights, renderer } = self;
        renderer.prepare(view, lights).unwrap();
        let mut strategy = match threshold {
            Some(threshold) => Box::new(Stochastic::new(gpu, strategy, threshold).unwrap()),
            None => strategy,
        };
        let options = LightingOptions {
            kinds: lights.kinds(),
            stochastic: threshold,
            ..LightingOptions::default()
        };
        let lighting = Lighting::new(renderer, strategy.as_ref(), mode, options).unwrap();
        let mut image = |seed: u32| {
            renderer.reseed(view, lights, seed).unwrap();
            // The pool may have to grow before lists fit.
            for _ in 0..2 {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let mut passes = EncoderPasses { encoder: &mut encoder };
                let frame = renderer.frame(view, lights);
                strategy.prepare(gpu, &frame).unwrap();
                record_before_lighting(renderer, mode, strategy.as_mut(), &frame, &mut passes);
                lighting.record(renderer, view, strategy.as_ref(), &mut passes).unwrap();
                gpu.queue.submit([encoder.finish()]);
            }
            HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
        };
        seeds.map(&mut image).collect()
    }
}

/// How many channels differ.
fn differing(a: &HdrImage, b: &HdrImage) -> u64 {
    a.difference(b).unwrap().differing_channels
}

#[test]
fn lists_hold_every_light_that_shading_keeps() {
    let mut scene = Scene::new();
    for mode in [Mode::Deferred, Mode::Forward] {
        let all = scene.images(everything(&scene.gpu.clone()), Some(0.05), mode, 0..4);
        let listed = scene.images(clusters(&scene.gpu.clone()), Some(0.05), mode, 0..4);
        for (all, listed) in all.iter().zip(&listed) {
            assert_eq!(differing(listed, all), 0, "{mode:?}");
        }
        // Frames differ.
        assert!(differing(&all[0], &all[1]) > 100, "{mode:?}");
    }
}

#[test]
fn a_threshold_below_all_light_changes_no_bit() {
    let mut scene = Scene::new();
    let reference = scene.images(everything(&scene.gpu.clone()), None, Mode::Deferred, 0..1);
    let low = scene.images(clusters(&scene.gpu.clone()), Some(1e-35), Mode::Deferred, 7..8);
    assert_eq!(differing(&low[0], &reference[0]), 0);
}

#[test]
fn the_mean_of_many_frames_is_the_image_of_no_culling() {
    let mut scene = Scene::new();
    let reference = scene.images(everything(&scene.gpu.clone()), None, Mode::Deferred, 0..1);
    let frames = scene.images(clusters(&scene.gpu.clone()), Some(0.05), Mode::Deferred, 0..256);
    let sum =
        |image: &HdrImage| -> f64 { image.pixels.iter().flatten().copied().map(f64::from).sum() };
    let truth = sum(&reference[0]);
    let sums: Vec<f64> = frames.iter().map(|image| sum(image) / truth).collect();
    let count = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / count;
    let variance = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let standard_error = (variance / count).sqrt();
    println!("mean {mean}, standard error {standard_error}");
    // Frames are noisy, and four standard errors hold the truth: one test in 16,000 fails by chance, and seeds are fixed.
    assert!(variance.sqrt() > 1e-3, "{variance}");
    assert!((mean - 1.0).abs() < 4.0 * standard_error, "{mean} +- {standard_error}");
    // Ranges that shrink without a weight would lose light.
    assert!(standard_error < 0.01, "{standard_error}");
}
