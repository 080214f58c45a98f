//! Many polygon lights through clusters with normal cones (Swarbrick 2025, chapter 5): 126 lights in
//! one scene and 2,016 in sixteen, from three places, by the number of cones.

use glam::Vec3;
use scenes::Aabb;

use super::{Job, StudyScene};
use crate::{
    cli::{Size, StudyArgs},
    compare::Bench,
    error::HarnessError,
};

/// Polygon lights of each copy of the scene.
const LIGHTS: &str = "126";

/// Where diffuse light ends, as a share of the range of specular light: that is 50 % longer.
const DIFFUSE_SHARE: &str = "0.6667";

/// The range of a light over the side of the cube that is as large as the scene's core: there the
/// diffuse parts of about 20 lights reach a sample, as in the paper (42.9 million operations of two
/// terms on 1280x720 pixels, table 5.1).
const RANGE_SHARE: f32 = 0.55;

/// Clusters through the hierarchy, by position alone.
const CLUSTERS: &str = "SC-E/48x48x40/bvh";

/// How much the study looks at.
struct Extent {
    size: Size,
    /// Copies along each side of the ground, with what jobs are called by: the lights of all.
    copies: [(&'static str, &'static str); 2],
    frames: &'static str,
    warmup: &'static str,
    /// Whether no culling is timed.
    none: bool,
    cones: &'static [u32],
    /// Radiances below which specular light is left out.
    cuts: &'static [&'static str],
}

const FULL: Extent = Extent {
    // The paper's, for its counts of operations.
    size: Size { width: 1280, height: 720 },
    copies: [("1", "126"), ("4", "2016")],
    frames: "32",
    warmup: "4",
    none: true,
    cones: &[1, 6, 24, 54],
    cuts: &["0.001", "0.01"],
};

const QUICK: Extent = Extent {
    size: Size { width: 96, height: 54 },
    // No more than a software adapter sums in one loop.
    copies: [("1", "126"), ("3", "1134")],
    frames: "6",
    warmup: "1",
    none: false,
    cones: &[1, 6, 54],
    cuts: &["0.01"],
};

/// The jobs of one scene: each place under each count of lights.
pub(super) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let extent = if args.quick { QUICK } else { FULL };
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let [core, all] = scene.boxes(bench)?;
    let range = format!("{:.3}", range_m(core));
    let strategies = strategies(&extent);
    let lit = ["--lights", LIGHTS, "--areas", "1"];
    let shaped = ["--outlines", "polygons", "--diffuse-share", DIFFUSE_SHARE, "--radii", "equal"];
    // Images say whether anything was lost; pairs in f64 would take minutes a job.
    let seen = ["--radius-scale", &range, "--area-model", "ltc", "--operations", "--truth", "none"];
    let timed = ["--strategies", &strategies, "--frames", extent.frames, "--warmup", extent.warmup];
    let common = [&["compare"], &drawn[..], &lit, &shaped, &seen, &timed].concat();
    let mut jobs = Vec::new();
    for (side, count) in extent.copies {
        let far = afar(all, side.parse().unwrap_or(1));
        for (place, camera) in [("a", "path:0/12"), ("b", "path:7/12"), ("c", far.as_str())] {
            let own = ["--replicate", side, "--camera", camera];
            let words = [&common[..], &own].concat();
            jobs.push(Job::new(scene, place, count, &words));
        }
    }
    Ok(jobs)
}

/// No culling, clusters by position alone, and by each number of cones without a loss and with each
/// cut.
fn strategies(extent: &Extent) -> String {
    let mut ids = Vec::new();
    if extent.none {
        ids.push("None".to_owned());
    }
    ids.push(CLUSTERS.to_owned());
    for cones in extent.cones {
        ids.push(format!("{CLUSTERS}/n{cones}"));
        ids.extend(extent.cuts.iter().map(|cut| format!("{CLUSTERS}/n{cones}/s{cut}")));
    }
    ids.join(",")
}

/// The range of the lights, metres.
fn range_m(core: Aabb) -> f32 {
    let size = core.size();
    ((size.x * size.y * size.z).cbrt() * RANGE_SHARE).clamp(1e-3, 1e5)
}

/// A camera that overlooks all copies: above a corner of the ground, looking down at its middle.
fn afar(one: Aabb, side: u32) -> String {
    let size = one.size();
    let ground = Vec3::new(size.x, 0.0, size.z) * side as f32;
    let middle = one.min + 0.5 * ground;
    let eye = one.min + 0.05 * ground + Vec3::Y * (size.y + 0.2 * ground.length());
    format!(
        "{:.3},{:.3},{:.3}:{:.3},{:.3},{:.3}",
        eye.x, eye.y, eye.z, middle.x, middle.y, middle.z
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_far_camera_stands_above_a_corner_and_looks_at_the_middle() {
        let one = Aabb::new(Vec3::new(-15.0, 0.0, -7.0), Vec3::new(15.0, 10.0, 7.0));
        for side in [1, 4] {
            let Ok(pose) = afar(one, side).parse::<crate::cli::CameraPose>() else {
                panic!("{} is a pose", afar(one, side));
            };
            assert!(pose.eye[1] > one.max.y && pose.eye[0] < 0.0 && pose.eye[2] < 0.0, "{pose:?}");
            let middle = [side as f32 * 15.0 - 15.0, 0.0, side as f32 * 7.0 - 7.0];
            assert_eq!(pose.target, middle);
        }
    }

    #[test]
    fn every_number_of_cones_is_there_without_a_loss_and_with_each_cut() {
        let ids = strategies(&FULL);
        assert_eq!(ids.split(',').count(), 2 + 4 * 3);
        assert!(ids.starts_with("None,SC-E/48x48x40/bvh,SC-E/48x48x40/bvh/n1,"), "{ids}");
        assert!(ids.ends_with("/n54/s0.01"), "{ids}");
    }
}
