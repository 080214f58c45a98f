//! What is checked before anything long begins.

use std::path::Path;

use assign::{AssignError, Gpu};
use shading::Cut;

use crate::{
    choice::Choice,
    cli::{CliError, CompareArgs},
    error::HarnessError,
    painter::raster_spheres,
    results::ResultsError,
    stage::Stage,
    strategy::Method,
};

/// The most frames of a method on the clock, laps and poses together.
const MAX_SAMPLES: u32 = 100_000;

/// Poses of a lap where the command line names none, at most.
const MOST_POSES: u32 = 1_200;

/// An error where laps are asked for without a path or too often, or where no choice can be measured
/// in any of the modes.
pub(crate) fn check_modes(args: &CompareArgs, choices: &[Choice]) -> Result<(), CliError> {
    if let Some(checks) = args.checks.filter(|_| !args.path) {
        let accepted = "given with --path: a camera that stands still has one pose";
        return Err(CliError::out_of_range("--checks", &checks.to_string(), accepted));
    }
    if let Some(laps) = args.laps {
        let refuse =
            |accepted: &str| Err(CliError::out_of_range("--laps", &laps.to_string(), accepted));
        if !args.path {
            return refuse("given with --path: a camera that stands still takes no laps");
        }
        let most = MAX_SAMPLES / args.frames.unwrap_or(MOST_POSES);
        if laps > most.max(1) {
            return refuse(&format!("at most {} with as many --frames", most.max(1)));
        }
    }
    if let Some(choice) = choices.iter().find(|choice| choice.is_reused() && !args.path) {
        let accepted =
            "given with --path: from a still camera lists are right however old they are";
        return Err(CliError::out_of_range("--strategies", choice.id(), accepted));
    }
    let modes = args.mode.modes();
    let is_served = |choice: &Choice| modes.iter().any(|&mode| choice.refuses_mode(mode).is_none());
    if let Some(choice) = choices.first().filter(|_| !choices.iter().any(is_served)) {
        let family = choice.row().family;
        let accepted = format!("deferred for {family}, which has no such mode");
        let names: Vec<&str> = modes.iter().map(|mode| mode.name()).collect();
        return Err(CliError::out_of_range("--mode", &names.join(" and "), &accepted));
    }
    Ok(())
}

/// The choices with their parameters checked, none twice.
pub(crate) fn checked(choices: Vec<Choice>, gpu: &Gpu) -> Result<Vec<Choice>, HarnessError> {
    let mut checked: Vec<Choice> = Vec::new();
    for choice in choices {
        let id = choice.id();
        choice.make(gpu).map_err(|error| match error {
            AssignError::Parameter { .. } => {
                HarnessError::Cli(CliError::new(format!("--strategies {id}: {error}")))
            }
            other => other.into(),
        })?;
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
pub(crate) fn served(
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
                    if cut == Cut::Hard && choice.is_specular_cut() {
                        let accepted = format!("windowed for {}", choice.id());
                        return Err(CliError::out_of_range("--cut", cut.name(), &accepted).into());
                    }
                    if choice.is_specular_cut() && stage.has_dielectrics() {
                        return Err(CliError::new(format!(
                            "{}: its bound on lost light holds for dielectrics that reflect 0.04, and \
                             materials of the scene reflect otherwise (KHR_materials_ior, \
                             KHR_materials_specular): leave the segment out",
                            choice.id()
                        ))
                        .into());
                    }
                    strategy.prepare(gpu, &stage.renderer.frame(&stage.view, &stage.lights))?;
                }
                Method::RasterSphere => {
                    raster_spheres(stage, cut)?;
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

/// An error where an option of area lights was given and no light is one: only the scene's file tells.
pub(crate) fn check_area_options(args: &CompareArgs, stage: &Stage) -> Result<(), CliError> {
    let given = [
        ("--area-model", args.area_model.map(|model| model.to_string())),
        ("--influence", args.stage.influence.map(|least| least.to_string())),
    ];
    let has_areas = stage.lights.kinds().areas || stage.lights.count() == 0;
    match given.into_iter().find_map(|(option, value)| Some((option, value?))) {
        Some((option, value)) if !has_areas => {
            let accepted = "given with area lights: there are none; --areas SHARE scatters some";
            Err(CliError::out_of_range(option, &value, accepted))
        }
        _ => Ok(()),
    }
}

/// Removes an earlier run's report: it would stand beside this run's pictures if this one is
/// interrupted.
pub(crate) fn remove_stale(out: &Path) -> Result<(), ResultsError> {
    for stale in ["index.html", "results.json", "metrics.json"].map(|name| out.join(name)) {
        if stale.is_file() {
            std::fs::remove_file(&stale)
                .map_err(|source| ResultsError::Write { path: stale, source })?;
        }
    }
    Ok(())
}
