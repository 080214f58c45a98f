//! The command line: its options, its help and its errors.
//!
//! Every mistake gets one line that names the option, the value and the accepted values ([`CliError`]),
//! and exit code [`BAD_INPUT`]. The command line does not check the names of scenes and strategies: the code
//! that looks them up does, and offers the [`nearest`] known ones.

mod advise;
mod camera;
mod cdi;
mod compare;
mod effect;
mod error;
mod explain;
mod explain_command;
mod fit_ltc;
mod fold;
mod headings;
mod layers;
mod modes;
mod motion;
mod named;
mod names;
mod parse;
mod report;
mod soak;
mod stage;
mod strategies;
mod study;
mod truth;
mod values;
mod vpl;

use clap::{CommandFactory, Parser, Subcommand, ValueEnum};

pub use advise::AdviseArgs;
pub use camera::{Camera, CameraPose};
pub use cdi::CdiArgs;
pub use compare::{CompareArgs, PicturesChoice, SourceChoice};
pub use error::{BAD_INPUT, CliError};
pub use explain::{ExplainArgs, Pixel};
pub use explain_command::{Explained, explain_words};
pub use fit_ltc::FitLtcArgs;
pub use layers::LayerArgs;
pub use modes::Modes;
pub use motion::{MotionArgs, MotionChoice, MovedBy};
pub use named::name_of;
pub use names::{did_you_mean, nearest};
pub use parse::{parse, parse_stored};
pub use report::ReportArgs;
pub use soak::{SOAK_SCENE, SoakArgs};
pub use stage::{LightBox, StageArgs};
pub use strategies::ALL;
pub use study::{Shard, StudyArgs};
pub use truth::TruthArgs;
pub(crate) use values::MAX_CHECKS;
pub use values::{DirectionCounts, FarPlane, MAX_LIGHTS, Size, Sizes, Span, Strategies};
pub use vpl::{BuildChoice, DeepArgs, RangeChoice, VplArgs};

const ABOUT: &str = "Compare ways of assigning many lights to pixels";

const LONG_ABOUT: &str = "\
Compare ways of assigning many lights to pixels.

Draws one scene with each strategy through the same pipeline, so that only the light lists differ. The \
reference, None, evaluates every light at every sample. Others skip a light early where it adds \
nothing, unless their id says no-exit; Sphere is None with this skip. The program times every pass, compares every list and every \
image with no culling, and writes a report: DIR/index.html to read, DIR/results.json to compute with.";

const EXAMPLES: &str = "\
Examples:
  lightbench
      The embedded atrium with 1,000 lights: no culling, the early exit, dense and sparse clusters.
  lightbench --scene Sponza.gltf --lights 10000 --size 1920x1080 --mode both
      Your scene with its own lights and 10,000 more, deferred and forward.
  lightbench --strategies None,DC-I/128x128x64,DC-I/64x64x24,DC-I/32x32x32 --frames 32
      One strategy with three settings. `lightbench list strategies` names all strategies.

How to read the result:
  rank           1 is the fastest strategy that loses nothing; strategies that tie share a rank
  both ms        time of assigning and shading together: compare strategies by this column
  span ms        the same with the gaps between passes; unknown on a software adapter
  listed         mean number of lights in the list that a pixel reads
  contributing   mean number of lights that reach a pixel: the length of a perfect list
  missed         (light, pixel) pairs missing from the lists: above 0 the image is wrong
  max diff       largest difference to the image of no culling: 0 means identical in every bit;
                 only light volumes may differ, by a stated tolerance
  memory         GPU memory that assignment needs, MiB
  overflow       groups whose list did not fit; they use all lights, which is slow and correct

Times on a software adapter are wall-clock times of a CPU, not times of a GPU.
Exit codes: 0 done, 1 failed, 2 bad input.";

const MORE: &str = "--help shows all options. `lightbench help COMMAND` explains a command.";

/// The end of the short help of a command that hides options from it.
const MORE_OPTIONS: &str = "--help shows all options.";

/// What `lightbench` is asked to do.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "the program makes only one value")]
pub enum Invocation {
    /// Compare strategies.
    Compare(CompareArgs),
    /// Run a study, or continue it.
    Study(StudyArgs),
    /// Write a report again, or join the shards of a study.
    Report(ReportArgs),
    /// Explain a pixel.
    Explain(ExplainArgs),
    /// Search for the best strategy and parameters.
    Advise(AdviseArgs),
    /// Fit linearly transformed cosines to the BRDF.
    FitLtc(FitLtcArgs),
    /// Draw random frames and check each.
    Soak(SoakArgs),
    /// Render what a view should look like.
    Truth(TruthArgs),
    /// Build deep images and cast rays through them.
    Cdi(CdiArgs),
    /// List names for the command line.
    List(Listing),
    /// Print this text (help or version) and exit with code 0.
    Show(String),
}

#[derive(Parser)]
#[command(
    name = "lightbench",
    version,
    about = ABOUT,
    long_about = LONG_ABOUT,
    after_help = MORE,
    after_long_help = EXAMPLES,
    args_conflicts_with_subcommands = true,
    max_term_width = 100,
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    compare: CompareArgs,
}

/// The definition of the command line.
fn definition() -> clap::Command {
    fold::fold(Cli::command())
}

#[derive(Subcommand)]
#[allow(clippy::large_enum_variant, reason = "the program makes only one value")]
enum Command {
    /// Compare strategies on one scene (the default command)
    #[command(long_about = LONG_ABOUT, after_help = MORE_OPTIONS, after_long_help = EXAMPLES)]
    Compare(CompareArgs),
    /// Explain one pixel: its list, what each light adds, and lights that the list misses
    #[command(after_help = MORE_OPTIONS, after_long_help = "")]
    Explain(ExplainArgs),
    /// Find the strategy and parameters to use for a scene on this GPU
    #[command(after_help = MORE_OPTIONS, after_long_help = "")]
    Advise(AdviseArgs),
    /// Run a study on this GPU, or continue an interrupted one
    ///
    /// A study is a set of comparisons with their charts and findings.
    #[command(after_help = MORE_OPTIONS, after_long_help = "")]
    Study(StudyArgs),
    /// Write the report of a comparison or a study again
    ///
    /// Recomputes the metrics. The folders of the shards of one study make one report.
    Report(ReportArgs),
    /// Render on the CPU what a view should look like
    ///
    /// Options add shadows and bounces.
    #[command(after_help = MORE_OPTIONS, after_long_help = "")]
    Truth(TruthArgs),
    /// Build the deep images of a scene, and compare rays through them with exact rays
    #[command(after_help = MORE_OPTIONS, after_long_help = "")]
    Cdi(CdiArgs),
    /// Draw many random frames, and check the lists and the image of each
    Soak(SoakArgs),
    /// Fit linearly transformed cosines to the BRDF, and compare them with those in use
    FitLtc(FitLtcArgs),
    /// List the names of strategies, engines, scenes, scenarios, adapters or studies
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
    /// Every engine whose default is known, for --strategies engine:NAME
    Engines,
    /// Every scene that needs no file
    Scenes,
    /// Every scene in which methods fail, for --scene stability:NAME
    Scenarios,
    /// Every adapter that wgpu can drive; the first is the default
    Adapters,
    /// Every study, and what it answers
    Studies,
}

#[cfg(test)]
mod help_tests;
#[cfg(test)]
mod tests;
