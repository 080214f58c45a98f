//! The command line: what it accepts, and what it says about what it does not.
//!
//! Whatever is wrong gets one line that names the option, the value and what would be accepted
//! ([`CliError`]), and exit code [`BAD_INPUT`]. Names of scenes and strategies are passed on as
//! they are; whoever looks them up offers the [`nearest`] ones.

mod camera;
mod cdi;
mod effect;
mod error;
mod fit_ltc;
mod names;
mod parse;
mod stage;
mod strategies;
mod study;
mod truth;
mod values;
mod vpl;

use std::path::PathBuf;

use assign::FrustumTests;
use clap::{Args, Parser, Subcommand, ValueEnum};
use shading::{AreaModel, Cut};

pub use camera::{Camera, CameraPose};
pub use cdi::CdiArgs;
pub use error::{BAD_INPUT, CliError};
pub use fit_ltc::FitLtcArgs;
pub use names::{did_you_mean, nearest};
pub use parse::{parse, parse_stored};
pub use stage::{LightBox, OutlinesChoice, RadiiChoice, StageArgs};
pub use strategies::ALL;
pub use study::{AdviseArgs, ReportArgs, Shard, StudyArgs, StudyName};
pub use truth::TruthArgs;
pub(crate) use values::MAX_CHECKS;
pub use values::{DirectionCounts, FarPlane, Size, Sizes, Span, Strategies};
pub use vpl::{BuildChoice, DeepArgs, PrimaryRay, RangeChoice, SpreadChoice, VplArgs};

use crate::results::{Mode, TruthLevel};

/// The most lights that can be scattered.
pub const MAX_LIGHTS: u32 = 1 << 24;

const ABOUT: &str = "Compare ways of assigning many lights to pixels";

const LONG_ABOUT: &str = "\
Compare ways of assigning many lights to pixels.

Draws one scene with each strategy through the same pipeline: only the light lists differ. None, the \
reference, evaluates every light at every sample. All others skip a light early where it adds nothing; \
Sphere is None with that skip. Times every pass, checks every list and every image against no culling, and writes a \
report: DIR/index.html to look at, DIR/results.json to compute with.";

const EXAMPLES: &str = "\
Examples:
  lightbench
      The embedded atrium with 1,000 lights: no culling, without and with an early exit, against
      clusters, dense and sparse.
  lightbench --scene Sponza.gltf --lights 10000 --size 1920x1080 --mode both
      Your scene, its own lights and 10,000 more, deferred and forward.
  lightbench --strategies None,DC-I/128x128x64,DC-I/64x64x24,DC-I/32x32x32 --frames 32
      One strategy with three settings. `lightbench list strategies` names them all.

How to read the result:
  rank           1 is fastest of those that lose nothing; methods that tie share a rank
  both ms        assigning and shading together: compare strategies by it
  span ms        the same with the gaps between passes; not known on a software adapter
  listed         lights in the list that a pixel reads, mean; contributing is what a perfect list holds
  missed         (light, pixel) pairs that the lists lack: 0, or the image is wrong
  max diff       largest difference to the image of no culling: 0 means the same in every bit
  memory         everything that assignment needs on the GPU, MiB
  overflow       groups whose list did not fit and that fell back to all lights: slow, still correct

Times on a software adapter are wall-clock times of a CPU, not a GPU's.
Exit codes: 0 done, 1 failed, 2 bad input.";

/// What `lightbench` is asked to do.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "one value a run")]
pub enum Invocation {
    /// Compare strategies.
    Compare(CompareArgs),
    /// Run a study, or go on with it.
    Study(StudyArgs),
    /// Make a report again, or of the shards of a study.
    Report(ReportArgs),
    /// Search for the best strategy and parameters.
    Advise(AdviseArgs),
    /// Fit linearly transformed cosines to the BRDF.
    FitLtc(FitLtcArgs),
    /// Render what a view should look like.
    Truth(TruthArgs),
    /// Build deep images and cast rays through them.
    Cdi(CdiArgs),
    /// List what can be named on the command line.
    List(Listing),
    /// Print this text (help or version) and end well.
    Show(String),
}

#[derive(Parser)]
#[command(
    name = "lightbench",
    version,
    about = ABOUT,
    long_about = LONG_ABOUT,
    after_long_help = EXAMPLES,
    after_help = "`lightbench --help` says more, with examples.",
    args_conflicts_with_subcommands = true,
    max_term_width = 100,
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    compare: CompareArgs,
}

#[derive(Subcommand)]
#[allow(clippy::large_enum_variant, reason = "one value a run")]
enum Command {
    /// Compare strategies on one scene (the default: `lightbench --scene X` is enough)
    #[command(long_about = LONG_ABOUT, after_long_help = EXAMPLES)]
    Compare(CompareArgs),
    /// Run a study on your GPU: many comparisons, their charts and findings; goes on where it was
    /// interrupted
    Study(StudyArgs),
    /// Make the report of a comparison or a study again, metrics included, or of a study's shards
    Report(ReportArgs),
    /// Search for the strategy and parameters to use on this scene and this GPU
    Advise(AdviseArgs),
    /// Fit linearly transformed cosines to the BRDF anew, and compare them with those in use
    FitLtc(FitLtcArgs),
    /// Render on the CPU what a view should look like, with shadows or a bounce where asked for
    Truth(TruthArgs),
    /// Build the deep images of a scene, cast rays through them, and compare those with exact ones
    Cdi(CdiArgs),
    /// List the strategies, scenes or adapters that can be named
    List {
        /// What to list
        what: Listing,
    },
}

/// What `lightbench list` lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Listing {
    /// Every strategy with its parameters
    Strategies,
    /// Every scene that needs no file
    Scenes,
    /// Every adapter that wgpu can drive, the one taken by default first
    Adapters,
}

/// The options of `lightbench compare`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct CompareArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Strategies, separated by commas, with their parameters; None is no culling, all is every one
    #[arg(long, value_name = "A,B,C", default_value = "None,Sphere,DC-I,SC-E/bvh")]
    pub strategies: Strategies,

    /// Tests of lights against frusta, for strategies that name none, joined by +: hs (behind one of
    /// its planes), or an axis that parts the two along its edges (sat-e), towards its nearest corner
    /// (sat-n), along its planes' normals (sat-p) or towards every corner (sat-v)
    /// [default: hs+sat-n]
    #[arg(long, value_name = "UNION", value_parser = values::tests)]
    pub test: Option<FrustumTests>,

    /// Where strategies take lights from that name no source: the list of all, or the hierarchy
    #[arg(long, value_name = "SOURCE", default_value = "linear")]
    pub source: SourceChoice,

    /// How the light of area lights is integrated: from one point (point, mrp, mrp-published), by linearly
    /// transformed cosines (ltc, ltc-hammon, ltc-unsplit, ltc-per-light, ltc-polynomial,
    /// ltc-polynomial-per-light), or by samples (monte-carlo:N, monte-carlo-reflected:N) [default: ltc]
    #[arg(long, value_name = "MODEL", value_parser = values::area_model)]
    pub area_model: Option<AreaModel>,

    /// Frames to time, 1 to 100,000, every sample kept; with --path, poses of a lap
    /// [default: 64, or 3 on a software adapter; with --path 1,200 or 60]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::frames)]
    pub frames: Option<u32>,

    /// Frames of each method to draw before the clock starts, 0 to 100,000; a GPU draws more, until its
    /// times are steady [default: 16, or 1 on a software adapter]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::warmup)]
    pub warmup: Option<u32>,

    /// Time each frame from another pose: the camera goes once along the scene's path
    #[arg(long, conflicts_with = "camera")]
    pub path: bool,

    /// With --path, go along the path N times, 1 to 1,000, from --frames poses each time; testing
    /// ties needs 6 laps [default: 1]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::laps)]
    pub laps: Option<u32>,

    /// With --path, poses at which images are compared with that of no culling, 1 to 8 [default: 8]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::checks)]
    pub checks: Option<u32>,

    /// How fall-off ends at a light's range
    #[arg(long, value_name = "HOW", default_value = "windowed")]
    pub cut: CutChoice,

    /// Compare images with that of lights without a range, too: the error of their ranges
    #[arg(long)]
    pub unbounded: bool,

    /// How pixels are lit
    #[arg(long, value_name = "MODE", default_value = "deferred")]
    pub mode: ModeChoice,

    /// Part of the adapter's name, where there are several
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for results.json, index.html and the pictures
    #[arg(long, value_name = "DIR", default_value = "out/compare")]
    pub out: PathBuf,

    /// Which pictures to keep
    #[arg(long, value_name = "WHICH", default_value = "all")]
    pub pictures: PicturesChoice,

    /// Multiply each sample by this number of lights over the number of those that light it, within a
    /// factor of 4: hides where virtual point lights lie thick or thin, and errors with them
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::compensation)]
    pub compensate: Option<f64>,

    /// Count the light operations of every method with lists: terms of lights at samples that its lists
    /// name, those of them that shading evaluates, and those that would be seen
    #[arg(long)]
    pub operations: bool,

    /// What to check against the CPU: every (light, pixel) pair, or nothing
    #[arg(long, value_name = "LEVEL", default_value = "full")]
    pub truth: TruthChoice,
}

/// How fall-off ends at a light's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CutChoice {
    /// Smoothly
    Windowed,
    /// At once: inverse square up to the range
    Hard,
}

impl From<CutChoice> for Cut {
    fn from(choice: CutChoice) -> Self {
        match choice {
            CutChoice::Windowed => Self::Windowed,
            CutChoice::Hard => Self::Hard,
        }
    }
}

/// Which pictures are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PicturesChoice {
    /// Every method's image, as PNG and as linear EXR, its difference and its heat map
    All,
    /// None; images are compared all the same
    None,
}

/// Where lights come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SourceChoice {
    /// The list of all lights
    Linear,
    /// The hierarchy of boxes around them
    Bvh,
    /// Each strategy twice
    Both,
}

/// How pixels are lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ModeChoice {
    /// From a G-buffer, in a compute pass
    Deferred,
    /// In the fragment shader that draws the surfaces
    Forward,
    /// deferred and forward, one after the other
    Both,
    /// From a G-buffer that also holds the model of each pixel, which M reads
    DeferredIds,
    /// In the fragment shader, without a depth pre-pass but for strategies that read depth, which pay
    /// for it
    ForwardNoPrepass,
    /// The three frames of a renderer: forward-no-prepass, forward and deferred-ids
    Frames,
    /// All four
    All,
}

impl ModeChoice {
    /// The modes to run, in order.
    pub fn modes(self) -> &'static [Mode] {
        match self {
            Self::Deferred => &[Mode::Deferred],
            Self::Forward => &[Mode::Forward],
            Self::Both => &[Mode::Deferred, Mode::Forward],
            Self::DeferredIds => &[Mode::DeferredIds],
            Self::ForwardNoPrepass => &[Mode::ForwardNoPrepass],
            Self::Frames => &[Mode::ForwardNoPrepass, Mode::Forward, Mode::DeferredIds],
            Self::All => &Mode::ALL,
        }
    }
}

/// What is checked on the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TruthChoice {
    /// Every (light, pixel) pair, in f64
    Full,
    /// Nothing; images are still compared with no culling
    None,
}

impl From<TruthChoice> for TruthLevel {
    fn from(choice: TruthChoice) -> Self {
        match choice {
            TruthChoice::Full => Self::Full,
            TruthChoice::None => Self::None,
        }
    }
}

#[cfg(test)]
mod tests;
