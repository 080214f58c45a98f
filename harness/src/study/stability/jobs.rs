//! The jobs of a scenario: one frame, frames over time, and the methods that fail on purpose.

use scenes::stability::{self, Move, PREFIX, Scenario};

use crate::bench::Bench;
use crate::cli::{CliError, Size, StudyArgs};
use crate::error::HarnessError;
use crate::strategy::{Flaw, flaws};
use crate::study::job::Job;
use crate::study::scene::StudyScene;

/// The section of jobs with one frame.
pub(crate) const STILL: &str = "still";
/// The section of jobs with methods that fail on purpose.
pub(crate) const FLAWED: &str = "flawed";
/// What the section of frames over time starts with; the move follows.
const OVER_TIME: &str = "over-time";

/// How much the study looks at.
struct Extent {
    size: Size,
    /// Frames of a move. Each is compared.
    frames: u32,
}

const FULL: Extent = Extent { size: Size { width: 1920, height: 1080 }, frames: 6 };

/// The size of scenarios with very many lights: no culling evaluates a million of them in each pixel, which takes a fast GPU
/// seconds for each frame at the full size.
const HEAVY_SIZE: Size = Size { width: 480, height: 270 };

/// Small images with a border tile in each direction.
const QUICK: Extent = Extent { size: Size { width: 96, height: 54 }, frames: 3 };

/// All scenarios; without the heavy ones if the study is to be quick.
pub(crate) fn scenes(args: &StudyArgs) -> Vec<String> {
    let is_wanted = |scenario: &&Scenario| !(args.quick && scenario.heavy);
    stability::list().iter().filter(is_wanted).map(Scenario::id).collect()
}

/// The jobs of one scenario.
///
/// # Errors
///
/// Names a scene that is no scenario.
pub(crate) fn jobs(
    _: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    Ok(plan(args, scene)?)
}

/// The scenario that a scene of the study is.
pub(crate) fn scenario_of(scene: &str) -> Option<&'static Scenario> {
    stability::named(scene.strip_prefix(PREFIX).unwrap_or(scene))
}

fn plan(args: &StudyArgs, scene: &StudyScene) -> Result<Vec<Job>, CliError> {
    let Some(scenario) = scenario_of(&scene.scene) else {
        let accepted = "stability:NAME with a name that `lightbench list scenarios` prints";
        return Err(CliError::out_of_range("--scene", &scene.scene, accepted));
    };
    if !args.scene_scale.is_empty() {
        let accepted = "left out of study stability, because each scenario has its size";
        let value = args.scene_scale[0].to_string();
        return Err(CliError::out_of_range("--scene-scale", &value, accepted));
    }
    let extent = if args.quick { QUICK } else { FULL };
    let size = match (args.size, args.quick, scenario.heavy) {
        (Some(size), ..) => size,
        (None, false, true) => HEAVY_SIZE,
        (None, ..) => extent.size,
    };
    let frames = extent.frames.to_string();
    // Only forward modes draw several samples per pixel, and only images are checked then.
    let is_multisampled = scenario.options.contains(&"--msaa");
    let truth = if is_multisampled { "none" } else { "full" };
    let job = |id: String, section: &str, variant: &str, options: &[&str]| {
        let Size { width, height } = size;
        let (size, seed) = (format!("{width}x{height}"), args.seed.to_string());
        // What is wrong with a list is wrong in every mode.
        let mode = match section {
            _ if is_multisampled => "forward",
            FLAWED => "deferred",
            _ => "both",
        };
        let all = ["compare", "--scene", &id, "--size", &size, "--seed", &seed, "--mode", mode];
        let all =
            [&all[..], &["--warmup", "0", "--pictures", "differing"], scenario.options].concat();
        let all = [&all[..], options].concat();
        Job::new(scene, section, variant, &all)
    };
    let moved = |way: Option<Move>| -> Vec<&str> {
        match way {
            // Lists in random order differ from frame to frame.
            None => vec!["--frames", "1", "--temporal", "--checks", "3"],
            Some(Move::Lights(law)) => vec!["--motion", law, "--frames", &frames, "--temporal"],
            Some(_) => vec!["--path", "--frames", &frames, "--temporal"],
        }
    };
    let of_all = ["--strategies", "all"];
    let still = [&of_all[..], &["--truth", truth, "--frames", "1"]].concat();
    let mut jobs = vec![job(scenario.id(), STILL, "", &still)];
    for way in scenario.moves.iter().copied() {
        let options = [&of_all[..], &["--truth", "none"], &moved(Some(way))].concat();
        let section = format!("{OVER_TIME}-{}", way.name());
        jobs.push(job(scenario.id_with(way), &section, "", &options));
    }
    // In the first of its moves: what fails still fails there too.
    let way = scenario.moves.first().copied();
    let id = way.map_or_else(|| scenario.id(), |way| scenario.id_with(way));
    // A command is refused if one of its methods cannot serve what lies in front of surfaces: nothing that reads their
    // depth serves fog, and tiles serve the rest.
    let has_fog = scenario.options.contains(&"--fog");
    // Z-bins keep bit masks, which hold 2^20 lights at most.
    let exceeds_masks = scenario.name == "count-1048577";
    let is_served = |flaw: &&Flaw| match flaw.id_at([1, 1]).row() {
        Some(row) if exceeds_masks && row.family == "ZB" => false,
        Some(row) if !scenario.options.is_empty() && row.needs.depth => {
            !has_fog && !row.parameters.contains(&"slices")
        }
        _ => true,
    };
    for (ix, mut group) in by_options().into_iter().enumerate() {
        group.retain(is_served);
        if group.is_empty() {
            continue;
        }
        let ids: Vec<&str> = group.iter().map(|flaw| flaw.id).collect();
        let names: Vec<&str> = group.iter().map(|flaw| flaw.name).collect();
        let ids = ids.join(",");
        let options =
            [&["--strategies", ids.as_str(), "--truth", truth], group[0].options].concat();
        let mut options = [options, moved(way)].concat();
        if matches!(way, Some(Move::Lights(_))) {
            // The CPU must know the lights that a limit leaves out.
            options.extend(["--light-order", "given"]);
        }
        let flawed = job(id.clone(), FLAWED, &(ix + 1).to_string(), &options);
        jobs.push(flawed.with("flaws", &names.join(SEPARATOR)));
    }
    Ok(jobs)
}

/// Between the names of methods in the setting `flaws` of a job.
pub(crate) const SEPARATOR: &str = "; ";

/// The methods that fail on purpose, by their options: each group is one command.
fn by_options() -> Vec<Vec<&'static Flaw>> {
    let mut groups: Vec<Vec<&Flaw>> = Vec::new();
    for flaw in flaws() {
        match groups.iter_mut().find(|group| group[0].options == flaw.options) {
            Some(group) => group.push(flaw),
            None => groups.push(vec![flaw]),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    fn planned(line: &str) -> Result<Vec<Job>, CliError> {
        let words = ["lightbench", "study", "stability"].into_iter().chain(line.split_whitespace());
        let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
        let args = args.with_scenes(scenes);
        let mut all = Vec::new();
        for scene in StudyScene::all(&args)? {
            all.extend(plan(&args, &scene)?);
        }
        Ok(all)
    }

    #[test]
    fn every_scenario_has_its_jobs_and_every_command_is_valid() {
        let jobs = planned("").expect("jobs");
        for scenario in stability::list() {
            let of_scenario: Vec<&Job> =
                jobs.iter().filter(|job| job.scene == scenario.name).collect();
            let sections: Vec<&str> = of_scenario.iter().map(|job| job.section.as_str()).collect();
            assert_eq!(sections[0], STILL, "{}", scenario.name);
            let over_time =
                sections.iter().filter(|section| section.starts_with(OVER_TIME)).count();
            assert_eq!(over_time, scenario.moves.len(), "{}", scenario.name);
            let flawed = sections.iter().filter(|section| **section == FLAWED).count();
            let all = by_options().len();
            let is_whole = flawed == all || !scenario.options.is_empty() && flawed > 0;
            assert!(is_whole, "{}: {flawed} of {all}", scenario.name);
        }
        for job in &jobs {
            assert!(parse(&job.command).is_ok(), "{:?}", job.command);
        }
        let mut names: Vec<&str> = jobs.iter().map(|job| job.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), jobs.len());
    }

    #[test]
    fn quick_runs_leave_out_heavy_scenarios() {
        let heavy = stability::list().iter().find(|scenario| scenario.heavy).expect("a heavy one");
        let has =
            |line: &str| planned(line).expect("jobs").iter().any(|job| job.scene == heavy.name);
        assert!(has("") && !has("--quick"));
    }

    #[test]
    fn scenes_that_are_no_scenario_are_refused() {
        let error = planned("--scene atrium").expect_err("refused").to_string();
        assert!(error.starts_with("--scene is atrium: it must be stability:NAME"), "{error}");
        let error = planned("--scene stability:far-slices --scene-scale 2").expect_err("refused");
        assert!(error.to_string().starts_with("--scene-scale is 2: "), "{error}");
    }
}
