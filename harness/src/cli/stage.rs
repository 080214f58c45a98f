//! The options that decide what is drawn: scene, lights and camera.

use assign::LightOrder;
use clap::{Args, ValueEnum};
use scenes::{Outlines, Radii};

use super::{
    camera::Camera,
    headings::{RANGES, SCATTERED, SCENE},
    motion::MotionArgs,
    named::named,
    values::{self, FarPlane, Size},
    vpl::VplArgs,
};

/// What is drawn: the options that comparisons and truth images share.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct StageArgs {
    /// Scene to draw: a name from `lightbench list scenes`, or a .gltf or .glb file
    #[arg(long, display_order = 1, value_name = "NAME|FILE", default_value = "atrium", value_parser = values::text)]
    pub scene: String,

    /// Lights to scatter besides the scene's own; 0 to 16,777,216 [default: 1000; a scenario: 0]
    #[arg(long, display_order = 2, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(0, values::MAX_LIGHTS))]
    pub lights: Option<u32>,

    /// Add the lights of another .gltf or .glb file
    #[arg(long, display_order = 3, value_name = "FILE", value_parser = values::text)]
    pub lights_from: Option<String>,

    /// Image size in pixels, each side 1 to 16,384
    #[arg(
        long,
        display_order = 4,
        value_name = "WxH",
        default_value = "640x360",
        allow_hyphen_values = true
    )]
    pub size: Size,

    /// Camera position and a point that it looks at, in metres; or a camera of the scene
    ///
    /// X,Y,Z:X,Y,Z is the position and the point that the camera looks at. path:F/N is frame F of N along the
    /// scene's path. NAME or #N is a camera of the scene's file, by its name or its number from 0. [default:
    /// the file's first camera, else the start of the scene's path]
    #[arg(long, display_order = 5, value_name = "POSE", allow_hyphen_values = true)]
    pub camera: Option<Camera>,

    /// Factor on the size of the scene and of its own lights, not of scattered ones; 1e-6 to 1e6
    #[arg(long, value_name = "X", default_value = "1", allow_hyphen_values = true, value_parser = values::scale, help_heading = SCENE, hide_short_help = true)]
    pub scene_scale: f64,

    /// Give all surfaces this roughness, 0 to 1, and no metal
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = values::number_from(0.0, 1.0), help_heading = SCENE, hide_short_help = true)]
    pub roughness: Option<f64>,

    /// Draw N x N copies of the scene side by side, with all their lights; 1 to 64
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::whole_from(1, 64), help_heading = SCENE, hide_short_help = true)]
    pub replicate: u32,

    /// View depth of the near plane in metres, 1e-6 to 1e6
    ///
    /// [default: that of the file's camera; else 1/500 of the size of the scene, or half the depth of the
    /// nearest visible surface where the near plane would cut it away]
    #[arg(long, value_name = "METRES", allow_hyphen_values = true, value_parser = values::scale, help_heading = SCENE, hide_short_help = true)]
    pub near: Option<f64>,

    /// View depth of the far plane in metres, 1e-6 to 1e9, or infinite
    ///
    /// [default: that of the file's camera, else just beyond the scene's bounds]
    #[arg(long, value_name = "METRES|infinite", allow_hyphen_values = true, help_heading = SCENE, hide_short_help = true)]
    pub far: Option<FarPlane>,

    /// Leave out the scene's own lights
    #[arg(long, help_heading = SCENE, hide_short_help = true)]
    pub no_own_lights: bool,

    /// Seed of the scattered lights and particles, and of a scenario
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed, help_heading = SCATTERED, hide_short_help = true)]
    pub seed: u64,

    /// Where to scatter lights
    #[arg(long, value_name = "BOX", default_value = "core", help_heading = SCATTERED, hide_short_help = true)]
    pub light_box: LightBox,

    /// Share of spots among the scattered lights, 0 to 1
    #[arg(long, value_name = "SHARE", default_value = "0", allow_hyphen_values = true, value_parser = values::share, help_heading = SCATTERED, hide_short_help = true)]
    pub spots: f64,

    /// Share of area lights among scattered lights, 0 to 1; with --spots at most 1
    #[arg(long, value_name = "SHARE", default_value = "0", allow_hyphen_values = true, value_parser = values::share, help_heading = SCATTERED, hide_short_help = true)]
    pub areas: f64,

    /// Outlines of the scattered area lights
    ///
    /// both is half rectangles, half polygons of 3 to 10 vertices; all is a fifth of each. Lines are tubes, 10 to 50 times as long as wide.
    #[arg(long, value_name = "WHICH", default_value = "both", value_parser = named(OUTLINES, Outlines::name), help_heading = SCATTERED, hide_short_help = true)]
    pub outlines: Outlines,

    /// Diffuse / specular range of scattered area lights, above 0 and at most 1
    #[arg(long, value_name = "SHARE", default_value = "1", allow_hyphen_values = true, value_parser = values::part, help_heading = SCATTERED, hide_short_help = true)]
    pub diffuse_share: f64,

    /// Factor on the radii of scattered lights, 1e-6 to 1e6
    ///
    /// At 1 their mean is one metre. [default: 1 in a scene of 10 to 60 m, smaller or larger in proportion
    /// in other scenes]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::scale, help_heading = SCATTERED, hide_short_help = true)]
    pub radius_scale: Option<f64>,

    /// Distribution of the radii of scattered lights, each of mean one metre
    #[arg(long, value_name = "NAME", default_value = "gamma", value_parser = named(RADII, Radii::name), help_heading = SCATTERED, hide_short_help = true)]
    pub radii: Radii,

    /// End every light at the distance where intensity / distance^2 falls to X (candela / m^2 = lux); 1e-9
    /// to 1e9
    ///
    /// [default: every light keeps its range. Scattered lights have the range of X = 0.02. A light without a
    /// range in its file gets the range of X = 0.02 or of a smaller X, so that dim lights stay visible]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::threshold, help_heading = RANGES, hide_short_help = true)]
    pub threshold: Option<f64>,

    /// Give area lights the range of Swarbrick 2025 (listing 4.1) from irradiance X; 1e-9 to 1e9
    ///
    /// The diffuse light ends where 4.4 times the flux, spread over a hemisphere, falls to X.
    #[arg(long, value_name = "X", allow_hyphen_values = true, conflicts_with = "threshold", value_parser = values::threshold, help_heading = RANGES, hide_short_help = true)]
    pub influence: Option<f64>,

    /// Order of the lights in their buffer: given, morton, bvh, gpu, gpuN or gpuN%
    ///
    /// All strategies use the same order. given keeps the order of the scene. morton follows a space-filling
    /// curve. bvh is the order of the leaves of a hierarchy. These three are made by the CPU, off the clock
    /// if the lights stand still. gpu is made by the GPU in every frame, on the clock; gpuN in every Nth
    /// frame; gpuN% as soon as boxes may have grown by N percent. With gpu, --vpls makes its lights in every
    /// frame, with the others once. [default: bvh, gpu8 with --motion, gpu with --vpls]
    #[arg(long, value_name = "ORDER", value_parser = values::light_order, help_heading = RANGES, hide_short_help = true)]
    pub light_order: Option<LightOrder>,

    /// Lights that move.
    #[command(flatten)]
    pub motion: MotionArgs,

    /// Indirect light.
    #[command(flatten)]
    pub bounce: VplArgs,
}

/// Frames between two sorts of lights that move, unless the command line gives a number: boxes grow little
/// in so few frames.
const SORTED_EVERY: u32 = 8;

/// Lights that are scattered in a scene, unless the command line gives a number.
const SCATTERED_LIGHTS: u32 = 1_000;

impl StageArgs {
    /// The number of lights to scatter. A stability scenario brings all of its lights.
    pub fn scattered(&self) -> u32 {
        let is_scenario = self.scene.starts_with(scenes::stability::PREFIX);
        self.lights.unwrap_or(if is_scenario { 0 } else { SCATTERED_LIGHTS })
    }

    /// The order of the lights.
    pub fn light_order(&self) -> LightOrder {
        self.light_order.unwrap_or(match self.motion.motion {
            Some(_) => LightOrder::Gpu { every: SORTED_EVERY },
            None if self.bounce.vpls > 0 => LightOrder::Gpu { every: 1 },
            None => LightOrder::Bvh,
        })
    }
}

/// Where lights are scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LightBox {
    /// The box around the scene without its far-off parts
    Core,
    /// The box around everything in the scene
    Bounds,
    /// Seven upright cylinders in the core box
    Cylinders,
}

const OUTLINES: [(Outlines, &str); 7] = [
    (Outlines::Both, ""),
    (Outlines::Rectangles, ""),
    (Outlines::Polygons, ""),
    (Outlines::Discs, ""),
    (Outlines::Spheres, ""),
    (Outlines::Lines, ""),
    (Outlines::All, ""),
];

const RADII: [(Radii, &str); 3] = [
    (Radii::Gamma, "Gamma distribution of mode 0.25, as in the comparison paper"),
    (Radii::Equal, "All equal"),
    (Radii::LogNormal, "Log-normal: many small radii and a few very large ones"),
];
