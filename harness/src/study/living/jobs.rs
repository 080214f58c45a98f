//! Frames with lights that move, by their number and by who moves them; three kinds of lights at once; and
//! Van Oosten's density.
//!
//! The scene grows with the cube root of the number of lights, from 10,000 on, so that as many lights as at
//! 10,000 reach a sample. All four ways to move lights are driven along the same path.
//!
//! No culling takes half a minute for a frame of four million lights at 1920x1080 on an H200. So jobs of many
//! lights do not compare images. Jobs of the section `images` do, for two frames of a small size.

use super::movement::{Movement, SORTED_EVERY};
use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::{
    bench::Bench,
    cli::{CliError, MotionChoice, MovedBy, Size, StudyArgs},
    error::HarnessError,
    strategy::{Axis, Role, Row, rows},
};

/// The section of frames by their number of lights.
pub(crate) const LIGHTS: &str = "lights";
/// The section of points, spots and polygons at once.
pub(crate) const KINDS: &str = "kinds";
/// The section of Van Oosten's density.
pub(crate) const DENSITY: &str = "density";
/// The section of images that are compared at a small size.
pub(crate) const IMAGES: &str = "images";

/// The scene has its own scale up to this number of lights.
const BASE_LIGHTS: u32 = 10_000;

/// The most lights that the CPU moves. To check, convert and upload so many takes it 0.26 s per frame, on the
/// machine of an H200.
const MOST_BY_CPU: u32 = 1_000_000;

/// The law by which lights move, unless the command line names another.
const LAW: &str = "drift";

/// How much the study looks at.
struct Extent {
    size: Size,
    counts: &'static [u32],
    /// From this number of lights on, jobs do not compare images, and see fewer poses.
    many: u32,
    /// Poses of a lap with few lights and with many: a multiple of the frames between two sorts.
    poses: [u32; 2],
    laps: u32,
    warmup: u32,
    /// Poses at which images are compared.
    checks: u32,
    /// The numbers of lights at Van Oosten's density.
    dense: &'static [u32],
    /// The size at which images of many lights are compared.
    compared: Size,
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    counts: &[1_000, 10_000, 100_000, 1_000_000, 4_000_000],
    many: 1_000_000,
    poses: [24, 16],
    laps: 6,
    warmup: 4,
    checks: 2,
    // Those that the thesis leads with.
    dense: &[200_000, 1_000_000, 4_000_000],
    compared: Size { width: 384, height: 216 },
};

const QUICK: Extent = Extent {
    size: Size { width: 96, height: 54 },
    counts: &[100, 1_000],
    many: u32::MAX,
    poses: [8, 8],
    laps: 2,
    warmup: 1,
    checks: 2,
    dense: &[1_000],
    compared: Size { width: 96, height: 54 },
};

/// The ids that are measured: families of the comparison paper with explicit bounds, and the other families that
/// make lists, except those with implicit bounds. Clusters look for lights through the hierarchy if they can. Tiles read the plain list, which needs
/// no order, but not a list of many lights: they would take 40 ms for four million on an H200.
fn strategies(has_many_lights: bool) -> Vec<String> {
    let is_explicit = |row: &Row| row.role == Role::ComparisonPaper && row.family.ends_with("-E");
    // What has no list to cap has bit masks, which do not hold four million lights.
    let has_lists = |row: &Row| row.has_groups && row.has_axis(Axis::Cap);
    let is_other = |row: &Row| {
        matches!(row.role, Role::OtherPaper | Role::Engine)
            && has_lists(row)
            && !row.family.ends_with("-I")
    };
    let id = |row: &Row| {
        let is_large = row.parameters.contains(&"slices") || has_many_lights;
        let through = is_large && row.has_axis(Axis::Source);
        row.default_id() + if through { "/bvh" } else { "" }
    };
    rows().filter(|row| is_explicit(row) || is_other(row)).map(id).collect()
}

/// The jobs of one scene.
///
/// # Errors
///
/// Names a motion that the GPU cannot repeat, or what is wrong with the scene.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    if args.motion.motion == Some(MotionChoice::File) {
        let accepted =
            "one of the laws for study living, because only the CPU plays a file's animation";
        return Err(CliError::out_of_range("--motion", "file", accepted).into());
    }
    if args.motion.moved_by == MovedBy::Gpu {
        let accepted = "left out of study living, which has both";
        return Err(CliError::out_of_range("--moved-by", "gpu", accepted).into());
    }
    let ([core, _], _) = scene.boxes(bench)?;
    let size = core.size().as_dvec3();
    Ok(plan(args, scene, size.x * size.y * size.z))
}

/// The jobs of a scene whose core has this volume, cubic metres.
fn plan(args: &StudyArgs, scene: &StudyScene, volume_m3: f64) -> Vec<Job> {
    let extent = if args.quick { QUICK } else { FULL };
    let plan = Plan { args, scene, extent };
    let mut jobs = Vec::new();
    for &count in plan.extent.counts {
        for movement in movements(count) {
            jobs.push(plan.along_path(LIGHTS, count, movement, &[]));
        }
        if count >= plan.extent.many {
            jobs.push(plan.compared(&count.to_string(), count, &[]));
        }
    }
    let most = plan.extent.counts.last().copied().unwrap_or(0);
    let kinds = ["--spots", "0.3333", "--areas", "0.3333", "--outlines", "polygons"];
    jobs.push(plan.along_path(KINDS, most, Movement::Gpu, &kinds));
    if most >= plan.extent.many {
        jobs.push(plan.compared("kinds", most, &kinds));
    }
    for &count in plan.extent.dense {
        let factor = (f64::from(count) / volume_m3.max(f64::MIN_POSITIVE)).cbrt();
        jobs.push(plan.dense(count, (scene.scale * factor).clamp(1e-6, 1e6)));
    }
    jobs
}

/// The ways in which so many lights move.
fn movements(count: u32) -> impl Iterator<Item = Movement> {
    Movement::ALL.into_iter().filter(move |way| *way != Movement::Cpu || count <= MOST_BY_CPU)
}

struct Plan<'a> {
    args: &'a StudyArgs,
    scene: &'a StudyScene,
    extent: Extent,
}

impl Plan<'_> {
    fn size(&self) -> Size {
        self.args.size.unwrap_or(self.extent.size)
    }

    /// The scale at which as many lights reach a sample as with [`BASE_LIGHTS`].
    fn scale(&self, count: u32) -> f64 {
        let factor = f64::from(count.max(BASE_LIGHTS)) / f64::from(BASE_LIGHTS);
        self.scene.scale * factor.cbrt()
    }

    /// A job along the path.
    fn along_path(&self, section: &str, count: u32, movement: Movement, own: &[&str]) -> Job {
        let extent = &self.extent;
        let is_many = count >= extent.many;
        let checks = if is_many { 0 } else { extent.checks }.to_string();
        let poses = extent.poses[usize::from(is_many)].to_string();
        let laps = extent.laps.to_string();
        let timed = ["--path", "--frames", &poses, "--laps", &laps, "--checks", &checks];
        let own = [own, &timed].concat();
        let name = format!("{count}-{}", movement.slug());
        self.job(section, &name, (count, self.scale(count), self.size()), movement, &own)
    }

    /// A job that compares images of two of as many frames as there are between two sorts. Even at a small
    /// size, no culling takes 20 s for a frame of four million lights on an H200, because each lane reads
    /// them one after the other.
    fn compared(&self, name: &str, count: u32, own: &[&str]) -> Job {
        let frames = SORTED_EVERY.to_string();
        let timed = ["--path", "--frames", &frames, "--laps", "1", "--checks", "2"];
        let own = [own, &timed].concat();
        let drawn = (count, self.scale(count), self.extent.compared);
        self.job(IMAGES, name, drawn, Movement::Gpu, &own)
    }

    /// A job at Van Oosten's density. As in the thesis, the camera stands still, and lights are sorted in every
    /// frame.
    fn dense(&self, count: u32, scale: f64) -> Job {
        let extent = &self.extent;
        let is_many = count >= extent.many;
        let checks = if is_many { 0 } else { 1 }.to_string();
        let frames = extent.poses[usize::from(is_many)].to_string();
        let laps = extent.laps.to_string();
        let timed = ["--frames", &frames, "--laps", &laps, "--checks", &checks];
        let drawn = (count, scale, self.size());
        self.job(DENSITY, &count.to_string(), drawn, Movement::Sorted, &timed)
    }

    /// A job of a number of lights in the scene at a scale and a size.
    fn job(
        &self,
        section: &str,
        name: &str,
        (count, scale, size): (u32, f64, Size),
        movement: Movement,
        own: &[&str],
    ) -> Job {
        let (law, speed) = (&self.args.motion.motion, self.args.motion.speed);
        let scene = StudyScene { scale, ..self.scene.clone() };
        let drawn = scene.options(size, self.args.seed);
        let moved = movement.options(law.map_or(LAW, MotionChoice::name), speed);
        let ids = strategies(count >= self.extent.many).join(",");
        let (count, warmup) = (count.to_string(), self.extent.warmup.to_string());
        let mut words = vec!["compare"];
        words.extend(drawn.iter().map(String::as_str));
        words.extend(["--lights", &count, "--strategies", &ids, "--warmup", &warmup]);
        words.extend(own);
        words.extend(["--truth", "none", "--pictures", "none"]);
        words.extend(moved.iter().map(String::as_str));
        Job::new(&scene, section, name, &words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::check_options;
    use crate::cli::{CompareArgs, Invocation, parse};

    fn planned(line: &str) -> Vec<(Job, CompareArgs)> {
        let words = ["lightbench", "study", "living"].into_iter().chain(line.split_whitespace());
        let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: no study") };
        let scene = &StudyScene::all(&args).unwrap()[0];
        let parsed = |job: Job| match parse(&job.command) {
            Ok(Invocation::Compare(args)) => {
                check_options(&args, &args.choices().unwrap()).unwrap();
                (job, args)
            }
            other => panic!("{}: {other:?}", job.name),
        };
        plan(&args, scene, 4_000.0).into_iter().map(parsed).collect()
    }

    fn in_section<'a>(
        jobs: &'a [(Job, CompareArgs)],
        section: &'a str,
    ) -> impl Iterator<Item = &'a CompareArgs> {
        jobs.iter().filter(move |(job, _)| job.section == section).map(|(_, args)| args)
    }

    #[test]
    fn explicit_bounds_and_other_papers_run_and_tiles_read_the_plain_list_of_few_lights() {
        assert_eq!(
            strategies(false),
            [
                "T-E/28x28",
                "T-E1/32x32",
                "HalfZ/28x28",
                "ModifiedHalfZ/28x28",
                "T-25D/28x28",
                "DC-E/64x64x40/bvh",
                "SC-E/48x48x40/bvh",
                "DA-E/48x48x40/bvh",
                "HG/48x48x40"
            ]
        );
        let is_plain = |id: &String| !id.ends_with("/bvh");
        let plain: Vec<String> = strategies(true).into_iter().filter(is_plain).collect();
        assert_eq!(plain, ["HG/48x48x40"]);
    }

    #[test]
    fn every_count_of_lights_stands_still_and_moves_in_three_ways() {
        for (line, counts) in [("", FULL.counts), ("--quick", QUICK.counts)] {
            let jobs = planned(line);
            for &count in counts {
                let of_count =
                    in_section(&jobs, LIGHTS).filter(|args| args.stage.scattered() == count);
                let orders: Vec<String> = of_count
                    .map(|args| {
                        let mover = args.stage.motion.words().join(" ");
                        format!("{mover} {}", args.stage.light_order())
                    })
                    .collect();
                let drift = "--motion drift --speed 1 --moved-by";
                let known = [
                    " bvh".to_owned(),
                    format!("{drift} gpu gpu8"),
                    format!("{drift} gpu gpu"),
                    format!("{drift} cpu gpu8"),
                ];
                // The CPU does not move the most lights.
                let ways = if count > MOST_BY_CPU { &known[..3] } else { &known[..] };
                assert_eq!(orders, ways, "{count}");
            }
            // Laps have as many sorts as they should.
            assert!(in_section(&jobs, LIGHTS).all(|args| args.frames.unwrap().is_multiple_of(8)));
            let names: Vec<&str> = jobs.iter().map(|(job, _)| job.name.as_str()).collect();
            let mut unique = names.clone();
            unique.sort_unstable();
            unique.dedup();
            assert_eq!(unique.len(), names.len(), "{names:?}");
        }
        let orbits = planned("--quick --motion orbit --speed 3");
        let moves = |args: &&CompareArgs| args.stage.motion.motion.is_some();
        let laws: Vec<_> = in_section(&orbits, LIGHTS).filter(moves).collect();
        assert!(
            laws.iter().all(|args| args.stage.motion.words()[1..4] == ["orbit", "--speed", "3"])
        );
        assert_eq!(laws.len(), 6);
    }

    #[test]
    fn the_scene_grows_so_that_density_stays() {
        let jobs = planned("--scene-scale 1.6");
        let scales: Vec<f64> = in_section(&jobs, LIGHTS)
            .filter(|args| args.stage.motion.motion.is_none())
            .map(|args| (args.stage.scene_scale * 1e3).round() / 1e3)
            .collect();
        assert_eq!(scales, [1.6, 1.6, 3.447, 7.427, 11.789]);
        for args in in_section(&jobs, DENSITY) {
            // 4,000 cubic metres at scale 1.6.
            let volume = 4_000.0 * (args.stage.scene_scale / 1.6).powi(3);
            assert!((f64::from(args.stage.scattered()) / volume - 1.0).abs() < 1e-9);
            assert!(!args.path && args.stage.light_order().to_string() == "gpu");
        }
    }

    #[test]
    fn images_of_many_lights_are_compared_at_a_small_size() {
        let jobs = planned("");
        for args in in_section(&jobs, LIGHTS).chain(in_section(&jobs, DENSITY)) {
            assert_eq!(args.checks == Some(0), args.stage.scattered() >= 1_000_000);
        }
        let compared: Vec<(u32, bool)> = in_section(&jobs, IMAGES)
            .map(|args| (args.stage.scattered(), args.stage.areas > 0.0))
            .collect();
        assert_eq!(compared, [(1_000_000, false), (4_000_000, false), (4_000_000, true)]);
        assert!(in_section(&jobs, IMAGES).all(|args| args.checks == Some(2)));
        assert_eq!(in_section(&planned("--quick"), IMAGES).count(), 0);
    }
}
