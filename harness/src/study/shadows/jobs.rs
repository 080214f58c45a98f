//! The jobs of one scene: truth images first, then one comparison per shadow model.

use shading::{MAX_MAP_PX, MIN_MAP_PX, ShadowModel};

use crate::{
    bench::Bench,
    cli::{Size, StudyArgs},
    error::HarnessError,
    strategy::BASELINE,
    study::{against_truth::TRUTH, job::Job, scene::StudyScene},
};

/// The section of P, the exact visible share times the exact light without shadows.
pub(crate) const SEPARATED: &str = "separated";
/// Without shadows.
pub(crate) const NONE: &str = "none";
/// The number of maps in atlases of fixed sizes.
pub(crate) const MAPS: &str = "maps";
/// The side of a map at a fixed number of maps.
pub(crate) const SIDES: &str = "sides";
/// Texels that a look-up compares.
pub(crate) const TAPS: &str = "taps";
/// The number of lights that share one atlas.
pub(crate) const LIGHTS: &str = "lights";

/// The sections whose images are compared with the truth.
pub(crate) const COMPARED: [&str; 5] = [NONE, MAPS, SIDES, TAPS, LIGHTS];

/// The setting of jobs whose maps share an atlas of a fixed side, texels.
pub(crate) const ATLAS: &str = "atlas_px";

/// The range of a light as a share of the diagonal of the scene's core: that of the study of area lights.
const RANGE_SHARE: f32 = 0.5;

/// Lights of all sections but one.
const FEW: u32 = 4;

/// How much the study looks at.
pub(crate) struct Extent {
    pub(crate) size: Size,
    pub(crate) frames: &'static str,
    pub(crate) warmup: &'static str,
    /// Samples per pixel of T and P. From 64 on, T's rays only estimate the visible share.
    samples: &'static str,
    /// Sides of atlases, texels; the last one is that of `LIGHTS`.
    atlases: &'static [u32],
    maps: &'static [u32],
    /// Numbers of maps, and the sides at which each is drawn.
    sides: (&'static [u32], &'static [u32]),
    /// Numbers of maps, and the taps with which each is read.
    taps: (&'static [u32], &'static [u32]),
    /// The side of a map that is filtered.
    filtered_px: u32,
    lights: &'static [u32],
    /// Maps of each of these lights.
    shared_maps: u32,
}

pub(crate) const FULL: Extent = Extent {
    size: Size { width: 1280, height: 720 },
    frames: "32",
    warmup: "4",
    samples: "256",
    atlases: &[2048, 8192],
    maps: &[1, 4, 9, 25, 81, 289],
    sides: (&[9, 25], &[64, 128, 256, 512]),
    taps: (&[4, 9, 25], &[1, 4, 9, 16, 25]),
    filtered_px: 256,
    lights: &[1, 4, 16, 64],
    shared_maps: 25,
};

pub(crate) const QUICK: Extent = Extent {
    size: Size { width: 96, height: 54 },
    frames: "1",
    warmup: "0",
    samples: "64",
    atlases: &[1024, 2048],
    maps: &[1, 9, 25, 81],
    sides: (&[9], &[64, 128, 256]),
    taps: (&[4, 25], &[1, 9]),
    filtered_px: 128,
    lights: &[1, 4, 16],
    shared_maps: 9,
};

/// The squares of an atlas that one map of a one-sided rectangle takes: one face and four halves.
const SQUARES_PER_MAP: u32 = 3;

/// The largest even side with which the maps of rectangles fit an atlas; `None` where none is long enough.
fn side_that_fits(atlas_px: u32, lights: u32, maps: u32) -> Option<u32> {
    let squares = SQUARES_PER_MAP * lights * maps;
    let columns = f64::from(squares).sqrt().ceil() as u32;
    let px = (atlas_px / columns.max(1)).min(MAX_MAP_PX) & !1;
    (px >= MIN_MAP_PX).then_some(px)
}

/// The jobs of one scene.
///
/// # Errors
///
/// Names what is wrong with the scene: a scene that cannot be opened shows before anything is written.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let ([core, _], _) = scene.boxes(bench)?;
    Ok(plan(args, scene, core.diagonal() * RANGE_SHARE))
}

/// How much the study looks at.
pub(crate) fn extent_of(args: &StudyArgs) -> &'static Extent {
    if args.quick { &QUICK } else { &FULL }
}

fn plan(args: &StudyArgs, scene: &StudyScene, range_m: f32) -> Vec<Job> {
    let extent = extent_of(args);
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    // All digits: in a scene of millimetres, a rounded range would differ.
    let range = range_m.clamp(1e-6, 1e6).to_string();
    let alike = ["--radii", "equal", "--radius-scale", &range];
    let lit = [&drawn[..], &alike, &["--areas", "1", "--outlines", "rectangles"]].concat();
    let truth = |section: &str, lights: u32, more: &[&str]| {
        let count = lights.to_string();
        let variant = if lights == FEW { "" } else { count.as_str() };
        let sampled = ["--shadows", "--samples", extent.samples, "--lights", &count];
        Job::new(scene, section, variant, &[&["truth"], &lit[..], &sampled, more].concat())
    };
    let frames = ["--frames", extent.frames, "--warmup", extent.warmup];
    let timed = [&["--strategies", BASELINE, "--truth", "none"], &frames[..]].concat();
    let compare = |section: &str, variant: &str, lights: u32, model: ShadowModel| {
        let (lights, model) = (lights.to_string(), model.to_string());
        let chosen = ["--lights", &lights, "--shadows", &model];
        Job::new(scene, section, variant, &[&["compare"], &lit[..], &timed, &chosen].concat())
    };
    let plain = |maps, px, taps| ShadowModel::Maps { maps, px, taps };
    let mut jobs = vec![truth(TRUTH, FEW, &[]), truth(SEPARATED, FEW, &["--separated"])];
    let others = extent.lights.iter().filter(|lights| **lights != FEW);
    jobs.extend(others.map(|lights| truth(TRUTH, *lights, &[])));
    jobs.push(compare(NONE, "", FEW, ShadowModel::None));
    for atlas in extent.atlases {
        for maps in extent.maps {
            let Some(px) = side_that_fits(*atlas, FEW, *maps) else { continue };
            let job = compare(MAPS, &format!("{atlas}-{maps}"), FEW, plain(*maps, px, 1));
            jobs.push(job.with(ATLAS, &atlas.to_string()));
        }
    }
    for maps in extent.sides.0 {
        for px in extent.sides.1 {
            jobs.push(compare(SIDES, &format!("{maps}-{px}"), FEW, plain(*maps, *px, 1)));
        }
    }
    for maps in extent.taps.0 {
        for taps in extent.taps.1 {
            let model = plain(*maps, extent.filtered_px, *taps);
            jobs.push(compare(TAPS, &format!("{maps}-pcf{taps}"), FEW, model));
        }
    }
    let atlas = extent.atlases.last().copied().unwrap_or_default();
    for lights in extent.lights {
        let maps = extent.shared_maps;
        let Some(px) = side_that_fits(atlas, *lights, maps) else { continue };
        let job = compare(LIGHTS, &lights.to_string(), *lights, plain(maps, px, 1));
        jobs.push(job.with(ATLAS, &atlas.to_string()));
    }
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    fn jobs(line: &str) -> Vec<Job> {
        let words = ["lightbench", "study", "shadows"].into_iter().chain(line.split_whitespace());
        let Ok(Invocation::Study(args)) = parse(words) else { panic!("{line}: a study") };
        let args = args.with_scenes(|_| vec!["atrium".to_owned()]);
        let scenes = StudyScene::all(&args).expect("scenes");
        scenes.iter().flat_map(|scene| plan(&args, scene, 10.0)).collect()
    }

    #[test]
    fn every_job_is_a_command_and_every_image_has_a_truth_of_as_many_lights() {
        for line in ["", "--quick"] {
            let jobs = jobs(line);
            let truths: Vec<Option<&str>> = jobs
                .iter()
                .filter(|job| job.section == TRUTH)
                .map(|job| job.option("--lights"))
                .collect();
            for job in &jobs {
                assert!(parse(&job.command).is_ok(), "{:?}", job.command);
                assert!(truths.contains(&job.option("--lights")), "{}", job.name);
                let known = COMPARED.contains(&job.section.as_str());
                assert_eq!(known, job.command[1] == "compare", "{}", job.name);
            }
            for section in COMPARED {
                assert!(jobs.iter().any(|job| job.section == section), "{line}: {section}");
            }
        }
    }

    #[test]
    fn maps_fill_their_atlas_and_do_not_exceed_it() {
        // 4 rectangles with 81 maps take 972 squares: 32 columns.
        assert_eq!(side_that_fits(8192, 4, 81), Some(256));
        assert_eq!(side_that_fits(2048, 4, 289), Some(34));
        assert_eq!(side_that_fits(1024, 4, 289), None);
        assert_eq!(side_that_fits(16384, 1, 1), Some(MAX_MAP_PX));
        for atlas in [1024, 2048, 8192] {
            for lights in [1, 4, 16, 64] {
                for maps in shading::MAP_COUNTS {
                    let Some(px) = side_that_fits(atlas, lights, maps) else { continue };
                    let squares = (atlas / px).pow(2);
                    assert!(px % 2 == 0 && squares >= SQUARES_PER_MAP * lights * maps);
                }
            }
        }
    }
}
