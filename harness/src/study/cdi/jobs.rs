//! Compound deep images (Archer, Leach, Knowles 2019): time of every step, ranges against exact rays,
//! and indirect light by virtual point lights against a path-traced image.

use crate::study::against_truth::{MODELS, TRUTH};
use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::{
    bench::Bench,
    cli::{Size, StudyArgs},
    error::HarnessError,
    results::{DeepImages, Vpls},
};

/// The section whose job is timed step by step.
pub(crate) const STEPS: &str = "steps";
/// The section of what light comes straight from the primary light: the paper's zero bounces.
pub(crate) const DIRECT: &str = "direct";
/// The section of deep images, by directions, sizes and builds.
pub(crate) const BUILDS: &str = "builds";
/// The section of rays from every pixel of reflective shadow maps.
pub(crate) const CASTS: &str = "casts";
/// The section of strategies that share the virtual point lights.
pub(crate) const STRATEGIES: &str = "strategies";

/// The strategy that errors and steps are measured with: the paper's.
const GRID: &str = "HG/48x48x40";

/// How much the study looks at.
struct Extent {
    /// Of the images that are compared with the truth.
    size: Size,
    /// Of the steps and of the strategies.
    timed_size: Size,
    /// Directions of a pixel's bounce in the truth.
    samples: &'static str,
    frames: &'static str,
    warmup: &'static str,
    /// Side of the reflective shadow map.
    rsm: &'static str,
    /// Sides at which the number of lights is varied.
    rsms: &'static [&'static str],
    /// Directions of the deep images, the usual last.
    directions: &'static [&'static str],
    /// Pixels along their sides, the usual first.
    deep_sizes: &'static [&'static str],
    /// Rays of a light, the usual first.
    rays: &'static [&'static str],
    /// Factors on the average of ranges that were found.
    scales: &'static [&'static str],
    /// Factors on the longest of them.
    longest_scales: &'static [&'static str],
    /// Longest random ranges, as shares of the diagonal of the scene's core: as many as both kinds of
    /// factors together, and beyond the diagonal, so that the least error lies inside. Constant ranges
    /// are half of these, the mean of random ones.
    random: &'static [f32],
    /// Sides of shadow maps to cast from.
    casts: &'static str,
    compared: &'static str,
    strategies: &'static str,
    /// Directions of conservative images: at least one fragment per triangle and direction, which would
    /// be 5 GiB in the town with 169 directions.
    conservative: &'static str,
}

const FULL: Extent = Extent {
    size: Size { width: 480, height: 270 },
    timed_size: Size { width: 1920, height: 1080 },
    samples: "1024",
    frames: "32",
    warmup: "4",
    rsm: "256",
    rsms: &["64", "128", "256", "512"],
    directions: &["2x4", "4x4", "4x8", "8x8", "8x16", "13x13"],
    deep_sizes: &["64", "32", "128", "256"],
    rays: &["6", "1", "3", "12"],
    scales: &["2", "3", "4", "6"],
    longest_scales: &["0.75", "1", "1.5", "2"],
    random: &[0.15, 0.2, 0.3, 0.5, 0.8, 1.2, 1.6, 2.4],
    casts: "256,512,1024,2048",
    compared: "200000",
    strategies: "None,T-E,DC-E,SC-E,G,M/2,HG",
    conservative: "4x4",
};

const QUICK: Extent = Extent {
    size: Size { width: 96, height: 54 },
    timed_size: Size { width: 192, height: 108 },
    samples: "16",
    frames: "3",
    warmup: "1",
    rsm: "32",
    rsms: &["16", "32"],
    directions: &["2x4", "4x8"],
    deep_sizes: &["32", "16"],
    rays: &["6", "1"],
    scales: &["1", "2"],
    longest_scales: &["1", "2"],
    random: &[0.1, 0.4],
    casts: "16,32",
    compared: "2000",
    strategies: "None,SC-E,HG",
    conservative: "1x4",
};

impl Extent {
    /// Options of deep images; `None` is the usual.
    fn deep(
        &self,
        directions: Option<&'static str>,
        size: Option<&'static str>,
    ) -> [&'static str; 4] {
        let usual = |all: Option<&&'static str>| all.copied().unwrap_or_default();
        let directions = directions.unwrap_or_else(|| usual(self.directions.last()));
        let size = size.unwrap_or_else(|| usual(self.deep_sizes.first()));
        ["--directions", directions, "--deep-size", size]
    }
}

/// Whether rays are cast as in most jobs: how many, through which deep images, built how.
pub(crate) fn is_usual(vpls: &Vpls) -> bool {
    let is_of = |extent: &Extent, deep: &DeepImages| {
        let directions = format!("{}x{}", deep.stacks, deep.slices);
        let size = deep.size_px.to_string();
        deep.build == "compute"
            && extent.directions.last() == Some(&directions.as_str())
            && extent.deep_sizes.first() == Some(&size.as_str())
            && extent.rays.first() == Some(&vpls.rays.to_string().as_str())
    };
    let is_plain = !vpls.is_corrected && !vpls.is_reflected;
    let deep = vpls.deep.as_ref();
    is_plain && deep.is_some_and(|deep| [&FULL, &QUICK].iter().any(|extent| is_of(extent, deep)))
}

/// The jobs of one scene.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let extent = if args.quick { QUICK } else { FULL };
    let ([core, _], _) = scene.boxes(bench)?;
    let mut jobs = images(args, scene, &extent, core.diagonal());
    jobs.extend(steps(args, scene, &extent));
    jobs.extend(deep_images(args, scene, &extent));
    Ok(jobs)
}

/// The truth, and indirect light by each setting against it.
fn images(args: &StudyArgs, scene: &StudyScene, extent: &Extent, diagonal_m: f32) -> Vec<Job> {
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let traced = [&["truth"], &drawn[..], &["--primary", "--shadows"]].concat();
    let bounced = ["--bounces", "1", "--indirect", "--samples", extent.samples];
    let mut jobs = vec![
        Job::new(scene, TRUTH, "", &[&traced[..], &bounced].concat()),
        Job::new(scene, DIRECT, "", &traced),
    ];
    let timed = ["--strategies", GRID, "--frames", extent.frames, "--warmup", extent.warmup];
    let timed = [&timed[..], &["--light-order", "given"]].concat();
    let common = [&["compare"], &drawn[..], &timed, &["--truth", "none"]].concat();
    let mut add = |name: &str, rsm: &str, settings: &[(&str, &str)], words: &[&str]| {
        let words = [&common[..], &["--vpls", rsm], words].concat();
        let job = Job::new(scene, MODELS, name, &words);
        let with = |job: Job, (name, value): &(&str, &str)| job.with(name, value);
        jobs.push(settings.iter().fold(job, with));
    };
    // How ranges are found.
    for (rule, scales) in [("average", extent.scales), ("maximum", extent.longest_scales)] {
        for scale in scales {
            let words = [&extent.deep(None, None)[..], &["--ranges", rule, "--range-scale", scale]];
            let swept = [("sweep", rule), ("range_scale", scale)];
            add(&format!("{rule}-x{scale}"), extent.rsm, &swept, &words.concat());
        }
    }
    let random: Vec<String> =
        extent.random.iter().map(|share| format!("0,{}", share * diagonal_m)).collect();
    let random_words = |span| ["--ranges", "random", "--random-ranges", span];
    for (share, span) in extent.random.iter().zip(&random) {
        let text = share.to_string();
        let swept = |rule| [("sweep", rule), ("range_share", text.as_str())];
        add(&format!("random-{share}"), extent.rsm, &swept("random"), &random_words(span));
        // What rays leave out, without what they say of the others.
        let deep = extent.deep(None, None);
        let words = ["--ranges", "random-discard", "--random-ranges", span];
        let words = [&deep[..], &words].concat();
        let settings = swept("random-discard");
        add(&format!("random-discard-{share}"), extent.rsm, &settings, &words);
        let range_m = (0.5 * share * diagonal_m).to_string();
        let words = ["--ranges", "constant-discard", "--constant-range", &range_m];
        let words = [&deep[..], &words].concat();
        let settings = swept("constant-discard");
        add(&format!("constant-discard-{share}"), extent.rsm, &settings, &words);
    }
    add("infinite", extent.rsm, &[], &["--ranges", "infinite"]);
    // The paper sees no difference between the two builds in the image.
    let each = [&extent.deep(None, None)[..], &["--build", "per-direction-batched"]].concat();
    add("per-direction", extent.rsm, &[], &each);
    let corrected = [&extent.deep(None, None)[..], &["--correct-rays"]].concat();
    add("corrected", extent.rsm, &[], &corrected);
    let reflected = [&extent.deep(None, None)[..], &["--primary-ray", "reflected"]].concat();
    add("reflected", extent.rsm, &[], &reflected);
    // More and fewer lights.
    for rsm in extent.rsms.iter().filter(|rsm| **rsm != extent.rsm) {
        add(&format!("rsm{rsm}-average"), rsm, &[], &extent.deep(None, None));
        // Every other span.
        for (share, span) in extent.random.iter().zip(&random).skip(1).step_by(2) {
            add(&format!("rsm{rsm}-random-{share}"), rsm, &[], &random_words(span));
        }
    }
    // What the deep images are like, and how many rays go through them.
    for directions in extent.directions.iter().rev().skip(1) {
        let deep = extent.deep(Some(directions), None);
        add(&format!("directions-{directions}"), extent.rsm, &[], &deep);
    }
    for size in extent.deep_sizes.iter().skip(1) {
        let deep = extent.deep(None, Some(size));
        add(&format!("size-{size}"), extent.rsm, &[], &deep);
    }
    for rays in extent.rays.iter().skip(1) {
        let words = [&extent.deep(None, None)[..], &["--rays", rays]].concat();
        add(&format!("rays-{rays}"), extent.rsm, &[], &words);
    }
    jobs
}

/// The paper's pipeline step by step, and every strategy under its lights.
fn steps(args: &StudyArgs, scene: &StudyScene, extent: &Extent) -> Vec<Job> {
    let drawn = scene.options(args.size.unwrap_or(extent.timed_size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let timed = ["--frames", extent.frames, "--warmup", extent.warmup, "--pictures", "none"];
    let deep = extent.deep(None, None);
    let common = [&["compare"], &drawn[..], &timed, &["--vpls", extent.rsm], &deep].concat();
    let options = ["--strategies", GRID, "--light-order", "given", "--truth", "none"];
    // Pairs in f64 would take minutes: images say whether anything was lost. Lights that are made in each
    // frame have the order of their map and no hierarchy.
    let all = ["--strategies", extent.strategies, "--light-order", "given", "--truth", "none"];
    vec![
        Job::new(scene, STEPS, "", &[&common[..], &options].concat()),
        Job::new(scene, STRATEGIES, "", &[&common[..], &all].concat()),
    ]
}

/// Deep images by directions, sizes and builds, and rays through them.
fn deep_images(args: &StudyArgs, scene: &StudyScene, extent: &Extent) -> Vec<Job> {
    let (scale, seed) = (scene.scale.to_string(), args.seed.to_string());
    let drawn = ["cdi", "--scene", &scene.scene, "--scene-scale", &scale, "--seed", &seed];
    let common = [&drawn[..], &["--frames", extent.frames]].concat();
    let mut jobs = Vec::new();
    let mut add = |name: &str, words: &[&str]| {
        jobs.push(Job::new(scene, BUILDS, name, &[&common[..], words].concat()));
    };
    let compared = ["--casts", "none", "--compared", extent.compared];
    let only_built = ["--casts", "none", "--compared", "0"];
    for directions in extent.directions {
        let deep = extent.deep(Some(directions), None);
        let words = [&deep[..], &compared].concat();
        add(&format!("compute-{directions}"), &words);
        for build in ["fragment", "per-direction", "per-direction-batched"] {
            // Rays through both builds of most directions are compared: the paper sees no difference.
            let is_usual = extent.directions.last() == Some(directions);
            let rays = if is_usual && build == "per-direction" { compared } else { only_built };
            let words = [&deep[..], &["--build", build], &rays].concat();
            add(&format!("{build}-{directions}"), &words);
        }
    }
    for size in extent.deep_sizes.iter().skip(1) {
        let deep = extent.deep(None, Some(size));
        add(&format!("size-{size}"), &[&deep[..], &compared].concat());
    }
    let usual = extent.deep(None, None);
    let oversampled = [&usual[..], &["--oversampling", "2"], &compared].concat();
    add("oversampled", &oversampled);
    let squares = [&usual[..], &["--spread", "squares"], &compared].concat();
    add("squares", &squares);
    let linked = [&usual[..], &["--build", "linked-lists"], &compared].concat();
    add("linked-lists", &linked);
    let deep = extent.deep(Some(extent.conservative), None);
    let conservative = [&deep[..], &["--build", "conservative"], &compared].concat();
    add("conservative", &conservative);
    let cast = [&usual[..], &["--casts", extent.casts, "--compared", "0"]].concat();
    let words = [&common[..], &cast].concat();
    jobs.push(Job::new(scene, CASTS, "", &words));
    let linked = [&cast[..], &["--build", "linked-lists"]].concat();
    let words = [&common[..], &linked].concat();
    jobs.push(Job::new(scene, CASTS, "linked-lists", &words));
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{self, Invocation};

    #[test]
    fn every_job_is_a_command() {
        let Ok(Invocation::Study(args)) = cli::parse(["lightbench", "study", "cdi"]) else {
            panic!("a study");
        };
        let scene = StudyScene { scene: "atrium".into(), name: "atrium".into(), scale: 1.0 };
        for extent in [&FULL, &QUICK] {
            let mut all = images(&args, &scene, extent, 40.0);
            all.extend(steps(&args, &scene, extent));
            all.extend(deep_images(&args, &scene, extent));
            let mut names: Vec<&String> = all.iter().map(|job| &job.name).collect();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), all.len(), "every job has a name of its own");
            for job in &all {
                let asked =
                    cli::parse(&job.command).unwrap_or_else(|e| panic!("{}: {e}", job.name));
                let is_known = matches!(
                    asked,
                    Invocation::Compare(_) | Invocation::Truth(_) | Invocation::Cdi(_)
                );
                assert!(is_known, "{}", job.name);
            }
        }
    }
}
