//! The options that decide what is drawn: scene, lights and camera.

use assign::LightOrder;
use clap::{Args, ValueEnum};
use scenes::{Outlines, Radii};

use super::{
    camera::Camera,
    values::{self, FarPlane, Size},
    vpl::VplArgs,
};

/// What is drawn: the options that comparisons and truth images share.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct StageArgs {
    /// A scene's name (see `lightbench list scenes`) or a .gltf or .glb file
    #[arg(long, value_name = "NAME|FILE", default_value = "atrium", value_parser = values::text)]
    pub scene: String,

    /// Factor on the scene's size and its own lights, 1e-6 to 1e6; scattered lights keep theirs
    #[arg(long, value_name = "X", default_value = "1", allow_hyphen_values = true, value_parser = values::scale)]
    pub scene_scale: f64,

    /// Draw the scene N x N times beside itself, with its lights and those scattered in it, 1 to 64
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::copies)]
    pub replicate: u32,

    /// Lights to scatter in addition to the scene's own, 0 to 16,777,216
    #[arg(long, value_name = "N", default_value = "1000", allow_hyphen_values = true, value_parser = values::lights)]
    pub lights: u32,

    /// Add the lights that another .gltf or .glb file holds
    #[arg(long, value_name = "FILE", value_parser = values::text)]
    pub lights_from: Option<String>,

    /// Leave out the lights that the scene's file holds
    #[arg(long)]
    pub no_own_lights: bool,

    /// Where lights are scattered
    #[arg(long, value_name = "BOX", default_value = "core")]
    pub light_box: LightBox,

    /// Factor on the radii of scattered lights, 1e-6 to 1e6; at 1 their mean is one metre
    /// [default: 1 in a scene of 10 to 60 m, smaller and larger in proportion]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::scale)]
    pub radius_scale: Option<f64>,

    /// Distribution of the radii of scattered lights, of mean one metre each
    #[arg(long, value_name = "NAME", default_value = "gamma")]
    pub radii: RadiiChoice,

    /// Share of spots among the scattered lights, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0", allow_hyphen_values = true, value_parser = values::share)]
    pub spots: f64,

    /// Share of area lights among the scattered lights, 0 to 1, with that of spots at most 1
    #[arg(long, value_name = "SHARE", default_value = "0", allow_hyphen_values = true, value_parser = values::share)]
    pub areas: f64,

    /// Outlines of the scattered area lights
    #[arg(long, value_name = "WHICH", default_value = "both")]
    pub outlines: OutlinesChoice,

    /// Where the diffuse light of scattered area lights ends, as a share of the range of their
    /// specular light, above 0 and at most 1
    #[arg(long, value_name = "SHARE", default_value = "1", allow_hyphen_values = true, value_parser = values::part)]
    pub diffuse_share: f64,

    /// End every light where its intensity over squared distance (candela over square metres: lux) falls
    /// to this, 1e-9 to 1e9 [default: ranges as they are; scattered lights have 0.02, lights whose
    /// file gives no range 0.02 or less, so that dim ones are seen]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::threshold)]
    pub threshold: Option<f64>,

    /// Give every area light the range of Swarbrick 2025 (listing 4.1): where its flux, times 4.4 and spread
    /// over a hemisphere, falls to this irradiance, its diffuse light ends, 1e-9 to 1e9
    #[arg(long, value_name = "X", allow_hyphen_values = true, conflicts_with = "threshold", value_parser = values::threshold)]
    pub influence: Option<f64>,

    /// Order of the lights in their buffer, for all methods alike: given (as they come), morton (along a
    /// space-filling curve) or bvh (as the leaves of a hierarchy)
    #[arg(long, value_name = "ORDER", default_value = "bvh", value_parser = values::light_order)]
    pub light_order: LightOrder,

    /// Image size in pixels, each side 1 to 16,384
    #[arg(long, value_name = "WxH", default_value = "640x360", allow_hyphen_values = true)]
    pub size: Size,

    /// Where the camera is and a point that it looks at, in metres; or path:F/N for frame F of N along
    /// the scene's path; or a camera of the scene's file by its name, or by its place among them as
    /// '#0', '#1', ...
    /// [default: the file's first camera, else the start of the scene's path]
    #[arg(long, value_name = "X,Y,Z:X,Y,Z|path:F/N|NAME|#N", allow_hyphen_values = true)]
    pub camera: Option<Camera>,

    /// View depth of the near plane in metres, 1e-6 to 1e6
    /// [default: that of the file's camera, else a 500th of the size of the scene, or half the depth
    /// of the nearest surface in view where that would be cut away]
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = values::scale)]
    pub near: Option<f64>,

    /// View depth of the far plane in metres, 1e-6 to 1e9, or infinite
    /// [default: that of the file's camera, else just beyond the scene's bounds]
    #[arg(long, value_name = "M|infinite", allow_hyphen_values = true)]
    pub far: Option<FarPlane>,

    /// Seed of the scattered lights
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed)]
    pub seed: u64,

    /// Indirect light.
    #[command(flatten)]
    pub bounce: VplArgs,
}

/// Where lights are scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LightBox {
    /// The box of the scene without far-off parts
    Core,
    /// The box of everything in the scene
    Bounds,
    /// Seven upright cylinders in the box of the scene without far-off parts
    Cylinders,
}

/// Outlines of scattered area lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OutlinesChoice {
    /// Half of each
    Both,
    /// Rectangles
    Rectangles,
    /// Polygons of 3 to 10 vertices
    Polygons,
}

impl From<OutlinesChoice> for Outlines {
    fn from(choice: OutlinesChoice) -> Self {
        match choice {
            OutlinesChoice::Both => Self::Both,
            OutlinesChoice::Rectangles => Self::Rectangles,
            OutlinesChoice::Polygons => Self::Polygons,
        }
    }
}

/// How the radii of scattered lights are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RadiiChoice {
    /// Gamma with mode 0.25, as in the comparison paper
    Gamma,
    /// All alike
    Equal,
    /// Many small, a few very large
    LogNormal,
}

impl From<RadiiChoice> for Radii {
    fn from(choice: RadiiChoice) -> Self {
        match choice {
            RadiiChoice::Gamma => Self::Gamma,
            RadiiChoice::Equal => Self::Equal,
            RadiiChoice::LogNormal => Self::LogNormal,
        }
    }
}
