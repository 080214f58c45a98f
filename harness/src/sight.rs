//! Finds out whether a view can test light lists at all.
//!
//! A view that shows no surface has no samples, so every list is right and every image is black. The same
//! holds if no light reaches a visible surface. Such a run proves no method exact, ranks none and recommends
//! none.

use assign::{Assignment, EncoderPasses, Everything, Gpu};
use rayon::prelude::*;
use shading::{LightBvh, Samples, probe, record_for_probe};

use crate::{error::HarnessError, moving::known_lights, results::Untested, stage::Stage};

/// Samples to test against every light before building a hierarchy over the lights.
const TRIED: usize = 64;

/// Why neither the stage's view nor one of `poses` (of `count` along the path) tests anything. `None` if a
/// light reaches a sample in one of them. Leaves the camera at the last pose that was tested.
pub fn untested(
    gpu: &Gpu,
    stage: &mut Stage,
    poses: &[u32],
    count: u32,
) -> Result<Option<Untested>, HarnessError> {
    stage.prepare()?;
    let mut why = untested_here(gpu, stage)?;
    for &pose in poses {
        if why.is_none() {
            break;
        }
        stage.go_to(pose, count)?;
        // If one view shows surfaces, the missing light is the reason.
        why = match (why, untested_here(gpu, stage)?) {
            (Some(unlit @ (Untested::NoLight | Untested::OnlySuns)), Some(_)) => Some(unlit),
            (_, here) => here,
        };
    }
    Ok(why)
}

/// Why the current view tests nothing.
fn untested_here(gpu: &Gpu, stage: &Stage) -> Result<Option<Untested>, HarnessError> {
    let samples = samples(gpu, stage)?;
    if samples.positions.is_empty() {
        return Ok(Some(Untested::NoSurface));
    }
    let lights = known_lights(gpu, &stage.lights)?;
    let step = samples.positions.len().div_ceil(TRIED);
    let is_reached = |point: &[f32; 3]| {
        let point = glam::Vec3::from(*point).as_dvec3();
        lights.iter().any(|light| light.reach(point) > 0.0)
    };
    if samples.positions.par_iter().step_by(step).any(is_reached) {
        return Ok(None);
    }
    if !lights.is_empty() {
        let bvh = LightBvh::new(&lights);
        let is_reached = |point: &[f32; 3]| {
            let mut any = false;
            bvh.lights_at(*point, |_, _| any = true);
            any
        };
        if samples.positions.par_iter().any(is_reached) {
            return Ok(None);
        }
    }
    Ok(Some(if stage.suns.is_empty() { Untested::NoLight } else { Untested::OnlySuns }))
}

/// The samples of the view: visible surfaces, one per pixel.
fn samples(gpu: &Gpu, stage: &Stage) -> Result<Samples, HarnessError> {
    let Stage { renderer, view, lights, .. } = stage;
    let mut strategy = Everything::new(gpu)?;
    let frame = renderer.frame(view, lights);
    strategy.prepare(gpu, &frame)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    record_for_probe(renderer, view, &strategy, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    Ok(probe(renderer, &strategy, &frame)?)
}
