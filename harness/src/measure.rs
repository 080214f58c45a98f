//! One method in one mode: its times, its lists and its image.

use std::time::{Duration, Instant};

use assign::{Assignment, Counters, EncoderPasses, Gpu, Passes};
use shading::{
    HdrImage, LightBvh, Lighting, LightingOptions, ListsTruth, Mode, RasterSpheres, probe,
    record_before_lighting, record_for_probe,
};

use crate::{
    clock::PassClock,
    error::HarnessError,
    list_lengths::ListLengths,
    registry::Method,
    results::{PassKind, PassTimes},
    stage::Stage,
};

/// What was measured.
pub struct Measurement {
    /// Times per pass.
    pub passes: crate::results::Passes,
    /// The last frame's radiance.
    pub image: HdrImage,
    /// The lists of the last frame; `None` for a method without lists.
    pub lists: Option<ListsFigures>,
}

/// What was counted of the lists.
#[derive(Clone, Debug, Default)]
pub struct ListsFigures {
    /// Groups.
    pub groups: u64,
    /// The culling kernel's counters.
    pub counters: Counters,
    /// Bytes of the lists on the GPU.
    pub bytes: u64,
    /// The truth on the CPU, where asked for.
    pub truth: Option<ListsTruth>,
    /// How long the lists are that samples read; empty where the truth was not asked for.
    pub lengths: ListLengths,
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
    let mut painter = Painter::new(stage, method, mode)?;
    let mut overflowed_frames = 0;
    let mut drawn = 0;
    let warm = Instant::now();
    let mut timed = 0;
    while timed < frames.timed {
        let settled = painter.draw(gpu, stage, mode, &mut clock)?;
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
    let lists = match painter {
        Painter::Lists { strategy, .. } => {
            Some(count(gpu, stage, strategy, mode, truth, overflowed_frames)?)
        }
        Painter::RasterSphere(_) | Painter::Clay => None,
    };
    tick();
    let passes = samples
        .into_iter()
        .map(|(name, kind, samples)| (name, PassTimes::new(kind, samples)))
        .collect();
    Ok(Measurement { passes, image, lists })
}

/// A method with the pipelines that draw with it.
pub enum Painter<'a> {
    /// Lists, and lighting by them.
    Lists {
        /// The strategy.
        strategy: &'a mut dyn Assignment,
        /// Lighting with its look-up.
        lighting: Lighting,
    },
    /// Light volumes.
    RasterSphere(RasterSpheres),
    /// Surfaces alone.
    Clay,
}

impl<'a> Painter<'a> {
    /// Compiles what `method` needs in one mode.
    pub fn new(stage: &Stage, method: &'a mut Method, mode: Mode) -> Result<Self, HarnessError> {
        let spots = stage.lights.has_spots();
        Ok(match method {
            Method::Lists { strategy, early_exit } => {
                let exit_weight = if *early_exit { 0.0 } else { LightingOptions::EVALUATE_ALL };
                let options = LightingOptions { spots, exit_weight };
                let lighting = Lighting::new(&stage.renderer, strategy.as_ref(), mode, options)?;
                Self::Lists { strategy: strategy.as_mut(), lighting }
            }
            Method::RasterSphere => Self::RasterSphere(RasterSpheres::new(&stage.renderer, spots)?),
            Method::Clay => Self::Clay,
        })
    }

    /// Records one frame: geometry, the strategy's passes, lighting. Returns whether no list of
    /// the frame before overflowed.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        stage: &Stage,
        mode: Mode,
        passes: &mut dyn Passes,
    ) -> Result<bool, HarnessError> {
        let Stage { renderer, view, lights, .. } = stage;
        match self {
            Self::Lists { strategy, lighting } => {
                let frame = renderer.frame(view, lights);
                strategy.prepare(gpu, &frame)?;
                record_before_lighting(renderer, mode, *strategy, &frame, passes);
                lighting.record(renderer, view, *strategy, passes)?;
                // The counters of the frame before: this one grew the pool to what it asked for.
                Ok(strategy.lists().stats().is_none_or(|c| c.overflowed_groups == 0))
            }
            Self::RasterSphere(spheres) => {
                renderer.record_depth(view, passes);
                renderer.record_gbuffer(view, passes);
                spheres.record(renderer, view, lights, passes)?;
                Ok(true)
            }
            Self::Clay => {
                renderer.record_depth(view, passes);
                renderer.record_clay(view, passes);
                Ok(true)
            }
        }
    }
}

/// Which bill a pass is on: what the pipeline does not know is a strategy's own.
pub fn pass_kind(name: &str) -> PassKind {
    match name {
        "depth" | "gbuffer" => PassKind::Scene,
        "shade" | "clay" => PassKind::Shade,
        _ => PassKind::Assign,
    }
}

fn collect(samples: &mut Vec<(String, PassKind, Vec<f64>)>, times: Vec<(String, f64)>) {
    for (name, ms) in times {
        match samples.iter_mut().find(|(known, ..)| *known == name) {
            Some((.., list)) => list.push(ms),
            None => {
                let kind = pass_kind(&name);
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
    let mut lengths = ListLengths::default();
    let truth = match truth {
        None => None,
        Some(bvh) => {
            let Stage { renderer, view, lights, .. } = stage;
            if mode == Mode::Forward {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                let mut passes = EncoderPasses { encoder: &mut encoder };
                record_for_probe(renderer, view, strategy, &mut passes);
                gpu.queue.submit([encoder.finish()]);
            }
            let samples = probe(renderer, strategy, &renderer.frame(view, lights))?;
            let pixels = view.viewport.width as usize * view.viewport.height as usize;
            lengths = ListLengths::new(&samples, &snapshot, pixels);
            Some(bvh.check(&samples, &snapshot))
        }
    };
    Ok(ListsFigures {
        groups: u64::from(strategy.lists().group_count()),
        counters: snapshot.counters,
        bytes: strategy.lists().bytes(),
        truth,
        lengths,
        overflowed_frames,
    })
}
