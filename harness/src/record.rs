//! The record of one method in one mode, from what was seen and timed of it.

use assign::Gpu;
use shading::{Cut, Mode};

use crate::{
    choice::Choice,
    cli::{CompareArgs, LayerArgs, name_of},
    clock::clock_of,
    drift::unsteady,
    error::HarnessError,
    image_errors::{errors, no_errors, stored},
    measure::{ListsFigures, Plan, Shown, Timed},
    moving::Moving,
    results::{
        Clock, Errors, HiddenFigures, ImageFigures, Images, LayerSetting, ListFigures, Operations,
        Record, Setting, Times, WorstPixel, mean,
    },
    schedule::rounds,
    stage::Stage,
    temporal::Follower,
    visible::visible,
};

/// What was seen of a method: its lists, and how far its images are from what they should be.
#[derive(Default)]
pub struct Seen {
    /// Its lists.
    pub lists: ListsFigures,
    /// Its pictures.
    pub images: Images,
    /// Errors against lights without a range.
    pub unbounded_errors: Vec<(&'static str, f64)>,
    /// Whether it is the control, whose images are not compared.
    is_control: bool,
    /// Whether any image was compared.
    compared: bool,
    max_abs: f64,
    max_rel: f64,
    differing_channels: u64,
    worst_pixel: Option<WorstPixel>,
    /// Errors against no culling, of each image that was compared.
    errors: Vec<(&'static str, Vec<f64>)>,
    /// Whether one of these images differs from no culling.
    measured_one_that_differs: bool,
    /// How the error changes over frames that follow each other.
    follower: Follower,
}

impl Seen {
    /// Lists whose images were not compared yet; those of the control never are.
    pub fn new(lists: ListsFigures, is_control: bool) -> Self {
        Self { lists, is_control, ..Self::default() }
    }

    /// Adds an image of a frame, beside that of no culling; `frame` `None` is the still view.
    pub fn compare(
        &mut self,
        shown: &Shown,
        exposure: f32,
        frame: Option<u32>,
    ) -> Result<(), HarnessError> {
        if self.is_control {
            return Ok(());
        }
        self.note_difference(shown, exposure, frame)?;
        self.measure_errors(shown, exposure);
        Ok(())
    }

    fn measure_errors(&mut self, shown: &Shown, exposure: f32) {
        self.measured_one_that_differs |= shown.differs();
        let errors = shown.pair(exposure).map_or_else(no_errors, |pair| errors(&pair));
        for (id, error) in errors {
            match self.errors.iter_mut().find(|(known, _)| *known == id) {
                Some((_, all)) => all.push(error),
                None => self.errors.push((id, vec![error])),
            }
        }
    }

    fn note_difference(
        &mut self,
        shown: &Shown,
        exposure: f32,
        frame: Option<u32>,
    ) -> Result<(), HarnessError> {
        self.compared = true;
        let Some(pair) = shown.pair(exposure) else { return Ok(()) };
        let difference = pair.image.difference(pair.reference)?;
        self.max_abs = self.max_abs.max(difference.max_abs);
        if let Some(pixel) = difference.worst_pixel
            && (self.worst_pixel.is_none() || difference.max_rel > self.max_rel)
        {
            let rel_diff = Some(difference.max_rel).filter(|rel| rel.is_finite());
            self.worst_pixel = Some(WorstPixel { pixel, frame, rel_diff });
        }
        self.max_rel = self.max_rel.max(difference.max_rel);
        self.differing_channels += difference.differing_channels;
        Ok(())
    }

    /// Adds the image of the next frame, and how its error differs from that of the frame before. Other errors are those of
    /// the first image that differs: FLIP takes a second for each large image.
    pub fn follow(&mut self, shown: &Shown, exposure: f32, frame: u32) -> Result<(), HarnessError> {
        if self.is_control {
            return Ok(());
        }
        self.note_difference(shown, exposure, Some(frame))?;
        if shown.differs() && !self.measured_one_that_differs {
            self.errors.clear();
        }
        if self.errors.is_empty() {
            self.measure_errors(shown, exposure);
        }
        self.follower.follow(shown.pair(exposure).as_ref());
        Ok(())
    }

    /// Forgets the errors so far, not the differences.
    pub fn forget_errors(&mut self) {
        self.errors.clear();
        self.measured_one_that_differs = false;
    }
}

/// The record of one method in one mode.
#[allow(clippy::too_many_arguments, reason = "everything that a record holds comes together here")]
pub fn record(
    args: &CompareArgs,
    stage: &Stage,
    plan: &Plan,
    gpu: &Gpu,
    choice: &Choice,
    mode: Mode,
    seen: Seen,
    timed: Timed,
) -> Record {
    let Seen { lists, images, unbounded_errors, errors, ref follower, .. } = seen;
    let truth = lists.truth;
    let known = |value: f64| (seen.compared && value.is_finite()).then_some(value);
    let count = stage.light_count();
    let has_lists = lists.bytes > 0;
    let mut record = Record {
        strategy: choice.id().clone(),
        is_lossy: choice.is_lossy(count)
            || loses_edges(choice, plan.cut)
            || (loses_ends(choice, plan.cut) && count > 0),
        setting: Setting {
            scene: visible(&stage.scene.name).into_owned(),
            scene_hash: stage.scene_hash.clone(),
            path_hash: args.path.then(|| stage.scene.path_hash()),
            scene_scale: args.stage.scene_scale,
            roughness: args.stage.roughness,
            triangles: stage.scene.triangle_count(),
            mode,
            lights: count,
            light_kinds: stage
                .light_kinds()
                .into_iter()
                .filter(|(_, count)| *count > 0)
                .map(|(kind, count)| (kind.to_owned(), count))
                .collect(),
            area_model: stage.lights.kinds().areas.then(|| stage.area_model.to_string()),
            radius_scale: stage.radius_scale,
            eye: stage.eye().to_array(),
            forward: (-stage.view.world_to_view.row(2).truncate()).to_array().map(f64::from),
            planes: Some(stage.planes()),
            light_box: [stage.light_box.min, stage.light_box.max]
                .map(|corner| (stage.scene.origin + corner.as_dvec3()).to_array()),
            own_lights: stage.own_lights as u64,
            open_lights: stage.open_lights.map(|open| open.count),
            open_threshold: stage.open_lights.map(|open| open.threshold),
            width: stage.view.viewport.width,
            height: stage.view.viewport.height,
            along_path: plan.laps > 0,
            poses: (plan.laps > 0).then_some(plan.timed),
            radii: Some(args.stage.radii.name().to_owned()),
            light_places: Some(name_of(&args.stage.light_box)),
            threshold: args.stage.threshold,
            cut: Some(plan.cut.name().to_owned()),
            compensation: args.compensate,
            specular_reach: args.specular_reach,
            area_lod: args.area_lod,
            shadows: stage.shadow_setting(),
            seed: args.stage.seed,
            light_order: Some(stage.lights.order().to_string()),
            layers: layer_setting(&args.layers),
            msaa: (args.msaa > 1).then_some(args.msaa),
            motion: stage.moving.as_ref().map(Moving::setting),
        },
        times: Times {
            frames: plan.timed * plan.laps.max(1),
            warmup_frames: plan.warmup,
            rounds: if plan.laps > 0 { plan.laps } else { rounds(plan.timed) },
            clock: clock_of(gpu),
            passes: timed.passes,
            assign_ms: 0.0,
            shade_ms: 0.0,
            frame_ms: 0.0,
            spans: timed.spans,
            span_ms: None,
            frame_span_ms: None,
            light_build_ms: stage.light_build_ms(),
            upload_bytes: stage.moving.as_ref().and_then(Moving::upload).map(|upload| upload.bytes),
        },
        lists: ListFigures {
            operations: lists.operations.map(Operations::from),
            groups: lists.groups,
            occupied_groups: u64::from(lists.counters.occupied_groups),
            entries: match lists.groups {
                0 if has_lists => count,
                _ => lists.counters.requested(),
            },
            longest: u64::from(lists.counters.longest.min(choice.cap())),
            listed_per_sample: truth.map(|t| t.listed_per_sample()),
            contributing_per_sample: truth.map(|t| t.contributing_per_sample()),
            missed_pairs: truth.map(|t| t.missed),
            hidden: lists.hidden.map(HiddenFigures::from),
            first_missed: lists.first_missed,
            checked_pairs: truth.map(|t| t.contributing),
            samples: truth.map_or(0, |t| t.samples),
            layer_samples: (lists.layer_samples > 0).then_some(lists.layer_samples),
            untested: None,
            list_bytes: lists.bytes,
            assignment_bytes: has_lists.then_some(lists.memory_bytes),
            lengths_read: lists.lengths.histogram,
            lengths_all: lists.lengths.all_groups,
            overflowed_groups: u64::from(lists.counters.overflowed_groups),
        },
        image: ImageFigures {
            temporal: follower.found(),
            errors: stored(errors.into_iter().map(|(id, all)| (id, mean(&all)))),
            unbounded_errors: stored(unbounded_errors),
            truth_errors: Errors::new(),
            max_abs_diff: known(seen.max_abs),
            max_rel_diff: known(seen.max_rel),
            differing_channels: seen.compared.then_some(seen.differing_channels),
            worst_pixel: seen.worst_pixel,
            tolerance: choice.tolerance(),
            files: images,
        },
        indirect: stage.vpls.clone(),
        note: note(timed.overflowed_frames),
    };
    record.set_times();
    record
}

/// What is drawn over the opaque surfaces; `None` if nothing is.
fn layer_setting(args: &LayerArgs) -> Option<LayerSetting> {
    (*args != LayerArgs::default()).then(|| LayerSetting {
        transparent: args.transparent,
        particles: args.particles.into(),
        fog_per_m: args.fog,
    })
}

/// Whether a method that rounds in its own way may gain or lose a light at the edge of its range, where
/// the light ends at once.
fn loses_edges(choice: &Choice, cut: Cut) -> bool {
    choice.tolerance().is_some() && cut == Cut::Hard
}

/// Whether a method leaves out what lights add beyond their ranges, where they do not end there.
fn loses_ends(choice: &Choice, cut: Cut) -> bool {
    choice.culls() && cut == Cut::Never
}

/// What a reader of the record has to know.
fn note(overflowed_frames: u32) -> Option<String> {
    (overflowed_frames > 0).then(|| {
        format!(
            "lists overflowed in {overflowed_frames} of the timed frames, which shaded all lights where they did"
        )
    })
}

/// Adds a note to a record whose times drifted. Only for GPUs and still cameras: a software adapter has no
/// clock to raise, and the poses of a path differ in their work.
pub fn note_drift(record: &mut Record) {
    if record.setting.along_path || record.times.clock != Clock::GpuTimestamps {
        return;
    }
    let Some(why) = unsteady(&record.frames_ms()) else { return };
    let drift = format!(
        "{} in {}: its times are not steady, measure it again: {why}",
        record.strategy,
        record.setting.mode.name()
    );
    record.note = Some(match record.note.take() {
        Some(note) => format!("{note}; {drift}"),
        None => drift,
    });
}
