//! The options of one bounce of indirect light: virtual point lights, how far each reaches, and the
//! deep images that tell.

use clap::{Args, ValueEnum};

use super::values::{self, DirectionCounts, Span};

/// The lights of one bounce, in place of scattered lights and the scene's own.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct VplArgs {
    /// Light the scene by its primary light alone: its brightest spot, else a sun
    #[arg(long, conflicts_with_all = ["lights", "lights_from", "spots", "areas", "threshold"])]
    pub primary: bool,

    /// Light the scene by what its surfaces reflect of its primary light: virtual point lights from a
    /// reflective shadow map of N x N pixels, 16 to 2,048; 0 is none
    #[arg(long, value_name = "N", default_value = "0", allow_hyphen_values = true, value_parser = values::rsm, conflicts_with_all = ["primary", "lights", "lights_from", "spots", "areas", "threshold"])]
    pub vpls: u32,

    /// How far a virtual point light reaches: as far as rays through the deep images say on average or
    /// at most, as random numbers or one number say, or everywhere. Average and maximum leave out lights
    /// whose rays meet nothing; random and infinite leave out none
    #[arg(long, value_name = "RULE", default_value = "average", requires = "vpls")]
    pub ranges: RangeChoice,

    /// Bounds of random ranges, metres [default: 0 to a quarter of the diagonal of the scene's core]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "vpls")]
    pub random_ranges: Option<Span>,

    /// The range of all lights where --ranges is constant-discard, metres
    /// [default: an eighth of the diagonal of the scene's core]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls")]
    pub constant_range: Option<f64>,

    /// Rays that look for the range of a virtual point light, 1 to 16: the first along the primary ray,
    /// the others around it
    #[arg(long, value_name = "N", default_value = "6", allow_hyphen_values = true, value_parser = values::rays, requires = "vpls")]
    pub rays: u32,

    /// Where the first ray goes
    #[arg(long, value_name = "WHERE", default_value = "normal", requires = "vpls")]
    pub primary_ray: PrimaryRay,

    /// Correct each ray by a second look-up: nearer to exact rays, and slower
    #[arg(long, requires = "vpls")]
    pub correct_rays: bool,

    /// Factor on the ranges that were found, 0.1 to 100: light fades out before its range
    #[arg(long, value_name = "X", default_value = "2", allow_hyphen_values = true, value_parser = values::range_scale, requires = "vpls")]
    pub range_scale: f64,

    /// Shortest and longest range of a virtual point light that is kept, metres: others are left out
    /// [default: all that reach a surface, up to the size of the scene]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "vpls")]
    pub keep_ranges: Option<Span>,

    /// Gather pixels of the shadow map into blocks while those are no wider than this on their surface,
    /// metres; 0 keeps every pixel
    #[arg(long, value_name = "X", default_value = "0", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls")]
    pub vpl_spacing: f64,

    /// Distance within which the light of a virtual point light grows no further, metres
    /// [default: a hundredth of the diagonal of the scene's core]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::metres, requires = "vpls")]
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

/// The deep images.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct DeepArgs {
    /// Directions of the deep images over the hemisphere: stacks x slices
    #[arg(long, value_name = "SxS", default_value = "13x13", allow_hyphen_values = true)]
    pub directions: DirectionCounts,

    /// How directions are spread over the hemisphere
    #[arg(long, value_name = "HOW", default_value = "stacks")]
    pub spread: SpreadChoice,

    /// Pixels along a side of each deep image, 4 to 1,024
    #[arg(long, value_name = "N", default_value = "64", allow_hyphen_values = true, value_parser = values::deep_size)]
    pub deep_size: u32,

    /// Samples of surfaces along each side of a pixel of the deep images, 1 to 8; 1 is the paper's
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::oversampling)]
    pub oversampling: u32,

    /// How the deep images are built
    #[arg(long, value_name = "HOW", default_value = "compute")]
    pub build: BuildChoice,
}

/// How directions are spread over the hemisphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SpreadChoice {
    /// Stacks of equal solid angle, each cut into slices, as in the paper
    Stacks,
    /// Cells as wide as high: a square mapped to the hemisphere with equal areas
    Squares,
}

impl SpreadChoice {
    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stacks => "stacks",
            Self::Squares => "squares",
        }
    }
}

/// How far a virtual point light reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RangeChoice {
    /// As far as the surfaces that its rays meet are on average
    Average,
    /// As far as the farthest of them
    Maximum,
    /// A random number
    Random,
    /// A random number for lights whose rays meet a surface; the others are left out, as by average
    RandomDiscard,
    /// One number for all lights whose rays meet a surface; the others are left out, as by average
    ConstantDiscard,
    /// Beyond all surfaces
    Infinite,
}

impl RangeChoice {
    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Average => "average",
            Self::Maximum => "maximum",
            Self::Random => "random",
            Self::RandomDiscard => "random-discard",
            Self::ConstantDiscard => "constant-discard",
            Self::Infinite => "infinite",
        }
    }

    /// Whether rays are cast through deep images.
    pub fn casts(self) -> bool {
        !matches!(self, Self::Random | Self::Infinite)
    }

    /// Whether ranges are the lengths of rays. Where rays are cast and this is not so, they only
    /// decide which lights are left out.
    pub fn measures(self) -> bool {
        matches!(self, Self::Average | Self::Maximum)
    }

    /// Whether ranges are drawn between two bounds.
    pub fn draws(self) -> bool {
        matches!(self, Self::Random | Self::RandomDiscard)
    }
}

/// Where the first ray of a virtual point light goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PrimaryRay {
    /// Along the surface's normal
    Normal,
    /// As a mirror would reflect the primary light
    Reflected,
}

/// How deep images are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BuildChoice {
    /// One pass over the triangles, by compute
    Compute,
    /// One pass over the triangles, by the rasteriser
    Fragment,
    /// One dispatch over the triangles for each direction, one after another
    PerDirection,
    /// Each direction visits all triangles, all of them in one dispatch
    PerDirectionBatched,
    /// One pass, into lists linked from fragment to fragment, unsorted
    LinkedLists,
    /// Every pixel that a triangle touches, by compute
    Conservative,
}

impl BuildChoice {
    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Compute => "compute",
            Self::Fragment => "fragment",
            Self::PerDirection => "per-direction",
            Self::PerDirectionBatched => "per-direction-batched",
            Self::LinkedLists => "linked-lists",
            Self::Conservative => "conservative",
        }
    }
}
