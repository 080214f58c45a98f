//! What was seen at a pixel, as `explain --json` prints it. Radiance is linear RGB, positions are in the coordinates
//! of the scene's file, metres.

use serde::Serialize;

/// A pixel explained.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// The scene.
    pub scene: String,
    /// The number of lights.
    pub lights: u64,
    /// Width and height of the image, pixels.
    pub size: [u32; 2],
    /// The mode that lit it.
    pub mode: String,
    /// The frame; `null` in the still view.
    pub frame: Option<u32>,
    /// The frames of the camera's path; `null` if the camera stands still.
    pub path_frames: Option<u32>,
    /// The pixel, from the upper left corner.
    pub pixel: [u32; 2],
    /// What it shows; `null` if it shows no surface.
    pub sample: Option<SampleSeen>,
    /// No culling first, then the strategies in the order asked.
    pub strategies: Vec<StrategySeen>,
    /// What a reader has to know, one sentence each.
    pub notes: Vec<String>,
}

/// The view sample of a pixel.
#[derive(Clone, Debug, Serialize)]
pub struct SampleSeen {
    /// Position.
    pub position_world: [f64; 3],
    /// Position in view space: x right, y up, the camera looks along -z.
    pub position_view: [f32; 3],
    /// Distance along the viewing axis, metres.
    pub depth_view_m: f32,
    /// The depth buffer's value.
    pub depth_clip: f32,
    /// Unit shading normal, world space.
    pub normal_world: [f32; 3],
    /// The surface's material.
    pub material: Material,
    /// Radiance that the surface emits.
    pub emission: [f32; 3],
    /// Radiance from all suns, which stand in no list.
    pub from_suns: [f32; 3],
    /// The number of lights that reach it, decided in f64.
    pub reached_by: usize,
}

/// The material of a surface.
#[derive(Clone, Debug, Serialize)]
pub struct Material {
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Reflectance of its dielectric share at normal incidence, linear RGB, and at grazing incidence.
    pub dielectric: [f32; 4],
}

/// One strategy at the pixel.
#[derive(Clone, Debug, Serialize)]
pub struct StrategySeen {
    /// Its id.
    pub strategy: String,
    /// Whether a setting of it loses light on purpose.
    pub is_lossy: bool,
    /// The pixel's radiance.
    pub radiance: [f32; 3],
    /// How it differs from no culling; `null` for no culling itself.
    pub difference: Option<Difference>,
    /// The groups of the sample: one, or two for a strategy that intersects two. Empty without lists and without a
    /// surface.
    pub groups: Vec<GroupSeen>,
    /// The list that the pixel reads; `null` without lists and without a surface.
    pub list: Option<ListSeen>,
}

/// The difference of a pixel from that of no culling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Channel by channel, the strategy's minus that of no culling.
    pub radiance: [f32; 3],
    /// The largest ratio of a channel's difference to its value without culling (at least 1e-6).
    pub relative: f64,
    /// Whether all bits are the same.
    pub is_same: bool,
}

/// A group of the sample.
#[derive(Clone, Debug, Serialize)]
pub struct GroupSeen {
    /// Its index; `null` outside all groups.
    pub index: Option<u32>,
    /// The number of groups.
    pub count: u32,
    /// What lights were tested against; `null` if the strategy keeps no bounds.
    pub bounds: Option<BoundsSeen>,
    /// Whether its list did not fit into the pool, so that it became the list of all lights.
    pub overflowed: bool,
}

/// The bounds of a group.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "shape", rename_all = "kebab-case")]
pub enum BoundsSeen {
    /// A rectangle of pixels and a range of view depths.
    Frustum {
        /// Upper left corner, pixels of the image.
        low_px: [f32; 2],
        /// Lower right corner.
        high_px: [f32; 2],
        /// Least and greatest view depth, metres; `null` without a far plane.
        depth_m: [Option<f32>; 2],
        /// How many of the 32 slices of that range hold samples, if the strategy counts them.
        slices: Option<u32>,
    },
    /// A box along the world's axes.
    Box {
        /// Lower corner.
        min_world: [f64; 3],
        /// Upper corner.
        max_world: [f64; 3],
    },
    /// A box along axes of its own.
    OrientedBox {
        /// Centre.
        center_world: [f64; 3],
        /// Unit axes.
        axes: [[f32; 3]; 3],
        /// Half the size along each axis, metres.
        half_extents_m: [f32; 3],
    },
}

/// The list that a pixel reads.
#[derive(Clone, Debug, Serialize)]
pub struct ListSeen {
    /// Its length.
    pub listed: usize,
    /// How many of its lights reach the sample.
    pub reaching: usize,
    /// Lights that reach the sample and are missing from the list, or from it with a term that reaches.
    pub missed: usize,
    /// All listed and all missed lights: missed ones first, then by brightness, then by distance.
    pub lights: Vec<LightSeen>,
}

/// A light at the pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightSeen {
    /// Its slot in the buffer, by which lists name it.
    pub light: u32,
    /// Its index among all lights of the run, before they were ordered; `null` if only the GPU knows.
    pub given: Option<u32>,
    /// Its kind: `point`, `spot`, `rectangle`, `polygon` or `vpl`.
    pub kind: &'static str,
    /// Distance from the sample to the nearest point of the emitter, as a share of the light's range.
    pub distance_over_range: f64,
    /// Radiance that it adds, or that it would add if it is missed: linear RGB.
    pub radiance: [f32; 3],
    /// Whether the list holds it.
    pub is_listed: bool,
    /// Whether it reaches the sample, decided in f64.
    pub reaches: bool,
    /// Whether it reaches the sample, and the list lacks it or a term of it.
    pub is_missed: bool,
    /// The terms that its entry names; empty if it is not listed.
    pub terms: &'static str,
}
