//! Specular terms beyond their lights' ranges: the bound of the lobe, the image against the reference and against no
//! culling, and what is refused.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Everything, Frame, Gpu, Light,
    LightBuffer, LightLists, LightSource, Lookup, Needs, Passes, lobe_peak,
};
use assign_clustered::{ClusterOptions, Clustered, Occupancy, Slices};
use glam::{DVec3, Vec3};
use scenes::Scene;
use shading::{
    Cut, HdrImage, Lighting, LightingOptions, Mode, Renderer, count_operations,
    record_before_lighting,
    reference::{Reflectance, Surface, light_contribution, reaching_contribution, reflect_light},
    traced::{GBufferSamples, TracedScene},
};

const SIZE: [u32; 2] = [64, 48];
/// The most ranges that a specular term reaches in these tests.
const MOST: f32 = 6.0;

/// The brightest specular term of a black surface, times the cosine of incidence, over directions to a light around the
/// mirror direction and towards the horizon.
fn brightest(roughness: f64, f0: f64, cos_v: f64) -> f64 {
    let surface = Surface {
        base_color: DVec3::ZERO,
        metallic: 0.0,
        normal: DVec3::Z,
        roughness,
        dielectric: Reflectance { f0: DVec3::splat(f0), f90: 1.0 },
    };
    let to_eye = DVec3::new((1.0 - cos_v * cos_v).max(0.0).sqrt(), 0.0, cos_v);
    let mut brightest = 0.0_f64;
    // Tilts of the half vector, from a millionth of a radian to a right angle, in the plane of the eye and out of it.
    for step in -60..=60_i32 {
        let tilt = f64::from(step.signum()) * 1e-6 * 1.57e6_f64.powf(f64::from(step.abs()) / 60.0);
        for turn in [0.0, 0.5, 1.2_f64] {
            let (sin, cos) = tilt.sin_cos();
            let half = DVec3::new(sin * turn.cos(), sin * turn.sin(), cos);
            let to_light = 2.0 * half.dot(to_eye) * half - to_eye;
            if to_light.z > 0.0 {
                brightest = brightest.max(reflect_light(&surface, to_eye, to_light).x);
            }
        }
    }
    brightest
}

/// The bound holds everywhere, is reached somewhere, and is nowhere looser than stated.
#[test]
fn the_peak_bounds_every_lobe() {
    // With F0 of 0.04 or more; less has no bound, because the lobe itself vanishes.
    const LOOSEST: f64 = 4.1;
    let (mut tightest, mut loosest, mut polished) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for roughness in [0.0, 0.045, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0] {
        for f0 in [0.0, 0.04, 0.2, 0.6, 1.0] {
            // The BRDF takes no cosine below 1e-4.
            for cos_v in [1e-4, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0] {
                let (bound, seen) =
                    (lobe_peak(roughness, f0, cos_v), brightest(roughness, f0, cos_v));
                let what = format!("roughness {roughness}, F0 {f0}, cos {cos_v}");
                assert!(bound >= seen * (1.0 - 1e-9), "{what}: {bound} < {seen}");
                tightest = tightest.min(bound / seen);
                if f0 >= 0.04 {
                    assert!(bound <= LOOSEST * seen, "{what}: {bound} > {LOOSEST} x {seen}");
                    loosest = loosest.max(bound / seen);
                    if roughness <= 0.3 {
                        polished = polished.max(bound / seen);
                    }
                }
            }
        }
    }
    println!("tightest {tightest:.4}, loosest {loosest:.2}, of roughness up to 0.3 {polished:.2}");
    // A bound 1 % lower would fail.
    assert!(tightest < 1.01, "{tightest}");
}

/// The showcase with a polished floor, a rough wall, and metal of a roughness in between.
fn scene() -> Scene {
    let mut scene = common::showcase();
    scene.materials[0].roughness = 0.15;
    scene.materials[3].roughness = 0.3;
    scene
}

/// Points, spots and virtual point lights with ranges far shorter than the scene, and no area light.
fn lights() -> Vec<Light> {
    let shorter = |light: Light| Light {
        range_m: 0.35 * light.range_m,
        intensity: 0.2 * light.intensity,
        ..light
    };
    common::lights(70).into_iter().map(shorter).collect()
}

fn options(reach: Option<f32>) -> LightingOptions {
    let kinds = assign::LightKinds { spots: true, ..Default::default() };
    LightingOptions { kinds, specular_reach: reach, ..LightingOptions::default() }
}

fn draw(
    renderer: &mut Renderer,
    gpu: &Gpu,
    strategy: &mut dyn Assignment,
    mode: Mode,
    options: LightingOptions,
) -> HdrImage {
    let view = common::view(SIZE);
    let lights = LightBuffer::new(gpu, &lights()).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let lighting = Lighting::new(renderer, strategy, mode, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(&view, &lights);
    strategy.prepare(gpu, &frame).unwrap();
    record_before_lighting(renderer, mode, strategy, &frame, &mut passes);
    lighting.record(renderer, &view, strategy, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap()
}

fn clusters(gpu: &Gpu, source: LightSource, slices: Slices, reach: Option<f32>) -> Clustered {
    let settings = CullSettings { source, ..CullSettings::default() };
    let (size, bounds) = ("8x8x16".parse().unwrap(), Bounds::Explicit);
    let plain = ClusterOptions::new(size, bounds, Occupancy::Sparse, settings);
    Clustered::with_options(gpu, ClusterOptions { slices, reach, ..plain }).unwrap()
}

/// A strategy that claims to list lights as far as shading wants.
struct Claims(Clustered);

impl Assignment for Claims {
    fn id(&self) -> String {
        self.0.id()
    }

    fn needs(&self) -> Needs {
        self.0.needs()
    }

    fn specular_reach(&self) -> f32 {
        f32::INFINITY
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self(self.0.view(gpu)?)))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.0.prepare(gpu, frame)
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.0.record(frame, passes);
    }

    fn lookup(&self) -> Lookup<'_> {
        self.0.lookup()
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.0.bind_group()
    }

    fn lists(&self) -> &LightLists {
        self.0.lists()
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        self.0.lists_mut()
    }

    fn memory_bytes(&self) -> u64 {
        self.0.memory_bytes()
    }
}

#[test]
fn clusters_show_the_image_of_no_culling() {
    let gpu = common::gpu();
    let mut renderer = Renderer::new(&gpu, &scene(), &common::view(SIZE)).unwrap();
    let [linear, bvh] = [LightSource::Linear, LightSource::Hierarchy];
    for mode in [Mode::Deferred, Mode::Forward] {
        let mut none = Everything::new(&gpu).unwrap();
        let mut image = |strategy: &mut dyn Assignment, reach| {
            draw(&mut renderer, &gpu, strategy, mode, options(reach))
        };
        let reference = image(&mut none, Some(MOST));
        let near = image(&mut none, None);
        let differing =
            |image: &HdrImage, of: &HdrImage| image.difference(of).unwrap().differing_channels;
        // The option lights what ranges leave dark.
        let gained = differing(&reference, &near);
        assert!(gained > 1_000, "{mode:?}: {gained}");
        for (source, slices) in
            [(linear, Slices::Exponential), (bvh, Slices::Exponential), (bvh, Slices::Cascaded(2))]
        {
            let mut strategy = clusters(&gpu, source, slices, Some(MOST));
            let what = format!("{mode:?}, {}", strategy.id());
            assert_eq!(differing(&image(&mut strategy, Some(MOST)), &reference), 0, "{what}");
            // No reach is served too.
            assert_eq!(differing(&image(&mut strategy, None), &near), 0, "{what}");
            if slices != Slices::Exponential {
                continue;
            }
            // Negative control: lists that end before what they claim.
            for too_short in [None, Some(0.97 * MOST)] {
                let mut faulty = Claims(clusters(&gpu, source, slices, too_short));
                let lost = differing(&image(&mut faulty, Some(MOST)), &reference);
                assert!(lost > 0, "{what}: lists out to {too_short:?} ranges");
            }
        }
    }
}

#[test]
fn the_image_is_that_of_the_reference() {
    let gpu = common::gpu();
    let scene = scene();
    let view = common::view(SIZE);
    let mut renderer = Renderer::new(&gpu, &scene, &view).unwrap();
    let mut none = Everything::new(&gpu).unwrap();
    let image = draw(&mut renderer, &gpu, &mut none, Mode::Deferred, options(Some(MOST)));
    let samples = GBufferSamples::read(&renderer, &view).unwrap();
    let traced = TracedScene::new(&scene);
    let (mut sum, mut error, mut without) = (0.0, 0.0, 0.0);
    for (ix, pixel) in image.pixels.iter().enumerate() {
        let Some(sample) = samples.sample(ix, &traced) else { continue };
        let (at, surface, to_eye) = (sample.position, &sample.surface, sample.to_eye);
        let far = |light: &Light| reaching_contribution(light, at, surface, to_eye, MOST.into());
        let near = |light: &Light| light_contribution(light, at, surface, to_eye);
        let shown = Vec3::from_slice(&pixel[..3]).as_dvec3() - sample.emission;
        let expected: DVec3 = lights().iter().map(far).sum();
        sum += expected.element_sum();
        error += (shown - expected).abs().element_sum();
        let plain: DVec3 = lights().iter().map(near).sum();
        without += (shown - plain).abs().element_sum();
    }
    assert!(sum > 10.0 && error < 2e-3 * sum, "error {error}, sum {sum}");
    assert!(without > 20.0 * error, "error {error}, and {without} without the reach");
}

#[test]
fn what_cannot_reach_is_refused() {
    let gpu = common::gpu();
    let view = common::view(SIZE);
    let lights = LightBuffer::new(&gpu, &lights()).unwrap();
    let mut renderer = Renderer::new(&gpu, &scene(), &view).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let mut plain = clusters(&gpu, LightSource::Linear, Slices::Exponential, None);
    let shorter = clusters(&gpu, LightSource::Linear, Slices::Exponential, Some(4.0));
    let none = Everything::new(&gpu).unwrap();
    let refused = |strategy: &dyn Assignment, options| {
        Lighting::new(&renderer, strategy, Mode::Deferred, options).unwrap_err().to_string()
    };
    let reaching = options(Some(MOST));
    let error = refused(&plain, reaching);
    assert!(error.ends_with("its lists hold lights out to their range"), "{error}");
    let error = refused(&shorter, reaching);
    assert!(error.ends_with("its lists hold lights out to 4 ranges"), "{error}");
    let error = refused(&none, options(Some(0.5)));
    assert_eq!(error, "specular reach is 0.5: it must be 1 to 64, in ranges of a light");
    for (options, field) in [
        (LightingOptions { cut: Cut::Never, ..reaching }, "cut is never: "),
        (LightingOptions { compensation: Some(4.0), ..reaching }, "compensation is 4: "),
        (LightingOptions { stochastic: Some(0.1), ..reaching }, "stochastic threshold is 0.1: "),
    ] {
        let error = refused(&none, options);
        assert!(error.starts_with(field) && error.contains("with a specular reach"), "{error}");
    }
    let frame = renderer.frame(&view, &lights);
    plain.prepare(&gpu, &frame).unwrap();
    let error = count_operations(&renderer, &plain, &frame, reaching, 1.0).unwrap_err();
    assert!(error.to_string().starts_with("specular reach is 6: "), "{error}");
}
