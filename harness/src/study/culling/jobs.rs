//! The culling survey (Watrous 2024) as its paper has it, with lossless rows beside.
//!
//! As in the paper: 1920x1080, 0 to 1,500 lights in seven spawn cylinders, a threshold of 0.02 that
//! ends each light at once (`1/d^2`, no window), and clusters of 40 x 40 pixels and 24 slices, 48 x 27 x
//! 24 of them, that keep the first 128 lights of a list and ignore the rest. Lights lie in the buffer as
//! they were drawn, so that "the first 128" are not the nearest ones. Both renderers draw depth first.
//!
//! The paper does not state the lights' intensities; here all are alike. Its path has 1,000 frames; ours
//! has fewer, and fewer still where pixels are lit in fragment shaders, which data-centre GPUs run on a
//! few of their processors: there no culling takes most of a second per frame. Laps, the same poses
//! again, show which methods tie.

use crate::bench::Bench;
use crate::cli::{Size, StudyArgs};
use crate::error::HarnessError;
use crate::study::job::Job;
use crate::study::scene::StudyScene;

/// Clay, no culling, bounding spheres, rasterised spheres, the paper's clusters, the same without a cap,
/// our sparse clusters, and cells that lights add themselves to.
const STRATEGIES: &str = "Clay,None,Sphere,RasterSphere,DC-I/40x40x24/cap128,DC-I/40x40x24,SC-E,HG";

/// The family of the paper's clusters.
pub(crate) const CLUSTERS: &str = "DC-I";

/// How long to look at a mode.
struct Extent {
    mode: &'static str,
    counts: &'static [u32],
    poses: u32,
    laps: u32,
    warmup: u32,
}

const FULL: [Extent; 2] = [
    Extent {
        mode: "deferred",
        counts: &[0, 375, 750, 1_125, 1_500],
        poses: 20,
        laps: 6,
        warmup: 4,
    },
    Extent { mode: "forward", counts: &[0, 750, 1_500], poses: 12, laps: 1, warmup: 1 },
];

const QUICK: [Extent; 2] = [
    Extent { mode: "deferred", counts: &[0, 100, 300], poses: 4, laps: 2, warmup: 1 },
    Extent { mode: "forward", counts: &[0, 100, 300], poses: 8, laps: 1, warmup: 1 },
];

/// The paper's resolution.
const SIZE: Size = Size { width: 1920, height: 1080 };
const QUICK_SIZE: Size = Size { width: 192, height: 108 };

/// The jobs of one scene: a mode and a number of lights each.
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
    let (extents, size) = if args.quick { (QUICK, QUICK_SIZE) } else { (FULL, SIZE) };
    let size = args.size.unwrap_or(size);
    let mut jobs = Vec::new();
    for extent in &extents {
        for count in extent.counts {
            let is_last = extent.counts.last() == Some(count);
            let words = command(args, scene, extent, *count, size, is_last);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let lights = count.to_string();
            jobs.push(Job::new(scene, extent.mode, &lights, &words));
        }
    }
    jobs
}

/// One comparison; the last one of deferred lighting compares with lights without a range too.
fn command(
    args: &StudyArgs,
    scene: &StudyScene,
    extent: &Extent,
    count: u32,
    size: Size,
    is_last: bool,
) -> Vec<String> {
    let mut command = vec!["compare".to_owned()];
    command.extend(scene.options(size, args.seed));
    let mut option = |name: &str, value: String| command.extend([name.to_owned(), value]);
    option("--lights", count.to_string());
    option("--light-box", "cylinders".to_owned());
    option("--radii", "equal".to_owned());
    option("--threshold", "0.02".to_owned());
    option("--cut", "hard".to_owned());
    option("--light-order", "given".to_owned());
    option("--mode", extent.mode.to_owned());
    option("--strategies", STRATEGIES.to_owned());
    option("--frames", extent.poses.to_string());
    option("--laps", extent.laps.to_string());
    option("--warmup", extent.warmup.to_string());
    option("--truth", "none".to_owned());
    option("--pictures", "none".to_owned());
    command.push("--path".to_owned());
    if is_last && extent.mode == "deferred" {
        command.push("--unbounded".to_owned());
    }
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};
    use crate::study::slice::atrium;

    #[test]
    fn the_jobs_are_the_papers() {
        let Ok(Invocation::Study(args)) = parse(["lightbench", "study", "culling"]) else {
            panic!("a study")
        };
        let scene = &StudyScene::all(&args.with_scenes(atrium)).unwrap()[0];
        let jobs = plan(&args, scene);
        for mode in ["deferred", "forward"] {
            let of_mode: Vec<&Job> = jobs.iter().filter(|job| job.section == mode).collect();
            let commands: Vec<String> = of_mode.iter().map(|job| job.command.join(" ")).collect();
            // Three counts of lights make a line, from none to the paper's most.
            assert!(commands.len() >= 3, "{commands:?}");
            assert!(
                commands[0].contains("--lights 0 ")
                    && commands.last().unwrap().contains("--lights 1500 ")
            );
            for commands in &commands {
                for part in [
                    "DC-I/40x40x24/cap128,",
                    "--size 1920x1080",
                    "--cut hard",
                    "--threshold 0.02",
                    "--light-order given",
                    "--light-box cylinders",
                ] {
                    assert!(commands.contains(part), "{part}: {commands}");
                }
            }
        }
        assert!(jobs.iter().all(|job| parse(&job.command).is_ok()));
    }
}
