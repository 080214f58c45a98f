//! The comparison paper (Enhuber 2019) on any scene, and what it left out: many more lights, other
//! radii, and speed against accuracy.

use super::{Job, StudyScene, views::Views};
use crate::{
    cli::{Invocation, Size, StudyArgs},
    compare::Bench,
    error::HarnessError,
};

/// Every strategy at the paper's parameters, M also in parts.
const ALL: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2";
/// Those whose groups are cut from the view or the world.
const CUT: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M/2";
/// One of each kind, for the lossy knobs, through the hierarchy.
const LOSSY: [&str; 4] = ["T-E", "DC-I", "SC-E", "G"];

/// Every strategy from both sources, but HG, which has one.
const BOTH: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2,\
     T-I/bvh,T-E/bvh,DC-I/bvh,DC-E/bvh,SC-I/bvh,SC-E/bvh,G/bvh,M/bvh,M/2/bvh";
/// Every strategy, and one of each kind through the hierarchy.
const SOME: &str = "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2,T-E/bvh,SC-E/bvh,G/bvh";

/// How much a study looks at.
struct Extent {
    size: Size,
    /// Frames of each method before the clock starts.
    warmup: &'static str,
    /// Strategies of the main comparison, from both sources.
    main: &'static str,
    /// Strategies of the views.
    views: &'static str,
    /// Strategies under many lights and under other radii.
    many: &'static str,
    counts: &'static [u32],
    /// The most lights of the path, the views and the searches.
    most: u32,
    scaling: &'static [u32],
    frames: u32,
    path_frames: u32,
    tiles: &'static [u32],
    cluster_tiles: &'static [u32],
    slices: &'static [u32],
    cells: &'static [&'static str],
    parts: &'static [&'static str],
    tests: &'static [&'static str],
    caps: &'static [u32],
    thresholds: &'static [&'static str],
    reuse: &'static [u32],
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    warmup: "4",
    main: BOTH,
    views: ALL,
    many: CUT,
    counts: &[100, 1_000, 10_000],
    most: 10_000,
    scaling: &[100, 1_000, 3_000, 10_000, 30_000],
    frames: 32,
    path_frames: 1_200,
    tiles: &[16, 20, 24, 28, 32, 40, 48, 64],
    cluster_tiles: &[32, 48, 64, 96, 128],
    slices: &[24, 40, 64],
    cells: &["8x8x8", "12x12x12", "16x16x16", "20x20x20", "28x28x28", "40x40x40", "40x12x20"],
    parts: &["0.5", "1", "2", "4", "8"],
    tests: &[
        "hs",
        "hs+sat-e",
        "hs+sat-n",
        "hs+sat-p",
        "hs+sat-v",
        "sat-e+sat-n+sat-p",
        "hs+sat-e+sat-p+sat-v",
        "hs+sat-e+sat-n+sat-p+sat-v",
    ],
    caps: &[4, 8, 16, 32, 64],
    thresholds: &["0.005", "0.02", "0.05", "0.2"],
    reuse: &[2, 4, 8],
};

const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    warmup: "1",
    main: SOME,
    views: "T-E,SC-E,G,HG,M/2",
    many: "T-E,DC-E,SC-E,G,HG",
    counts: &[100, 500],
    most: 500,
    scaling: &[100, 300, 1_000],
    frames: 6,
    path_frames: 12,
    tiles: &[16, 32],
    cluster_tiles: &[16, 32],
    slices: &[16],
    cells: &["8x8x8", "16x16x16"],
    parts: &["2"],
    tests: &["hs", "hs+sat-n", "hs+sat-e+sat-p+sat-v"],
    caps: &[4, 16],
    thresholds: &["0.01", "0.1"],
    reuse: &[4],
};

/// Builds the jobs of one scene.
struct Plan<'a> {
    scene: &'a StudyScene,
    extent: Extent,
    seed: u64,
    jobs: Vec<Job>,
}

/// The jobs of one scene, in the order of the report.
pub(super) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let mut extent = if args.quick { QUICK } else { FULL };
    extent.size = args.size.unwrap_or(extent.size);
    let mut plan = Plan { scene, extent, seed: args.seed, jobs: Vec::new() };
    plan.comparison();
    plan.searches();
    plan.views(bench)?;
    plan.paths();
    plan.scaling(args.quick);
    plan.beyond(args.quick);
    plan.accuracy();
    let ends = [plan.extent.counts.first(), plan.extent.counts.last()].map(|end| end.copied());
    let ends: Vec<u32> = ends.into_iter().flatten().collect();
    plan.jobs.extend(super::frames::jobs(scene, plan.extent.size, args.seed, &ends, args.quick));
    Ok(plan.jobs)
}

impl Plan<'_> {
    /// Adds a job: its section, what tells it from others of the section, and its options.
    fn add(&mut self, section: &str, variant: &str, lights: u32, options: &[&str]) {
        let scale = self.scene.scale.to_string();
        self.add_scaled(section, variant, lights, &scale, options);
    }

    fn add_scaled(
        &mut self,
        section: &str,
        variant: &str,
        lights: u32,
        scale: &str,
        options: &[&str],
    ) {
        let Size { width, height } = self.extent.size;
        let (lights, size, seed) =
            (lights.to_string(), format!("{width}x{height}"), self.seed.to_string());
        let mut words = vec!["compare", "--scene", self.scene.scene.as_str()];
        words.extend(["--scene-scale", scale, "--lights", &lights, "--size", &size]);
        words.extend(["--seed", &seed, "--warmup", self.extent.warmup]);
        words.extend(options);
        self.jobs.push(Job::new(self.scene, section, variant, &words));
    }

    /// Every strategy from both sources at the paper's counts of lights.
    fn comparison(&mut self) {
        let frames = self.extent.frames.to_string();
        let strategies = format!("None,Sphere,RasterSphere,Clay,{}", self.extent.main);
        for &count in self.extent.counts {
            let pictures = if count == self.extent.most { "all" } else { "none" };
            let options = ["--strategies", &strategies, "--frames", &frames];
            let options = [&options[..], &["--pictures", pictures]].concat();
            self.add("main", &count.to_string(), count, &options);
        }
    }

    /// Group sizes and intersection tests (the paper's sections 4.3.1 and 4.3.2).
    fn searches(&mut self) {
        let frames = (self.extent.frames / 4).max(6).to_string();
        let lossless = ["--truth", "none", "--pictures", "none", "--frames", &frames];
        let each = |family: &str, sizes: &[String]| {
            sizes.iter().map(|size| format!("{family}/{size}")).collect::<Vec<_>>().join(",")
        };
        let tiles: Vec<String> = self.extent.tiles.iter().map(|t| format!("{t}x{t}")).collect();
        let clusters: Vec<String> = self
            .extent
            .cluster_tiles
            .iter()
            .flat_map(|t| self.extent.slices.iter().map(move |s| format!("{t}x{t}x{s}")))
            .collect();
        let owned = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<Vec<_>>();
        let (cells, parts) = (owned(self.extent.cells), owned(self.extent.parts));
        let families = [("T-I", &tiles), ("T-E", &tiles)]
            .into_iter()
            .chain(["DC-I", "DC-E", "SC-I", "SC-E", "HG"].map(|family| (family, &clusters)))
            .chain([("G", &cells), ("M", &parts)]);
        for (family, sizes) in families {
            let strategies = each(family, sizes);
            let options = ["--strategies", &strategies, "--source", "bvh"];
            let most = self.extent.most;
            self.add("sizes", family, most, &[&options[..], &lossless].concat());
        }
        for family in ["T-E", "DC-I", "SC-I"] {
            let strategies = each(family, &owned(self.extent.tests));
            let options = ["--strategies", strategies.as_str()];
            self.add("tests", family, self.extent.most, &[&options[..], &lossless].concat());
        }
    }

    /// The views with the least and the most depth discontinuity (section 4.4.1.2).
    fn views(&mut self, bench: &mut Bench) -> Result<(), HarnessError> {
        let words = ["lightbench", "compare", "--scene", &self.scene.scene, "--size", "160x90"];
        let scale = self.scene.scale.to_string();
        let words = [&words[..], &["--scene-scale", &scale, "--lights", "1"]].concat();
        let Invocation::Compare(args) = crate::cli::parse(words)? else {
            return Ok(());
        };
        let gpu = bench.gpu().clone();
        let views = Views::find(&gpu, bench.stage(&args.stage)?)?;
        let frames = self.extent.frames.to_string();
        let strategies = format!("None,{}", self.extent.views);
        for (name, frame) in [("low", views.low), ("high", views.high)] {
            let camera = format!("path:{frame}/{}", views.count);
            let options = ["--strategies", &strategies, "--camera", &camera, "--frames", &frames];
            self.add("views", name, self.extent.most, &options);
        }
        Ok(())
    }

    /// Frame times along the camera path (section 4.4.1.1).
    fn paths(&mut self) {
        let frames = self.extent.path_frames.to_string();
        let options = ["--strategies", CUT, "--path", "--frames", &frames];
        let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
        let most = self.extent.most;
        self.add("path", &most.to_string(), most, &options);
    }

    /// Times against the number of lights (section 4.4.2).
    fn scaling(&mut self, quick: bool) {
        let frames = (self.extent.frames / 4).max(6).to_string();
        let strategies = format!("None,{CUT}");
        for &count in self.extent.scaling {
            let source = if quick { "linear" } else { "both" };
            let options = ["--strategies", &strategies, "--source", source, "--frames", &frames];
            let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
            self.add("scaling", &count.to_string(), count, &options);
        }
    }

    /// Many more lights, at growing and at constant density, and other radii.
    fn beyond(&mut self, quick: bool) {
        let frames = (self.extent.frames / 4).max(6).to_string();
        let options = ["--strategies", self.extent.many, "--source", "bvh", "--frames", &frames];
        let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
        let many: &[u32] = if quick { &[2_000] } else { &[100_000, 300_000] };
        for &count in many {
            let factor = (f64::from(count) / f64::from(self.extent.most)).cbrt();
            let scale = format!("{:.4}", self.scene.scale * factor);
            self.add_scaled("constant", &count.to_string(), count, &scale, &options);
            if count <= 100_000 {
                self.add("growing", &count.to_string(), count, &options);
            }
        }
        for radii in ["gamma", "equal", "log-normal"] {
            let options = [&options[..], &["--radii", radii]].concat();
            self.add("radii", radii, self.extent.most, &options);
        }
    }

    /// The lossy knobs: capped lists, lists used for several frames, and the threshold at which
    /// lights end.
    fn accuracy(&mut self) {
        let frames = (self.extent.frames / 4).max(6).to_string();
        let most = self.extent.most;
        let knobs = |families: &[&str], knob: &str, values: &[u32]| {
            let lossless = families.iter().map(|family| format!("{family}/bvh"));
            let mut ids: Vec<String> = lossless.collect();
            for value in values {
                ids.extend(families.iter().map(|family| format!("{family}/bvh/{knob}{value}")));
            }
            ids.join(",")
        };
        let caps = knobs(&LOSSY, "cap", self.extent.caps);
        let options = ["--strategies", &caps, "--frames", &frames, "--truth", "none"];
        self.add("caps", "", most, &options);
        let path_frames = (self.extent.path_frames / 10).max(16).to_string();
        let reuse = knobs(&LOSSY[1..], "reuse", self.extent.reuse);
        let options = ["--strategies", &reuse, "--path", "--frames", &path_frames];
        let options = [&options[..], &["--truth", "none", "--pictures", "none"]].concat();
        self.add("reuse", "", most, &options);
        let lossless = LOSSY.map(|family| format!("{family}/bvh")).join(",");
        for cut in ["windowed", "hard"] {
            for &threshold in self.extent.thresholds {
                let options = ["--strategies", &lossless, "--threshold", threshold, "--cut", cut];
                let options = [&options[..], &["--unbounded", "--frames", &frames]].concat();
                let options = [&options[..], &["--truth", "none"]].concat();
                self.add("ranges", &format!("{cut}-{threshold}"), most, &options);
            }
        }
    }
}
