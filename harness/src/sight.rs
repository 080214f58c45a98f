//! Whether what is drawn puts lists to a test at all.
//!
//! A view that shows no surface has no sample, so any list is right and any image is black. The same holds
//! where no light reaches what it shows. Nothing may be called exact, ranked or advised from such a run.

use assign::{Assignment, EncoderPasses, Everything, Gpu};
use rayon::prelude::*;
use shading::{LightBvh, Samples, probe, record_for_probe};

use crate::{error::HarnessError, results::Untested, stage::Stage};

/// Samples that are tried against every light before a hierarchy over the lights is built.
const TRIED: usize = 64;

/// Why neither the stage's view nor one of some poses along the path, of `count`, tests anything; `None`
/// where a light reaches a sample in one. Leaves the camera at the pose that was looked at last.
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
        // Where surfaces are seen from somewhere, the lights are to blame.
        why = match (why, untested_here(gpu, stage)?) {
            (Some(unlit @ (Untested::NoLight | Untested::OnlySuns)), Some(_)) => Some(unlit),
            (_, here) => here,
        };
    }
    Ok(why)
}

/// The same of the view alone.
fn untested_here(gpu: &Gpu, stage: &Stage) -> Result<Option<Untested>, HarnessError> {
    let samples = samples(gpu, stage)?;
    if samples.positions.is_empty() {
        return Ok(Some(Untested::NoSurface));
    }
    let lights = stage.lights.lights();
    let step = samples.positions.len().div_ceil(TRIED);
    let is_reached = |point: &[f32; 3]| {
        let point = glam::Vec3::from(*point).as_dvec3();
        lights.iter().any(|light| light.reach(point) > 0.0)
    };
    if samples.positions.par_iter().step_by(step).any(is_reached) {
        return Ok(None);
    }
    if !lights.is_empty() {
        let bvh = LightBvh::new(lights);
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

/// The surfaces that the pixels show.
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
