//! What a record was measured on.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Mode, Planes, Vpls};

/// What is drawn, with which lights, from where: the same for all methods of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The scene's id, or its file's name.
    pub scene: String,
    /// Hash of everything in the scene that reaches the GPU, hexadecimal.
    pub scene_hash: String,
    /// Hash of the camera's path, hexadecimal; absent from a still camera, and in older results.
    #[serde(default)]
    pub path_hash: Option<String>,
    /// Factor on the scene's size and its own lights; scattered lights keep theirs.
    pub scene_scale: f64,
    /// Triangles drawn, instances counted each.
    pub triangles: u64,
    /// How pixels were lit.
    pub mode: Mode,
    /// Lights that took part.
    pub lights: u64,
    /// Lights of each kind, by name: `point`, `spot`, `rectangle`, `polygon`, `vpl`; and `sun`, which
    /// stands in no list and is none of [`lights`](Self::lights).
    #[serde(default)]
    pub light_kinds: BTreeMap<String, u64>,
    /// How area lights were shaded: `ltc`; absent where there was none.
    #[serde(default)]
    pub area_model: Option<String>,
    /// Factor on the radii of scattered lights; at 1 their mean is one metre.
    pub radius_scale: f64,
    /// Distribution of the radii of scattered lights: `gamma`, `equal` or `log-normal`.
    #[serde(default)]
    pub radii: Option<String>,
    /// What was scattered into: `core`, `bounds` or `cylinders`.
    #[serde(default)]
    pub light_places: Option<String>,
    /// Where lights were scattered: lower and upper corner, world space, metres.
    #[serde(default)]
    pub light_box: [[f64; 3]; 2],
    /// Lights that the scene's file holds, of [`lights`](Self::lights).
    #[serde(default)]
    pub own_lights: u64,
    /// Lights whose file gives no range, of [`own_lights`](Self::own_lights); absent where there is none,
    /// and in older results.
    #[serde(default)]
    pub open_lights: Option<u64>,
    /// The greatest intensity over squared distance that one of them still gives at its end.
    #[serde(default)]
    pub open_threshold: Option<f64>,
    /// Intensity over squared distance at which the ranges of lights end, where one was given.
    #[serde(default)]
    pub threshold: Option<f64>,
    /// How fall-off ends at a light's range: `windowed` or `hard`.
    #[serde(default)]
    pub cut: Option<String>,
    /// Lights of usual brightness, where brightness was compensated.
    #[serde(default)]
    pub compensation: Option<f64>,
    /// Order of the lights in their buffer: `given`, `morton` or `bvh`.
    #[serde(default)]
    pub light_order: Option<String>,
    /// The seed of the scattered lights.
    pub seed: u64,
    /// The virtual point lights that took part, where there were any.
    #[serde(default)]
    pub vpls: Option<Vpls>,
    /// The camera's position, world space, metres.
    #[serde(default)]
    pub eye: [f64; 3],
    /// The direction it looks in, of unit length, world space.
    #[serde(default)]
    pub forward: [f64; 3],
    /// Near and far plane; unknown in results of earlier versions, whose far planes were infinite
    /// but for orthographic cameras.
    #[serde(default)]
    pub planes: Option<Planes>,
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// Whether each frame was drawn from another pose along the scene's path; times are then means.
    #[serde(default)]
    pub along_path: bool,
    /// Poses of one lap along the path. Samples are stored lap after lap, so there are
    /// `frames / poses` laps. `null` from a still camera, and in older results, which have one lap.
    #[serde(default)]
    pub poses: Option<u32>,
}
