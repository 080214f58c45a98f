//! All methods of a comparison in one mode: their lists and images, then their times, frame by
//! frame in turns.

mod laps;
mod lists;
mod plan;
mod shown;

pub use lists::{ListsFigures, memory_bytes};
pub use plan::{Plan, Timetable};
pub use shown::Shown;

use std::sync::Arc;

use assign::{EncoderPasses, Gpu, Light, LightBuffer, MAX_RANGE_M};
use shading::{Cut, HdrImage, ListCheck, Mode};

use crate::{
    clock::PassClock,
    drift::WarmUp,
    error::HarnessError,
    moving::{Moving, known_lights},
    painter::Painter,
    pass_samples::PassSamples,
    results::{Passes, Spans},
    schedule::{Orders, frames_of_round, rounds},
    shadows::PLAN_PASS,
    stage::Stage,
    strategy::Method,
};
use lists::count;
use shown::Kept;

/// What a method showed before its times were taken.
pub struct Checked {
    /// Its image beside that of no culling; `None` if images are not compared.
    pub image: Option<Shown>,
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

/// Is handed a frame's number and its images, method by method.
pub type Compare<'a> = dyn FnMut(u32, &[Shown]) -> Result<(), HarnessError> + 'a;

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
    /// The method whose image is that of no culling, if images are compared, and its last image.
    reference: Option<(usize, Option<Kept>)>,
    /// The method whose frame is in the targets, if it was drawn to keep its image.
    drawn: Option<usize>,
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
            reference: None,
            drawn: None,
            exposure: None,
        })
    }

    /// Has the images of all methods compared with that of one, which is no culling. Returns its image.
    pub fn compare_with(
        &mut self,
        stage: &mut Stage,
        method: usize,
    ) -> Result<Arc<HdrImage>, HarnessError> {
        self.reference = Some((method, None));
        self.draw_reference(stage)?;
        self.drawn = Some(method);
        match &mut self.reference {
            Some((_, Some(kept))) => kept.image(),
            _ => Ok(Arc::new(read(&self.gpu, stage)?)),
        }
    }

    /// Draws no culling and keeps its image, if images are compared.
    fn draw_reference(&mut self, stage: &mut Stage) -> Result<(), HarnessError> {
        let Some((method, _)) = self.reference else { return Ok(()) };
        self.draw(stage, method)?;
        if let Some((_, kept)) = &mut self.reference {
            Kept::keep(kept, &self.gpu, stage)?;
        }
        Ok(())
    }

    /// Compares the image that a frame left in the targets with that of no culling.
    fn look(&mut self, stage: &Stage) -> Result<Option<Shown>, HarnessError> {
        match &mut self.reference {
            Some((_, Some(kept))) => kept.look(&self.gpu, stage).map(Some),
            _ => Ok(None),
        }
    }

    /// Draws one method until none of its lists overflows, compares its image, and checks its lists with `truth`.
    pub fn check(
        &mut self,
        stage: &mut Stage,
        method: usize,
        truth: Option<&mut ListCheck<'_>>,
    ) -> Result<Checked, HarnessError> {
        let is_drawn = self.drawn.take() == Some(method);
        for drawn in 0..=MAX_SETTLING {
            if is_drawn && !self.contenders[method].painter.has_groups() {
                break;
            }
            let settled = self.draw(stage, method)?;
            // The counters of the first frame come back with the second.
            if settled && (drawn > 0 || !self.contenders[method].painter.has_groups()) {
                break;
            }
        }
        let image = self.look(stage)?;
        let lists = match &self.contenders[method].painter {
            Painter::Lists { strategy, lighting, .. } => {
                let seen = match self.plan.operations {
                    true => {
                        let known = self.exposure.map_or_else(
                            || Ok(read(&self.gpu, stage)?.auto_exposure()),
                            Ok::<_, HarnessError>,
                        );
                        Some((lighting.options(), *self.exposure.insert(known?)))
                    }
                    false => None,
                };
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
        if let Some(plan_ms) = stage.shadow_plan_ms {
            times.begin_with(PLAN_PASS, plan_ms);
        }
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
