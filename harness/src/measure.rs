//! All methods of a comparison in one mode: their lists and images, then their times, frame by
//! frame in turns.

mod laps;
mod plan;

pub use plan::{Plan, Timetable};

use assign::{Assignment, Counters, EncoderPasses, Gpu, Light, LightBuffer, MAX_RANGE_M};
use shading::{
    Cut, HdrImage, LayerSamples, LightBvh, LightingOptions, ListsTruth, Mode, Operations,
    count_operations, record_for_probe, visit_layer_lists, visit_lists,
};

use crate::{
    clock::PassClock,
    drift::WarmUp,
    error::HarnessError,
    list_lengths::ListLengths,
    moving::{Moving, known_lights, order_bytes},
    painter::Painter,
    pass_samples::PassSamples,
    results::{MissedPair, Passes, Spans},
    schedule::{Orders, frames_of_round, rounds},
    stage::Stage,
    strategy::Method,
};

/// What was counted of the lists.
#[derive(Clone, Debug, Default)]
pub struct ListsFigures {
    /// Groups.
    pub groups: u64,
    /// The culling kernel's counters.
    pub counters: Counters,
    /// Bytes of the lists on the GPU.
    pub bytes: u64,
    /// Bytes of everything that the strategy needs on the GPU, images that are drawn only for it
    /// included.
    pub memory_bytes: u64,
    /// The truth on the CPU, where asked for.
    pub truth: Option<ListsTruth>,
    /// The first missed pair of the truth.
    pub first_missed: Option<MissedPair>,
    /// Of the samples of the truth, those of layers.
    pub layer_samples: u64,
    /// How long the lists are that samples read; empty where the truth was not asked for.
    pub lengths: ListLengths,
    /// Light operations, where they were asked for.
    pub operations: Option<Operations>,
}

/// What a method showed before its times were taken.
pub struct Checked {
    /// Its radiance.
    pub image: HdrImage,
    /// Its lists; `None` for a method without.
    pub lists: Option<ListsFigures>,
}

/// The times of a method.
pub struct Timed {
    /// Times per pass.
    pub passes: Passes,
    /// From first to last pass, frame by frame, where the clock can tell.
    pub spans: Option<Spans>,
    /// Frames on the clock that followed one in which a group overflowed.
    pub overflowed_frames: u32,
}

/// Is handed a frame's number, its images, method by method, and that of no culling.
pub type Compare<'a> = dyn FnMut(u32, &[HdrImage], &HdrImage) -> Result<(), HarnessError> + 'a;

/// Frames in which the pool of a method may grow to what its lists ask for.
const MAX_SETTLING: u32 = 8;

/// One method on its way.
struct Contender<'a> {
    painter: Painter<'a>,
    samples: PassSamples,
    overflowed_frames: u32,
}

/// All methods of a comparison in one mode.
pub struct Contest<'a> {
    gpu: Gpu,
    mode: Mode,
    plan: Plan,
    clock: PassClock,
    contenders: Vec<Contender<'a>>,
    /// That of the first image that was checked.
    exposure: Option<f32>,
}

impl<'a> Contest<'a> {
    /// Compiles what the methods need.
    pub fn new(
        gpu: &Gpu,
        stage: &mut Stage,
        methods: &'a mut [Method],
        mode: Mode,
        plan: Plan,
    ) -> Result<Self, HarnessError> {
        stage.prepare()?;
        let mut contenders = Vec::new();
        for method in methods {
            contenders.push(Contender {
                painter: Painter::new(stage, method, mode, plan.cut)?,
                samples: PassSamples::new(mode),
                overflowed_frames: 0,
            });
        }
        Ok(Self {
            gpu: gpu.clone(),
            mode,
            plan,
            clock: PassClock::new(gpu),
            contenders,
            exposure: None,
        })
    }

    /// Draws one method until none of its lists overflows, reads its image back, and checks its
    /// lists against `truth`.
    pub fn check(
        &mut self,
        stage: &mut Stage,
        method: usize,
        truth: Option<&LightBvh<'_>>,
    ) -> Result<Checked, HarnessError> {
        for drawn in 0..=MAX_SETTLING {
            let settled = self.draw(stage, method)?;
            // The counters of the first frame come back with the second.
            if settled && (drawn > 0 || !self.contenders[method].painter.has_groups()) {
                break;
            }
        }
        let image = read(&self.gpu, stage)?;
        let lists = match &self.contenders[method].painter {
            Painter::Lists { strategy, lighting, .. } => {
                let exposure = *self.exposure.get_or_insert_with(|| image.auto_exposure());
                let seen = self.plan.operations.then(|| (lighting.options(), exposure));
                Some(count(&self.gpu, stage, *strategy, self.mode, truth, seen)?)
            }
            Painter::RasterSphere(_) | Painter::Clay => None,
        };
        Ok(Checked { image, lists })
    }

    /// Takes the times of some methods: round after round, each in turn. `tick` is called after each
    /// frame. Along the path, and where frames that follow each other are compared, `seen` gets the images of
    /// some frames: those of the timed methods, in their order, and that of the reference.
    pub fn time(
        &mut self,
        stage: &mut Stage,
        timetable: Timetable<'_>,
        tick: &mut dyn FnMut(),
        seen: &mut Compare<'_>,
    ) -> Result<(), HarnessError> {
        let Timetable { timed, .. } = timetable;
        let mut orders = Orders::new(timed.len(), self.plan.seed);
        if self.plan.laps > 0 {
            self.compare_along_path(stage, timetable, seen)?;
            return self.time_along_path(stage, timed, &mut orders, tick);
        }
        if self.plan.is_temporal {
            self.compare_along_path(stage, timetable, seen)?;
        }
        self.warm_up(stage, timed)?;
        let count = self.plan.timed;
        let rounds = rounds(count);
        for round in 0..rounds {
            for place in orders.next_round() {
                let method = timed[place];
                if !self.gpu.is_software() {
                    // The caches are another method's.
                    self.draw(stage, method)?;
                }
                for _ in frames_of_round(round, rounds, count) {
                    self.frame(stage, method)?;
                    tick();
                }
            }
        }
        Ok(())
    }

    /// One frame off the clock. Returns whether no list of the frame before overflowed.
    fn draw(&mut self, stage: &mut Stage, method: usize) -> Result<bool, HarnessError> {
        draw_unclocked(&self.gpu, stage, self.mode, &mut self.contenders[method].painter)
    }

    /// Draws all methods in turn until each was drawn often enough and the device is warm: a GPU's clock
    /// falls while the CPU compares images. The time of a round of all methods tells when it has risen,
    /// and [`WarmUp`] gives up after four seconds.
    fn warm_up(&mut self, stage: &mut Stage, timed: &[usize]) -> Result<(), HarnessError> {
        let mut warm_up = WarmUp::new(self.gpu.is_software());
        let mut drawn = 0;
        while drawn < self.plan.warmup || (drawn > 0 && !warm_up.is_warm()) {
            let mut round_ms = 0.0;
            for &method in timed {
                let painter = &mut self.contenders[method].painter;
                painter.draw(&self.gpu, stage, self.mode, &mut self.clock)?;
                round_ms += self.clock.finish()?.iter().map(|(_, ms)| ms).sum::<f64>();
            }
            warm_up.feed(round_ms);
            drawn += 1;
        }
        Ok(())
    }

    /// One frame on the clock.
    fn frame(&mut self, stage: &mut Stage, method: usize) -> Result<(), HarnessError> {
        let contender = &mut self.contenders[method];
        let settled = contender.painter.draw(&self.gpu, stage, self.mode, &mut self.clock)?;
        let mut times = self.clock.finish_frame()?;
        if let Some(upload) = stage.moving.as_ref().and_then(Moving::upload) {
            times.begin_with("upload", upload.ms);
        }
        contender.samples.collect_frame(times);
        contender.overflowed_frames += u32::from(!settled);
        Ok(())
    }

    /// The times, method by method.
    pub fn finish(self) -> Vec<Timed> {
        self.contenders
            .into_iter()
            .map(|Contender { samples, overflowed_frames, .. }| {
                (samples.finish_frames(), overflowed_frames)
            })
            .map(|((passes, spans), overflowed_frames)| Timed { overflowed_frames, passes, spans })
            .collect()
    }
}

/// The radiance that a frame left in the targets.
fn read(gpu: &Gpu, stage: &Stage) -> Result<HdrImage, HarnessError> {
    Ok(HdrImage::read(gpu, stage.renderer.targets(), stage.view.viewport)?)
}

/// The image of lights that have no range: inverse square to any distance, without culling. Lights that only
/// the GPU knows are read back. Leaves the stage as it was, to be prepared again.
pub fn unbounded_image(gpu: &Gpu, stage: &mut Stage, mode: Mode) -> Result<HdrImage, HarnessError> {
    let unbounded = |light: &Light| Light { range_m: MAX_RANGE_M, ..*light };
    let lights: Vec<Light> = known_lights(gpu, &stage.lights)?.iter().map(unbounded).collect();
    let bounded = std::mem::replace(&mut stage.lights, LightBuffer::new(gpu, &lights)?);
    let bounce = stage.bounce.take();
    // Both terms end nowhere.
    let reach = stage.specular_reach.take();
    let mut method = Method::everything(gpu)?;
    let image = stage.prepare().and_then(|()| {
        let mut painter = Painter::new(stage, &mut method, mode, Cut::Hard)?;
        draw_unclocked(gpu, stage, mode, &mut painter)?;
        read(gpu, stage)
    });
    (stage.lights, stage.bounce, stage.specular_reach) = (bounded, bounce, reach);
    image
}

/// Draws one frame and waits for it. Returns whether no list of the frame before overflowed.
pub(crate) fn draw_unclocked(
    gpu: &Gpu,
    stage: &mut Stage,
    mode: Mode,
    painter: &mut Painter<'_>,
) -> Result<bool, HarnessError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let settled = painter.draw(gpu, stage, mode, &mut EncoderPasses { encoder: &mut encoder })?;
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(settled)
}

/// Bytes of everything that a strategy needs on the GPU in a mode: its own, images that are drawn only for it,
/// and what orders the lights in every frame if it reads the hierarchy.
pub fn memory_bytes(stage: &Stage, strategy: &dyn Assignment, mode: Mode) -> u64 {
    let needs = strategy.needs();
    let order = if needs.hierarchy { order_bytes(&stage.lights) } else { 0 };
    strategy.memory_bytes() + order + stage.renderer.targets().bytes_for(mode, needs)
}

/// The place of a missed pair as results name it.
fn place(stage: &Stage, pair: shading::MissedPair) -> MissedPair {
    let width = stage.view.viewport.width;
    // The GPU's order is known to the GPU only.
    let given = |slot| stage.lights.given_index(slot).filter(|_| !stage.lights.order().is_on_gpu());
    MissedPair {
        pixel: [pair.pixel % width, pair.pixel / width],
        light: pair.light,
        given: pair.light.and_then(given),
    }
}

/// Reads the lists of the last frame back and checks them; `seen` asks for light operations.
fn count(
    gpu: &Gpu,
    stage: &Stage,
    strategy: &dyn Assignment,
    mode: Mode,
    truth: Option<&LightBvh<'_>>,
    seen: Option<(LightingOptions, f32)>,
) -> Result<ListsFigures, HarnessError> {
    let snapshot = strategy.lists().snapshot(gpu)?;
    let mut lengths = ListLengths::default();
    let Stage { renderer, view, lights, .. } = stage;
    if mode.is_forward() && (truth.is_some() || seen.is_some()) {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        record_for_probe(renderer, view, strategy, &mut passes);
        gpu.queue.submit([encoder.finish()]);
    }
    let frame = renderer.frame(view, lights);
    let operations = match seen {
        None => None,
        Some((options, exposure)) => {
            Some(count_operations(renderer, strategy, &frame, options, exposure)?)
        }
    };
    let mut layer_samples = 0;
    let truth = match truth {
        None => None,
        Some(bvh) => {
            let pixels = view.viewport.width as usize * view.viewport.height as usize;
            let mut found = ListsTruth::default();
            let is_forward = mode.is_forward();
            visit_lists(
                renderer,
                strategy,
                &frame,
                &snapshot,
                is_forward,
                &mut |samples, lists| {
                    lengths.add(samples, lists, pixels);
                    found = found.plus(bvh.check(samples, lists, strategy.needs().normals));
                },
            )?;
            let layers = LayerSamples::capture(renderer, &frame)?;
            visit_layer_lists(
                renderer,
                strategy,
                &frame,
                &snapshot,
                &layers,
                &mut |samples, lists| {
                    let checked = bvh.check(samples, lists, false);
                    layer_samples += checked.samples;
                    found = found.plus(checked);
                },
            )?;
            Some(found)
        }
    };
    let mut counters = snapshot.counters;
    if truth.is_some() && strategy.lookup().is_per_sample() {
        // Each sample has a list of its own, which is no group's.
        counters.longest = lengths.longest();
        lengths.all_groups.clear();
    }
    Ok(ListsFigures {
        groups: u64::from(strategy.lists().group_count()),
        counters,
        bytes: strategy.lists().bytes(),
        memory_bytes: memory_bytes(stage, strategy, mode),
        first_missed: truth.and_then(|truth| truth.first_missed).map(|pair| place(stage, pair)),
        truth,
        layer_samples,
        lengths,
        operations,
    })
}
