//! One job per scene and reach: no culling and sparse clusters, from both sources of lights.

use scenes::stability::{self, Group, Scenario};

use crate::bench::Bench;
use crate::cli::{Size, StudyArgs};
use crate::error::HarnessError;
use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::study::stability::scenario_of;

/// The section of all jobs.
pub(crate) const REACH: &str = "reach";

/// Clusters that hold samples, bounded by them.
const CLUSTERS: &str = "SC-E/48x48x40";

/// How much the study looks at.
struct Extent {
    size: Size,
    /// The most ranges that a specular term reaches; 1 is that of the diffuse term.
    reaches: &'static [u32],
    /// Lights of scenes that are no scenarios.
    lights: u32,
    frames: u32,
    warmup: u32,
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    reaches: &[1, 2, 4, 8, 16],
    lights: 1_000,
    frames: 16,
    warmup: 4,
};

const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    reaches: &[1, 4, 16],
    lights: 200,
    frames: 3,
    warmup: 1,
};

/// The scenarios of gloss, and the atrium.
pub(crate) fn scenes(_: &StudyArgs) -> Vec<String> {
    let of_gloss = |scenario: &&Scenario| scenario.group == Group::Gloss;
    let scenarios = stability::list().iter().filter(of_gloss).map(Scenario::id);
    scenarios.chain(["atrium".to_owned()]).collect()
}

/// The jobs of one scene, by reach.
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
    let Size { width, height } = args.size.unwrap_or(extent.size);
    let (scale, size) = (scene.scale.to_string(), format!("{width}x{height}"));
    let (seed, lights) = (args.seed.to_string(), extent.lights.to_string());
    let [frames, warmup] = [extent.frames, extent.warmup].map(|count| count.to_string());
    let drawn = ["compare", "--scene", &scene.scene, "--scene-scale", &scale, "--size", &size];
    // A scenario has its own lights.
    let lit = match scenario_of(&scene.scene) {
        Some(scenario) => scenario.options.to_vec(),
        None => vec!["--lights", &lights, "--no-own-lights"],
    };
    let timed = ["--seed", &seed, "--mode", "both", "--frames", &frames, "--warmup", &warmup];
    let common = [&drawn[..], &lit, &timed, &["--unbounded"]].concat();
    let job = |reach: &u32| {
        let (segment, reach) = (format!("/reach{reach}"), reach.to_string());
        let (segment, own) = match reach.as_str() {
            "1" => ("", Vec::new()),
            _ => (segment.as_str(), vec!["--specular-reach", &reach]),
        };
        let strategies = format!("None,{CLUSTERS}{segment},{CLUSTERS}{segment}/bvh");
        let words = [&common[..], &["--strategies", &strategies], &own].concat();
        Job::new(scene, REACH, &reach, &words)
    };
    extent.reaches.iter().map(job).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    #[test]
    fn each_reach_is_drawn_with_lists_as_long() {
        for line in ["", "--quick"] {
            let words = ["lightbench", "study", "gloss"].into_iter().chain(line.split_whitespace());
            let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
            let args = args.with_scenes(scenes);
            assert_eq!(args.scene.len(), 4, "{:?}", args.scene);
            for scene in StudyScene::all(&args).expect("scenes") {
                let jobs = plan(&args, &scene);
                assert!(jobs.len() >= 3 && jobs[0].option("--specular-reach").is_none());
                for job in &jobs {
                    assert!(parse(&job.command).is_ok(), "{:?}", job.command);
                    let reach = job.option("--specular-reach").map(|n| format!("/reach{n}"));
                    let ids = job.option("--strategies").expect("ids");
                    let clusters = CLUSTERS.to_owned() + &reach.unwrap_or_default();
                    assert_eq!(ids, format!("None,{clusters},{clusters}/bvh"));
                }
            }
        }
    }
}
