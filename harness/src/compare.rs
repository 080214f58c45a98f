//! `lightbench compare`: the main job.

use std::{path::Path, sync::Arc, time::Duration};

use assign::{AssignError, Gpu};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use shading::{Cut, EDGE, HdrImage, LightBvh, Mode, RasterSpheres, heat_map_png};

use crate::{
    choice::{Choice, choices},
    cli::{CliError, CompareArgs, ModeChoice, PicturesChoice, TruthChoice},
    error::HarnessError,
    errors::{ImagePair, errors},
    machine::machine,
    measure::{Checked, Contest, Plan, unbounded_image},
    record::{Seen, record},
    registry::Method,
    report,
    results::{
        BASELINE, CONTROL, Images, Machine, RejectedLight, Results, ResultsError, Truth,
        write_atomically,
    },
    stage::Stage,
};

/// Frames on the clock where the command line names none: on a GPU, and on a software adapter.
const DEFAULT_FRAMES: [u32; 2] = [64, 3];
/// The same along a path.
const DEFAULT_PATH_FRAMES: [u32; 2] = [1200, 60];
/// Frames before the clock, likewise.
const DEFAULT_WARMUP: [u32; 2] = [16, 1];

/// Gain of difference images: a difference of 1/64 shows as white.
const DIFFERENCE_GAIN: f32 = 64.0;

/// The method that has no forward mode.
const RASTER_SPHERE: &str = "RasterSphere";

/// How long a GPU warms up at least; a software adapter has no clocks to raise.
const GPU_WARM_UP: Duration = Duration::from_millis(250);

/// Pictures of a report, PNG files, by name.
pub type Pictures = Vec<(String, Vec<u8>)>;

/// A device with the scene that was drawn last.
pub struct Bench {
    gpu: Gpu,
    machine: Machine,
    stage: Option<(String, Stage)>,
}

/// Runs a comparison, writes its report, and returns what to print. `command` is the command
/// line, for provenance.
pub fn compare(args: &CompareArgs, command: Vec<String>) -> Result<String, HarnessError> {
    // What is wrong with the words shows before a device is opened.
    check_modes(args, &choices(args)?)?;
    check_writable(&args.out)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let (results, pictures) = bench.compare(args, command)?;
    write(&results, &pictures, &args.out)
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

impl Bench {
    /// Opens a device.
    pub fn open(adapter: Option<&str>) -> Result<Self, HarnessError> {
        let gpu = Gpu::open(adapter)?;
        end_on_device_error(&gpu);
        let machine = machine(&gpu);
        eprintln!("adapter  {} ({}, {})", machine.adapter, machine.backend, machine.driver);
        Ok(Self { gpu, machine, stage: None })
    }

    /// The machine that results come from.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The stage that arguments ask for; the scene is opened once while it stays the same.
    pub fn stage(&mut self, args: &CompareArgs) -> Result<&mut Stage, HarnessError> {
        let key = format!("{} {}", args.scene, args.scene_scale);
        let (_, stage) = match self.stage.take().filter(|(known, _)| *known == key) {
            Some((key, mut stage)) => {
                stage.set_up(&self.gpu, args)?;
                self.stage.insert((key, stage))
            }
            None => {
                let stage = Stage::new(&self.gpu, args)?;
                describe(&stage);
                self.stage.insert((key, stage))
            }
        };
        Ok(stage)
    }

    /// Runs a comparison; returns its results and the pictures that they name.
    pub fn compare(
        &mut self,
        args: &CompareArgs,
        command: Vec<String>,
    ) -> Result<(Results, Pictures), HarnessError> {
        let choices = choices(args)?;
        check_modes(args, &choices)?;
        let gpu = self.gpu.clone();
        let choices = checked(choices, &gpu)?;
        let machine = machine(&gpu);
        let stage = self.stage(args)?;
        // What a strategy cannot serve shows before anything long begins.
        let (choices, left_out) = served(choices, &gpu, stage, args.cut.into())?;
        let truth = Truth { level: args.truth.into(), edge_tolerance: EDGE, notes: Vec::new() };
        let mut run = Run {
            results: Results::new(machine, command, truth),
            args,
            plan: plan(&gpu, args),
            gpu,
            stage,
            pictures: Vec::new(),
        };
        run.results.warnings.extend(left_out);
        run.warn();
        remove_stale(&args.out)?;
        run.measure_all(&choices)?;
        Ok((run.results, run.pictures))
    }
}

/// The frames asked for, or the defaults of the kind of device.
fn plan(gpu: &Gpu, args: &CompareArgs) -> Plan {
    let kind = usize::from(gpu.is_software());
    let defaults = if args.path { DEFAULT_PATH_FRAMES } else { DEFAULT_FRAMES };
    Plan {
        warmup: args.warmup.unwrap_or(DEFAULT_WARMUP[kind]),
        warm_up: if gpu.is_software() { Duration::ZERO } else { GPU_WARM_UP },
        timed: args.frames.unwrap_or(defaults[kind]),
        along_path: args.path,
        seed: args.seed,
        cut: args.cut.into(),
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
}

/// What the images of one mode are compared with, and the exposure that all its pictures share.
struct Reference {
    image: HdrImage,
    unbounded: Option<HdrImage>,
    /// Errors of no culling against lights without a range.
    unbounded_errors: Vec<(&'static str, f64)>,
    exposure: f32,
    picture: Option<String>,
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
        if self.args.path && !self.stage.scene.path.moves() {
            self.results
                .warnings
                .push(format!("{name} has no camera path: the camera stood still"));
        }
    }

    fn measure_all(&mut self, choices: &[Choice]) -> Result<(), HarnessError> {
        let lights = self.stage.lights.lights().to_vec();
        let bvh = (self.args.truth == TruthChoice::Full).then(|| LightBvh::new(&lights));
        let modes = self.args.mode.modes();
        let per_method = u64::from(self.plan.timed) + 1;
        let bar = progress_bar(modes.len() as u64 * choices.len() as u64 * per_method);
        for &mode in modes {
            let mut served = choices.to_vec();
            if mode == Mode::Forward {
                served.retain(|choice| choice.family() != RASTER_SPHERE);
                if served.len() < choices.len() {
                    self.results.warnings.push(format!("{RASTER_SPHERE} has no forward mode"));
                    bar.inc(per_method);
                }
            }
            self.measure_mode(served, mode, bvh.as_ref(), &bar)?;
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// All methods in one mode: their images and lists first, no culling before the others, then
    /// their times in turns.
    fn measure_mode(
        &mut self,
        mut choices: Vec<Choice>,
        mode: Mode,
        bvh: Option<&LightBvh<'_>>,
        bar: &ProgressBar,
    ) -> Result<(), HarnessError> {
        let timed: Vec<usize> = (0..choices.len()).collect();
        let reference_ix = choices.iter().position(Choice::is_reference).unwrap_or_else(|| {
            // Drawn for its image, and not timed.
            choices.extend(Choice::parse(BASELINE));
            choices.len() - 1
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
        let mut none = Some(contest.check(self.stage, reference_ix, bvh)?);
        let image = none.as_ref().map(|checked| checked.image.clone()).unwrap_or_default();
        let reference = self.reference(image, unbounded, mode)?;
        let mut all_checked = Vec::new();
        for &ix in &timed {
            let checked = match none.take_if(|_| ix == reference_ix) {
                Some(checked) => checked,
                None => contest.check(self.stage, ix, bvh)?,
            };
            all_checked.push((&choices[ix], checked));
            bar.inc(1);
        }
        let args = self.args;
        let see = |(choice, checked)| see(args, choice, mode, checked, &reference);
        let all: Result<Vec<_>, _> = all_checked.into_par_iter().map(see).collect();
        let (mut all_seen, pictures): (Vec<Seen>, Vec<Pictures>) = all?.into_iter().unzip();
        self.pictures.extend(pictures.into_iter().flatten());
        bar.set_message(format!("times, {}", mode.name()));
        let exposure = reference.exposure;
        let mut compared = |images: &[HdrImage], reference: &HdrImage| {
            all_seen.par_iter_mut().zip(images).try_for_each(|(seen, image)| {
                seen.compare(&ImagePair { image, reference, exposure })
            })
        };
        let tick = &mut || bar.inc(1);
        contest.time(self.stage, &timed, reference_ix, tick, &mut compared)?;
        for ((&ix, seen), times) in timed.iter().zip(all_seen).zip(contest.finish()) {
            let record = record(
                self.args,
                self.stage,
                &self.plan,
                &self.gpu,
                &choices[ix],
                mode,
                seen,
                times,
            );
            self.results.records.push(record);
        }
        if self.args.path {
            self.stage.set_up(&self.gpu, self.args)?;
        }
        Ok(())
    }

    /// Keeps the images that others are compared with.
    fn reference(
        &mut self,
        image: HdrImage,
        unbounded: Option<HdrImage>,
        mode: Mode,
    ) -> Result<Reference, HarnessError> {
        let exposure = image.auto_exposure();
        let mut picture = None;
        if self.args.pictures == PicturesChoice::All {
            let out = &self.args.out;
            let name = format!("{}-None.png", mode.name());
            let images = [
                Some((name.clone(), &image)),
                unbounded.as_ref().map(|image| (format!("{}-unbounded.png", mode.name()), image)),
            ];
            let keep = |(name, image): (String, &HdrImage)| -> Result<_, HarnessError> {
                keep(out, &name, image.to_png(exposure)?, Some(image))
            };
            let kept: Result<Pictures, _> =
                images.into_par_iter().flatten_iter().map(keep).collect();
            self.pictures.extend(kept?);
            picture = Some(name);
        }
        let unbounded_errors = unbounded
            .as_ref()
            .map(|reference| errors(&ImagePair { image: &image, reference, exposure }))
            .unwrap_or_default();
        Ok(Reference { image, unbounded, unbounded_errors, exposure, picture })
    }
}

/// Writes a picture, and the linear image that it shows; returns it for the report.
fn keep(
    out: &Path,
    name: &str,
    png: Vec<u8>,
    raw: Option<&HdrImage>,
) -> Result<(String, Vec<u8>), HarnessError> {
    let path = out.join(name);
    write_atomically(&path, &png)?;
    if let Some(image) = raw {
        image.write_exr(&path.with_extension("exr"))?;
    }
    Ok((name.to_owned(), png))
}

/// Compares a method's image with what it should be, and keeps its pictures.
fn see(
    args: &CompareArgs,
    choice: &Choice,
    mode: Mode,
    checked: Checked,
    reference: &Reference,
) -> Result<(Seen, Pictures), HarnessError> {
    let is_control = choice.family() == CONTROL;
    let Checked { image, lists } = checked;
    let is_same = image.pixels == reference.image.pixels;
    let exposure = reference.exposure;
    let pair = ImagePair { image: &image, reference: &reference.image, exposure };
    let mut seen = Seen::new(lists.unwrap_or_default(), is_control);
    if !is_control {
        seen.compare(&pair)?;
        seen.unbounded_errors = match &reference.unbounded {
            Some(unbounded) if !is_same => errors(&ImagePair { reference: unbounded, ..pair }),
            _ => reference.unbounded_errors.clone(),
        };
    }
    if args.path {
        // Along a path errors are means over the frames that are compared there.
        seen.forget_errors();
    }
    let mut pictures = Pictures::new();
    let Some(baseline) = &reference.picture else { return Ok((seen, pictures)) };
    let raw = |picture: &str| Some(picture.replace(".png", ".exr"));
    let mut images = Images {
        baseline: Some(baseline.clone()),
        raw_baseline: raw(baseline),
        raw_unbounded: reference
            .unbounded
            .as_ref()
            .map(|_| format!("{}-unbounded.exr", mode.name())),
        exposure: Some(f64::from(exposure)),
        ..Images::default()
    };
    let stem = format!("{}-{}", mode.name(), choice.id().replace('/', "-"));
    if is_same {
        // An image that is the same in every number is kept once.
        (images.image, images.raw) = (Some(baseline.clone()), raw(baseline));
    } else {
        let name = format!("{stem}.png");
        let exposure = if is_control { 1.0 } else { exposure };
        pictures.push(keep(&args.out, &name, image.to_png(exposure)?, Some(&image))?);
        images.raw = raw(&name);
        images.image = Some(name);
    }
    if !is_same && !is_control {
        let name = format!("{stem}-difference.png");
        let gain = DIFFERENCE_GAIN * exposure;
        let png = image.difference_png(&reference.image, gain)?;
        pictures.push(keep(&args.out, &name, png, None)?);
        images.difference = Some(name);
        images.difference_amplification = Some(f64::from(gain));
    }
    let lengths = &seen.lists.lengths.per_pixel;
    if !lengths.is_empty() {
        let name = format!("{stem}-heat.png");
        let png = heat_map_png(&reference.image, exposure, lengths)?;
        pictures.push(keep(&args.out, &name, png, None)?);
        images.heat_map = Some(name);
    }
    seen.images = images;
    Ok((seen, pictures))
}

fn progress_bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} frames, {eta} left  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
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
    if let Some(choice) = choices.iter().find(|choice| choice.is_reused() && !args.path) {
        let accepted =
            "given with --path: from a still camera lists are right however old they are";
        return Err(CliError::out_of_range("--strategies", choice.id(), accepted));
    }
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
        let asked = choice.id().to_owned();
        let choice = choice.checked(gpu).map_err(|error| match error {
            AssignError::Parameter { .. } => {
                HarnessError::Cli(CliError::new(format!("--strategies {asked}: {error}")))
            }
            other => other.into(),
        })?;
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
    cut: Cut,
) -> Result<(Vec<Choice>, Vec<String>), HarnessError> {
    let mut served = Vec::new();
    let mut left_out = Vec::new();
    for choice in choices {
        let check = || -> Result<(), HarnessError> {
            match choice.make(gpu)? {
                Method::Lists { mut strategy, .. } => {
                    strategy.prepare(gpu, &stage.renderer.frame(&stage.view, &stage.lights))?;
                }
                Method::RasterSphere if cut == Cut::Hard => {
                    let accepted = format!("windowed for {RASTER_SPHERE}");
                    return Err(CliError::out_of_range("--cut", cut.name(), &accepted).into());
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

/// Makes the output folder and writes to it once, before anything long begins.
pub fn check_writable(out: &Path) -> Result<(), ResultsError> {
    let probe = out.join(".lightbench");
    write_atomically(&probe, b"")?;
    std::fs::remove_file(&probe)
        .map_err(|source| ResultsError::Write { path: probe.clone(), source })
}

/// Removes an earlier run's report: it would stand beside this run's pictures if this one is
/// interrupted.
fn remove_stale(out: &Path) -> Result<(), ResultsError> {
    for stale in ["index.html", "results.json"].map(|name| out.join(name)) {
        if stale.is_file() {
            std::fs::remove_file(&stale)
                .map_err(|source| ResultsError::Write { path: stale, source })?;
        }
    }
    Ok(())
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
