//! Jobs of rays through deep images in place of maps, and as many maps beside them.

use shading::{MAP_COUNTS, ShadowModel};

use super::jobs::{FEW, RAYS, extent_of, lit};
use crate::{
    cli::StudyArgs,
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
pub(crate) fn jobs(args: &StudyArgs, scene: &StudyScene, range_m: f32) -> Vec<Job> {
    let extent = if args.quick { &QUICK } else { &FULL };
    let study = extent_of(args);
    let lit = lit(args, scene, study.size, range_m);
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
