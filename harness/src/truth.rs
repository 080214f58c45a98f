//! `lightbench truth`: renders on the CPU, from the triangles, what a view should look like.
//!
//! Without shadows, the shading pipeline approximates this image. Then the same light on the surfaces of the
//! G-buffer shows the error of the G-buffer's formats.

use std::path::Path;
use std::time::Instant;

use assign::{EncoderPasses, Gpu, Light};
use indicatif::{ProgressBar, ProgressStyle};
use shading::traced::{
    self, GBufferSamples, Paths, SurfaceSample, TracedScene, Transport, TruthSettings, truth_image,
};
use shading::{EDGE, HdrImage, luminance};

use crate::{
    against_image,
    bench::Bench,
    checks::remove_stale,
    cli::{CliError, TruthArgs},
    described::note_faults,
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    machine::machine,
    messages::say,
    moving::known_lights,
    out_folder::OutFolder,
    results::{Errors, Results, Truth, TruthImage, TruthLevel, Untested, write_atomically},
    sight::untested,
    stage::Stage,
};

/// The picture of the standard error is white at this share of the mean luminance.
const WHITE: f64 = 0.01;

/// Files of a truth image.
const RAW: &str = "truth.exr";
const IMAGE: &str = "truth.png";
const ERROR_IMAGE: &str = "error.png";
const RAW_ERROR: &str = "error.exr";

/// Renders a truth image into its folder; returns what to print. `command` is the command line, for
/// provenance.
pub fn truth(args: &TruthArgs, command: Vec<String>) -> Result<String, HarnessError> {
    check(args)?;
    let _held = OutFolder::hold(&args.out, &command)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let results = render(&mut bench, args, command)?;
    let data = args.out.join("results.json");
    results.write(&data)?;
    let summary = results.truth_image.as_ref().map(summary).unwrap_or_default();
    let notes: String =
        results.truth.notes.iter().map(|note| format!("note     {note}\n")).collect();
    Ok(format!("{summary}{notes}data     {}\n", data.display()))
}

/// Checks the options before a device is opened.
fn check(args: &TruthArgs) -> Result<(), CliError> {
    if args.stage.motion.is_on_gpu() {
        let accepted = "cpu, because the CPU renders the truth";
        return Err(CliError::out_of_range("--moved-by", "gpu", accepted));
    }
    if args.bounces > 0 && !args.shadows {
        let accepted = "0 without --shadows, because reflected light needs shadows";
        return Err(CliError::out_of_range("--bounces", &args.bounces.to_string(), accepted));
    }
    if args.indirect && args.bounces == 0 {
        let needs = "--bounces 1 or more, or the image would be black";
        return Err(CliError::without_effect("indirect", needs));
    }
    if args.matte_bounces && !(args.bounces == 1 && args.stage.bounce.primary) {
        let needs = "--primary and --bounces 1, the light that --vpls approximates";
        return Err(CliError::without_effect("matte-bounces", needs));
    }
    Ok(())
}

/// `truth    atrium, 3 lights, 640x360, no shadows, 0 bounces: standard error 0 % of the mean, 12.3 s`.
fn summary(image: &TruthImage) -> String {
    format!(
        "truth    {}, {} lights, {}x{}, {}, {} {}{}: standard error {:.3} % of the mean, {:.1} s\n",
        image.scene,
        image.lights,
        image.width,
        image.height,
        match (image.shadows, image.is_separated) {
            (false, _) => "no shadows",
            (true, false) => "shadows",
            (true, true) => "separated shadows",
        },
        image.bounces,
        if image.bounces == 1 { "bounce" } else { "bounces" },
        if image.is_indirect { ", indirect light alone" } else { "" },
        image.standard_error * 100.0,
        image.seconds
    )
}

/// Renders a truth image into the folder of `args`; returns its results.
pub fn render(
    bench: &mut Bench,
    args: &TruthArgs,
    command: Vec<String>,
) -> Result<Results, HarnessError> {
    check(args)?;
    let other = against_image::open(args.against.as_deref(), args.stage.size)?;
    let gpu = bench.gpu().clone();
    let stage = bench.stage(&args.stage)?;
    remove_stale(&args.out)?;
    let began = Instant::now();
    let scene = TracedScene::new(&stage.scene);
    let image = trace(&gpu, stage, &scene, args)?;
    let seconds = began.elapsed().as_secs_f64();
    let notes = notes(scene.emissive_count(), args);
    drop(scene);
    let mut truth = keep(stage, args, &image, seconds)?;
    if let Some(other) = other {
        let (found, line) = other.compare("truth", &image.radiance);
        say(line.trim_end());
        truth.against_errors = found;
    }
    if !args.shadows {
        truth.gbuffer_errors = gbuffer_errors(&gpu, stage, args, &image)?;
    }
    let level = Truth { level: TruthLevel::None, edge_tolerance: EDGE, notes };
    let mut results = Results::new(machine(&gpu), command, level);
    note_faults(&mut results, stage);
    let why = untested(&gpu, stage, &[], 0)?.filter(|why| *why != Untested::OnlySuns);
    if let Some(why) = why {
        let why = why.words(stage.light_count(), false);
        let warning = format!("NO DIRECT LIGHT: {why}");
        say(format!("warning  {warning}"));
        results.warnings.insert(0, warning);
    }
    results.truth_image = Some(truth);
    Ok(results)
}

/// The visible surfaces as the G-buffer stores them.
fn surfaces(gpu: &Gpu, stage: &mut Stage) -> Result<GBufferSamples, HarnessError> {
    stage.prepare()?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    stage.renderer.record_depth(&stage.view, &mut passes);
    stage.renderer.record_gbuffer(&stage.view, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    Ok(GBufferSamples::read(&stage.renderer, &stage.view)?)
}

/// Notes for readers of the image.
fn notes(emissive_triangles: usize, args: &TruthArgs) -> Vec<String> {
    let is_dark = emissive_triangles > 0 && args.bounces == 0;
    let note = "surfaces that emit light no others: --shadows --bounces 1 adds their light";
    is_dark.then(|| note.to_owned()).into_iter().collect()
}

/// The errors from rounding depth and G-buffer: the same light on their surfaces, compared with the truth.
fn gbuffer_errors(
    gpu: &Gpu,
    stage: &mut Stage,
    args: &TruthArgs,
    truth: &traced::TruthImage,
) -> Result<Errors, HarnessError> {
    let samples = surfaces(gpu, stage)?;
    let scene = TracedScene::new(&stage.scene);
    let sample_of = |pixel| samples.sample(pixel, &scene);
    let settings = settings(stage, args, Transport::Unshadowed);
    let lights = known_lights(gpu, &stage.lights)?;
    let image = lit((stage, &lights), &scene, sample_of, settings, "through the G-buffer");
    let exposure = truth.radiance.auto_exposure();
    let pair = ImagePair { image: &image.radiance, reference: &truth.radiance, exposure };
    Ok(stored(errors(&pair)))
}

/// Direct light, and bounces if the options ask for them.
fn trace(
    gpu: &Gpu,
    stage: &Stage,
    scene: &TracedScene<'_>,
    args: &TruthArgs,
) -> Result<traced::TruthImage, HarnessError> {
    let view = stage.view;
    let width = view.viewport.width as usize;
    let sample_of = |pixel| scene.primary(&view, [(pixel % width) as u32, (pixel / width) as u32]);
    let lights = &*known_lights(gpu, &stage.lights)?;
    let traced = |transport, message| {
        lit((stage, lights), scene, sample_of, settings(stage, args, transport), message)
    };
    let bounce = || traced(Transport::Bounce, "bounces");
    if args.indirect {
        return Ok(bounce());
    }
    let direct = match (args.shadows, args.separated) {
        (false, _) => Transport::Unshadowed,
        (true, false) => Transport::Direct,
        (true, true) => Transport::Separated,
    };
    let image = traced(direct, "direct light");
    match args.bounces {
        0 => Ok(image),
        _ => Ok(image.plus(&bounce())?),
    }
}

fn settings(stage: &Stage, args: &TruthArgs, transport: Transport) -> TruthSettings {
    // Each transport has its own random numbers, so that their errors are independent.
    let of_transport = if transport == Transport::Bounce { 2 } else { 1 };
    let seed = args.sample_seed.unwrap_or(args.stage.seed);
    TruthSettings {
        paths: Paths { count: args.samples, bounces: args.bounces, is_matte: args.matte_bounces },
        area_samples: args.samples,
        suns: stage.suns,
        seed: seed.wrapping_mul(2).wrapping_add(of_transport),
        ..TruthSettings::new(transport)
    }
}

/// Evaluates lights at the stage's samples, with a progress bar.
fn lit(
    (stage, lights): (&Stage, &[Light]),
    scene: &TracedScene<'_>,
    sample_of: impl Fn(usize) -> Option<SurfaceSample> + Sync,
    settings: TruthSettings,
    message: &'static str,
) -> traced::TruthImage {
    let viewport = stage.view.viewport;
    let bar = progress_bar(u64::from(viewport.height));
    bar.set_message(message);
    let progress = |done: u32, _| bar.set_position(u64::from(done));
    let size = [viewport.width, viewport.height];
    let image = truth_image(scene, lights, size, sample_of, settings, &progress);
    bar.finish_and_clear();
    image
}

fn progress_bar(rows: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} rows, {eta} left  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(rows).with_style(style)
}

/// Writes the image, its picture and that of its standard error.
fn keep(
    stage: &Stage,
    args: &TruthArgs,
    image: &traced::TruthImage,
    seconds: f64,
) -> Result<TruthImage, HarnessError> {
    let traced::TruthImage { radiance, standard_error } = image;
    let exposure = radiance.auto_exposure();
    let mean = mean_of(radiance, |luminance| luminance);
    let error = mean_of(standard_error, |luminance| luminance * luminance).sqrt();
    let over_mean = |value: f64| if value == 0.0 { 0.0 } else { value / mean };
    let out: &Path = &args.out;
    write_atomically(&out.join(IMAGE), &radiance.to_png(exposure)?)?;
    let black = HdrImage { pixels: vec![[0.0; 3]; radiance.pixels.len()], ..*standard_error };
    let gain = ((over_mean(1.0) / WHITE) as f32).min(f32::MAX);
    write_atomically(&out.join(ERROR_IMAGE), &standard_error.difference_png(&black, gain)?)?;
    write_atomically(&out.join(RAW), &radiance.to_exr()?)?;
    write_atomically(&out.join(RAW_ERROR), &standard_error.to_exr()?)?;
    Ok(TruthImage {
        scene: stage.scene.name.clone(),
        scene_hash: stage.scene_hash.clone(),
        lights: stage.light_count(),
        width: radiance.width,
        height: radiance.height,
        raw: RAW.to_owned(),
        image: IMAGE.to_owned(),
        error_image: ERROR_IMAGE.to_owned(),
        raw_error: Some(RAW_ERROR.to_owned()),
        exposure: f64::from(exposure),
        standard_error: over_mean(error),
        shadows: args.shadows,
        bounces: args.bounces,
        is_separated: args.separated,
        is_indirect: args.indirect,
        is_matte: args.matte_bounces,
        samples: args.samples,
        sample_seed: Some(args.sample_seed.unwrap_or(args.stage.seed)),
        gbuffer_errors: Errors::new(),
        against_errors: Errors::new(),
        seconds,
    })
}

/// The mean over pixels of a value of their luminance.
fn mean_of(image: &HdrImage, value: impl Fn(f64) -> f64) -> f64 {
    let sum: f64 = image.pixels.iter().map(|pixel| value(luminance(pixel))).sum();
    sum / image.pixels.len().max(1) as f64
}
