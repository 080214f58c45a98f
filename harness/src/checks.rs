//! Checks that run before any long work starts.

use std::path::Path;

use assign::{AssignError, Gpu, check_listed_reach};
use shading::{Cut, Mode};

use crate::{
    area_options::{check_area_lod, check_lit_by_emitters},
    choice::Choice,
    cli::{BAD_INPUT, CliError, CompareArgs, LayerArgs, MotionChoice, PicturesChoice, StageArgs},
    error::HarnessError,
    painter::raster_spheres,
    results::{RefusedStrategy, ResultsError},
    shadows::{check_occlusion, check_shadows},
    stage::Stage,
    strategy::{Method, rows},
    truth_level::TruthLevel,
};

/// The most timed frames per method: laps times poses.
const MAX_SAMPLES: u32 = 100_000;

/// The most poses per lap where the command line gives no number.
const MOST_POSES: u32 = 1_200;

/// Refuses options that contradict each other or have no effect, and modes in which no strategy can run.
pub(crate) fn check_options(args: &CompareArgs, choices: &[Choice]) -> Result<(), CliError> {
    check_effect(args, choices)?;
    let is_still = !args.path && args.stage.motion.motion.is_none();
    check_motion(&args.stage)?;
    check_samples(args)?;
    if args.checks == Some(0) && (args.unbounded || args.pictures != PicturesChoice::None) {
        let accepted =
            "1 or more without --pictures none, and with --unbounded: both draw no culling";
        return Err(CliError::out_of_range("--checks", "0", accepted));
    }
    if args.temporal && args.checks.is_some_and(|checks| checks < 2) {
        let checks = args.checks.unwrap_or_default().to_string();
        let accepted = "2 to 8 with --temporal, which compares a frame with the one before";
        return Err(CliError::out_of_range("--checks", &checks, accepted));
    }
    if args.temporal && !is_still && args.frames == Some(1) {
        let accepted = "2 or more with --temporal, which compares a frame with the one before";
        return Err(CliError::out_of_range("--frames", "1", accepted));
    }
    if args.unbounded && args.cut == Cut::Never {
        let accepted = "windowed or hard with --unbounded: with never, no culling shows lights without a range";
        return Err(CliError::out_of_range("--cut", args.cut.name(), accepted));
    }
    check_reach(args.specular_reach, args.cut)?;
    check_area_lod(args)?;
    check_shadows(args.shadows, &args.stage, &args.layers, (args.path, args.msaa))?;
    check_occlusion(args.shadows, choices)?;
    if let Some(path) = args.against.as_ref().filter(|_| args.pictures != PicturesChoice::All) {
        let accepted =
            "left out with --pictures differing and none, which keep no image of no culling";
        return Err(CliError::out_of_range("--against", &path.display().to_string(), accepted));
    }
    if args.unbounded && args.shadows.is_on() {
        let accepted =
            "none with --unbounded, whose lights have other ranges than those of the maps";
        return Err(CliError::out_of_range("--shadows", &args.shadows.to_string(), accepted));
    }
    if let Some(checks) = args.checks.filter(|_| is_still && !args.temporal) {
        let accepted =
            "left out without --path, --motion and --temporal, because all frames are the same";
        return Err(CliError::out_of_range("--checks", &checks.to_string(), accepted));
    }
    if let Some(laps) = args.laps {
        let refuse =
            |accepted: &str| Err(CliError::out_of_range("--laps", &laps.to_string(), accepted));
        if is_still {
            return refuse(
                "left out without --path and --motion, because a still frame makes no laps",
            );
        }
        let most = MAX_SAMPLES / args.frames.unwrap_or(MOST_POSES);
        if laps > most.max(1) {
            return refuse(&format!("at most {} for this number of --frames", most.max(1)));
        }
    }
    if let Some(choice) = choices.iter().find(|choice| choice.is_reused() && is_still) {
        let accepted =
            "combined with --path or --motion: for a still frame old lists are always right";
        return Err(CliError::out_of_range("--strategies", choice.id().as_str(), accepted));
    }
    let modes = args.mode.modes();
    let is_served = |choice: &Choice| modes.iter().any(|&mode| choice.refuses_mode(mode).is_none());
    if !choices.is_empty() && !choices.iter().any(is_served) {
        let mut accepted: Vec<String> = Vec::new();
        for row in choices.iter().map(Choice::row) {
            let served = Mode::ALL.into_iter().filter(|mode| row.refuses_mode(*mode).is_none());
            let served: Vec<&str> = served.map(Mode::name).collect();
            let why = modes.iter().find_map(|mode| row.refuses_mode(*mode)).unwrap_or_default();
            let accepted_here =
                format!("{} for {}, because {why}", served.join(" or "), row.family);
            if !accepted.contains(&accepted_here) {
                accepted.push(accepted_here);
            }
        }
        let names: Vec<&str> = modes.iter().map(|mode| mode.name()).collect();
        let accepted = accepted.join("; ");
        return Err(CliError::out_of_range("--mode", &names.join(" and "), &accepted));
    }
    Ok(())
}

/// Refuses specular terms that reach beyond ranges where no term ends.
pub(crate) fn check_reach(specular_reach: Option<f64>, cut: Cut) -> Result<(), CliError> {
    if specular_reach.is_some() && cut == Cut::Never {
        let accepted = "windowed or hard with --specular-reach: with never, no term ends";
        return Err(CliError::out_of_range("--cut", cut.name(), accepted));
    }
    Ok(())
}

/// Refuses several samples per pixel where something reads or draws one.
fn check_samples(args: &CompareArgs) -> Result<(), CliError> {
    let refuse = |value: &str, accepted| Err(CliError::out_of_range("--msaa", value, accepted));
    match args.msaa {
        1 => Ok(()),
        4 if !args.mode.modes().iter().all(|mode| mode.is_forward()) => {
            refuse("4", "1, or 4 with --mode forward or forward-no-prepass")
        }
        4 if args.truth != TruthLevel::None || args.operations => refuse(
            "4",
            "1, or 4 with --truth none and without --operations, which read one depth per pixel",
        ),
        4 if args.layers != LayerArgs::default() => {
            refuse("4", "1 with --transparent, --particles and --fog")
        }
        4 => Ok(()),
        other => refuse(&other.to_string(), "1 or 4"),
    }
}

/// Refuses lights that cannot move as they are asked to, whatever the scene.
pub(crate) fn check_motion(args: &StageArgs) -> Result<(), CliError> {
    if args.motion.motion == Some(MotionChoice::File) && args.no_own_lights {
        let accepted =
            "one of the laws with --no-own-lights, which leaves out what the file animates";
        return Err(CliError::out_of_range("--motion", "file", accepted));
    }
    let order = args.light_order();
    if args.motion.is_on_gpu() && !order.is_on_gpu() {
        let accepted =
            "gpu, gpuN or gpuN% with --moved-by gpu, because the CPU does not know the lights";
        return Err(CliError::out_of_range("--light-order", &order.to_string(), accepted));
    }
    Ok(())
}

/// Refuses options of strategies that apply to none of them.
fn check_effect(args: &CompareArgs, choices: &[Choice]) -> Result<(), CliError> {
    type Applies = fn(&Choice) -> bool;
    let rules: [(&str, bool, Applies, &str); 3] = [
        (
            "test",
            args.test.is_some(),
            Choice::takes_tests,
            "tests lights against frusta and whose id names no tests",
        ),
        (
            "source",
            args.source.is_some(),
            Choice::takes_source,
            "can read lights from both sources and whose id names none",
        ),
        ("operations", args.operations, Choice::has_groups, "has lists"),
    ];
    match rules.into_iter().find(|(_, given, applies, _)| *given && !choices.iter().any(applies)) {
        Some((option, .., what)) => Err(CliError::without_effect(
            option,
            &format!("a strategy in --strategies that {what}"),
        )),
        None => Ok(()),
    }
}

/// Checks the parameters of all choices and removes repeated ones.
pub(crate) fn checked(choices: Vec<Choice>, gpu: &Gpu) -> Result<Vec<Choice>, HarnessError> {
    let mut checked: Vec<Choice> = Vec::new();
    for choice in choices {
        let id = choice.id();
        match choice.make(gpu) {
            Ok(_) => {}
            // `served` leaves it out, and says so.
            Err(AssignError::Unsupported { .. }) if !choice.is_named => {}
            Err(error @ AssignError::Parameter { .. }) => {
                return Err(CliError::new(format!("--strategies {id}: {error}")).into());
            }
            Err(other) => return Err(other.into()),
        }
        if checked.iter().any(|known| known.id() == id) {
            if !choice.is_named {
                continue;
            }
            let message = format!("--strategies names {id} twice: it must name each strategy once");
            return Err(CliError::new(message).into());
        }
        checked.push(choice);
    }
    Ok(checked)
}

/// The choices that can serve the scene on this device, and the other ones of `all` with the reason. An
/// error where the user named a choice that cannot.
pub(crate) fn served(
    choices: Vec<Choice>,
    gpu: &Gpu,
    stage: &mut Stage,
    cut: Cut,
) -> Result<(Vec<Choice>, Vec<RefusedStrategy>), HarnessError> {
    // Images of the view's size.
    stage.renderer.prepare(&stage.view, &stage.lights)?;
    let mut served = Vec::new();
    let mut left_out = Vec::new();
    for choice in choices {
        match check_serves(&choice, gpu, stage, cut) {
            Ok(()) => served.push(choice),
            Err(error) if !choice.is_named => {
                let (strategy, reason) = (choice.id().to_string(), error.to_string());
                left_out.push(RefusedStrategy { strategy, mode: None, reason });
            }
            Err(error) if error.exit_code() != BAD_INPUT => return Err(error),
            Err(error) => {
                let others = rows().filter_map(|row| Choice::parse(row.family).ok());
                let others = others.filter(|other| check_serves(other, gpu, stage, cut).is_ok());
                let ids: Vec<String> = others.map(|other| other.id().to_string()).collect();
                let ids = match ids.is_empty() {
                    true => "none".to_owned(),
                    false => ids.join(", "),
                };
                return Err(CliError::new(format!("{error}; what serves this run: {ids}")).into());
            }
        }
    }
    Ok((served, left_out))
}

/// Refuses a choice that cannot serve the scene on this device.
fn check_serves(choice: &Choice, gpu: &Gpu, stage: &Stage, cut: Cut) -> Result<(), HarnessError> {
    match choice.make(gpu)? {
        Method::Lists { mut strategy, .. } => {
            if cut != Cut::Windowed && choice.is_specular_cut() {
                let accepted = format!("windowed for {}", choice.id());
                return Err(CliError::out_of_range("--cut", cut.name(), &accepted).into());
            }
            if choice.is_specular_cut() && stage.has_dielectrics() {
                return Err(CliError::new(format!(
                    "{}: remove the segment that cuts specular light. Its bound on lost light holds for \
                     dielectrics of reflectance 0.04, and the scene has other ones (KHR_materials_ior, \
                     KHR_materials_specular)",
                    choice.id()
                ))
                .into());
            }
            if let Some(most) = stage.specular_reach {
                check_listed_reach(strategy.as_ref(), most)?;
            }
            strategy.prepare(gpu, &stage.renderer.frame(&stage.view, &stage.lights))?;
        }
        Method::RasterSphere => {
            if let Some(most) = stage.specular_reach {
                return Err(AssignError::Unsupported {
                    strategy: choice.id().to_string(),
                    asked: format!("specular terms that reach {most} ranges of their lights"),
                    reason: "its light volumes end at the lights' ranges".into(),
                }
                .into());
            }
            check_lit_by_emitters(choice, stage)?;
            raster_spheres(stage, cut)?;
        }
        Method::Clay => {}
    }
    Ok(())
}

/// Removes the report of an earlier run. If this run is interrupted, the old report must not stand beside
/// the new pictures.
pub(crate) fn remove_stale(out: &Path) -> Result<(), ResultsError> {
    for stale in ["index.html", "results.json", "metrics.json"].map(|name| out.join(name)) {
        if stale.is_file() {
            std::fs::remove_file(&stale)
                .map_err(|source| ResultsError::Write { path: stale, source })?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    fn check(line: &str) -> Result<(), CliError> {
        let words = std::iter::once("lightbench").chain(line.split(' '));
        let Ok(Invocation::Compare(args)) = parse(words) else { panic!("{line} does not parse") };
        check_options(&args, &args.choices().expect("strategies"))
    }

    #[test]
    fn options_that_apply_to_no_strategy_are_refused() {
        for (line, option) in [
            ("--strategies None,T-E/hs --test hs+sat-p", "--test"),
            ("--strategies None,HG,T-E/bvh --source linear", "--source"),
            ("--strategies None,Sphere --operations", "--operations"),
        ] {
            let error = check(line).expect_err(line).to_string();
            let expected =
                format!("{option} has no effect here: it needs a strategy in --strategies that ");
            assert!(error.starts_with(&expected), "{line}: {error}");
        }
        assert_eq!(check("--strategies None,T-E --test hs --source both --operations"), Ok(()));
    }

    #[test]
    fn shadows_are_refused_where_there_are_no_maps() {
        for option in ["--motion drift", "--vpls 64", "--light-order gpu", "--unbounded"] {
            let line = format!("--shadows maps:4,64 {option}");
            let error = check(&line).expect_err(option).to_string();
            let name = option.split(' ').next().expect("a name");
            assert!(
                error.starts_with("--shadows is maps:4,64: ") && error.contains(name),
                "{error}"
            );
            assert_eq!(check(&format!("--shadows none {option}")), Ok(()), "{option}");
        }
        assert_eq!(check("--shadows maps:4,64 --path --areas 0.5"), Ok(()));
        for layers in ["--fog 0.1", "--particles 9", "--transparent"] {
            assert_eq!(check(&format!("--shadows maps:4,64 {layers}")), Ok(()), "{layers}");
        }
        assert_eq!(check("--shadows maps:4,64 --motion drift --light-order given"), Ok(()));
        for option in ["--path", "--msaa 4 --mode forward --truth none", "--motion drift"] {
            let error = check(&format!("--shadows adaptive:64,4,25 {option}")).expect_err(option);
            let name = option.split(' ').next().expect("a name");
            let error = error.to_string();
            assert!(
                error.starts_with("--shadows is adaptive:64,4,25: ") && error.contains(name),
                "{error}"
            );
        }
        assert_eq!(check("--shadows adaptive:64,4,25 --mode both --areas 0.5"), Ok(()));
    }

    #[test]
    fn lights_that_cannot_move_as_asked_are_refused() {
        for (line, refused) in [
            ("--motion drift --moved-by gpu --light-order given", "--light-order is given: "),
            ("--motion drift --moved-by gpu --light-order bvh", "--light-order is bvh: "),
            ("--motion file --no-own-lights", "--motion is file: "),
            ("--path --checks 0", "--checks is 0: "),
            ("--path --checks 0 --pictures none --unbounded", "--checks is 0: "),
            ("--checks 0 --pictures none", "--checks is 0: "),
            ("--checks 4", "--checks is 4: "),
            ("--temporal --checks 1", "--checks is 1: "),
            ("--temporal --path --frames 1", "--frames is 1: "),
            ("--unbounded --cut never", "--cut is never: "),
            ("--against truth.exr --pictures none", "--against is truth.exr: "),
            ("--specular-reach 4 --cut never", "--cut is never: "),
            ("--area-lod 0.01 --area-model point", "--area-lod is 0.01: "),
        ] {
            let error = check(line).expect_err(line).to_string();
            assert!(error.starts_with(refused), "{line}: {error}");
        }
        for line in [
            "--motion drift --moved-by gpu",
            "--motion drift --moved-by gpu --unbounded",
            "--motion drift --light-order given --laps 2 --checks 3",
            "--path --checks 0 --pictures none",
            "--temporal --checks 2 --frames 1",
            "--temporal --path --frames 2 --cut never",
            "--area-lod 0.01 --area-model mrp",
        ] {
            assert_eq!(check(line), Ok(()), "{line}");
        }
    }
}
