//! `lightbench cdi`: deep images of a scene, built, timed, and compared with exact rays.

use assign::{EncoderPasses, Gpu};
use assign_cdi::{DeepImages, Triangles};
use scenes::Scene;
use shading::{EDGE, WorldTriangles};

use crate::{
    checks::{check_writable, remove_stale},
    cli::CdiArgs,
    clock::PassClock,
    compare::{Bench, DEFAULT_FRAMES},
    deep::{figures, settings_of, settle},
    error::HarnessError,
    machine::machine,
    pass_samples::PassSamples,
    results::{DeepImageRun, Results, Truth, TruthLevel, median},
};

/// Builds before the clock starts, on a GPU.
const WARMUP: u32 = 16;

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
    let run = DeepImageRun {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        triangles: scene.triangle_count(),
        deep: figures(&images, &args.deep),
        passes: passes.finish(),
        casts: Vec::new(),
        range_errors: None,
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
    let warmup = if gpu.is_software() { 0 } else { WARMUP };
    for _ in 0..warmup {
        images.prepare(gpu, triangles)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        images.record(&mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
    }
    for _ in 0..frames {
        images.prepare(gpu, triangles)?;
        images.record(&mut clock);
        samples.collect(clock.finish()?);
    }
    Ok(samples)
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
    text += &format!("         {:<14} {:.4} ms\n", "together", median(&run.passes.per_frame_ms(None)));
    text
}

#[allow(unused)]
fn unused(_: &Scene) {}
