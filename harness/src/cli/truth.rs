//! The options of `truth`.

use std::path::PathBuf;

use clap::Args;

use super::{stage::StageArgs, values};

/// The options of `lightbench truth`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct TruthArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Let surfaces cast shadows
    #[arg(long)]
    pub shadows: bool,

    /// Surfaces that light may meet before the one that is seen, 0 to 16. From 1 on, surfaces that emit
    /// light others
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::bounces)]
    pub bounces: u32,

    /// Leave out light that comes straight from lights
    #[arg(long)]
    pub indirect: bool,

    /// With --primary and --bounces 1: surfaces that light bounces off reflect as virtual point lights
    /// emit, diffusely
    #[arg(long)]
    pub matte_bounces: bool,

    /// Samples of each pixel where they are drawn, of shadows and of bounces, 1 to 65,536
    #[arg(long, value_name = "N", default_value = "64", allow_hyphen_values = true, value_parser = values::samples)]
    pub samples: u32,

    /// Seed of the samples: images of different seeds have independent noise [default: that of --seed]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::seed)]
    pub sample_seed: Option<u64>,

    /// Part of the adapter's name, where there are several
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for truth.exr, truth.png, error.exr, error.png and results.json
    #[arg(long, value_name = "DIR", default_value = "out/truth")]
    pub out: PathBuf,
}
