//! The options of `truth`.

use std::path::PathBuf;

use clap::Args;
use shading::traced::MAX_BOUNCES;

use super::{stage::StageArgs, values};

/// The options of `lightbench truth`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct TruthArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Let surfaces cast shadows
    #[arg(long, display_order = 6)]
    pub shadows: bool,

    /// With --shadows: multiply the light of each light without shadows by the share of it that a surface sees
    ///
    /// The exact form of what shadow maps approximate. Its distance to the image without this option is the error
    /// of separating shadows from shading.
    #[arg(long, display_order = 7, requires = "shadows", conflicts_with = "indirect")]
    pub separated: bool,

    /// Surfaces that light may meet before it meets the visible one, 0 to 16
    ///
    /// From 1 on, surfaces that emit light also light other surfaces.
    #[arg(long, display_order = 7, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::whole_from(0, MAX_BOUNCES))]
    pub bounces: u32,

    /// Leave out the light that comes straight from lights
    #[arg(long, display_order = 8)]
    pub indirect: bool,

    /// With --primary and --bounces 1: surfaces reflect the bounced light only diffusely, as virtual point lights do
    #[arg(long, display_order = 9)]
    pub matte_bounces: bool,

    /// Samples per pixel for shadows and bounces, 1 to 65,536
    #[arg(long, display_order = 10, value_name = "N", default_value = "64", allow_hyphen_values = true, value_parser = values::whole_from(1, 65_536))]
    pub samples: u32,

    /// Seed of the samples [default: --seed]
    ///
    /// Images of different seeds have independent noise.
    #[arg(long, display_order = 11, value_name = "N", allow_hyphen_values = true, value_parser = values::seed)]
    pub sample_seed: Option<u64>,

    /// Also compare the image with another truth image of the same size: an EXR file
    #[arg(long, display_order = 12, value_name = "FILE")]
    pub against: Option<PathBuf>,

    /// GPU to use, by any part of its name
    #[arg(long, display_order = 12, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for truth.exr, truth.png, error.exr, error.png and results.json
    #[arg(long, display_order = 13, value_name = "DIR", default_value = "out/truth")]
    pub out: PathBuf,
}
