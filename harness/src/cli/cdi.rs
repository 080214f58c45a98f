//! The options of `cdi`.

use std::path::PathBuf;

use clap::Args;

use super::{
    headings::RAYS,
    values::{self, Sizes},
    vpl::DeepArgs,
};

/// The options of `lightbench cdi`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct CdiArgs {
    /// Scene: a name from `lightbench list scenes`, or a .gltf or .glb file
    #[arg(long, value_name = "NAME|FILE", default_value = "atrium", value_parser = values::text)]
    pub scene: String,

    /// Factor on the size of the scene, 1e-6 to 1e6
    #[arg(long, value_name = "X", default_value = "1", allow_hyphen_values = true, value_parser = values::scale)]
    pub scene_scale: f64,

    /// Builds to time, 1 to 100,000 [default: 64, or 3 on a software adapter]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(1, values::MAX_FRAMES))]
    pub frames: Option<u32>,

    /// GPU to use, by any part of its name
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for results.json
    #[arg(long, value_name = "DIR", default_value = "out/cdi")]
    pub out: PathBuf,

    /// What the deep images are like.
    #[command(flatten)]
    pub deep: DeepArgs,

    /// Sides of reflective shadow maps to cast rays from, 16 to 2,048 pixels, or none
    ///
    /// Each pixel of a map is one virtual point light.
    #[arg(long, value_name = "N,N", default_value = "256", allow_hyphen_values = true, help_heading = RAYS)]
    pub casts: Sizes,

    /// Rays per virtual point light, 1 to 16
    #[arg(long, value_name = "N", default_value = "6", allow_hyphen_values = true, value_parser = values::whole_from(1, 16), help_heading = RAYS)]
    pub rays: u32,

    /// Rays to compare with exact ones, 0 to 1,048,576
    #[arg(long, value_name = "N", default_value = "20000", allow_hyphen_values = true, value_parser = values::whole_from(0, 1 << 20), help_heading = RAYS)]
    pub compared: u32,

    /// Seed of the compared rays
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed, help_heading = RAYS)]
    pub seed: u64,
}
