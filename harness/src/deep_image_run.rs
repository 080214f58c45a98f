//! `lightbench cdi`: deep images of a scene, built, timed, and compared with exact rays.

use assign::{EncoderPasses, Gpu, Light};
use assign_cdi::{DeepImages, RandomRanges, RangeCaster, RangeRule, Triangles};
use scenes::{Scene, primary_light};
use shading::{EDGE, Renderer, rsm_view, traced::TracedScene};

use crate::{
    bench::Bench,
    checks::remove_stale,
    cli::CdiArgs,
    clock::{PassClock, PassTime},
    deep::{DeepChoice, triangles_of},
    drift::{WarmUp, unsteady},
    error::HarnessError,
    machine::machine,
    out_folder::OutFolder,
    pass_samples::PassSamples,
    range_errors::{range_errors, seen_points},
    results::{CastTimes, DeepImageRun, Passes, Results, Truth, TruthLevel, median},
    schedule::DEFAULT_FRAMES,
    vpls::{all_texels, points_of},
};

/// Runs it, writes its results, and returns what to print. `command` is the command line, for
/// provenance.
pub fn cdi(args: &CdiArgs, command: Vec<String>) -> Result<String, HarnessError> {
    DeepChoice::of_ranges(&args.deep).settings()?;
    let _held = OutFolder::hold(&args.out, &command)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let results = measure(&mut bench, args, command)?;
    let data = args.out.join("results.json");
    results.write(&data)?;
    let summary = results.deep_images.as_ref().map(summary).unwrap_or_default();
    Ok(format!("{summary}data     {}\n", data.display()))
}

/// Builds, casts and compares; returns the results.
pub fn measure(
    bench: &mut Bench,
    args: &CdiArgs,
    command: Vec<String>,
) -> Result<Results, HarnessError> {
    let deep = DeepChoice::of_ranges(&args.deep);
    let settings = deep.settings()?;
    let gpu = bench.gpu().clone();
    let (scene, triangles) = bench.triangles(&args.scene, args.scene_scale)?;
    remove_stale(&args.out)?;
    let triangles = triangles_of(triangles);
    let mut images = DeepImages::new(&gpu, settings)?;
    images.settle(&gpu, &triangles)?;
    let frames = args.frames.unwrap_or(DEFAULT_FRAMES[usize::from(gpu.is_software())]);
    let passes = time(&gpu, &mut images, &triangles, frames)?;
    let primary = primary_light(scene);
    let casts = casts(&gpu, scene, primary, &images, args, frames)?;
    let rule = RangeRule { rays: args.rays, ..RangeRule::default() };
    let [plain, corrected] = match args.compared {
        0 => [None, None],
        rays => {
            let traced = TracedScene::new(scene);
            let points =
                seen_points(&traced, &scene.path, rays.div_ceil(args.rays) as usize, args.seed);
            let measured = |is_corrected| {
                let rule = RangeRule { is_corrected, ..rule };
                range_errors(&gpu, &images, &traced, &points, rule).map(Some)
            };
            [measured(false)?, measured(true)?]
        }
    };
    let run = DeepImageRun {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        triangles: scene.triangle_count(),
        deep: deep.figures(&images),
        passes,
        casts,
        range_errors: plain,
        corrected_errors: corrected,
    };
    let level = Truth { level: TruthLevel::None, edge_tolerance: EDGE, notes: Vec::new() };
    let mut results = Results::new(machine(&gpu), command, level);
    results.warnings.extend(scene.warnings.iter().cloned());
    results.warnings.extend(refused_times(&run));
    results.deep_images = Some(run);
    Ok(results)
}

/// Builds in a row, without a pause, that keep a GPU busy before each timed frame of a warm-up.
const BUSY: u32 = 8;

/// How often times are taken again where they drifted.
const ATTEMPTS: u32 = 3;

/// Times of `frames` builds on a warm device. Times that drift are taken again; the last are kept
/// whatever they do, and [`refused_times`] says so.
fn time(
    gpu: &Gpu,
    images: &mut DeepImages,
    triangles: &Triangles<'_>,
    frames: u32,
) -> Result<Passes, HarnessError> {
    let mut clock = PassClock::new(gpu);
    let mut last = Passes::default();
    for _ in 0..ATTEMPTS {
        let mut warm_up = WarmUp::new(gpu.is_software());
        let mut samples = PassSamples::default();
        for warm in [true, false] {
            let mut drawn = 0;
            while if warm { !warm_up.is_warm() } else { drawn < frames } {
                images.prepare(gpu, triangles)?;
                if warm && !gpu.is_software() {
                    keep_busy(gpu, |passes| images.record(passes));
                }
                images.record(&mut clock);
                let times = clock.finish()?;
                drawn += 1;
                match warm {
                    true => warm_up.feed(sum(&times)),
                    false => samples.collect(times),
                }
            }
        }
        last = samples.finish();
        if unsteady(&last.per_frame_ms(None)).is_none() {
            break;
        }
    }
    Ok(last)
}

/// All passes of a frame together, ms.
fn sum(times: &[PassTime]) -> f64 {
    times.iter().map(|(_, ms)| ms).sum()
}

/// Submits the same work several times, and does not wait.
fn keep_busy(gpu: &Gpu, mut record: impl FnMut(&mut EncoderPasses<'_>)) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for _ in 0..BUSY {
        record(&mut EncoderPasses { encoder: &mut encoder });
    }
    gpu.queue.submit([encoder.finish()]);
}

/// What a reader has to know of times that drifted: a report leaves them out of its verdicts.
fn refused_times(run: &DeepImageRun) -> Vec<String> {
    let build = run.unsteady().map(|why| format!("times of the build are refused: {why}"));
    let casts = run.casts.iter().filter_map(|cast| {
        let why = cast.unsteady()?;
        Some(format!("times of rays from {0} x {0} pixels are refused: {why}", cast.rsm_px))
    });
    build.into_iter().chain(casts).collect()
}

/// Times of giving a range to a light a pixel of shadow maps, by rays and at random.
fn casts(
    gpu: &Gpu,
    scene: &Scene,
    primary: Light,
    images: &DeepImages,
    args: &CdiArgs,
    frames: u32,
) -> Result<Vec<CastTimes>, HarnessError> {
    let Some(&first) = args.casts.0.first() else { return Ok(Vec::new()) };
    let view = rsm_view(&primary, first, (scene.bounds.min, scene.bounds.max))?;
    let renderer = Renderer::new(gpu, scene, &view)?;
    let mut all = Vec::new();
    let whole = args.casts.0.iter().map(|&rsm_px| (rsm_px, false));
    let largest = args.casts.0.iter().max().map(|&rsm_px| (rsm_px, true));
    for (rsm_px, is_middle) in whole.chain(largest) {
        let vpls = all_texels(gpu, scene, &renderer, primary, (rsm_px, is_middle))?;
        let rule = RangeRule { rays: args.rays, ..RangeRule::default() };
        let mut caster = RangeCaster::new(gpu, images, rule)?;
        caster.prepare(gpu, &points_of(&vpls, None))?;
        let twice = RangeRule { is_corrected: true, ..rule };
        let mut corrected = RangeCaster::new(gpu, images, twice)?;
        corrected.prepare(gpu, &points_of(&vpls, None))?;
        let mut random = RandomRanges::new(gpu)?;
        random.prepare(gpu, vpls.ranges_m(), vpls.capacity(), (0.0, 1.0), args.seed as u32)?;
        let lights = u64::from(vpls.read_counts(gpu)?.chosen);
        let mut times =
            CastTimes { rsm_px, is_middle, lights, rays: args.rays, ..CastTimes::default() };
        for _ in 0..ATTEMPTS {
            let casters = (&random, &caster, &corrected);
            [times.random_ms, times.cast_ms, times.corrected_ms] =
                time_casts(gpu, images, casters, frames)?;
            if times.unsteady().is_none() {
                break;
            }
        }
        all.push(times);
    }
    Ok(all)
}

/// Times of `frames` casts on a warm device: random ranges, rays, and corrected rays.
fn time_casts(
    gpu: &Gpu,
    images: &DeepImages,
    (random, caster, corrected): (&RandomRanges, &RangeCaster, &RangeCaster),
    frames: u32,
) -> Result<[Vec<f64>; 3], HarnessError> {
    let mut clock = PassClock::new(gpu);
    let mut warm_up = WarmUp::new(gpu.is_software());
    let mut all = [const { Vec::new() }; 3];
    while (all[0].len() as u32) < frames {
        let is_warm = gpu.is_software() || warm_up.is_warm();
        if !is_warm {
            let mut outcome = Ok(());
            keep_busy(gpu, |passes| outcome = corrected.record(images, passes));
            outcome?;
        }
        random.record(&mut clock);
        let random_ms = sum(&clock.finish()?);
        caster.record(images, &mut clock)?;
        let cast_ms = sum(&clock.finish()?);
        corrected.record(images, &mut clock)?;
        let corrected_ms = sum(&clock.finish()?);
        if is_warm {
            for (list, ms) in all.iter_mut().zip([random_ms, cast_ms, corrected_ms]) {
                list.push(ms);
            }
        } else {
            warm_up.feed(random_ms + cast_ms + corrected_ms);
        }
    }
    Ok(all)
}

/// What was built, and what it took.
fn summary(run: &DeepImageRun) -> String {
    let deep = &run.deep;
    let mut text = format!(
        "cdi      {}, {} triangles: {} directions of {}x{} pixels of {:.3} m, {} fragments, {:.1} MiB\n",
        run.scene,
        run.triangles,
        deep.directions(),
        deep.size_px,
        deep.size_px,
        deep.footprint_m,
        deep.fragments,
        deep.bytes as f64 / f64::from(1 << 20)
    );
    for (pass, times) in run.passes.iter() {
        text += &format!("         {pass:<14} {:.4} ms\n", times.median_ms);
    }
    text += &format!("         {:<14} {:.4} ms\n", "together", run.build_ms());
    for refused in refused_times(run) {
        text += &format!("refused  {refused}\n");
    }
    for cast in &run.casts {
        text += &format!(
            "casts    {} rays of {} lights{}: {:.4} ms, corrected {:.4} ms\n",
            cast.lights * u64::from(cast.rays),
            cast.lights,
            if cast.is_middle { " of the middle" } else { "" },
            median(&cast.cast_ms),
            median(&cast.corrected_ms)
        );
    }
    for (what, errors) in [("", &run.range_errors), (" corrected", &run.corrected_errors)] {
        let Some(errors) = errors else { continue };
        text += &format!(
            "ranges   {}{what} rays: median error {:.3} of a pixel, of lights {:.3}; {:.1} % lost, {:.1} % \
             invented\n",
            errors.rays,
            errors.median(),
            errors.median_range_error,
            errors.lost as f64 / errors.rays.max(1) as f64 * 100.0,
            errors.invented as f64 / errors.rays.max(1) as f64 * 100.0
        );
    }
    text
}
