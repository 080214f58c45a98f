//! Tests whole frames of a small scene, on this machine's adapter.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{
    Assignment, Emitter, EncoderPasses, Everything, Gpu, Light, LightBuffer, LightKinds, View,
};
use glam::{DVec3, Vec3};
use shading::{
    AreaModel, HdrImage, LightBvh, Lighting, LightingOptions, Mode, Renderer, Samples, probe,
    record_before_lighting, record_for_probe,
};

fn options(kinds: LightKinds) -> LightingOptions {
    LightingOptions { kinds, ..LightingOptions::default() }
}

/// A frame lit by every light: its image and its samples.
fn draw(gpu: &Gpu, view: &View, lights: &LightBuffer, mode: Mode) -> (HdrImage, Samples) {
    let mut renderer = Renderer::new(gpu, &common::showcase(), view).unwrap();
    renderer.prepare(view, lights).unwrap();
    let mut strategy = Everything::new(gpu).unwrap();
    let lighting = Lighting::new(&renderer, &strategy, mode, options(lights.kinds())).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(view, lights);
    strategy.prepare(gpu, &frame).unwrap();
    record_before_lighting(&renderer, mode, &mut strategy, &frame, &mut passes);
    lighting.record(&renderer, view, &strategy, &mut passes).unwrap();
    if mode.is_forward() {
        record_for_probe(&renderer, view, &strategy, &mut passes);
    }
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap();
    let samples = probe(&renderer, &strategy, &frame).unwrap();
    (image, samples)
}

#[test]
fn deferred_and_forward_agree_up_to_the_g_buffers_precision() {
    let gpu = common::gpu();
    let view = common::view([96, 64]);
    let lights = LightBuffer::new(&gpu, &common::lights(40)).unwrap();
    let (deferred, samples) = draw(&gpu, &view, &lights, Mode::Deferred);
    let (forward, _) = draw(&gpu, &view, &lights, Mode::Forward);
    assert!(samples.positions.len() > 3_000, "{} samples", samples.positions.len());
    let mean = |image: &HdrImage| {
        image.pixels.iter().flatten().map(|v| f64::from(*v)).sum::<f64>()
            / image.pixels.len() as f64
    };
    let off = |deferred: &HdrImage| {
        let pairs = deferred.pixels.iter().flatten().zip(forward.pixels.iter().flatten());
        pairs.map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / forward.pixels.len() as f64
    };
    assert!(mean(&forward) > 0.01, "the image is dark: {}", mean(&forward));
    // Colours have eight bits and normals are half floats: 2 % of the mean is accepted.
    let most = 0.02 * mean(&forward);
    assert!(off(&deferred) < most, "difference {}, mean {}", off(&deferred), mean(&forward));
    // Leaving out ten of the 40 lights must be visible.
    let fewer = LightBuffer::new(&gpu, &common::lights(40)[10..]).unwrap();
    let (fewer, _) = draw(&gpu, &view, &fewer, Mode::Deferred);
    assert!(off(&fewer) > most, "difference {}, mean {}", off(&fewer), mean(&forward));
}

/// The showcase has holes cut by alpha masks. Without a pre-pass, forward lighting cuts them
/// itself.
#[test]
fn a_pre_pass_and_ids_in_the_g_buffer_change_no_bit() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &common::lights(40)).unwrap();
    let mut standard = common::view([96, 64]);
    standard.depth = assign::DepthMapping::Standard;
    standard.far_m = Some(100.0);
    let oblique = common::oblique([96, 64]);
    let mask =
        View::look_at(Vec3::new(-1.5, 1.0, 0.2), Vec3::new(-1.5, 1.0, -1.0), 1.0, 0.05, [64, 64]);
    for (name, view) in [
        ("reversed", common::view([96, 64])),
        ("standard", standard),
        ("mask", mask),
        ("oblique", oblique),
    ] {
        for pair in [[Mode::Forward, Mode::ForwardNoPrepass], [Mode::Deferred, Mode::DeferredIds]] {
            let [(reference, samples), (image, _)] =
                pair.map(|mode| draw(&gpu, &view, &lights, mode));
            assert!(samples.positions.len() > 1_000, "{name}: {}", samples.positions.len());
            let brightest = image.pixels.iter().flatten().fold(0.0_f32, |a, b| a.max(*b));
            assert!(brightest > 0.01, "{name}, {pair:?}: the image is dark");
            let difference = image.difference(&reference).unwrap();
            assert_eq!(difference.differing_channels, 0, "{name}, {pair:?}: {difference:?}");
        }
    }
}

#[test]
fn positions_lie_on_the_surfaces() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let mut orthographic = common::view([96, 64]);
    orthographic.projection = assign::Projection::Orthographic {
        min: glam::Vec2::new(-3.0, -2.0),
        max: glam::Vec2::new(3.0, 2.0),
    };
    orthographic.near_m = 0.0;
    orthographic.far_m = Some(30.0);
    let mut standard = common::view([96, 64]);
    standard.depth = assign::DepthMapping::Standard;
    standard.far_m = Some(100.0);
    standard.jitter = glam::Vec2::new(0.3, -0.2);
    let mut offset = common::view([64, 48]);
    offset.viewport.x = 13;
    offset.viewport.y = 7;
    for (name, view) in [
        ("reversed infinite", common::view([96, 64])),
        ("orthographic", orthographic),
        ("standard, jittered", standard),
        ("viewport with an offset", offset),
        ("oblique", common::oblique([96, 64])),
    ] {
        let (_, samples) = draw(&gpu, &view, &lights, Mode::Deferred);
        assert!(samples.positions.len() > 1_000, "{name}: {}", samples.positions.len());
        let triangles: Vec<[Vec3; 3]> = common::showcase().world_triangles().collect();
        for position in &samples.positions {
            let point = DVec3::from(position.map(f64::from));
            let nearest =
                triangles.iter().map(|t| plane_distance(point, t)).fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 2e-4,
                "{name}: {position:?} is {nearest} m off every triangle's plane"
            );
        }
    }
}

fn plane_distance(point: DVec3, triangle: &[Vec3; 3]) -> f64 {
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    (point - a).dot((b - a).cross(c - a).normalize()).abs()
}

#[test]
fn the_check_accepts_full_lists_and_finds_a_dropped_light() {
    let gpu = common::gpu();
    let view = common::view([64, 48]);
    let lights = LightBuffer::new(&gpu, &common::lights(30)).unwrap();
    let (_, samples) = draw(&gpu, &view, &lights, Mode::Deferred);
    let mut strategy = Everything::new(&gpu).unwrap();
    let frame = assign::Frame::new(&view, &lights);
    strategy.prepare(&gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let mut lists = strategy.lists().snapshot(&gpu).unwrap();
    let bvh = LightBvh::new(lights.lights());
    let truth = bvh.check(&samples, &lists, false);
    assert!(truth.contributing > 1_000, "{truth:?}");
    assert_eq!(truth.missed, 0);
    assert_eq!(truth.listed, truth.samples * 30);
    lists.lists[0].count -= 1;
    assert!(bvh.check(&samples, &lists, false).missed > 0, "a dropped light must be missed");
}

#[test]
fn without_lights_only_emission_shows() {
    let gpu = common::gpu();
    let view = common::view([48, 32]);
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    for mode in [Mode::Deferred, Mode::Forward] {
        let (image, _) = draw(&gpu, &view, &lights, mode);
        let brightest = image.pixels.iter().flatten().fold(0.0_f32, |a, b| a.max(*b));
        assert!(brightest > 0.001 && brightest <= 0.021, "{mode:?}: {brightest}");
    }
}

#[test]
fn clay_is_drawn_without_lists() {
    let gpu = common::gpu();
    let view = common::view([48, 32]);
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(&view, &mut passes);
    renderer.record_clay(&view, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(&gpu, renderer.targets(), view.viewport).unwrap();
    let drawn = image.pixels.iter().filter(|p| p[0] > 0.05).count();
    assert!(drawn > 500, "{drawn} pixels");
}

#[test]
fn the_alpha_mask_has_holes() {
    let gpu = common::gpu();
    let view =
        View::look_at(Vec3::new(-1.5, 1.0, 0.2), Vec3::new(-1.5, 1.0, -1.0), 1.0, 0.05, [64, 64]);
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let (_, samples) = draw(&gpu, &view, &lights, Mode::Deferred);
    let on_mask = samples.positions.iter().filter(|p| (p[2] + 1.0).abs() < 1e-3).count();
    let through = samples.positions.iter().filter(|p| p[2] < -1.5).count();
    assert!(on_mask > 1_000 && through > 1_000, "{on_mask} on the mask, {through} through it");
}

#[test]
fn every_pipeline_passes_validation_without_a_gpu() {
    let gpu = Gpu::noop().unwrap();
    let view = common::view([32, 32]);
    let renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let strategy = Everything::new(&gpu).unwrap();
    for mode in Mode::ALL {
        for kinds in LightKinds::ALL {
            Lighting::new(&renderer, &strategy, mode, options(kinds)).unwrap();
        }
    }
}

/// The image of no culling under `count` copies of a light, or the error.
fn copies(gpu: &Gpu, light: Light, count: u32, area: AreaModel) -> Result<HdrImage, String> {
    let view = common::view([8, 8]);
    let lights = LightBuffer::new(gpu, &vec![light; count as usize]).unwrap();
    let mut renderer = Renderer::new(gpu, &common::showcase(), &view).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let mut strategy = Everything::new(gpu).unwrap();
    let options = LightingOptions { area, ..options(lights.kinds()) };
    let lighting = Lighting::new(&renderer, &strategy, Mode::Deferred, options).unwrap();
    let frame = renderer.frame(&view, &lights);
    strategy.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    record_before_lighting(&renderer, Mode::Deferred, &mut strategy, &frame, &mut passes);
    let recorded = lighting.record(&renderer, &view, &strategy, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    recorded.map_err(|e| e.to_string())?;
    Ok(HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap())
}

#[test]
fn more_lights_than_a_loop_can_sum_are_an_error() {
    let gpu = common::gpu();
    let Some(most) = gpu.max_loop_rounds() else {
        println!("skipped: nothing bounds a loop on {}", gpu.info.name);
        return;
    };
    let point = common::lights(1)[0];
    copies(&gpu, point, most, AreaModel::default()).unwrap();
    let error = copies(&gpu, point, most + 1, AreaModel::default()).unwrap_err();
    assert!(error.contains("65536"), "{error}");
}

/// As many area lights as are accepted all light a sample.
#[test]
fn as_many_area_lights_as_are_accepted_are_all_summed() {
    let gpu = common::gpu();
    let lamp = Emitter::rectangle(Vec3::X * 0.2, Vec3::Y * 0.2).two_sided();
    let light = Light::area(lamp, Vec3::new(0.0, 1.5, 1.0), 20.0, Vec3::splat(0.01));
    // Their loops are those of the table and of the polynomials.
    let is_own = |model: &AreaModel| {
        !matches!(
            model,
            AreaModel::LtcHammon
                | AreaModel::LtcUnsplit
                | AreaModel::LtcPerLight
                | AreaModel::LtcPolynomialPerLight
        )
    };
    for model in AreaModel::ALL.into_iter().filter(is_own) {
        let sum = |count| -> Result<f64, String> {
            let image = copies(&gpu, light, count, model)?;
            Ok(image.pixels.iter().map(|p| f64::from(p[0])).sum())
        };
        let (mut most, mut refused) = (16, 65_536);
        while refused - most > 64 {
            let middle = (most + refused) / 2;
            *if sum(middle).is_ok() { &mut most } else { &mut refused } = middle;
        }
        let dark = sum(0).unwrap();
        let [one, all] = [1, most].map(|count| sum(count).unwrap() - dark);
        let ratio = all / one / f64::from(most);
        assert!(one > 1e-6 && (ratio - 1.0).abs() < 1e-2, "{model}: {most} lights, {ratio}");
    }
}

#[test]
fn sizes_out_of_range_are_errors() {
    let gpu = common::gpu();
    let view = common::view([100_000, 8]);
    let error = Renderer::new(&gpu, &common::showcase(), &view).err().unwrap().to_string();
    assert!(error.contains("100000x8"), "{error}");
}
