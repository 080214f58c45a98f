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
use shading::{Cut, HdrImage, Lighting, LightingOptions, Mode, Renderer, record_before_lighting};

const SPOT: fn() -> LightShape = || LightShape::Spot {
    direction: Vec3::new(0.3, -1.0, 0.2).normalize(),
    inner_angle: 0.3,
    outer_angle: 1.2,
};
const VPL: fn() -> LightShape = || LightShape::Vpl { normal: Vec3::NEG_Y, min_distance_m: 0.2 };
const POINT: fn() -> LightShape = || LightShape::Point;

/// Lights of these shapes in turn, that reach far.
fn lights(shapes: &[fn() -> LightShape]) -> Vec<Light> {
    let mut lights = common::lights(90);
    for (light, shape) in lights.iter_mut().zip(shapes.iter().cycle()) {
        light.range_m *= 3.0;
        light.shape = shape();
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
    cut: Cut,
}

impl Scene {
    fn new(shapes: &[fn() -> LightShape]) -> Self {
        let gpu = common::gpu();
        let view = common::view([48, 32]);
        let lights = LightBuffer::new(&gpu, &lights(shapes)).unwrap();
        let renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
        Self { gpu, view, lights, renderer, cut: Cut::Windowed }
    }

    /// Images of some frames. Without a threshold nothing is random.
    fn images(
        &mut self,
        strategy: Box<dyn Assignment>,
        threshold: Option<f32>,
        mode: Mode,
        seeds: std::ops::Range<u32>,
    ) -> Vec<HdrImage> {
        let Self { gpu, view, lights, renderer, cut } = self;
        renderer.prepare(view, lights).unwrap();
        let mut strategy = match threshold {
            Some(threshold) => Box::new(Stochastic::new(gpu, strategy, threshold).unwrap()),
            None => strategy,
        };
        let options = LightingOptions {
            kinds: lights.kinds(),
            stochastic: threshold,
            cut: *cut,
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
    let mut scene = Scene::new(&[SPOT, VPL, POINT]);
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
    let mut scene = Scene::new(&[SPOT, VPL, POINT]);
    let reference = scene.images(everything(&scene.gpu.clone()), None, Mode::Deferred, 0..1);
    let low = scene.images(clusters(&scene.gpu.clone()), Some(1e-35), Mode::Deferred, 7..8);
    assert_eq!(differing(&low[0], &reference[0]), 0);
}

/// The mean of many frames over the image of no culling, and its standard error, both of the whole image's light.
fn mean_of_frames(shape: fn() -> LightShape, cut: Cut, mode: Mode) -> (f64, f64) {
    let mut scene = Scene { cut, ..Scene::new(&[shape]) };
    let reference = scene.images(everything(&scene.gpu.clone()), None, mode, 0..1);
    let frames = scene.images(clusters(&scene.gpu.clone()), Some(0.05), mode, 0..128);
    let sum =
        |image: &HdrImage| -> f64 { image.pixels.iter().flatten().copied().map(f64::from).sum() };
    let truth = sum(&reference[0]);
    let sums: Vec<f64> = frames.iter().map(|image| sum(image) / truth).collect();
    let count = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / count;
    let variance = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// Without the weight of what stays, the mean of lights of all kinds is 0.969 +- 0.0004: that was tried.
#[test]
fn the_mean_of_many_frames_is_the_image_of_no_culling() {
    for (name, shape, cut, mode) in [
        ("points", POINT, Cut::Windowed, Mode::Deferred),
        ("points that end abruptly", POINT, Cut::Hard, Mode::Forward),
        ("spots", SPOT, Cut::Windowed, Mode::Forward),
        ("virtual point lights", VPL, Cut::Windowed, Mode::Deferred),
    ] {
        let (mean, standard_error) = mean_of_frames(shape, cut, mode);
        println!("{name}: {mean} +- {standard_error}");
        // Frames are noisy, but not so noisy that a missing weight would pass.
        assert!((1e-5..2e-3).contains(&standard_error), "{name}: {standard_error}");
        // Four standard errors hold the truth: one test in 16,000 fails by chance, and seeds are fixed.
        assert!((mean - 1.0).abs() < 4.0 * standard_error, "{name}: {mean} +- {standard_error}");
    }
}

#[test]
fn a_number_of_lights_that_is_random_is_not_compensated() {
    let scene = Scene::new(&[POINT]);
    let strategy = everything(&scene.gpu);
    let options = LightingOptions {
        stochastic: Some(0.1),
        compensation: Some(9.0),
        ..LightingOptions::default()
    };
    let lighting = Lighting::new(&scene.renderer, strategy.as_ref(), Mode::Deferred, options);
    let error = lighting.err().unwrap().to_string();
    assert!(error.contains("compensation is on: it must be off"), "{error}");
}
