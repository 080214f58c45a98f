//! `lightbench compare`: the main job.

use std::path::Path;

use assign::{Gpu, LightOrder};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use shading::{EDGE, LightBvh, ListCheck, Mode, traced::TracedScene};

use crate::{
    against_image,
    area_options::check_area_options,
    bench::Bench,
    checks::{check_options, checked, remove_stale, served},
    choice::Choice,
    cli::{CompareArgs, MAX_CHECKS},
    described::{note_faults, note_flaws},
    error::HarnessError,
    machine::machine,
    measure::{Contest, Plan, Shown, Timetable, unbounded_image},
    messages::say,
    moving::{Moving, lights_by_slot},
    out_folder::OutFolder,
    pictures::{Pictures, Reference, see},
    record::{Seen, note_drift, record},
    report,
    report::listed,
    results::{RefusedStrategy, Results, Truth, TruthLevel, Untested},
    schedule::DEFAULT_FRAMES,
    shadows::Casting,
    sight::untested,
    stage::Stage,
    strategy::{BASELINE, engines},
};

/// Frames on the clock along a path: on a GPU, and on a software adapter.
pub(crate) const DEFAULT_PATH_FRAMES: [u32; 2] = [1200, 60];
/// Frames of lights that move before a still camera, likewise.
const DEFAULT_MOVING_FRAMES: [u32; 2] = [240, 12];
/// Frames before the clock, likewise.
const DEFAULT_WARMUP: [u32; 2] = [16, 1];

/// Runs a comparison, writes its report, and returns what to print. `command` is the command
/// line, for provenance.
pub fn compare(args: &CompareArgs, command: Vec<String>) -> Result<String, HarnessError> {
    // Check the options before a device is opened.
    check_options(args, &args.choices()?)?;
    let truth = against_image::open(args.against.as_deref(), args.stage.size)?;
    let _held = OutFolder::hold(&args.out, &command)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let (mut results, pictures) = compare_on(&mut bench, args, command)?;
    let errors = match &truth {
        Some(truth) => against_image::compare(&mut results, &args.out, truth)?,
        None => String::new(),
    };
    Ok(write(&results, &pictures, &args.out)? + &errors)
}

/// Writes results and report; returns the table and where they are.
fn write(
    results: &Results,
    pictures: &[(String, Vec<u8>)],
    out: &Path,
) -> Result<String, HarnessError> {
    let data = out.join("results.json");
    results.write(&data)?;
    let page = report::write_html(results, pictures, out)?;
    Ok(format!(
        "{}\nreport   {}\ndata     {}\n",
        report::render_table(results),
        page.display(),
        data.display()
    ))
}

/// Runs a comparison on an open device; returns its results and the pictures that they name.
pub fn compare_on(
    bench: &mut Bench,
    args: &CompareArgs,
    command: Vec<String>,
) -> Result<(Results, Pictures), HarnessError> {
    let choices = args.choices()?;
    check_options(args, &choices)?;
    let gpu = bench.gpu().clone();
    let choices = checked(choices, &gpu)?;
    let machine = machine(&gpu);
    let stage = bench.stage(&args.stage)?;
    check_area_options(args, stage)?;
    stage.area_model = args.area_model.unwrap_or_default();
    stage.compensation = args.compensate.map(|lights| lights as f32);
    stage.specular_reach = args.specular_reach.map(|most| most as f32);
    stage.area_lod = args.area_lod.map(|angle| angle as f32);
    // Layers are drawn with one sample per pixel.
    stage.sample_pixels(1)?;
    stage.show_layers(&args.layers, args.stage.seed)?;
    stage.sample_pixels(args.msaa)?;
    let finds_occluders = choices.iter().any(Choice::leaves_out_hidden);
    let images = Some(&args.stage.bounce.deep);
    let casting = Casting { cut: args.cut, finds_occluders, images };
    let warning = stage.cast_shadows(args.shadows, casting)?;
    // Refuse strategies that cannot serve the scene before any long work starts.
    let (choices, left_out) = served(choices, &gpu, stage, args.cut)?;
    let truth = Truth { level: args.truth, edge_tolerance: EDGE, notes: Vec::new() };
    let mut run = Run {
        results: Results::new(machine, command, truth),
        args,
        plan: plan(&gpu, args),
        gpu,
        stage,
        pictures: Vec::new(),
        untested: None,
    };
    run.follow_path();
    run.results.warnings.extend(left_out.iter().map(RefusedStrategy::words));
    run.results.refused.extend(left_out);
    run.results.warnings.extend(warning);
    run.warn(&choices);
    remove_stale(&args.out)?;
    run.look()?;
    run.measure_all(&choices)?;
    Ok((run.results, run.pictures))
}

/// The frames asked for, or the defaults of the kind of device.
fn plan(gpu: &Gpu, args: &CompareArgs) -> Plan {
    let kind = usize::from(gpu.is_software());
    let moves = args.stage.motion.motion.is_some();
    let defaults = match (args.path, moves) {
        (true, _) => DEFAULT_PATH_FRAMES,
        (false, true) => DEFAULT_MOVING_FRAMES,
        (false, false) => DEFAULT_FRAMES,
    };
    Plan {
        warmup: args.warmup.unwrap_or(DEFAULT_WARMUP[kind]),
        timed: args.frames.unwrap_or(defaults[kind]),
        laps: if args.path || moves { args.laps.unwrap_or(1) } else { 0 },
        checks: args.checks.unwrap_or(MAX_CHECKS),
        is_temporal: args.temporal,
        seed: args.stage.seed,
        cut: args.cut,
        operations: args.operations,
    }
}

/// A comparison on its way.
struct Run<'a> {
    results: Results,
    args: &'a CompareArgs,
    plan: Plan,
    gpu: Gpu,
    stage: &'a mut Stage,
    pictures: Pictures,
    untested: Option<Untested>,
}

impl Run<'_> {
    /// Sets the stage for the poses that are timed.
    fn follow_path(&mut self) {
        if self.args.path {
            let known = self.stage.notes.clone();
            self.stage.follow_path(self.plan.timed);
            for note in self.stage.notes.iter().filter(|note| !known.contains(note)) {
                say(format!("warning  {note}"));
            }
        }
    }

    /// Puts camera and lights back to what the arguments ask for.
    fn reset(&mut self) -> Result<(), HarnessError> {
        self.stage.set_up(&self.gpu, &self.args.stage)?;
        self.follow_path();
        Ok(())
    }

    /// Looks whether the run puts anything to a test, and says loudly where it does not.
    fn look(&mut self) -> Result<(), HarnessError> {
        if self.args.msaa > 1 {
            // Nothing reads the samples of pixels.
            return Ok(());
        }
        let poses = if self.args.path { self.plan.compared_frames() } else { Vec::new() };
        self.untested = untested(&self.gpu, self.stage, &poses, self.plan.timed)?;
        if self.args.path {
            self.reset()?;
        }
        let lights = self.stage.light_count();
        if let Some(why) = self.untested.map(|why| why.words(lights, self.args.path)) {
            let warning = format!("NOTHING WAS TESTED: {why}, so nothing here is exact or ranked");
            say(format!("warning  {warning}"));
            self.results.warnings.insert(0, warning);
        }
        Ok(())
    }

    /// Notes what a reader of the figures has to know.
    fn warn(&mut self, choices: &[Choice]) {
        note_faults(&mut self.results, self.stage);
        note_flaws(&mut self.results, choices, self.plan.cut);
        if self.args.strategies.0.iter().any(|id| engines::is_engine(id)) {
            let size = [self.args.stage.size.width, self.args.stage.size.height];
            for choice in choices {
                for engine in engines::engines_of(choice.id(), size) {
                    let (name, id) = (engine.name, choice.id());
                    say(format!("engine   {name} is {id}, except that {}", engine.differs));
                }
            }
        }
        if let Some(vpls) = &self.stage.vpls {
            let words = vpls.summary();
            say(format!("vpls     {words}"));
            if vpls.kept == 0 {
                let none = "no virtual point light is left: every image is black";
                self.results.warnings.push(format!("{words}: {none}"));
            }
        }
        let mut corners: Vec<&str> = choices
            .iter()
            .filter(|choice| choice.tests_corners())
            .map(|choice| choice.row().family)
            .collect();
        corners.dedup();
        if self.stage.view.far_m.is_none() && !corners.is_empty() {
            self.results.warnings.push(format!(
                "the view has no far plane: the farthest groups of {} have no far corners, so only HS tests \
                 lights against them",
                listed(&corners)
            ));
        }
        if self.plan.checks == 0 {
            let words = "images were not compared with no culling (--checks 0)";
            self.results.warnings.push(words.to_owned());
        }
        if choices.iter().any(|choice| choice.id().reads_hierarchy()) {
            self.results.warnings.extend(self.uneven_sorts());
        }
        let name = &self.stage.scene.name;
        if self.args.path && !self.stage.scene.path.moves() {
            self.results
                .warnings
                .push(format!("{name} has no camera path: the camera stood still"));
        }
    }

    /// Says how often a lap sorts the lights, where that is more often than it should: each lap begins with a
    /// sort.
    fn uneven_sorts(&self) -> Option<String> {
        let LightOrder::Gpu { every } = self.stage.lights.order() else { return None };
        let frames = self.plan.timed;
        let is_uneven = self.plan.laps > 0 && !frames.is_multiple_of(every);
        is_uneven.then(|| {
            let sorts = match frames.div_ceil(every) {
                1 => "once".to_owned(),
                sorts => format!("{sorts} times"),
            };
            format!(
                "a lap of {frames} frames sorts the lights {sorts}, which is more than once every {every} \
                 frames: the pass order takes less with --frames a multiple of {every}"
            )
        })
    }

    fn measure_all(&mut self, choices: &[Choice]) -> Result<(), HarnessError> {
        let lights = lights_by_slot(&self.gpu, &self.stage.lights)?;
        let bvh = (self.args.truth == TruthLevel::Full).then(|| LightBvh::new(&lights));
        // Rays tell what hidden lights lists leave out by mistake.
        let traces = bvh.is_some() && choices.iter().any(Choice::leaves_out_hidden);
        let scene = traces.then(|| self.stage.scene.clone());
        let traced = scene.as_ref().map(TracedScene::new);
        let mut check = bvh.as_ref().map(|bvh| ListCheck::new(bvh).in_scene(traced.as_ref()));
        let modes = self.args.mode.modes();
        let per_method = u64::from(self.plan.timed) * u64::from(self.plan.laps.max(1)) + 1;
        let bar = progress_bar(modes.len() as u64 * choices.len() as u64 * per_method);
        for &mode in modes {
            let mut served = choices.to_vec();
            served.retain(|choice| choice.refuses_mode(mode).is_none());
            for choice in choices {
                let Some(words) = choice.row().refusal(mode) else { continue };
                let reason = choice.row().refuses_mode(mode).unwrap_or_default().to_owned();
                let (strategy, mode) = (choice.id().to_string(), Some(mode));
                self.results.refused.push(RefusedStrategy { strategy, mode, reason });
                self.results.warnings.push(words);
                bar.inc(per_method);
            }
            if served.is_empty() {
                continue;
            }
            self.measure_mode(served, mode, check.as_mut(), &bar)?;
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// Warns once of lights that became faulty as they moved.
    fn note_left_out(&mut self) {
        let note = self.stage.moving.as_ref().and_then(Moving::left_out_note);
        if let Some(note) = note.filter(|note| !self.results.warnings.contains(note)) {
            say(format!("warning  {note}"));
            self.results.warnings.push(note);
        }
    }

    /// All methods in one mode: their images and lists first, no culling before the others, then
    /// their times in turns.
    fn measure_mode(
        &mut self,
        mut choices: Vec<Choice>,
        mode: Mode,
        mut truth: Option<&mut ListCheck<'_>>,
        bar: &ProgressBar,
    ) -> Result<(), HarnessError> {
        let timed: Vec<usize> = (0..choices.len()).collect();
        let is_compared = self.plan.checks > 0;
        let known = choices.iter().position(Choice::is_reference);
        let reference_ix = is_compared.then(|| {
            known.unwrap_or_else(|| {
                // Drawn for its image, and not timed.
                choices.extend(Choice::parse(BASELINE));
                choices.len() - 1
            })
        });
        let unbounded = match self.args.unbounded {
            true => Some(unbounded_image(&self.gpu, self.stage, mode)?),
            false => None,
        };
        let mut methods = Vec::new();
        for choice in &choices {
            methods.push(choice.make(&self.gpu)?);
        }
        let mut contest = Contest::new(&self.gpu, self.stage, &mut methods, mode, self.plan)?;
        bar.set_message(format!("images, {}", mode.name()));
        let none = match reference_ix {
            Some(ix) => Some(contest.compare_with(self.stage, ix)?),
            None => None,
        };
        let mut all_checked = Vec::new();
        for &ix in &timed {
            let checked = contest.check(self.stage, ix, truth.as_deref_mut())?;
            all_checked.push((&choices[ix], checked));
            bar.inc(1);
        }
        let mut reference = None;
        if let Some(none) = none {
            let differs = all_checked.iter().any(|(choice, checked)| {
                !choice.is_control() && checked.image.as_ref().is_some_and(Shown::differs)
            });
            let (made, pictures) = Reference::new(self.args, none, unbounded, mode, differs)?;
            self.pictures.extend(pictures);
            reference = Some(made);
        }
        let args = self.args;
        let see = |(choice, checked)| see(args, choice, mode, checked, reference.as_ref());
        let all: Result<Vec<_>, _> = all_checked.into_par_iter().map(see).collect();
        let (mut all_seen, pictures): (Vec<Seen>, Vec<Pictures>) = all?.into_iter().unzip();
        self.pictures.extend(pictures.into_iter().flatten());
        bar.set_message(format!("times, {}", mode.name()));
        let exposure = reference.as_ref().map_or(1.0, |reference| reference.exposure);
        let mut compared = |frame: u32, images: &[Shown]| {
            all_seen.par_iter_mut().zip(images).try_for_each(|(seen, shown)| match args.temporal {
                true => seen.follow(shown, exposure, frame),
                false => seen.compare(shown, exposure, Some(frame)),
            })
        };
        let tick = &mut || bar.inc(1);
        let remember: Vec<usize> =
            timed.iter().copied().filter(|&ix| choices[ix].is_reused()).collect();
        let timetable = Timetable { timed: &timed, remember: &remember };
        contest.time(self.stage, timetable, tick, &mut compared)?;
        for ((&ix, seen), times) in timed.iter().zip(all_seen).zip(contest.finish()) {
            let mut record = record(
                self.args,
                self.stage,
                &self.plan,
                &self.gpu,
                &choices[ix],
                mode,
                seen,
                times,
            );
            note_drift(&mut record);
            record.lists.untested = self.untested;
            self.results.records.push(record);
        }
        self.note_left_out();
        if self.plan.laps > 0 {
            self.reset()?;
        }
        Ok(())
    }
}

fn progress_bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} frames, {eta} left  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}
