//! `lightbench cdi`: deep images of a scene, built, timed, and compared with exact rays.

use std::time::Instant;

use assign::{Gpu, Light};
use assign_cdi::{DeepImages, RandomRanges, RangeCaster, RangeRule, Triangles};
use scenes::{Scene, primary_light};
use shading::{EDGE, Renderer, WorldTriangles, rsm_view, traced::TracedScene};

use crate::{
    checks::{check_writable, remove_stale},
    cli::CdiArgs,
    clock::{PassClock, PassTime},
    compare::{Bench, DEFAULT_FRAMES, is_warm},
    deep::{build, figures, settings_of, settle},
    error::HarnessError,
    machine::machine,
    pass_samples::PassSamples,
    range_errors::{range_errors, seen_points},
    results::{CastTimes, DeepImageRun, Results, Truth, TruthLevel, median},
    vpls::{all_texels, points_of},
};

/// Runs it, writes its results, and returns what to print. `command` is the command line, for
/// provenance.
pub fn cdi(args: &CdiArgs, command: Vec<String>) -> Result<String, HarnessError> {
    settings_of(&args.deep)?;
    check_writable(&args.out)?;
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
    let settings = settings_of(&args.deep)?;
    let gpu = bench.gpu().clone();
    let (scene, triangles) = bench.triangles(&args.scene, args.scene_scale)?;
    remove_stale(&args.out)?;
    let triangles = triangles_of(triangles);
    let mut images = DeepImages::new(&gpu, settings)?;
    settle(&gpu, &mut images, &triangles)?;
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
            let of = |is_corrected| {
                let rule = RangeRule { is_corrected, ..rule };
                range_errors(&gpu, &images, &traced, &points, rule).map(Some)
            };
            [of(false)?, of(true)?]
        }
    };
    let run = DeepImageRun {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        triangles: scene.triangle_count(),
        deep: figures(&images, &args.deep),
        passes: passes.finish(),
        casts,
        range_errors: plain,
        corrected_errors: corrected,
    };
    let level = Truth { level: TruthLevel::None, edge_tolerance: EDGE, notes: Vec::new() };
    let mut results = Results::new(machine(&gpu), command, level);
    results.warnings.extend(scene.warnings.iter().cloned());
    results.deep_images = Some(run);
    Ok(results)
}

/// The buffer of a scene's triangles, as deep images take it.
pub fn triangles_of(triangles: &WorldTriangles) -> Triangles<'_> {
    Triangles {
        positions: &triangles.positions,
        count: triangles.count,
        bounds_world: triangles.bounds_world,
    }
}

/// Times of `frames` builds.
fn time(
    gpu: &Gpu,
    images: &mut DeepImages,
    triangles: &Triangles<'_>,
    frames: u32,
) -> Result<PassSamples, HarnessError> {
    let mut samples = PassSamples::default();
    let mut clock = PassClock::new(gpu);
    let (began, mut built) = (Instant::now(), 0);
    while !is_warm(gpu, built, began) {
        images.prepare(gpu, triangles)?;
        build(gpu, images)?;
        built += 1;
    }
    for _ in 0..frames {
        images.prepare(gpu, triangles)?;
        images.record(&mut clock);
        samples.collect(clock.finish()?);
    }
    Ok(samples)
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
        let [mut cast_ms, mut corrected_ms, mut random_ms] = [const { Vec::new() }; 3];
        let mut clock = PassClock::new(gpu);
        let (began, mut warm) = (Instant::now(), 0);
        while (cast_ms.len() as u32) < frames {
            random.record(&mut clock);
            let random = clock.finish()?;
            caster.record(images, &mut clock)?;
            let cast = clock.finish()?;
            corrected.record(images, &mut clock)?;
            let corrected = clock.finish()?;
            warm += 1;
            if is_warm(gpu, warm - 1, began) {
                let ms = |times: Vec<PassTime>| times.into_iter().map(|(_, ms)| ms);
                random_ms.extend(ms(random));
                cast_ms.extend(ms(cast));
                corrected_ms.extend(ms(corrected));
            }
        }
        let lights = u64::from(vpls.read_counts(gpu)?.chosen);
        all.push(CastTimes {
            rsm_px,
            is_middle,
            lights,
            rays: args.rays,
            cast_ms,
            corrected_ms,
            random_ms,
        });
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
    let together = median(&run.passes.per_frame_ms(None));
    text += &format!("         {:<14} {together:.4} ms\n", "together");
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
