//! Tests methods without lists against no culling, and the models of pixels.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use std::f32::consts::FRAC_PI_4;

use assign::{
    Assignment, CullSettings, DepthMapping, EncoderPasses, Everything, Gpu, Light, LightBuffer,
    LightShape, Projection, Suns, View,
};
use assign_model::PerModel;
use glam::{Vec2, Vec3};
use shading::{
    AreaModel, Cut, HdrImage, Lighting, LightingOptions, Mode, RASTER_SPHERE_TOLERANCE,
    RasterSpheres, Renderer, ShadowModel, probe, record_before_lighting, record_for_probe,
};

/// Points, spots, one light around the camera, and one that reaches in from beyond any far plane.
fn lights(view: &View) -> Vec<Light> {
    let mut lights = common::lights(60);
    for light in lights.iter_mut().step_by(3) {
        light.shape = LightShape::Spot {
            direction: Vec3::new(0.3, -1.0, 0.2).normalize(),
            inner_angle: 0.3,
            outer_angle: FRAC_PI_4,
        };
    }
    lights.push(Light::point(view.eye(), 3.0, Vec3::ONE));
    lights.push(Light::point(Vec3::new(0.0, 1.0, -40.0), 41.0, Vec3::splat(30.0)));
    lights
}

fn views() -> Vec<(&'static str, View)> {
    let perspective = common::view([96, 64]);
    let orthographic = View {
        projection: Projection::Orthographic {
            min: Vec2::new(-3.0, -2.0),
            max: Vec2::new(3.0, 2.0),
        },
        near_m: 0.0,
        far_m: Some(30.0),
        ..perspective
    };
    let standard =
        View { depth: DepthMapping::Standard, far_m: Some(20.0), ..common::view([96, 64]) };
    let mut offset = common::view([64, 48]);
    (offset.viewport.x, offset.viewport.y) = (13, 7);
    vec![
        ("reversed infinite", perspective),
        ("orthographic", orthographic),
        ("standard", standard),
        ("viewport with an offset", offset),
        ("oblique", common::oblique([96, 64])),
    ]
}

const EVALUATE_ALL: f32 = LightingOptions::EVALUATE_ALL;

/// The image of no culling. Lights at or under `exit_weight` are skipped.
fn everything(
    gpu: &Gpu,
    renderer: &mut Renderer,
    view: &View,
    lights: &LightBuffer,
    mode: Mode,
    exit_weight: f32,
) -> HdrImage {
    let options =
        LightingOptions { kinds: lights.kinds(), exit_weight, ..LightingOptions::default() };
    image_of(gpu, renderer, view, lights, mode, options)
}

/// The image of no culling with the given options.
fn image_of(
    gpu: &Gpu,
    renderer: &mut Renderer,
    view: &View,
    lights: &LightBuffer,
    mode: Mode,
    options: LightingOptions,
) -> HdrImage {
    renderer.prepare(view, lights).unwrap();
    let mut strategy = Everything::new(gpu).unwrap();
    let lighting = Lighting::new(renderer, &strategy, mode, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(view, lights);
    strategy.prepare(gpu, &frame).unwrap();
    record_before_lighting(renderer, mode, &mut strategy, &frame, &mut passes);
    lighting.record(renderer, view, &strategy, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
}

#[test]
fn an_early_exit_changes_no_bit() {
    let gpu = common::gpu();
    for (name, view) in views() {
        let lights = LightBuffer::new(&gpu, &lights(&view)).unwrap();
        let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
        for mode in [Mode::Deferred, Mode::Forward] {
            let mut image = |exit| everything(&gpu, &mut renderer, &view, &lights, mode, exit);
            let reference = image(EVALUATE_ALL);
            let mut differs = |exit| {
                let difference = image(exit).difference(&reference).unwrap();
                println!("{name}, {mode:?}, {exit}: {difference:?}");
                difference.differing_channels
            };
            assert_eq!(differs(0.0), 0, "{name}, {mode:?}");
            // The number reaches the shader: a greater one skips lights that add something.
            assert!(differs(0.1) > 0, "{name}, {mode:?}");
        }
    }
}

#[test]
fn compensation_divides_by_the_number_of_lights() {
    let gpu = common::gpu();
    let view = common::view([48, 32]);
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let light = Light::vpl(Vec3::new(0.0, 3.0, 1.0), Vec3::NEG_Y, 30.0, Vec3::ONE);
    for mode in [Mode::Deferred, Mode::Forward] {
        let mut image = |count: usize, compensation| {
            let lights = LightBuffer::new(&gpu, &vec![light; count]).unwrap();
            let options =
                LightingOptions { kinds: lights.kinds(), compensation, ..Default::default() };
            image_of(&gpu, &mut renderer, &view, &lights, mode, options)
        };
        let one = image(1, None);
        assert!(one.pixels.iter().flatten().sum::<f32>() > 1.0, "{mode:?}");
        for (count, target) in [(1, 1.0), (2, 1.0), (4, 1.0)] {
            let difference = image(count, Some(target)).difference(&one).unwrap();
            assert!(difference.max_rel < 1e-5, "{mode:?}, {count}: {difference:?}");
        }
        // The factor is at most four, and nothing changes while compensation is off.
        let eight = image(8, Some(1.0)).difference(&one).unwrap();
        assert!((eight.max_rel - 1.0).abs() < 1e-5, "{mode:?}: {eight:?}");
        assert!(image(2, None).difference(&one).unwrap().max_rel > 0.9, "{mode:?}");
    }
}

#[test]
fn raster_spheres_show_the_image_of_no_culling() {
    let gpu = common::gpu();
    if !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
        println!("skipped: {} does not blend 32-bit floats", gpu.info.name);
        return;
    }
    let cuts = [Cut::Windowed, Cut::Hard];
    for ((name, view), cut) in views().into_iter().flat_map(|view| cuts.map(|cut| (view, cut))) {
        let all = lights(&view);
        let lights = LightBuffer::new(&gpu, &all).unwrap();
        let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
        // Test once with suns, which are drawn in a separate pass.
        let suns = if name == "orthographic" { common::suns() } else { Suns::default() };
        let options = LightingOptions {
            kinds: lights.kinds(),
            exit_weight: EVALUATE_ALL,
            cut,
            suns,
            ..LightingOptions::default()
        };
        let reference = image_of(&gpu, &mut renderer, &view, &lights, Mode::Deferred, options);
        let spheres = RasterSpheres::new(
            &renderer,
            lights.kinds(),
            AreaModel::default(),
            cut,
            suns,
            ShadowModel::None,
        )
        .unwrap();
        let draw = |lights: &LightBuffer| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            renderer.record_depth(&view, &mut passes);
            renderer.record_gbuffer(&view, &mut passes);
            spheres.record(&renderer, &view, lights, &mut passes).unwrap();
            gpu.queue.submit([encoder.finish()]);
            HdrImage::read(&gpu, renderer.targets(), view.viewport).unwrap()
        };
        let difference = draw(&lights).difference(&reference).unwrap();
        println!("{name}, {cut:?}: {difference:?}");
        assert!(difference.max_rel <= RASTER_SPHERE_TOLERANCE, "{name}: {difference:?}");
        // Leaving out the camera's own light must be visible.
        let fewer = LightBuffer::new(&gpu, &all[..60]).unwrap();
        let difference = draw(&fewer).difference(&reference).unwrap();
        assert!(difference.max_rel > 10.0 * RASTER_SPHERE_TOLERANCE, "{name}: {difference:?}");
    }
}

/// Suns are added once to every sample, in every mode, whatever the lists hold.
#[test]
fn suns_light_every_sample_in_every_mode() {
    let gpu = common::gpu();
    let view = common::view([48, 32]);
    let lights = LightBuffer::new(&gpu, &common::lights(20)).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    for mode in Mode::ALL {
        let mut image = |lights: &LightBuffer, exit_weight, suns| {
            let options =
                LightingOptions { kinds: lights.kinds(), exit_weight, suns, ..Default::default() };
            image_of(&gpu, &mut renderer, &view, lights, mode, options)
        };
        let both = image(&lights, EVALUATE_ALL, common::suns());
        let exits = image(&lights, 0.0, common::suns()).difference(&both).unwrap();
        assert_eq!(exits.differing_channels, 0, "{mode:?}: {exits:?}");
        let none = LightBuffer::new(&gpu, &[]).unwrap();
        let apart = [
            image(&lights, 0.0, Suns::default()),
            image(&none, 0.0, common::suns()),
            image(&none, 0.0, Suns::default()),
        ];
        let (mut sunlit, mut pixels) = (0, 0);
        for (ix, sum) in both.pixels.iter().enumerate() {
            for (channel, sum) in sum.iter().enumerate() {
                let [lamps, suns, emitted] = [0, 1, 2].map(|i| apart[i].pixels[ix][channel]);
                let expected = lamps + suns - emitted;
                assert!((sum - expected).abs() <= 1e-5 * expected + 1e-6, "{mode:?}");
                sunlit += usize::from(suns > emitted);
                pixels += 1;
            }
        }
        assert!(sunlit > pixels / 3, "{mode:?}: {sunlit} of {pixels}");
    }
}

#[test]
fn both_modes_find_the_models_of_their_pixels() {
    let gpu = common::gpu();
    let view = common::view([96, 64]);
    let lights = LightBuffer::new(&gpu, &common::lights(40)).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    for mode in [Mode::Deferred, Mode::Forward] {
        let reference = everything(&gpu, &mut renderer, &view, &lights, mode, EVALUATE_ALL);
        let mut strategy = PerModel::new(&gpu, Some(0.7), CullSettings::default()).unwrap();
        let options = LightingOptions { kinds: lights.kinds(), ..LightingOptions::default() };
        let lighting = Lighting::new(&renderer, &strategy, mode, options).unwrap();
        let frame = renderer.frame(&view, &lights);
        strategy.prepare(&gpu, &frame).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        record_before_lighting(&renderer, mode, &mut strategy, &frame, &mut passes);
        lighting.record(&renderer, &view, &strategy, &mut passes).unwrap();
        record_for_probe(&renderer, &view, &strategy, &mut passes);
        gpu.queue.submit([encoder.finish()]);
        let image = HdrImage::read(&gpu, renderer.targets(), view.viewport).unwrap();
        let difference = image.difference(&reference).unwrap();
        assert_eq!(difference.differing_channels, 0, "{mode:?}: {difference:?}");
        // Every pixel lies in its model's box, and there are several models.
        let mut groups = probe(&renderer, &strategy, &frame).unwrap().groups;
        groups.sort_unstable();
        groups.dedup();
        assert!(groups.len() > 8 && groups.iter().all(|&g| g != assign::ALL_LIGHTS), "{groups:?}");
    }
}
