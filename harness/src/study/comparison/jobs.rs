//! The comparison paper (Enhuber 2019) on any scene, and what it left out: many more lights, other radii,
//! and speed against accuracy.
//!
//! Rankings, searches and scaling are means along the scene's path, as in the paper. Each method draws
//! every pose of a run once a lap, and laps repeat the run, so that ties can be detected. A still camera
//! serves only as an example: pictures, heat maps, and lists that are checked pair by pair.

use super::depth_views::Views;
use super::extent::{self, Extent};
use super::frame_jobs;
use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::{
    bench::Bench,
    cli::{Invocation, Size, StudyArgs},
    error::HarnessError,
};

/// Builds the jobs of one scene.
struct Plan<'a> {
    scene: &'a StudyScene,
    extent: Extent,
    seed: u64,
    jobs: Vec<Job>,
}

/// The jobs of one scene, in the order of the report.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let (views, triangles) = look(bench, scene)?;
    let mut extent = Extent::new(args.quick, triangles);
    extent.size = args.size.unwrap_or(extent.size);
    let mut plan = Plan { scene, extent, seed: args.seed, jobs: Vec::new() };
    plan.example();
    plan.searches();
    plan.views(views);
    plan.rankings();
    plan.scaling();
    plan.beyond();
    plan.accuracy();
    let Extent { size, frames_at, .. } = plan.extent;
    plan.jobs.extend(frame_jobs::jobs(scene, size, args.seed, frames_at, args.quick));
    Ok(plan.jobs)
}

/// The views with the least and the most depth discontinuity (section 4.4.1.2), and the scene's
/// triangles.
fn look(bench: &mut Bench, scene: &StudyScene) -> Result<(Option<Views>, u64), HarnessError> {
    let words = ["lightbench", "compare", "--scene", &scene.scene, "--size", "160x90"];
    let scale = scene.scale.to_string();
    let words = [&words[..], &["--scene-scale", &scale, "--lights", "1"]].concat();
    let Invocation::Compare(args) = crate::cli::parse(words)? else {
        return Ok((None, 0));
    };
    let gpu = bench.gpu().clone();
    let stage = bench.stage(&args.stage)?;
    let triangles = stage.scene.triangle_count();
    Ok((Some(Views::find(&gpu, stage)?), triangles))
}

impl Plan<'_> {
    /// Adds a job: its section, its number of lights, and its options. Its name within the section is the
    /// values of what it varies; where it varies nothing else, its number of lights.
    fn add(&mut self, section: &str, varied: &[&str], lights: u32, options: &[&str]) {
        let name = if varied.is_empty() { lights.to_string() } else { varied.join("-") };
        self.jobs.push(self.job(section, &name, lights, self.scene.scale, options));
    }

    /// Adds the only job of its section.
    fn add_named(&mut self, section: &str, lights: u32, options: &[&str]) {
        self.jobs.push(self.job(section, "", lights, self.scene.scale, options));
    }

    /// A job of the scene at a scale.
    fn job(&self, section: &str, name: &str, lights: u32, scale: f64, options: &[&str]) -> Job {
        let Size { width, height } = self.extent.size;
        let (lights, size) = (lights.to_string(), format!("{width}x{height}"));
        let (scale, seed) = (scale.to_string(), self.seed.to_string());
        let mut words = vec!["compare", "--scene", self.scene.scene.as_str()];
        words.extend(["--scene-scale", &scale, "--lights", &lights, "--size", &size]);
        words.extend(["--seed", &seed, "--warmup", self.extent.warmup]);
        words.extend(options);
        Job::new(self.scene, section, name, &words)
    }

    /// Options of strategies along the path, with that many poses a lap.
    fn along(&self, poses: u32, strategies: &str) -> Vec<String> {
        // Searches try many methods, so they compare the images of one pose only.
        let checks = if poses >= extent::LONG { "4" } else { "1" };
        let (poses, laps) = (poses.to_string(), self.extent.laps.to_string());
        let options = ["--strategies", strategies, "--path", "--frames", &poses, "--laps", &laps];
        let options = [&options[..], &["--checks", checks]].concat();
        let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
        options.into_iter().map(str::to_owned).collect()
    }

    /// Adds a job along the path.
    fn add_along(&mut self, section: &str, varied: &[&str], lights: u32, poses: u32, ids: &str) {
        let options = self.along(poses, ids);
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        self.add(section, varied, lights, &options);
    }

    /// Every strategy from the still camera, with pictures: an example, and the rate of no culling.
    fn example(&mut self) {
        let frames = self.extent.frames.to_string();
        let strategies = self.extent.main();
        let options = ["--strategies", &strategies, "--frames", &frames, "--pictures", "all"];
        self.add("main", &[], self.extent.most, &options);
    }

    /// Group sizes and intersection tests (the paper's sections 4.3.1 and 4.3.2), from each source of
    /// lights that they are reported for.
    fn searches(&mut self) {
        let (most, poses) = (self.extent.most, self.extent.search_poses);
        for (family, sizes) in self.extent.linear_sizes.sizes() {
            let ids: Vec<String> = sizes.iter().map(|size| format!("{family}/{size}")).collect();
            self.add_along("sizes", &[family], most, poses, &ids.join(","));
        }
        for (family, sizes) in self.extent.bvh_sizes.sizes() {
            let ids: Vec<String> =
                sizes.iter().map(|size| format!("{family}/{size}/bvh")).collect();
            let varied = [family, "bvh"];
            self.add_along("sizes", &varied, most, poses, &ids.join(","));
        }
        for family in self.extent.tested {
            let ids: Vec<String> =
                self.extent.tests.iter().map(|tests| format!("{family}/{tests}")).collect();
            self.add_along("tests", &[family], most, poses, &ids.join(","));
        }
    }

    /// Heat maps and lists of the views with the least and the most depth discontinuity.
    fn views(&mut self, views: Option<Views>) {
        let Some(views) = views else { return };
        let frames = self.extent.frames.to_string();
        let strategies = format!("None,{}", self.extent.views());
        for (name, frame) in [("low", views.low), ("high", views.high)] {
            let camera = format!("path:{frame}/{}", views.count);
            let options = ["--strategies", &strategies, "--camera", &camera, "--frames", &frames];
            let job = self.job("views", name, self.extent.most, self.scene.scale, &options);
            self.jobs.push(job.with("depth_discontinuity", name));
        }
    }

    /// Times along the camera path (sections 4.4.1.1 and 4.4.2.1). Methods that take tens of milliseconds
    /// per frame have separate jobs with fewer poses.
    fn rankings(&mut self) {
        for (ix, &count) in self.extent.counts.iter().enumerate() {
            let is_most = ix + 1 == self.extent.counts.len();
            let (poses, ids) = match is_most {
                true => (self.extent.rank_poses[1], self.extent.ranked_at_most()),
                false => (self.extent.rank_poses[0], self.extent.ranked.to_owned()),
            };
            self.add_along("path", &[], count, poses, &ids);
            if !self.extent.slow.is_empty() {
                let (poses, ids) = (self.extent.slow_poses, self.extent.slow);
                let lights = count.to_string();
                let varied = [lights.as_str(), "slow"];
                self.add_along("path", &varied, count, poses, ids);
            }
        }
    }

    /// Times against the number of lights (section 4.4.2.2). M is left out of more lights than the
    /// paper has.
    fn scaling(&mut self) {
        for &count in self.extent.scaling {
            let mut ids = self.extent.scaled.to_owned();
            if count <= self.extent.most && !self.extent.scaled_whole.is_empty() {
                ids = format!("{ids},{}", self.extent.scaled_whole);
            }
            self.add_along("scaling", &[], count, self.extent.search_poses, &ids);
        }
    }

    /// Many more lights, at growing and at constant density, and other radii.
    fn beyond(&mut self) {
        let options = self.along(self.extent.search_poses, self.extent.beyond);
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        for &count in self.extent.many {
            let factor = (f64::from(count) / f64::from(self.extent.most)).cbrt();
            let scale = self.scene.scale * factor;
            self.jobs.push(self.job("constant", &count.to_string(), count, scale, &options));
            if count <= 100_000 {
                self.add("growing", &[], count, &options);
            }
        }
        for radii in self.extent.radii {
            let options = [&options[..], &["--radii", radii]].concat();
            self.add("radii", &[radii], self.extent.most, &options);
        }
    }

    /// The lossy knobs: capped lists, lists used for several frames, and the threshold at which
    /// lights end.
    fn accuracy(&mut self) {
        let frames = self.extent.lossy_frames.to_string();
        let most = self.extent.most;
        let knobs = |families: &[&str], knob: &str, values: &[u32]| {
            let lossless = families.iter().map(|family| format!("{family}/bvh"));
            let mut ids: Vec<String> = lossless.collect();
            for value in values {
                ids.extend(families.iter().map(|family| format!("{family}/bvh/{knob}{value}")));
            }
            ids.join(",")
        };
        if !self.extent.caps.is_empty() {
            let caps = knobs(&extent::LOSSY, "cap", self.extent.caps);
            let options = ["--strategies", &caps, "--frames", &frames, "--truth", "none"];
            self.add_named("caps", most, &options);
        }
        if !self.extent.reuse.is_empty() {
            let poses = self.extent.reuse_poses.to_string();
            let reuse = knobs(&extent::LOSSY[1..], "reuse", self.extent.reuse);
            let options = ["--strategies", &reuse, "--path", "--frames", &poses];
            let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
            self.add_named("reuse", most, &options);
        }
        let lossless = extent::LOSSY.map(|family| format!("{family}/bvh")).join(",");
        for cut in ["windowed", "hard"] {
            for &threshold in self.extent.thresholds {
                let options = ["--strategies", &lossless, "--threshold", threshold, "--cut", cut];
                let options = [&options[..], &["--unbounded", "--frames", &frames]].concat();
                let options = [&options[..], &["--truth", "none"]].concat();
                let varied = [cut, threshold];
                self.add("ranges", &varied, most, &options);
            }
        }
    }
}

#[cfg(test)]
mod tests;
