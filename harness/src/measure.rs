//! One method in one mode: its times, its lists and its image.

use std::time::{Duration, Instant};

use assign::{Assignment, Counters, EncoderPasses, Gpu};
use shading::{HdrImage, LightBvh, Lighting, ListsTruth, Mode, probe, record_before_lighting};

use crate::{
    clock::PassClock,
    error::HarnessError,
    registry::Method,
    results::{PassKind, PassTimes, Passes},
    stage::Stage,
};

/// What was measured.
pub struct Measurement {
    /// Times per pass.
    pub passes: Passes,
    /// The last frame's radiance.
    pub image: HdrImage,
    /// The lists of the last frame; `None` for a method without lists.
    pub lists: Option<ListsFigures>,
}

/// What was counted of the lists.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListsFigures {
    /// Groups.
    pub groups: u64,
    /// The culling kernel's counters.
    pub counters: Counters,
    /// Bytes of the lists on the GPU.
    pub bytes: u64,
    /// The truth on the CPU, where asked for.
    pub truth: Option<ListsTruth>,
    /// Frames on the clock that followed one in which a group overflowed.
    pub overflowed_frames: u32,
}

/// How many frames to draw.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    /// Before the clock starts; after it at least [`warm_up`](Self::warm_up) has passed too.
    pub warmup: u32,
    /// For how long to warm up at least: clocks fall while a device waits for the CPU.
    pub warm_up: Duration,
    /// On the clock.
    pub timed: u32,
}

/// Frames added to a warm-up while lists still overflow, at most.
const MAX_SETTLING: u32 = 8;

impl Frames {
    /// Whether frame number `drawn`, from 1, belongs on the clock. Without a warm-up all do.
    fn is_warm(&self, drawn: u32, elapsed: Duration, settled: bool) -> bool {
        if self.warmup == 0 {
            return true;
        }
        let settled = settled || drawn > self.warmup + MAX_SETTLING;
        drawn > self.warmup && elapsed >= self.warm_up && settled
    }
}

/// Draws the frames of one method and mode. `tick` is called after each that is timed, and once
/// after the lists were checked.
pub fn measure(
    gpu: &Gpu,
    stage: &mut Stage,
    method: &mut Method,
    mode: Mode,
    frames: Frames,
    truth: Option<&LightBvh<'_>>,
    tick: &mut dyn FnMut(),
) -> Result<Measurement, HarnessError> {
    stage.renderer.prepare(&stage.view, &stage.lights)?;
    let mut clock = PassClock::new(gpu);
    let mut samples: Vec<(String, PassKind, Vec<f64>)> = Vec::new();
    let lighting = match method {
        Method::Lists(strategy) => {
            Some(Lighting::new(&stage.renderer, strategy.as_ref(), mode, stage.lights.has_spots())?)
        }
        Method::Clay => None,
    };
    let mut overflowed_frames = 0;
    let mut drawn = 0;
    let warm = Instant::now();
    let mut timed = 0;
    while timed < frames.timed {
        let settled = match (&mut *method, &lighting) {
            (Method::Lists(strategy), Some(lighting)) => {
                draw(gpu, stage, strategy.as_mut(), lighting, mode, &mut clock)?;
                // The counters of the frame before: this one grew the pool to what it asked for.
                strategy.lists().stats().is_none_or(|c| c.overflowed_groups == 0)
            }
            _ => {
                stage.renderer.record_depth(&stage.view, &mut clock);
                stage.renderer.record_clay(&stage.view, &mut clock);
                true
            }
        };
        let times = clock.finish()?;
        drawn += 1;
        if frames.is_warm(drawn, warm.elapsed(), settled) {
            collect(&mut samples, times);
            overflowed_frames += u32::from(!settled);
            timed += 1;
            tick();
        }
    }
    let image = HdrImage::read(gpu, stage.renderer.targets(), stage.view.viewport)?;
    let lists = match method {
        Method::Lists(strategy) => {
            Some(count(gpu, stage, strategy.as_ref(), mode, truth, overflowed_frames)?)
        }
        Method::Clay => None,
    };
    tick();
    let passes = samples
        .into_iter()
        .map(|(name, kind, samples)| (name, PassTimes::new(kind, samples)))
        .collect();
    Ok(Measurement { passes, image, lists })
}

/// One frame: geometry, the strategy's passes, lighting.
fn draw(
    gpu: &Gpu,
    stage: &Stage,
    strategy: &mut dyn Assignment,
    lighting: &Lighting,
    mode: Mode,
    clock: &mut PassClock,
) -> Result<(), HarnessError> {
    let frame = stage.renderer.frame(&stage.view, &stage.lights);
    strategy.prepare(gpu, &frame)?;
    record_before_lighting(&stage.renderer, mode, strategy, &frame, clock);
    lighting.record(&stage.renderer, &stage.view, strategy, clock)?;
    Ok(())
}

fn collect(samples: &mut Vec<(String, PassKind, Vec<f64>)>, times: Vec<(String, f64)>) {
    for (name, ms) in times {
        match samples.iter_mut().find(|(known, ..)| *known == name) {
            Some((.., list)) => list.push(ms),
            None => {
                let kind = match name.as_str() {
                    "depth" | "gbuffer" => PassKind::Scene,
                    "shade" | "clay" => PassKind::Shade,
                    _ => PassKind::Assign,
                };
                samples.push((name, kind, vec![ms]));
            }
        }
    }
}

/// Reads the lists of the last frame back and checks them.
fn count(
    gpu: &Gpu,
    stage: &Stage,
    strategy: &dyn Assignment,
    mode: Mode,
    truth: Option<&LightBvh<'_>>,
    overflowed_frames: u32,
) -> Result<ListsFigures, HarnessError> {
    let snapshot = strategy.lists().snapshot(gpu)?;
    let truth = match truth {
        None => None,
        Some(bvh) => {
            if mode == Mode::Forward {
                // The probe reads normals, which forward shading does not draw.
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let mut passes = EncoderPasses { encoder: &mut encoder };
                stage.renderer.record_gbuffer(&stage.view, &mut passes);
                gpu.queue.submit([encoder.finish()]);
            }
            let frame = stage.renderer.frame(&stage.view, &stage.lights);
            Some(bvh.check(&probe(&stage.renderer, strategy, &frame)?, &snapshot))
        }
    };
    Ok(ListsFigures {
        groups: u64::from(strategy.lists().group_count()),
        counters: snapshot.counters,
        bytes: strategy.lists().bytes(),
        truth,
        overflowed_frames,
    })
}
