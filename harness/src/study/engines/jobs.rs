//! All engines' defaults with their nearest lossless settings, no culling, and two of our strategies for scale.

use crate::bench::Bench;
use crate::cli::{Size, StudyArgs};
use crate::error::HarnessError;
use crate::grouping::distinct;
use crate::strategy::{BASELINE, StrategyId, engines::ENGINES};
use crate::study::job::Job;
use crate::study::scene::StudyScene;

/// The section of times and errors along the path.
pub(crate) const PATH: &str = "path";
/// The section of lists and pictures from the still camera.
pub(crate) const VIEW: &str = "view";

/// Fast strategies without a loss: the best with many lights and with few (`docs/tuning.md`).
const OURS: [&str; 2] = ["SC-E/48x48x40/bvh", "T-E1/48x48"];

/// How much the study looks at.
struct Extent {
    size: Size,
    counts: [u32; 2],
    poses: u32,
    laps: u32,
    warmup: u32,
    /// Poses at which images are compared.
    checks: u32,
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    counts: [1_000, 10_000],
    poses: 24,
    laps: 6,
    warmup: 4,
    checks: 4,
};

/// The fewest lights at which the limits of engines bite.
const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    counts: [300, 1_000],
    poses: 4,
    laps: 2,
    warmup: 1,
    checks: 2,
};

/// The jobs of one scene: along the path and from the still camera, for each number of lights.
///
/// # Errors
///
/// Names what is wrong with the scene: a scene that cannot be opened shows before anything is written.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    scene.boxes(bench)?;
    Ok(plan(args, scene))
}

fn plan(args: &StudyArgs, scene: &StudyScene) -> Vec<Job> {
    let extent = if args.quick { QUICK } else { FULL };
    let size = args.size.unwrap_or(extent.size);
    let strategies = strategies([size.width, size.height]).join(",");
    let [poses, laps, warmup, checks] =
        [extent.poses, extent.laps, extent.warmup, extent.checks].map(|count| count.to_string());
    let path = ["--path", "--frames", &poses, "--laps", &laps, "--warmup", &warmup];
    let path = [&path[..], &["--checks", &checks]].concat();
    let path = [&path[..], &["--truth", "none", "--pictures", "none"]].concat();
    // Its times are not shown.
    let view = ["--frames", "1", "--warmup", "0", "--truth", "full", "--pictures", "all"];
    let job = |section: &str, count: u32, options: &[&str]| {
        let lights = count.to_string();
        let mut words = vec!["compare".to_owned()];
        words.extend(scene.options(size, args.seed));
        let all = ["--lights", &lights, "--strategies", &strategies];
        words.extend(all.iter().chain(options).map(|word| (*word).to_owned()));
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        Job::new(scene, section, &lights, &words)
    };
    let of_count = |count| [job(PATH, count, &path), job(VIEW, count, &view)];
    extent.counts.into_iter().flat_map(of_count).collect()
}

/// The ids that are measured at an image size, each once.
fn strategies(size_px: [u32; 2]) -> Vec<String> {
    let defaults: Vec<StrategyId> =
        ENGINES.iter().map(|engine| StrategyId::read(&engine.id(size_px))).collect();
    let lossless: Vec<StrategyId> =
        defaults.iter().filter_map(StrategyId::nearest_lossless).collect();
    let ids = defaults.iter().chain(&lossless).map(StrategyId::to_string);
    distinct(std::iter::once(BASELINE).chain(OURS).map(str::to_owned).chain(ids))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};
    use crate::study::slice::atrium;

    fn planned(line: &str) -> Vec<Job> {
        let words = ["lightbench", "study", "engines"].into_iter().chain(line.split_whitespace());
        let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
        let scene = &StudyScene::all(&args.with_scenes(atrium)).expect("scenes")[0];
        plan(&args, scene)
    }

    #[test]
    fn every_default_is_measured_beside_its_nearest_lossless_setting() {
        for (line, size) in [("", [1920, 1080]), ("--quick --size 480x270", [480, 270])] {
            let jobs = planned(line);
            let names: Vec<&str> = jobs.iter().map(|job| job.name.as_str()).collect();
            let counts = if line.is_empty() { ["1000", "10000"] } else { ["300", "1000"] };
            let expected = counts
                .map(|count| [PATH, VIEW].map(|section| format!("atrium-{section}-{count}")))
                .concat();
            assert_eq!(names, expected);
            for job in &jobs {
                let ids: Vec<&str> = job.option("--strategies").expect("ids").split(',').collect();
                assert_eq!(ids[..3], ["None", OURS[0], OURS[1]]);
                for engine in ENGINES {
                    let default = StrategyId::parse(&engine.id(size)).expect("an id");
                    assert!(ids.contains(&default.as_str()), "{default}");
                    let lossless = default.nearest_lossless();
                    assert_eq!(lossless.is_some(), default.is_lossy(u64::MAX), "{default}");
                    let is_there = lossless.is_none_or(|id| ids.contains(&id.as_str()));
                    assert!(is_there, "{default}");
                }
                let is_path = job.section == PATH;
                assert_eq!(job.command.iter().any(|word| word == "--path"), is_path);
                let pictures = if is_path { "none" } else { "all" };
                assert_eq!(job.option("--pictures"), Some(pictures));
                assert!(parse(&job.command).is_ok(), "{:?}", job.command);
            }
        }
    }
}
