//! The options of `cdi`.

use std::path::PathBuf;

use clap::Args;

use super::{
    values::{self, Sizes},
    vpl::DeepArgs,
};

/// The options of `lightbench cdi`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct CdiArgs {
    /// A scene's name (see `lightbench list scenes`) or a .gltf or .glb file
    #[arg(long, value_name = "NAME|FILE", default_value = "atrium", value_parser = values::text)]
    pub scene: String,

    /// Factor on the scene's size, 1e-6 to 1e6
    #[arg(long, value_name = "X", default_value = "1", allow_hyphen_values = true, value_parser = values::scale)]
    pub scene_scale: f64,

    /// What the deep images are like.
    #[command(flatten)]
    pub deep: DeepArgs,

    /// Sides of reflective shadow maps to cast from, a virtual point light a pixel; none casts nothing
    #[arg(long, value_name = "N,N", default_value = "256", allow_hyphen_values = true)]
    pub casts: Sizes,

    /// Rays of each virtual point light, 1 to 16
    #[arg(long, value_name = "N", default_value = "6", allow_hyphen_values = true, value_parser = values::rays)]
    pub rays: u32,

    /// Rays to compare with exact ones, up to 1,048,576; 0 compares none
    #[arg(long, value_name = "N", default_value = "20000", allow_hyphen_values = true, value_parser = values::compared_rays)]
    pub compared: u32,

    /// Builds to time, 1 to 100,000 [default: 64, or 3 on a software adapter]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::frames)]
    pub frames: Option<u32>,

    /// Seed of the rays that are compared
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed)]
    pub seed: u64,

    /// Part of the adapter's name, where there are several
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for results.json
    #[arg(long, value_name = "DIR", default_value = "out/cdi")]
    pub out: PathBuf,
}
