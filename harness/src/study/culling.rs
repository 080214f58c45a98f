//! The culling survey (Watrous 2024): 0 to 1,500 lights in seven spawn cylinders, along a path of
//! 1,000 frames, forward and deferred.

use super::{Job, StudyScene};
use crate::cli::{Size, StudyArgs};

/// Clay, no culling, bounding spheres, rasterised spheres, clusters, and cells that lights add
/// themselves to.
const STRATEGIES: &str = "Clay,None,Sphere,RasterSphere,DC-I,SC-E/bvh,HG";

/// The jobs of one scene: a mode and a number of lights each.
pub(super) fn jobs(args: &StudyArgs, scene: &StudyScene) -> Vec<Job> {
    let (counts, frames, size): (&[u32], u32, Size) = if args.quick {
        (&[0, 100, 300], 8, Size { width: 192, height: 108 })
    } else {
        (&[0, 250, 500, 750, 1_000, 1_250, 1_500], 1_000, Size { width: 1280, height: 720 })
    };
    let Size { width, height } = args.size.unwrap_or(size);
    let mut jobs = Vec::new();
    for mode in ["deferred", "forward"] {
        for count in counts {
            let mut command = vec!["lightbench".to_owned(), "compare".to_owned()];
            let mut option = |name: &str, value: String| command.extend([name.to_owned(), value]);
            option("--scene", scene.scene.clone());
            option("--scene-scale", scene.scale.to_string());
            option("--lights", count.to_string());
            option("--light-box", "cylinders".to_owned());
            option("--size", format!("{width}x{height}"));
            option("--seed", args.seed.to_string());
            option("--mode", mode.to_owned());
            option("--strategies", STRATEGIES.to_owned());
            option("--frames", frames.to_string());
            option("--truth", "none".to_owned());
            option("--pictures", "none".to_owned());
            command.push("--path".to_owned());
            jobs.push(Job {
                name: format!("{}-{mode}-{count}", scene.name),
                scene: scene.name.clone(),
                section: mode.to_owned(),
                command,
            });
        }
    }
    jobs
}
