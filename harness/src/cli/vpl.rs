//! The options of one bounce of indirect light: virtual point lights, their ranges, and the deep images
//! that find these ranges.

use assign_cdi::{Primary, Spread};
use clap::{Args, ValueEnum};

use super::{
    headings::{BOUNCE, DEEP},
    named::named,
    values::{self, DirectionCounts, Span},
};

/// The lights of one bounce, in place of scattered lights and the scene's own.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct VplArgs {
    /// Light the scene only by its primary light: its brightest sun, else spot, else a new sun
    #[arg(long, conflicts_with_all = ["lights", "lights_from", "spots", "areas", "threshold"], help_heading = BOUNCE, hide_short_help = true)]
    pub primary: bool,

    /// Light the scene only by what its surfaces reflect of its primary light
    ///
    /// A reflective shadow map of N x N pixels, 16 to 2,048, gives the virtual point lights. 0 makes none.
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::rsm, conflicts_with_all = ["primary", "lights", "lights_from", "spots", "areas", "threshold"], help_heading = BOUNCE, hide_short_help = true)]
    pub vpls: u32,

    /// How to choose the ranges of virtual point lights
    #[arg(long, value_name = "RULE", default_value = "average", requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub ranges: RangeChoice,

    /// Smallest and largest random range, metres [default: 0 and 1/4 of the diagonal of the scene's core]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub random_ranges: Option<Span>,

    /// Range for --ranges constant-discard, metres [default: 1/8 of the diagonal of the scene's core]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub constant_range: Option<f64>,

    /// Rays that find the range of one virtual point light, 1 to 16
    ///
    /// The first is the primary ray; the others surround it.
    #[arg(long, value_name = "N", default_value = "6", allow_hyphen_values = true, value_parser = values::whole_from(1, 16), requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub rays: u32,

    /// Direction of the primary ray
    #[arg(long, value_name = "WHERE", default_value = "normal", requires = "vpls", value_parser = named(PRIMARY_RAYS, Primary::name), help_heading = BOUNCE, hide_short_help = true)]
    pub primary_ray: Primary,

    /// Correct each ray by a second look-up: closer to exact rays, and slower
    #[arg(long, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub correct_rays: bool,

    /// Factor on the ranges that rays found, 0.1 to 100
    ///
    /// A factor above 1 makes up for the fall-off, which fades a light out before its range ends.
    #[arg(long, value_name = "X", default_value = "2", allow_hyphen_values = true, value_parser = values::number_from(0.1, 100.0), requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub range_scale: f64,

    /// Keep only virtual point lights whose range lies between these two, metres
    ///
    /// [default: all whose rays meet a surface, up to the size of the scene]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub keep_ranges: Option<Span>,

    /// Merge pixels of the shadow map into blocks that are at most this wide on their surface, metres
    ///
    /// 0 keeps every pixel.
    #[arg(long, value_name = "METRES", default_value = "0", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub vpl_spacing: f64,

    /// Distance below which a virtual point light gets no brighter, metres
    ///
    /// [default: 1/100 of the diagonal of the scene's core]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls", help_heading = BOUNCE, hide_short_help = true)]
    pub vpl_clamp: Option<f64>,

    /// What the deep images are like.
    #[command(flatten)]
    pub deep: DeepArgs,
}

impl VplArgs {
    /// Whether the scene is lit by its primary light, or by what surfaces reflect of it.
    pub fn is_on(&self) -> bool {
        self.primary || self.vpls > 0
    }
}

/// The deep images: of ranges, and of rays that find shadows.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct DeepArgs {
    /// Directions, stacks x slices, each 1 to 64 [default: 13x13, or 8x8 for shadows]
    #[arg(long, value_name = "SxS", allow_hyphen_values = true, help_heading = DEEP, hide_short_help = true)]
    pub directions: Option<DirectionCounts>,

    /// How to spread the directions over the hemisphere [default: stacks, or squares for shadows]
    #[arg(long, value_name = "HOW", value_parser = named(SPREADS, Spread::name), help_heading = DEEP, hide_short_help = true)]
    pub spread: Option<Spread>,

    /// Pixels along a side of each deep image, 4 to 1,024 [default: 64, or 512 for shadows]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(4, 1024), help_heading = DEEP, hide_short_help = true)]
    pub deep_size: Option<u32>,

    /// Surface samples along a side of a pixel of deep images, 1 (the paper's) to 8
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::whole_from(1, 8), help_heading = DEEP, hide_short_help = true)]
    pub oversampling: u32,

    /// How to build the deep images [default: compute, or per-direction-batched for shadows]
    #[arg(long, value_name = "HOW", help_heading = DEEP, hide_short_help = true)]
    pub build: Option<BuildChoice>,
}

const PRIMARY_RAYS: [(Primary, &str); 2] = [
    (Primary::Normal, "Along the surface's normal"),
    (Primary::Reflected, "As a mirror would reflect the primary light"),
];

const SPREADS: [(Spread, &str); 2] = [
    (Spread::StacksAndSlices, "Stacks of equal solid angle, each cut into slices, as in the paper"),
    (Spread::Squares, "A square grid, mapped with equal areas: cells are as wide as high"),
];

/// How far a virtual point light reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RangeChoice {
    /// Mean distance of the surfaces that the light's rays meet; no light where they meet nothing
    Average,
    /// Distance of the farthest of these surfaces; no light where the rays meet nothing
    Maximum,
    /// A random number
    Random,
    /// A random number; no light where the rays meet nothing
    RandomDiscard,
    /// One number for all; no light where the rays meet nothing
    ConstantDiscard,
    /// Beyond all surfaces
    Infinite,
}

impl RangeChoice {
    /// Whether rays are cast through deep images.
    pub fn casts(self) -> bool {
        !matches!(self, Self::Random | Self::Infinite)
    }

    /// Whether ranges come from the lengths of rays. Other rules that cast rays use them only to leave
    /// lights out.
    pub fn measures(self) -> bool {
        matches!(self, Self::Average | Self::Maximum)
    }

    /// Whether ranges are drawn between two bounds.
    pub fn draws(self) -> bool {
        matches!(self, Self::Random | Self::RandomDiscard)
    }
}

/// How deep images are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BuildChoice {
    /// One compute pass over the triangles
    Compute,
    /// One pass over the triangles, by the rasteriser
    Fragment,
    /// One dispatch over all triangles per direction, one after another
    PerDirection,
    /// As per-direction, with all directions in one dispatch
    PerDirectionBatched,
    /// One compute pass that links the fragments of a pixel into a list and leaves them unsorted
    LinkedLists,
    /// One dispatch that samples every pixel that a triangle touches
    Conservative,
}
