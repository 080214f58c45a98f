//! The options of `compare`.

use std::path::PathBuf;

use assign::{FrustumTests, LightSource, MAX_SPECULAR_REACH};
use clap::{Args, ValueEnum};
use shading::{AreaModel, Cut, ShadowModel};

use super::{
    headings::{BOUNCE, CHECKS, LISTS, SHADING, TIMING},
    layers::LayerArgs,
    modes::Modes,
    named::named,
    stage::StageArgs,
    values::{self, Strategies},
};
use crate::{strategy::default_ids, truth_level::TruthLevel};

/// The options of `lightbench compare`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct CompareArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Strategies to compare, separated by commas, or all
    ///
    /// `lightbench list strategies` lists all ids; `list engines` lists names like engine:bevy.
    #[arg(
        long,
        display_order = 6,
        value_name = "A,B,C",
        default_value = default_ids()
    )]
    pub strategies: Strategies,

    /// How pixels are lit
    #[arg(long, display_order = 7, value_name = "MODE", default_value = "deferred", value_parser = Modes::parser())]
    pub mode: Modes,

    /// Move the camera once along the scene's path, and time each frame from another pose
    #[arg(long, display_order = 8, conflicts_with = "camera")]
    pub path: bool,

    /// Frames to time, 1 to 100,000; with --path, poses per lap
    ///
    /// The results keep every sample. [default: 64, or 3 on a software adapter; with --path 1,200, or 60 on a
    /// software adapter]
    #[arg(long, display_order = 9, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(1, values::MAX_FRAMES))]
    pub frames: Option<u32>,

    /// GPU to use, by any part of its name
    #[arg(long, display_order = 10, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for index.html, results.json and the pictures
    #[arg(long, display_order = 11, value_name = "DIR", default_value = "out/compare")]
    pub out: PathBuf,

    /// What is drawn over the opaque surfaces.
    #[command(flatten)]
    pub layers: LayerArgs,

    /// Samples per pixel, 1 or 4; 4 needs --mode forward and --truth none
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::whole_from(1, 4), help_heading = SHADING, hide_short_help = true)]
    pub msaa: u32,

    /// How to integrate the light of area lights [default: ltc]
    ///
    /// From one point: point, mrp, mrp-published. By linearly transformed cosines: ltc, ltc-hammon,
    /// ltc-unsplit, ltc-per-light, ltc-polynomial, ltc-polynomial-per-light. By N samples: monte-carlo:N,
    /// monte-carlo-reflected:N.
    #[arg(long, value_name = "MODEL", value_parser = values::area_model, help_heading = SHADING, hide_short_help = true)]
    pub area_model: Option<AreaModel>,

    /// Light by a point each area light that looks smaller than X steradians, 1e-9 to 6: lossy
    #[arg(long, value_name = "X", value_parser = values::number_from(1e-9, 6.0), allow_hyphen_values = true, help_heading = SHADING, hide_short_help = true, conflicts_with = "operations")]
    pub area_lod: Option<f64>,

    /// How fall-off ends at a light's range
    #[arg(long, value_name = "HOW", default_value = "windowed", value_parser = named(CUTS, Cut::name), help_heading = SHADING, hide_short_help = true)]
    pub cut: Cut,

    /// Let specular terms reach up to N of their lights' ranges, 1 to 64, on polished surfaces
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::number_from(1.0, MAX_SPECULAR_REACH.into()), help_heading = SHADING, hide_short_help = true, conflicts_with_all = ["compensate", "operations"])]
    pub specular_reach: Option<f64>,

    /// How lights are shadowed
    ///
    /// maps:N,PX draws N maps of each area light, 1, 4, 9, 25, 81 or 289, and one of each other light, with faces of PX
    /// texels, even, 32 to 4096. pcfK compares K texels, 1, 4, 9, 16 or 25. pcssK blurs as widely as the penumbra is, by
    /// K look-ups, 4, 9, 16, 25, 49 or 81. paraboloid is wrong for large triangles. adaptive:PX,DOWN,MOST divides
    /// rectangles where the view shows bands, tested at 1/DOWN, 1, 2, 4, 8 or 16, with MOST of 4 to 289 maps. cdi:N casts N
    /// rays through deep images, as many as maps or 16.
    #[arg(long, value_name = "none|maps:N,PX[,pcfK|,pcssK|,paraboloid]|adaptive:PX,DOWN,MOST|cdi:N", default_value = "none", value_parser = values::shadow_model, help_heading = SHADING, hide_short_help = true)]
    pub shadows: ShadowModel,

    /// Even out the brightness of virtual point lights: multiply each sample by N / (number of lights that
    /// light it)
    ///
    /// The factor stays between 1/4 and 4. It hides where these lights are dense or sparse, and so hides part of
    /// the error. N is a number from 1 to 1e9.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::number_from(1.0, 1e9), help_heading = BOUNCE, hide_short_help = true)]
    pub compensate: Option<f64>,

    /// Tests of lights against frusta, joined by +, for strategies whose id names none
    ///
    /// hs rejects a light behind one of the frustum's planes. The others reject a light that an axis separates
    /// from the frustum: along the frustum's edges (sat-e), towards its nearest corner (sat-n), along its
    /// planes' normals (sat-p), or towards each corner (sat-v). [default: hs+sat-n]
    #[arg(long, value_name = "UNION", value_parser = values::tests, help_heading = LISTS, hide_short_help = true)]
    pub test: Option<FrustumTests>,

    /// Where strategies whose id names no source read lights from [default: linear]
    #[arg(long, value_name = "SOURCE", help_heading = LISTS, hide_short_help = true)]
    pub source: Option<SourceChoice>,

    /// Frames of each method to draw before timing starts, 0 to 100,000
    ///
    /// A GPU draws more of them until its times are steady. [default: 16, or 1 on a software adapter]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(0, values::MAX_FRAMES), help_heading = TIMING, hide_short_help = true)]
    pub warmup: Option<u32>,

    /// Laps of --frames frames each with --path or --motion, 1 to 1,000; ties need 6 [default: 1]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(1, 1_000), help_heading = TIMING, hide_short_help = true)]
    pub laps: Option<u32>,

    /// What to check against the CPU
    #[arg(long, value_name = "LEVEL", default_value = "full", value_parser = named(TRUTH_LEVELS, TruthLevel::name), help_heading = CHECKS, hide_short_help = true)]
    pub truth: TruthLevel,

    /// Frames to compare with --path, --motion or --temporal, 0 to 8 [default: 8]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(0, values::MAX_CHECKS), help_heading = CHECKS, hide_short_help = true)]
    pub checks: Option<u32>,

    /// Compare frames in a row, and report how much the error changes between them
    #[arg(long, help_heading = CHECKS, hide_short_help = true)]
    pub temporal: bool,

    /// Also compare each image with that of lights without a range: the error of their ranges
    #[arg(long, help_heading = CHECKS, hide_short_help = true)]
    pub unbounded: bool,

    /// Also compare the images with a truth image: an EXR file, such as truth.exr of `truth`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["path", "motion"], help_heading = CHECKS, hide_short_help = true)]
    pub against: Option<PathBuf>,

    /// Count the light operations of every strategy that has lists
    ///
    /// One operation is one term (diffuse or specular) of one light at one sample. The report counts those in
    /// the lists, those that shading evaluates, and those that change the image.
    #[arg(long, help_heading = CHECKS, hide_short_help = true)]
    pub operations: bool,

    /// Which pictures to keep
    #[arg(long, value_name = "WHICH", default_value = "all", help_heading = CHECKS, hide_short_help = true)]
    pub pictures: PicturesChoice,
}

impl CompareArgs {
    /// The sources of lights for a strategy whose id names none.
    pub fn sources(&self) -> &'static [LightSource] {
        match self.source {
            None | Some(SourceChoice::Linear) => &[LightSource::Linear],
            Some(SourceChoice::Bvh) => &[LightSource::Hierarchy],
            Some(SourceChoice::Both) => &[LightSource::Linear, LightSource::Hierarchy],
        }
    }
}

pub(super) const CUTS: [(Cut, &str); 3] = [
    (Cut::Windowed, "Smoothly: times (1 - (distance / range)^4)^2"),
    (Cut::Hard, "At once: inverse square up to the range, 0 beyond it"),
    (Cut::Never, "Not at all, though lists end there: all that cull fail, on purpose"),
];

const TRUTH_LEVELS: [(TruthLevel, &str); 2] = [
    (TruthLevel::Full, "Every (light, pixel) pair, in f64"),
    (TruthLevel::None, "Nothing; images are still compared with no culling"),
];

/// Which pictures are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PicturesChoice {
    /// Each method's image (PNG, linear EXR), its difference to no culling, its heat map
    All,
    /// The same, of methods whose image is not that of no culling in every bit
    Differing,
    /// No pictures; images are still compared
    None,
}

/// Where strategies read lights from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SourceChoice {
    /// The list of all lights
    Linear,
    /// The hierarchy of boxes around the lights
    Bvh,
    /// Run each strategy twice, once per source
    Both,
}
