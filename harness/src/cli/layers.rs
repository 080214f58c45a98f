//! The options of what is drawn over the opaque surfaces.

use clap::Args;
use scenes::MAX_PARTICLES;

use super::{headings::LAYERS, values};

/// Transparent surfaces, particles and fog. A strategy that serves only opaque surfaces refuses them.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub struct LayerArgs {
    /// Blend the scene's transparent surfaces (alphaMode BLEND, KHR_materials_transmission)
    #[arg(long, help_heading = LAYERS, hide_short_help = true)]
    pub transparent: bool,

    /// Scatter N particles in the scene, lit per fragment; 0 to 1,048,576
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::whole_from(0, MAX_PARTICLES), help_heading = LAYERS, hide_short_help = true)]
    pub particles: u32,

    /// Fill the view with fog that scatters light at the rate X per metre; 1e-6 to 1e3
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::number_from(1e-6, 1e3), help_heading = LAYERS, hide_short_help = true)]
    pub fog: Option<f64>,
}
