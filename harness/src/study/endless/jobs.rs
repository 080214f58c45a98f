//! Many polygon lights through clusters with normal cones (Swarbrick 2025, chapter 5): 126 lights in
//! one scene and 2,016 in sixteen, from three places, by the number of cones.

use glam::{DVec3, Vec3};
use scenes::Aabb;

use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::{
    bench::Bench,
    cli::{Size, StudyArgs},
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

/// Clusters through the hierarchy, by position only.
const CLUSTERS: &str = "SC-E/48x48x40/bvh";

/// The numbers of cones that the paper has.
const CONES: [u32; 3] = [6, 24, 54];

/// The cone test of the paper: its lobe of 45 degrees.
const CONE_TEST: &str = "cone45";

/// The paper's clusters: 16 x 9 tiles, and depth slices.
const GRID: [u32; 3] = [16, 9, 24];

/// The irradiance at which the paper's rule gives these lights about the range that they have: their
/// intensity is 0.02 times the square of their range in the brightest channel, and about twice that in the
/// sum of three; 4.4 * 0.04 / (2 pi * 0.6667^2).
const INFLUENCE: &str = "0.063";

/// How much the study looks at.
struct Extent {
    size: Size,
    /// Copies along each side of the ground, with what jobs are called by: the lights of all.
    copies: [(&'static str, &'static str); 2],
    frames: &'static str,
    warmup: &'static str,
    /// Whether no culling is timed, at location A.
    none: bool,
    cones: &'static [u32],
    /// Radiances below which 54 cones leave specular light out.
    cuts: &'static [&'static str],
}

const FULL: Extent = Extent {
    // The paper's size, because operations are compared with the paper's counts.
    size: Size { width: 1280, height: 720 },
    copies: [("1", "126"), ("4", "2016")],
    // A frame a round.
    frames: "16",
    warmup: "4",
    none: true,
    cones: &CONES,
    cuts: &["0.001", "0.01"],
};

const QUICK: Extent = Extent {
    size: Size { width: 96, height: 54 },
    // No more than a software adapter sums in one loop.
    copies: [("1", "126"), ("3", "1134")],
    frames: "6",
    warmup: "1",
    none: false,
    cones: &[6, 54],
    cuts: &["0.01"],
};

/// The jobs of one scene: each place under each count of lights that the paper has figures of, and
/// location A under the ranges of the paper's rule, with a hard cut.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let extent = if args.quick { QUICK } else { FULL };
    let size = args.size.unwrap_or(extent.size);
    let drawn = scene.options(size, args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let ([core, all], origin) = scene.boxes(bench)?;
    let range = range_m(core).to_string();
    let lit = ["--lights", LIGHTS, "--areas", "1"];
    let shaped = ["--outlines", "polygons", "--diffuse-share", DIFFUSE_SHARE, "--radii", "equal"];
    // Images say whether anything was lost; pairs in f64 would take minutes a job.
    let seen = ["--radius-scale", &range, "--area-model", "ltc", "--operations", "--truth", "none"];
    let timed = ["--frames", extent.frames, "--warmup", extent.warmup];
    let common = [&["compare"], &drawn[..], &lit, &shaped, &seen, &timed].concat();
    let mut jobs = Vec::new();
    let mut add = |place: &str, count: &str, strategies: &str, own: &[&str]| {
        let words = [&common[..], &["--strategies", strategies], own].concat();
        jobs.push(Job::new(scene, place, count, &words));
    };
    let [(_, few), (_, many)] = extent.copies;
    for (side, count) in extent.copies {
        let far = afar(all, origin, side.parse().unwrap_or(1));
        for (place, camera) in [("a", "path:0/12"), ("b", "path:7/12"), ("c", far.as_str())] {
            // The paper has no figures of few lights from afar.
            if place != "c" || count != few {
                let strategies = strategies(&extent, size, extent.none && place == "a");
                add(place, count, &strategies, &["--replicate", side, "--camera", camera]);
            }
        }
        if count == many {
            let ruled = ["--influence", INFLUENCE, "--cut", "hard", "--unbounded"];
            let options = [&["--replicate", side, "--camera", "path:0/12"], &ruled[..]].concat();
            add("influence", count, &published(&extent, size).join(","), &options);
        }
    }
    Ok(jobs)
}

/// Clusters by position, and by each number of cones: without a loss, by the paper's test, and by 54 with
/// each cut; specular light that ends with the diffuse; some of it without the early exit; and the paper's
/// own rows. One cone is not the paper's.
fn strategies(extent: &Extent, size: Size, none: bool) -> String {
    let mut ids = Vec::new();
    if none {
        ids.push("None".to_owned());
    }
    ids.push(CLUSTERS.to_owned());
    ids.push(format!("{CLUSTERS}/n1"));
    ids.extend(extent.cones.iter().map(|cones| format!("{CLUSTERS}/n{cones}")));
    ids.extend(extent.cones.iter().map(|cones| format!("{CLUSTERS}/n{cones}/{CONE_TEST}")));
    ids.extend(extent.cuts.iter().map(|cut| format!("{CLUSTERS}/n54/s{cut}")));
    ids.push(format!("{CLUSTERS}/dif"));
    ids.extend(["", "/n54"].map(|cones| format!("{CLUSTERS}{cones}/no-exit")));
    ids.extend(published(extent, size));
    ids.join(",")
}

/// The paper's rows: its clusters, its cone test, its `dif`, and half as many slices; each evaluates every
/// listed light, for the paper's shading has no early exit.
fn published(extent: &Extent, size: Size) -> Vec<String> {
    let [across, down, slices] = GRID;
    let grid = |slices: u32, rest: &str| {
        let (width, height) = (size.width.div_ceil(across), size.height.div_ceil(down));
        format!("SC-E/{width}x{height}x{slices}/bvh{rest}/no-exit")
    };
    let mut ids = vec![grid(slices, ""), grid(slices / 2, "")];
    let test = |cones: &u32| grid(slices, &format!("/n{cones}/{CONE_TEST}"));
    ids.extend(extent.cones.iter().map(test));
    ids.push(grid(slices, "/dif"));
    ids
}

/// The range of the lights, metres.
fn range_m(core: Aabb) -> f32 {
    let size = core.size();
    ((size.x * size.y * size.z).cbrt() * RANGE_SHARE).clamp(1e-6, 1e6)
}

/// A camera that overlooks all copies: above a corner of the ground, looking down at its middle. `origin` is
/// where world space begins in the coordinates of the scene's file.
fn afar(one: Aabb, origin: DVec3, side: u32) -> String {
    let size = one.size();
    let ground = Vec3::new(size.x, 0.0, size.z) * side as f32;
    let middle = one.min + 0.5 * ground;
    let eye = one.min + 0.05 * ground + Vec3::Y * (size.y + 0.2 * ground.length());
    // All digits, so that small scenes get distinct views; no negative zero.
    let point = |point: Vec3| match origin == DVec3::ZERO {
        true => point.to_array().map(|x| (x + 0.0).to_string()).join(","),
        false => (point.as_dvec3() + origin).to_array().map(|x| x.to_string()).join(","),
    };
    format!("{}:{}", point(eye), point(middle))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_far_camera_stands_above_a_corner_and_looks_at_the_middle() {
        let one = Aabb::new(Vec3::new(-15.0, 0.0, -7.0), Vec3::new(15.0, 10.0, 7.0));
        for side in [1, 4] {
            let Ok(pose) = afar(one, DVec3::ZERO, side).parse::<crate::cli::CameraPose>() else {
                panic!("{} is a pose", afar(one, DVec3::ZERO, side));
            };
            assert!(
                pose.eye[1] > f64::from(one.max.y) && pose.eye[0] < 0.0 && pose.eye[2] < 0.0,
                "{pose:?}"
            );
            let middle = [side as f32 * 15.0 - 15.0, 0.0, side as f32 * 7.0 - 7.0];
            assert_eq!(pose.target, middle.map(f64::from));
        }
    }

    #[test]
    fn small_and_large_scenes_have_cameras_and_ranges_of_their_own() {
        for size in [1e-4_f32, 0.01, 3.3, 1e5] {
            let one =
                Aabb::new(Vec3::new(-0.5, 0.0, -0.25) * size, Vec3::new(0.5, 0.4, 0.25) * size);
            let text = afar(one, DVec3::ZERO, 3);
            let pose: crate::cli::CameraPose =
                text.parse().unwrap_or_else(|e| panic!("{text}: {e}"));
            let ground = Vec3::new(3.0 * size, 0.0, 1.5 * size);
            let eye = one.min + 0.05 * ground + Vec3::Y * (0.4 * size + 0.2 * ground.length());
            assert_eq!(DVec3::from(pose.eye).as_vec3(), eye, "{text}");
            let range: f32 = range_m(one).to_string().parse().unwrap();
            assert_eq!(range, range_m(one));
            assert!(range > 0.1 * size && range < size, "{range}");
        }
        // A scene far off is named by its file's coordinates.
        let one = Aabb::new(Vec3::splat(-1.0), Vec3::ONE);
        let far = afar(one, DVec3::new(1e7, 0.0, 0.25), 1);
        let pose: crate::cli::CameraPose = far.parse().unwrap_or_else(|e| panic!("{far}: {e}"));
        assert_eq!(pose.target, [1e7, -1.0, 0.25], "{far}");
        let flat = Aabb::new(Vec3::ZERO, Vec3::new(2.0, 0.0, -0.0));
        assert!(!afar(flat, DVec3::ZERO, 1).contains("-0"), "{}", afar(flat, DVec3::ZERO, 1));
    }

    #[test]
    fn every_number_of_cones_is_there_without_a_loss_and_by_the_papers_test() {
        let ids = strategies(&FULL, FULL.size, true);
        let ids: Vec<&str> = ids.split(',').collect();
        assert_eq!(ids.len(), 1 + 2 + 3 + 3 + 2 + 1 + 2 + 6, "{ids:?}");
        assert_eq!(ids[..2], ["None", "SC-E/48x48x40/bvh"]);
        // The paper's 16 x 9 x 24 clusters of its 1280 x 720 pixels.
        for id in [
            "SC-E/48x48x40/bvh/n54/cone45",
            "SC-E/80x80x24/bvh/no-exit",
            "SC-E/80x80x12/bvh/no-exit",
            "SC-E/80x80x24/bvh/n24/cone45/no-exit",
            "SC-E/80x80x24/bvh/dif/no-exit",
        ] {
            assert!(ids.contains(&id), "{id}: {ids:?}");
        }
        for id in ids {
            crate::choice::Choice::parse(id).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}
