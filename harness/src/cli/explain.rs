//! The options of `explain`.

use std::str::FromStr;

use assign::MAX_SPECULAR_REACH;
use clap::Args;
use shading::{AreaModel, Cut, Mode, ShadowModel};

use super::{
    compare::CUTS,
    headings::{BOUNCE, SHADING},
    layers::LayerArgs,
    modes::MODES,
    named::named,
    stage::StageArgs,
    values::{self, Strategies},
};
use crate::strategy::default_ids;

/// The options of `lightbench explain`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct ExplainArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Strategies to explain, separated by commas; each is compared with None
    #[arg(long, display_order = 6, value_name = "A,B,C", default_value = default_ids())]
    pub strategies: Strategies,

    /// Pixel to explain: X from the left and Y from the top, both from 0
    #[arg(long, display_order = 7, value_name = "X,Y", allow_hyphen_values = true)]
    pub pixel: Pixel,

    /// How pixels are lit
    #[arg(long, display_order = 8, value_name = "MODE", default_value = "deferred", value_parser = named(MODES, Mode::name))]
    pub mode: Mode,

    /// Take --frame from the scene's camera path, as `compare --path` does
    #[arg(long, display_order = 9, conflicts_with = "camera")]
    pub path: bool,

    /// With --path, frames of the whole path, 1 to 100,000 [default: 1,200, or 60 on a software adapter]
    #[arg(long, display_order = 10, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(1, values::MAX_FRAMES))]
    pub frames: Option<u32>,

    /// With --path or --motion, the frame to explain, from 0 [default: the still view in which `compare`
    /// checks lists]
    #[arg(long, display_order = 11, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(0, values::MAX_FRAMES - 1))]
    pub frame: Option<u32>,

    /// Show every light, and not only the brightest
    #[arg(long, display_order = 12)]
    pub all: bool,

    /// Print JSON
    #[arg(long, display_order = 13)]
    pub json: bool,

    /// GPU to use, by any part of its name
    #[arg(long, display_order = 14, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// What is drawn over the opaque surfaces.
    #[command(flatten)]
    pub layers: LayerArgs,

    /// How to integrate the light of area lights, as for `compare` [default: ltc]
    #[arg(long, value_name = "MODEL", value_parser = values::area_model, help_heading = SHADING, hide_short_help = true)]
    pub area_model: Option<AreaModel>,

    /// Light by a point each area light that looks smaller than X steradians, as for `compare`
    #[arg(long, value_name = "X", value_parser = values::number_from(1e-9, 6.0), allow_hyphen_values = true, help_heading = SHADING, hide_short_help = true)]
    pub area_lod: Option<f64>,

    /// How fall-off ends at a light's range
    #[arg(long, value_name = "HOW", default_value = "windowed", value_parser = named(CUTS, Cut::name), help_heading = SHADING, hide_short_help = true)]
    pub cut: Cut,

    /// Let specular terms reach up to N of their lights' ranges, as for `compare`
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::number_from(1.0, MAX_SPECULAR_REACH.into()), help_heading = SHADING, hide_short_help = true, conflicts_with = "compensate")]
    pub specular_reach: Option<f64>,

    /// How lights are shadowed, as for `compare`
    #[arg(long, value_name = "none|maps:N,PX[,pcfK|,pcssK|,paraboloid]|adaptive:PX,DOWN,MOST|cdi:N", default_value = "none", value_parser = values::shadow_model, help_heading = SHADING, hide_short_help = true)]
    pub shadows: ShadowModel,

    /// Even out the brightness of virtual point lights, as for `compare`
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::number_from(1.0, 1e9), help_heading = BOUNCE, hide_short_help = true)]
    pub compensate: Option<f64>,
}

/// A pixel of the image: `320,180`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Pixels from the left edge.
    pub x: u32,
    /// Pixels from the top edge.
    pub y: u32,
}

impl FromStr for Pixel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<u32>().ok();
        text.split_once(',')
            .and_then(|(x, y)| Some(Self { x: number(x)?, y: number(y)? }))
            .ok_or_else(|| {
                "X,Y: two whole numbers of pixels, from the upper left corner".to_owned()
            })
    }
}

impl std::fmt::Display for Pixel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{}", self.x, self.y)
    }
}
