//! `lightbench compare`: the main job.

use std::{collections::HashMap, path::Path, sync::Arc, time::Duration};

use assign::Gpu;
use indicatif::{ProgressBar, ProgressStyle};
use shading::{EDGE, HdrImage, LightBvh, Mode, RasterSpheres, heat_map_png};

use crate::{
    choice::{Choice, choices},
    cli::{CliError, CompareArgs, ModeChoice, TruthChoice},
    clock::clock_of,
    error::HarnessError,
    machine::machine,
    measure::{Frames, Measurement, measure},
    registry::Method,
    report,
    results::{
        CONTROL, Clock, Images, Record, RejectedLight, Results, ResultsError, Truth,
        write_atomically,
    },
    stage::Stage,
};

/// Frames on the clock where the command line names none: on a GPU, and on a software adapter.
const DEFAULT_FRAMES: [u32; 2] = [64, 3];
/// Frames before the clock, likewise.
const DEFAULT_WARMUP: [u32; 2] = [16, 1];

/// Gain of difference images: a difference of 1/64 shows as white.
const DIFFERENCE_GAIN: f32 = 64.0;

/// The method that has no forward mode.
const RASTER_SPHERE: &str = "RasterSphere";

/// How long a GPU warms up at least; a software adapter has no clocks to raise.
const GPU_WARM_UP: Duration = Duration::from_millis(250);

/// Runs a comparison, writes its report, and returns what to print. `command` is the command
/// line, for provenance.
pub fn compare(args: &CompareArgs, command: Vec<String>) -> Result<String, HarnessError> {
    let choices = choices(args)?;
    check_modes(args, &choices)?;
    check_writable(&args.out)?;
    let gpu = Gpu::open(args.adapter.as_deref())?;
    end_on_device_error(&gpu);
    let machine = machine(&gpu);
    eprintln!("adapter  {} ({}, {})", machine.adapter, machine.backend, machine.driver);
    let choices = checked(choices, &gpu)?;
    let stage = Stage::new(&gpu, args)?;
    describe(&stage);
    // What a strategy cannot serve shows before anything long begins.
    let (choices, left_out) = served(choices, &gpu, &stage)?;
    let truth = Truth { level: args.truth.into(), edge_tolerance: EDGE, notes: Vec::new() };
    let mut run = Run {
        results: Results::new(machine, command, truth),
        args,
        clock: clock_of(&gpu),
        frames: frames(&gpu, args),
        gpu,
        stage,
        pictures: Vec::new(),
    };
    run.results.warnings.extend(left_out);
    run.warn();
    run.measure_all(&choices)?;
    run.write()
}

/// An error that no call returned is the device's: one line, exit code 1, no panic.
fn end_on_device_error(gpu: &Gpu) {
    gpu.device.on_uncaptured_error(Arc::new(|error: wgpu::Error| {
        eprintln!("lightbench: device: {}", CliError::new(error.to_string()));
        std::process::exit(1);
    }));
}

/// An error where no choice can be measured in any of the modes.
fn check_modes(args: &CompareArgs, choices: &[Choice]) -> Result<(), CliError> {
    let is_forward = args.mode == ModeChoice::Forward;
    if is_forward && choices.iter().all(|choice| choice.family() == RASTER_SPHERE) {
        let accepted = format!("deferred for {RASTER_SPHERE}, which has no forward mode");
        return Err(CliError::out_of_range("--mode", "forward", &accepted));
    }
    Ok(())
}

/// The choices with their parameters checked and written alike, none twice.
fn checked(choices: Vec<Choice>, gpu: &Gpu) -> Result<Vec<Choice>, HarnessError> {
    let mut checked: Vec<Choice> = Vec::new();
    for choice in choices {
        let choice = choice.checked(gpu)?;
        let id = choice.id();
        if checked.iter().any(|known| known.id() == id) {
            if !choice.is_named {
                continue;
            }
            let accepted = "given once each";
            return Err(
                CliError::out_of_range("--strategies", &format!("{id} twice"), accepted).into()
            );
        }
        checked.push(choice);
    }
    Ok(checked)
}

/// The choices that can serve the scene on this device, and what to say of those that cannot: an
/// error where one was named.
fn served(
    choices: Vec<Choice>,
    gpu: &Gpu,
    stage: &Stage,
) -> Result<(Vec<Choice>, Vec<String>), HarnessError> {
    let mut served = Vec::new();
    let mut left_out = Vec::new();
    for choice in choices {
        let check = || -> Result<(), HarnessError> {
            match choice.make(gpu)? {
                Method::Lists { mut strategy, .. } => {
                    strategy.prepare(gpu, &stage.renderer.frame(&stage.view, &stage.lights))?;
                }
                Method::RasterSphere => {
                    RasterSpheres::new(&stage.renderer, stage.lights.has_spots())?;
                }
                Method::Clay => {}
            }
            Ok(())
        };
        match check() {
            Ok(()) => served.push(choice),
            Err(error) if !choice.is_named => {
                left_out.push(format!("{} was left out: {error}", choice.id()));
            }
            Err(error) => return Err(error),
        }
    }
    Ok((served, left_out))
}

/// The frames asked for, or the defaults of the kind of device.
fn frames(gpu: &Gpu, args: &CompareArgs) -> Frames {
    let kind = usize::from(gpu.is_software());
    Frames {
        warmup: args.warmup.unwrap_or(DEFAULT_WARMUP[kind]),
        warm_up: if gpu.is_software() { Duration::ZERO } else { GPU_WARM_UP },
        timed: args.frames.unwrap_or(DEFAULT_FRAMES[kind]),
    }
}

/// Makes the output folder and writes to it once, before anything long begins. An earlier run's
/// report goes: it would stand beside this run's pictures if this one is interrupted.
fn check_writable(out: &Path) -> Result<(), ResultsError> {
    let probe = out.join(".lightbench");
    write_atomically(&probe, b"")?;
    for stale in ["index.html", "results.json"].map(|name| out.join(name)) {
        if stale.is_file() {
            std::fs::remove_file(&stale)
                .map_err(|source| ResultsError::Write { path: stale, source })?;
        }
    }
    std::fs::remove_file(&probe)
        .map_err(|source| ResultsError::Write { path: probe.clone(), source })
}

fn describe(stage: &Stage) {
    eprintln!(
        "scene    {}: {} triangles, {} models, {} lights",
        stage.scene.name,
        stage.scene.triangle_count(),
        stage.scene.models.len(),
        stage.lights.count()
    );
    if stage.lights.count() as usize > stage.own_lights {
        eprintln!("lights   scattered with a mean radius of {:.3} m", stage.radius_scale);
    }
    for warning in &stage.scene.warnings {
        eprintln!("warning  {warning}");
    }
    for rejected in stage.lights.rejected() {
        eprintln!("warning  light {} left out: {}", rejected.index, rejected.fault);
    }
}

/// A comparison on its way.
struct Run<'a> {
    results: Results,
    args: &'a CompareArgs,
    clock: Clock,
    frames: Frames,
    gpu: Gpu,
    stage: Stage,
    pictures: Vec<(String, Vec<u8>)>,
}

/// The image of no culling in one mode, and the exposure that all pictures of the mode share.
struct Reference {
    image: HdrImage,
    exposure: f32,
    picture: String,
}

impl Run<'_> {
    /// Notes what a reader of the figures has to know.
    fn warn(&mut self) {
        let name = &self.stage.scene.name;
        self.results.warnings.extend(self.stage.scene.warnings.iter().cloned());
        self.results.rejected_lights = self
            .stage
            .lights
            .rejected()
            .iter()
            .map(|rejected| RejectedLight {
                scene: name.clone(),
                index: rejected.index as u64,
                reason: rejected.fault.to_string(),
            })
            .collect();
    }

    fn measure_all(&mut self, choices: &[Choice]) -> Result<(), HarnessError> {
        let lights = self.stage.lights.lights().to_vec();
        let bvh = (self.args.truth == TruthChoice::Full).then(|| LightBvh::new(&lights));
        let per_method = per_method(self.frames);
        let modes = self.args.mode.modes();
        let has_reference = choices.iter().any(Choice::is_reference);
        let extra = if has_reference { 0 } else { 2 };
        let total = modes.len() as u64 * (choices.len() as u64 * per_method + extra);
        let bar = progress_bar(total);
        for &mode in modes {
            self.measure_mode(choices, mode, bvh.as_ref(), &bar)?;
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// All methods in one mode, no culling first: the others are compared with its image.
    fn measure_mode(
        &mut self,
        choices: &[Choice],
        mode: Mode,
        bvh: Option<&LightBvh<'_>>,
        bar: &ProgressBar,
    ) -> Result<(), HarnessError> {
        let mut measured: HashMap<usize, Measurement> = HashMap::new();
        let reference = choices.iter().position(Choice::is_reference);
        let image = match reference {
            Some(ix) => {
                let measurement = self.measure_one(&choices[ix], mode, self.frames, bvh, bar)?;
                let image = measurement.image.clone();
                measured.insert(ix, measurement);
                image
            }
            None => {
                let once = Frames { warmup: 0, timed: 1, ..self.frames };
                let none = Choice::parse(crate::results::BASELINE)?;
                self.measure_one(&none, mode, once, None, bar)?.image
            }
        };
        let exposure = image.auto_exposure();
        let picture = format!("{}-None.png", mode.name());
        let reference = Reference { image, exposure, picture };
        self.picture(&reference.picture, reference.image.to_png(exposure)?, &reference.image)?;
        for (ix, choice) in choices.iter().enumerate() {
            if mode == Mode::Forward && choice.family() == RASTER_SPHERE {
                self.results.warnings.push(format!("{RASTER_SPHERE} has no forward mode"));
                bar.inc(per_method(self.frames));
                continue;
            }
            let measurement = match measured.remove(&ix) {
                Some(measurement) => measurement,
                None => self.measure_one(choice, mode, self.frames, bvh, bar)?,
            };
            let record = self.record(choice, mode, &measurement, &reference)?;
            self.results.records.push(record);
        }
        Ok(())
    }

    fn measure_one(
        &mut self,
        choice: &Choice,
        mode: Mode,
        frames: Frames,
        bvh: Option<&LightBvh<'_>>,
        bar: &ProgressBar,
    ) -> Result<Measurement, HarnessError> {
        bar.set_message(format!("{} {}", choice.id(), mode.name()));
        let mut method = choice.make(&self.gpu)?;
        let tick = &mut || bar.inc(1);
        measure(&self.gpu, &mut self.stage, &mut method, mode, frames, bvh, tick)
    }

    /// Keeps a picture for the report, and writes it and its EXR.
    fn picture(&mut self, name: &str, png: Vec<u8>, image: &HdrImage) -> Result<(), HarnessError> {
        let path = self.args.out.join(name);
        write_atomically(&path, &png)?;
        image.write_exr(&path.with_extension("exr"))?;
        self.pictures.push((name.to_owned(), png));
        Ok(())
    }

    fn record(
        &mut self,
        choice: &Choice,
        mode: Mode,
        measurement: &Measurement,
        reference: &Reference,
    ) -> Result<Record, HarnessError> {
        let is_control = choice.family() == CONTROL;
        let difference = measurement.image.difference(&reference.image)?;
        let mut images = Images { baseline: Some(reference.picture.clone()), ..Images::default() };
        if choice.is_reference() {
            images.image = Some(reference.picture.clone());
        } else {
            let stem = format!("{}-{}", mode.name(), choice.id().replace('/', "-"));
            let name = format!("{stem}.png");
            let png =
                measurement.image.to_png(if is_control { 1.0 } else { reference.exposure })?;
            self.picture(&name, png, &measurement.image)?;
            images.image = Some(name);
            if !is_control {
                let name = format!("{stem}-difference.png");
                let gain = DIFFERENCE_GAIN * reference.exposure;
                let png = measurement.image.difference_png(&reference.image, gain)?;
                write_atomically(&self.args.out.join(&name), &png)?;
                self.pictures.push((name.clone(), png));
                images.difference = Some(name);
                images.difference_amplification = Some(f64::from(gain));
            }
        }
        let lists = measurement.lists.clone().unwrap_or_default();
        if !lists.lengths.per_pixel.is_empty() {
            let name = format!("{}-{}-heat.png", mode.name(), choice.id().replace('/', "-"));
            let lengths = &lists.lengths.per_pixel;
            let png = heat_map_png(&reference.image, reference.exposure, lengths)?;
            write_atomically(&self.args.out.join(&name), &png)?;
            self.pictures.push((name.clone(), png));
            images.heat_map = Some(name);
        }
        let truth = lists.truth;
        let stage = &self.stage;
        let compared = |value: f64| (!is_control && value.is_finite()).then_some(value);
        let mut record = Record {
            scene: stage.scene.name.clone(),
            scene_hash: stage.scene_hash.clone(),
            scene_scale: self.args.scene_scale,
            triangles: stage.scene.triangle_count(),
            strategy: choice.id().to_owned(),
            strategy_parameters: choice.parameters(),
            mode,
            lights: u64::from(stage.lights.count()),
            light_kinds: stage
                .light_kinds()
                .into_iter()
                .filter(|(_, count)| *count > 0)
                .map(|(kind, count)| (kind.to_owned(), count))
                .collect(),
            radius_scale: stage.radius_scale,
            eye: stage.view.eye().to_array().map(f64::from),
            forward: (-stage.view.world_to_view.row(2).truncate()).to_array().map(f64::from),
            light_box: [stage.light_box.min, stage.light_box.max]
                .map(|corner| corner.to_array().map(f64::from)),
            own_lights: stage.own_lights as u64,
            width: stage.view.viewport.width,
            height: stage.view.viewport.height,
            frames: self.frames.timed,
            warmup_frames: self.frames.warmup,
            seed: self.args.seed,
            clock: self.clock,
            passes: measurement.passes.clone(),
            assign_ms: 0.0,
            shade_ms: 0.0,
            frame_ms: 0.0,
            groups: lists.groups,
            occupied_groups: u64::from(lists.counters.occupied_groups),
            list_entries: if lists.groups == 0 && measurement.lists.is_some() {
                u64::from(stage.lights.count())
            } else {
                lists.counters.requested()
            },
            longest_list: u64::from(lists.counters.longest),
            listed_per_sample: truth.map(|t| t.listed_per_sample()),
            contributing_per_sample: truth.map(|t| t.contributing_per_sample()),
            missed_pairs: truth.map(|t| t.missed),
            checked_pairs: truth.map(|t| t.contributing),
            samples: truth.map_or(0, |t| t.samples),
            max_abs_diff: compared(difference.max_abs),
            max_rel_diff: compared(difference.max_rel),
            differing_channels: (!is_control).then_some(difference.differing_channels),
            lists_bytes: lists.bytes,
            histogram: lists.lengths.histogram.clone(),
            light_order: Some(stage.lights.order().to_string()),
            light_build_ms: Some(stage.lights.build_time().as_secs_f64() * 1e3),
            tolerance: choice.tolerance(),
            overflowed_groups: u64::from(lists.counters.overflowed_groups),
            images,
            note: self.note(mode, lists.overflowed_frames),
        };
        record.set_times();
        Ok(record)
    }

    fn note(&self, mode: Mode, overflowed_frames: u32) -> Option<String> {
        let mut notes = Vec::new();
        let mut words = self.results.machine.adapter.split_whitespace();
        if mode == Mode::Forward && words.any(|word| ["H100", "H200"].contains(&word)) {
            notes.push("this data-centre GPU runs fragment shaders on a few of its processors: compare forward figures with no other chip's".to_owned());
        }
        if overflowed_frames > 0 {
            notes.push(format!(
                "lists overflowed in {overflowed_frames} of the timed frames, which shaded all lights where they did"
            ));
        }
        (!notes.is_empty()).then(|| notes.join("; "))
    }

    /// Writes the results and the report; returns the table and where they are.
    fn write(&mut self) -> Result<String, HarnessError> {
        let out = &self.args.out;
        let data = out.join("results.json");
        self.results.write(&data)?;
        let page = report::write_html(&self.results, &self.pictures, out)?;
        Ok(format!(
            "{}\nreport   {}\ndata     {}\n",
            report::render_table(&self.results),
            page.display(),
            data.display()
        ))
    }
}

/// Ticks of a method in one mode: its timed frames and the check of its lists.
fn per_method(frames: Frames) -> u64 {
    u64::from(frames.timed) + 1
}

fn progress_bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} frames, {eta} left  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}
