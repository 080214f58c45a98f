//! Jobs of rays through deep images in place of maps, and as many maps beside them.

use shading::{MAP_COUNTS, ShadowModel};

use super::jobs::{FEW, RANGE_SHARE, RAYS, alike, extent_of};
use crate::{
    bench::Bench,
    cli::StudyArgs,
    error::HarnessError,
    strategy::BASELINE,
    study::{job::Job, scene::StudyScene},
};

/// How much the section looks at.
struct Extent {
    /// Rays to each light.
    rays: &'static [u32],
    /// Directions and pixels of the images that they cross.
    images: &'static [(&'static str, &'static str)],
    /// The side of maps from as many points, texels.
    map_px: u32,
}

const FULL: Extent =
    Extent { rays: &[1, 4, 9, 16, 25], images: &[("8x8", "256"), ("8x8", "512")], map_px: 512 };

const QUICK: Extent = Extent { rays: &[1, 9], images: &[("4x4", "32")], map_px: 64 };

/// The jobs of a scene.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let ([core, _], _) = scene.boxes(bench)?;
    Ok(plan(args, scene, core.diagonal() * RANGE_SHARE))
}

fn plan(args: &StudyArgs, scene: &StudyScene, range_m: f32) -> Vec<Job> {
    let extent = if args.quick { &QUICK } else { &FULL };
    let study = extent_of(args);
    let drawn = scene.options(args.size.unwrap_or(study.size), args.seed);
    let lit = [drawn, alike(range_m)].concat();
    let lit: Vec<&str> = lit.iter().map(String::as_str).collect();
    let few = FEW.to_string();
    let job = |variant: &str, model: ShadowModel, more: &[&str]| {
        let model = model.to_string();
        let timed = ["--frames", study.frames, "--warmup", study.warmup, "--truth", "none"];
        let chosen = ["--strategies", BASELINE, "--lights", &few, "--shadows", &model];
        Job::new(scene, RAYS, variant, &[&["compare"], &lit[..], &timed, &chosen, more].concat())
    };
    let mut jobs = Vec::new();
    for rays in extent.rays {
        for (directions, size) in extent.images {
            let images = ["--directions", directions, "--deep-size", size];
            let variant = format!("{rays}-{directions}-{size}");
            jobs.push(job(&variant, ShadowModel::Cdi { rays: *rays }, &images));
        }
        if MAP_COUNTS.contains(rays) {
            let model = ShadowModel::Maps { maps: *rays, px: extent.map_px, taps: 1 };
            jobs.push(job(&format!("maps-{rays}"), model, &[]));
        }
    }
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    #[test]
    fn every_job_is_a_command_that_is_not_refused() {
        for (line, count) in [("", 14), ("--quick", 4)] {
            let words =
                ["lightbench", "study", "shadows"].into_iter().chain(line.split_whitespace());
            let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
            let args = args.with_scenes(|_| vec!["atrium".to_owned()]);
            let scenes = StudyScene::all(&args).expect("scenes");
            let jobs = plan(&args, &scenes[0], 10.0);
            assert_eq!(jobs.len(), count);
            for job in jobs {
                let Ok(Invocation::Compare(compare)) = parse(&job.command) else {
                    panic!("{:?}", job.command)
                };
                let choices = compare.choices().expect("strategies");
                crate::checks::check_options(&compare, &choices).expect("accepted");
            }
        }
    }
}
