//! The jobs of one scene: truth images first, then one comparison per shadow model.

use assign::LightShape;
use glam::DVec3;
use shading::{MAX_MAP_PX, MIN_MAP_PX, ShadowModel};

use crate::{
    bench::Bench,
    cli::{self, Invocation, Size, StudyArgs},
    error::HarnessError,
    strategy::BASELINE,
    study::{against_truth::TRUTH, job::Job, scene::StudyScene},
};

/// P at each roughness of all surfaces.
pub(crate) const SEPARATED_BY: &str = "separated-roughness";
/// T at each roughness.
pub(crate) const TRUTH_BY: &str = "truth-roughness";
/// Far area lights as points, without shadows.
pub(crate) const LOD: &str = "lod";
/// The truth of the lights of [`LOD`], without shadows.
pub(crate) const LOD_TRUTH: &str = "truth-lod";
/// The section of P, the exact visible share times the exact light without shadows.
pub(crate) const SEPARATED: &str = "separated";
/// Without shadows.
pub(crate) const NONE: &str = "none";
/// The same, compared with [`UNSHADOWED`]: the error of the pipeline that no shadow model changes.
pub(crate) const PIPELINE: &str = "pipeline";
/// The truth without shadows.
pub(crate) const UNSHADOWED: &str = "unshadowed";
/// T of each number of lights of [`LIGHTS`].
pub(crate) const LIGHTS_TRUTH: &str = "truth-lights";
/// The number of maps in atlases of fixed sizes.
pub(crate) const MAPS: &str = "maps";
/// The side of a map at a fixed number of maps.
pub(crate) const SIDES: &str = "sides";
/// Texels that a look-up compares.
pub(crate) const TAPS: &str = "taps";
/// The number of lights that share one atlas.
pub(crate) const LIGHTS: &str = "lights";
/// Rays in place of maps, and maps from as many points.
pub(crate) const RAYS: &str = "rays";

/// Lights that frames subdivide, by the resolution of the test, and fixed numbers of maps beside them.
pub(crate) const ADAPTIVE: &str = "adaptive";
/// The same for one light that the camera approaches.
pub(crate) const APPROACH: &str = "approach";

/// The sections whose images are compared, each with the section of its truth.
pub(crate) const AGAINST: [(&str, &str); 11] = [
    (SEPARATED, TRUTH),
    (NONE, TRUTH),
    (MAPS, TRUTH),
    (SIDES, TRUTH),
    (TAPS, TRUTH),
    (LIGHTS, LIGHTS_TRUTH),
    (ADAPTIVE, TRUTH),
    (RAYS, TRUTH),
    (PIPELINE, UNSHADOWED),
    (SEPARATED_BY, TRUTH_BY),
    (LOD, LOD_TRUTH),
];

/// The options by which a truth is that of an image.
pub(crate) const ALIKE: &[&str] = &["--lights", "--size", "--roughness"];

/// The sections whose images are compared with the truth with shadows.
pub(crate) const COMPARED: [&str; 6] = [NONE, MAPS, SIDES, TAPS, LIGHTS, ADAPTIVE];

/// The setting of jobs whose maps share an atlas of a fixed side, texels.
pub(crate) const ATLAS: &str = "atlas_px";

/// The setting of jobs of [`APPROACH`]: from the camera to the light, metres.
pub(crate) const DISTANCE: &str = "distance_m";

/// Where the cameras of [`APPROACH`] stand: shares of the way from a place in front of the light to the default camera.
const APPROACHED: [f64; 3] = [1.0, 0.5, 0.25];

/// How far in front of the light that place lies, as a share of the light's range.
const IN_FRONT: f64 = 0.125;

/// The fixed numbers of maps beside subdivided lights (Dobetsberger 2025, figure 6.8).
const FIXED: [u32; 2] = [25, 81];

/// The most maps of a subdivided light: those of the paper's atlas (section 6.4).
const MOST_MAPS: u32 = 64;

/// The range of a light as a share of the diagonal of the scene's core: that of the study of area lights.
pub(super) const RANGE_SHARE: f32 = 0.5;

/// Lights of all sections but one.
pub(super) const FEW: u32 = 4;

/// How much the study looks at.
pub(crate) struct Extent {
    pub(crate) size: Size,
    pub(crate) frames: &'static str,
    pub(crate) warmup: &'static str,
    /// Samples per pixel of T and P. From 64 on, T's rays only estimate the visible share.
    pub(crate) samples: &'static str,
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
    /// The size of images of `lights`, and the samples per pixel of their truth: T of many lights takes long.
    pub(crate) lights_size: Size,
    pub(crate) lights_samples: &'static str,
    /// Maps of each of these lights.
    shared_maps: u32,
    /// The side of maps of subdivided lights.
    adaptive_px: u32,
    /// The test for bands looks at one pixel in so many along each axis.
    downs: &'static [u32],
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
    lights_size: Size { width: 480, height: 270 },
    lights_samples: "64",
    shared_maps: 25,
    adaptive_px: 256,
    downs: &[1, 2, 4, 8, 16],
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
    lights_size: Size { width: 96, height: 54 },
    lights_samples: "64",
    shared_maps: 9,
    adaptive_px: 64,
    downs: &[1, 8],
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

/// A camera on its way to the light, and its distance from it, metres.
pub(super) struct Stop {
    pub(super) camera: String,
    pub(super) distance_m: f64,
}

/// How much the study looks at.
pub(crate) fn extent_of(args: &StudyArgs) -> &'static Extent {
    if args.quick { &QUICK } else { &FULL }
}

/// The cameras that approach the only light of [`APPROACH`], the farthest first.
pub(super) fn stops(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
    range_m: f32,
) -> Result<Vec<Stop>, HarnessError> {
    let size = Size { width: 16, height: 9 };
    let words = [scene.options(size, args.seed), alike(range_m)].concat();
    let words = words.iter().map(String::as_str).chain(["--lights", "1"]);
    let words = ["lightbench", "compare"].into_iter().chain(words);
    let Invocation::Compare(asked) = cli::parse(words)? else { return Ok(Vec::new()) };
    let stage = bench.stage(&asked.stage)?;
    let Some(light) = stage.lights.lights().first() else { return Ok(Vec::new()) };
    let LightShape::Area(emitter) = &light.shape else { return Ok(Vec::new()) };
    let lit = light.position.as_dvec3()
        + emitter.normal().as_dvec3() * (IN_FRONT * f64::from(light.range_m));
    let eye = stage.view.eye().as_dvec3();
    let stop = |share: f64| {
        let eye = lit + (eye - lit) * share;
        let [from, to] = [eye, lit].map(|place| {
            let DVec3 { x, y, z } = stage.scene.origin + place;
            format!("{x},{y},{z}")
        });
        Stop { camera: format!("{from}:{to}"), distance_m: eye.distance(light.position.as_dvec3()) }
    };
    Ok(APPROACHED.map(stop).into())
}

/// The options of all sections whose lights are alike: scene, size and lights.
pub(super) fn lit(args: &StudyArgs, scene: &StudyScene, size: Size, range_m: f32) -> Vec<String> {
    [scene.options(args.size.unwrap_or(size), args.seed), alike(range_m)].concat()
}

/// The options of the lights: rectangles with equal ranges.
fn alike(range_m: f32) -> Vec<String> {
    // All digits: in a scene of millimetres, a rounded range would differ.
    let range = range_m.clamp(1e-6, 1e6).to_string();
    let alike = ["--radii", "equal", "--radius-scale", &range];
    let lit = ["--areas", "1", "--outlines", "rectangles"];
    alike.into_iter().chain(lit).map(str::to_owned).collect()
}

/// The jobs of one scene.
pub(super) fn jobs(args: &StudyArgs, scene: &StudyScene, range_m: f32, stops: &[Stop]) -> Vec<Job> {
    let extent = extent_of(args);
    let [many, lit] = [extent.lights_size, extent.size].map(|size| lit(args, scene, size, range_m));
    let lit: Vec<&str> = lit.iter().map(String::as_str).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let few = FEW.to_string();
    let truth = |section: &str, more: &[&str]| {
        let sampled = ["--samples", extent.samples, "--lights", &few];
        Job::new(scene, section, "", &[&["truth"], &lit[..], &sampled, more].concat())
    };
    let frames = ["--frames", extent.frames, "--warmup", extent.warmup];
    let timed = [&["--strategies", BASELINE, "--truth", "none"], &frames[..]].concat();
    let drawn = |section: &str, variant: &str, lit: &[&str], lights: u32, model: ShadowModel| {
        let (lights, model) = (lights.to_string(), model.to_string());
        let chosen = ["--lights", &lights, "--shadows", &model];
        Job::new(scene, section, variant, &[&["compare"], lit, &timed, &chosen].concat())
    };
    let compare = |section: &str, variant: &str, lights: u32, model: ShadowModel| {
        drawn(section, variant, &lit, lights, model)
    };
    let plain = |maps, px, taps| ShadowModel::Maps { maps, px, taps };
    let mut jobs = vec![
        truth(TRUTH, &["--shadows"]),
        truth(SEPARATED, &["--shadows", "--separated"]),
        truth(UNSHADOWED, &[]),
    ];
    jobs.extend(extent.lights.iter().map(|lights| {
        let count = lights.to_string();
        let sampled = ["--shadows", "--samples", extent.lights_samples, "--lights", &count];
        Job::new(scene, LIGHTS_TRUTH, &count, &[&["truth"], &many[..], &sampled].concat())
    }));
    jobs.push(compare(NONE, "", FEW, ShadowModel::None));
    jobs.push(compare(PIPELINE, "", FEW, ShadowModel::None));
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
        let job = drawn(LIGHTS, &lights.to_string(), &many, *lights, plain(maps, px, 1));
        jobs.push(job.with(ATLAS, &atlas.to_string()));
    }
    let px = extent.adaptive_px;
    let adaptive = extent.downs.iter().map(|down| {
        (format!("1-{down}"), ShadowModel::Adaptive { px, down: *down, most: MOST_MAPS })
    });
    let fixed = FIXED.map(|maps| (format!("fixed-{maps}"), plain(maps, px, 1)));
    let models: Vec<(String, ShadowModel)> = adaptive.chain(fixed).collect();
    jobs.extend(models.iter().map(|(variant, model)| compare(ADAPTIVE, variant, FEW, *model)));
    for (ix, stop) in stops.iter().enumerate() {
        for (variant, model) in &models {
            let mut job = compare(APPROACH, &format!("{ix}-{variant}"), 1, *model);
            job.command.extend([format!("--camera={}", stop.camera)]);
            jobs.push(job.with(DISTANCE, &stop.distance_m.to_string()));
        }
    }
    jobs
}

#[cfg(test)]
mod tests {
    use super::*;

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
