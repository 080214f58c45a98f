//! `lightbench truth`: what a view should look like, rendered on the CPU from the surfaces that the
//! GPU drew.

use std::path::Path;
use std::time::Instant;

use assign::{EncoderPasses, Gpu};
use indicatif::{ProgressBar, ProgressStyle};
use shading::traced::{self, GBufferSamples, TracedScene, Transport, TruthSettings, truth_image};
use shading::{EDGE, HdrImage, luminance};

use crate::{
    checks::remove_stale,
    cli::{CliError, TruthArgs},
    compare::{Bench, note_faults},
    error::HarnessError,
    machine::machine,
    messages::say,
    out_folder::OutFolder,
    results::{Results, Truth, TruthImage, TruthLevel, write_atomically},
    sight::untested,
    stage::Stage,
};

/// Where the standard error is this share of the mean luminance, its picture is white.
const WHITE: f64 = 0.01;

/// Files of a truth image.
const RAW: &str = "truth.exr";
const IMAGE: &str = "truth.png";
const ERROR_IMAGE: &str = "error.png";

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
    Ok(format!("{summary}data     {}\n", data.display()))
}

/// What is wrong with the words shows before a device is opened.
fn check(args: &TruthArgs) -> Result<(), CliError> {
    if args.bounces > 0 && !args.shadows {
        let accepted = "0, or given with --shadows: what is reflected is shadowed";
        return Err(CliError::out_of_range("--bounces", &args.bounces.to_string(), accepted));
    }
    if args.indirect && args.bounces == 0 {
        let accepted = "given with --bounces 1: nothing else would be left";
        return Err(CliError::new(format!("--indirect: it must be {accepted}")));
    }
    Ok(())
}

/// `truth    atrium, 3 lights, 640x360, no shadows, 0 bounces: standard error 0 % of the mean, 12.3 s`.
fn summary(image: &TruthImage) -> String {
    format!(
        "truth    {}, {} lights, {}x{}, {}, {} bounces{}: standard error {:.3} % of the mean, {:.1} s\n",
        image.scene,
        image.lights,
        image.width,
        image.height,
        if image.shadows { "shadows" } else { "no shadows" },
        image.bounces,
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
    let gpu = bench.gpu().clone();
    let stage = bench.stage(&args.stage)?;
    remove_stale(&args.out)?;
    let samples = surfaces(&gpu, stage)?;
    let began = Instant::now();
    let image = trace(stage, &samples, args)?;
    let truth = keep(stage, args, &image, began.elapsed().as_secs_f64())?;
    let level = Truth { level: TruthLevel::None, edge_tolerance: EDGE, notes: Vec::new() };
    let mut results = Results::new(machine(&gpu), command, level);
    note_faults(&mut results, stage);
    if let Some(why) = untested(&gpu, stage, &[], 0)? {
        let why = why.words(u64::from(stage.lights.count()), false);
        let warning = format!("NOTHING IS LIT directly: {why}");
        say(format!("warning  {warning}"));
        results.warnings.insert(0, warning);
    }
    results.truth_image = Some(truth);
    Ok(results)
}

/// The surfaces that the pixels show, as shading sees them.
fn surfaces(gpu: &Gpu, stage: &mut Stage) -> Result<GBufferSamples, HarnessError> {
    stage.prepare()?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    stage.renderer.record_depth(&stage.view, &mut passes);
    stage.renderer.record_gbuffer(&stage.view, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    Ok(GBufferSamples::read(&stage.renderer, &stage.view)?)
}

/// Direct light, and one bounce where it is asked for.
fn trace(
    stage: &Stage,
    samples: &GBufferSamples,
    args: &TruthArgs,
) -> Result<traced::TruthImage, HarnessError> {
    let scene = TracedScene::new(&stage.scene);
    let size = [samples.width, samples.height];
    let render = |transport, message| {
        let settings = TruthSettings {
            bounce_samples: args.samples,
            area_samples: args.samples,
            // Other numbers for each: their errors are independent.
            seed: if transport == Transport::Bounce { 2 } else { 1 },
            suns: stage.suns,
            ..TruthSettings::new(transport)
        };
        let bar = progress_bar(u64::from(samples.height));
        bar.set_message(message);
        let progress = |done: u32, _| bar.set_position(u64::from(done));
        let lights = stage.lights.lights();
        let sample_of = |pixel| samples.sample(pixel, &scene);
        let image = truth_image(&scene, lights, size, sample_of, settings, &progress);
        bar.finish_and_clear();
        image
    };
    let direct = if args.shadows { Transport::Direct } else { Transport::Unshadowed };
    let bounce = || render(Transport::Bounce, "one bounce");
    if args.indirect {
        return Ok(bounce());
    }
    let image = render(direct, "direct light");
    match args.bounces {
        0 => Ok(image),
        _ => Ok(image.plus(&bounce())?),
    }
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
    Ok(TruthImage {
        scene: stage.scene.name.clone(),
        scene_hash: stage.scene_hash.clone(),
        lights: u64::from(stage.lights.count()),
        width: radiance.width,
        height: radiance.height,
        raw: RAW.to_owned(),
        image: IMAGE.to_owned(),
        error_image: ERROR_IMAGE.to_owned(),
        exposure: f64::from(exposure),
        standard_error: over_mean(error),
        shadows: args.shadows,
        bounces: args.bounces,
        is_indirect: args.indirect,
        samples: args.samples,
        seconds,
    })
}

/// The mean over pixels of a value of their luminance.
fn mean_of(image: &HdrImage, value: impl Fn(f64) -> f64) -> f64 {
    let sum: f64 = image.pixels.iter().map(|pixel| value(luminance(pixel))).sum();
    sum / image.pixels.len().max(1) as f64
}
