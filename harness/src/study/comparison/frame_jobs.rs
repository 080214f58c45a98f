//! The frames that a renderer may draw, along the path: forward shading without a depth pre-pass and
//! with one, deferred shading without and with models in the G-buffer.

use crate::cli::Size;
use crate::study::job::Job;
use crate::study::scene::StudyScene;

/// Strategies at the paper's parameters, and one of each kind through the hierarchy.
const STRATEGIES: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,T-E/bvh,SC-E/bvh,G/bvh";

/// As few as show a pre-pass that is paid for, and one that is not.
const QUICK: &str = "T-I,SC-E,M/2";

/// A job for each count of lights.
///
/// One pose is checked against no culling: in forward shading that takes seconds a frame on chips that
/// run fragment shaders on a few processors.
pub(crate) fn jobs(
    scene: &StudyScene,
    size: Size,
    seed: u64,
    counts: &[u32],
    is_quick: bool,
) -> Vec<Job> {
    let (strategies, poses, laps) =
        if is_quick { (QUICK, "2", "6") } else { (STRATEGIES, "12", "6") };
    let size = format!("{}x{}", size.width, size.height);
    let (seed, scale) = (seed.to_string(), scene.scale.to_string());
    let job = |&count: &u32| {
        let lights = count.to_string();
        let mut words = vec!["compare", "--scene", scene.scene.as_str(), "--scene-scale", &scale];
        words.extend(["--lights", &lights, "--size", &size, "--seed", &seed, "--warmup", "4"]);
        words.extend(["--strategies", strategies, "--mode", "all"]);
        words.extend(["--path", "--frames", poses, "--laps", laps, "--checks", "1"]);
        words.extend(["--truth", "none", "--pictures", "none"]);
        Job::new(scene, "frames", &lights, &words)
    };
    counts.iter().map(job).collect()
}
