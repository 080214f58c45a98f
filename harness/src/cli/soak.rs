//! The options of `soak`.

use clap::Args;

use super::values;

/// The scene of a soak that names none.
pub const SOAK_SCENE: &str = "town-small";

/// The options of `lightbench soak`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct SoakArgs {
    /// Frames to draw, 1 to 1,000,000
    #[arg(long, value_name = "N", default_value = "500", allow_hyphen_values = true, value_parser = values::whole_from(1, 1_000_000))]
    pub frames: u32,

    /// Seed of everything that is random
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed)]
    pub seed: u64,

    /// First frame, to reproduce a finding: the round of this frame is drawn from its start
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::whole_from(0, 1_000_000))]
    pub from: u32,

    /// Scene to draw: a name from `lightbench list scenes`, or a .gltf or .glb file
    #[arg(long, value_name = "NAME|FILE", default_value = SOAK_SCENE, value_parser = values::text)]
    pub scene: String,

    /// GPU to use, by any part of its name
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,
}
