//! Draws the frames of a round with every strategy, and checks each of them.

use assign::{EncoderPasses, Gpu};
use glam::{DVec3, Vec3};
use indicatif::ProgressBar;
use scenes::Pose;
use shading::{HdrImage, LightBvh, ListsTruth, Mode, record_for_probe, visit_lists};

use super::{
    Alter, altered,
    plan::{CameraPlan, FramePlan, Round},
};
use crate::{
    bench::Bench,
    choice::Choice,
    cli::{BAD_INPUT, CliError},
    digits::grouped,
    error::HarnessError,
    measure::draw_unclocked,
    moving::lights_by_slot,
    painter::Painter,
    report::lights as lights_words,
    stage::Stage,
    strategy::{BASELINE, Method},
};

/// The frames of a path that a camera's place on it counts in.
const PATH_FRAMES: u32 = 100_000;

/// What a soak has done so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// Strategies that drew a round.
    strategies: u64,
    /// Strategies that refused their round, before its first frame.
    refused: u64,
    /// Images that were compared with that of no culling.
    images: u64,
    /// (Light, sample) pairs within range that were checked.
    pairs: u64,
    /// Images with overflowed groups, because the frame left the strategy too small a pool.
    starved: u64,
}

impl Counts {
    /// The counts in words, one fact per line.
    pub(super) fn summary(&self, seed: u64, frames: u32) -> String {
        let Self { strategies, refused, images, pairs, starved } = *self;
        let [strategies, refused, images, pairs, starved] =
            [strategies, refused, images, pairs, starved].map(|n| grouped(&n.to_string()));
        let frames = grouped(&frames.to_string());
        format!(
            "soak     {frames} frames of seed {seed}: nothing found\n\
             drawn    {images} images by {strategies} strategies, all as without culling; {refused} more refused \
             their round\n\
             lists    {pairs} (light, sample) pairs, none missed; {starved} images from a pool that was too small\n"
        )
    }
}

/// A finding in a round.
pub(super) struct Found {
    /// The frame of the round.
    pub(super) frame: u32,
    /// What was found, without a full stop.
    pub(super) words: String,
}

/// A strategy that draws the round.
struct Contender<'a> {
    ix: usize,
    choice: &'a Choice,
    painter: Painter<'a>,
}

/// Draws the first frames of a round; returns the first finding.
pub(super) fn draw_round(
    bench: &mut Bench,
    round: &Round,
    frames: u32,
    alter: &Alter<'_>,
    counts: &mut Counts,
    bar: &ProgressBar,
) -> Result<Option<Found>, HarnessError> {
    let gpu = bench.gpu().clone();
    let stage = bench.stage(&round.stage)?;
    stage.prepare()?;
    let baseline = Choice::parse(BASELINE).map_err(CliError::from)?;
    let mut none = baseline.make(&gpu)?;
    let mut none = Painter::new(stage, &mut none, round.mode, Default::default())?;
    let mut methods: Vec<(usize, &Choice, Method)> = Vec::new();
    for (ix, choice) in round.choices.iter().enumerate() {
        match choice.make(&gpu) {
            Ok(method) => methods.push((ix, choice, altered(&gpu, method, alter))),
            Err(error) => counts.refuse(error.into())?,
        }
    }
    let mut contenders = Vec::new();
    for (ix, choice, method) in &mut methods {
        match Painter::new(stage, method, round.mode, Default::default()) {
            Ok(painter) => contenders.push(Contender { ix: *ix, choice, painter }),
            Err(error) => counts.refuse(error)?,
        }
    }
    for (frame, plan) in (0..frames).zip(&round.frames) {
        show(stage, plan)?;
        draw_unclocked(&gpu, stage, round.mode, &mut none)?;
        let reference = HdrImage::read(&gpu, stage.renderer.targets(), stage.view.viewport)?;
        let by_slot = lights_by_slot(&gpu, &stage.lights)?;
        let bvh = LightBvh::new(&by_slot);
        let mut served = Vec::new();
        for mut contender in contenders {
            limit_pool(&mut contender, plan, frame);
            if let Err(error) = draw_unclocked(&gpu, stage, round.mode, &mut contender.painter) {
                if frame > 0 || error.exit_code() != BAD_INPUT {
                    let words = format!("{} fails: {error}", contender.choice.id());
                    return Ok(Some(Found { frame, words }));
                }
                counts.refuse(error)?;
                continue;
            }
            let check = Check {
                gpu: &gpu,
                stage,
                mode: round.mode,
                reference: &reference,
                bvh: &bvh,
                has_small_pool: pool_of(&contender, plan).is_some(),
            };
            if let Some(words) = check.look(&contender, counts)? {
                let words =
                    format!("{}{} {words}", contender.choice.id(), pool_words(&contender, plan));
                return Ok(Some(Found { frame, words }));
            }
            served.push(contender);
        }
        contenders = served;
        bar.inc(1);
    }
    counts.strategies += contenders.len() as u64;
    Ok(None)
}

impl Counts {
    /// Counts a refusal; other errors end the soak.
    fn refuse(&mut self, error: HarnessError) -> Result<(), HarnessError> {
        if error.exit_code() != BAD_INPUT {
            return Err(error);
        }
        self.refused += 1;
        Ok(())
    }
}

/// Brings the camera and the lights to a frame.
fn show(stage: &mut Stage, plan: &FramePlan) -> Result<(), HarnessError> {
    let pose = match plan.camera {
        CameraPlan::OnPath(share) => {
            let frame = (share * f64::from(PATH_FRAMES)) as u32;
            stage.scene.path.pose(frame.min(PATH_FRAMES - 1), PATH_FRAMES)
        }
        CameraPlan::Anywhere { at, along } => {
            let bounds = stage.scene.core_bounds;
            let size = (bounds.max - bounds.min).as_dvec3();
            let eye = bounds.min.as_dvec3() + size * DVec3::from(at);
            let along = DVec3::from(along).normalize_or(DVec3::NEG_Z).as_vec3();
            Pose::level(eye.as_vec3(), along.normalize_or(Vec3::NEG_Z))
        }
    };
    stage.stand_at(pose);
    // The camera does not follow the path, so the number of frames says nothing.
    stage.go_to(plan.lights_at, 1)
}

/// The pool that a frame leaves a strategy.
fn pool_of(contender: &Contender<'_>, plan: &FramePlan) -> Option<u32> {
    plan.pools.get(contender.ix).copied().flatten()
}

/// Limits the pool, or lifts the limit of the frame before.
fn limit_pool(contender: &mut Contender<'_>, plan: &FramePlan, frame: u32) {
    let limit = pool_of(contender, plan);
    if let Painter::Lists { strategy, .. } = &mut contender.painter
        && (limit.is_some() || frame > 0)
    {
        strategy.lists_mut().limit_pool(limit.unwrap_or(u32::MAX));
    }
}

fn pool_words(contender: &Contender<'_>, plan: &FramePlan) -> String {
    pool_of(contender, plan).map_or_else(String::new, |most| format!(" (a pool of {most} entries)"))
}

/// A frame that a strategy just drew, and what it is checked against.
struct Check<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage,
    mode: Mode,
    reference: &'a HdrImage,
    bvh: &'a LightBvh<'a>,
    /// Whether the frame limits the strategy's pool.
    has_small_pool: bool,
}

impl Check<'_> {
    /// What is wrong with the frame, to follow the strategy's id; `None` if nothing is.
    fn look(
        &self,
        contender: &Contender<'_>,
        counts: &mut Counts,
    ) -> Result<Option<String>, HarnessError> {
        let Stage { renderer, view, .. } = self.stage;
        // The check of lists may draw a G-buffer, and so comes after the image is read.
        let image = HdrImage::read(self.gpu, renderer.targets(), view.viewport)?;
        let difference = image.difference(self.reference)?;
        let missed = self.missed(contender, counts)?;
        counts.images += 1;
        let tolerated = contender.choice.tolerance().is_some_and(|most| difference.max_rel <= most);
        if difference.differing_channels == 0 || (tolerated && missed.is_none()) {
            return Ok(missed);
        }
        let [x, y] = difference.worst_pixel.unwrap_or_default();
        let differs = format!(
            "differs from no culling in {} channels, most at pixel {x},{y}, by {:.3e} of its value",
            difference.differing_channels, difference.max_rel
        );
        Ok(Some(missed.map_or_else(|| differs.clone(), |missed| format!("{missed}; it {differs}"))))
    }

    /// The missed pairs in words.
    fn missed(
        &self,
        contender: &Contender<'_>,
        counts: &mut Counts,
    ) -> Result<Option<String>, HarnessError> {
        let Painter::Lists { strategy, .. } = &contender.painter else { return Ok(None) };
        let Stage { renderer, view, lights, .. } = self.stage;
        let is_forward = self.mode.is_forward();
        if is_forward {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            record_for_probe(renderer, view, &**strategy, &mut passes);
            self.gpu.queue.submit([encoder.finish()]);
        }
        let snapshot = strategy.lists().snapshot(self.gpu)?;
        let is_starved = self.has_small_pool && snapshot.counters.overflowed_groups > 0;
        counts.starved += u64::from(is_starved);
        let frame = renderer.frame(view, lights);
        let mut truth = ListsTruth::default();
        let knows_normals = strategy.needs().normals;
        let check = &mut |samples: &_, lists: &_| {
            truth = truth.plus(self.bvh.check(samples, lists, knows_normals));
        };
        visit_lists(renderer, &**strategy, &frame, &snapshot, is_forward, check)?;
        counts.pairs += truth.contributing;
        Ok(truth.first_missed.map(|first| {
            let width = view.viewport.width;
            let (x, y) = (first.pixel % width, first.pixel / width);
            let light = first.light.map_or_else(|| "all".to_owned(), |light| light.to_string());
            format!(
                "misses {} of {} pairs under {}, the first is light {light} at pixel {x},{y}",
                truth.missed,
                truth.contributing,
                lights_words(u64::from(lights.count()))
            )
        }))
    }
}
