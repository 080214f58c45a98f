//! The scene, lights and camera of a record.

use std::collections::BTreeMap;

use assign::LightOrder;
use serde::{Deserialize, Serialize};

use super::{DeepImages, Mode, Planes};

/// The scene, the lights and the camera: the same in all records of a run, except [`mode`](Self::mode), of
/// which a run may have several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The scene's id, or its file's name.
    pub scene: String,
    /// Hash of everything in the scene that reaches the GPU, hexadecimal.
    pub scene_hash: String,
    /// Hash of the camera's path, hexadecimal; absent for a still camera and in older results.
    #[serde(default)]
    pub path_hash: Option<String>,
    /// Factor on the scene's size and its own lights; scattered lights keep theirs.
    pub scene_scale: f64,
    /// With `--roughness`: that of all surfaces, which are no metal then; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<f64>,
    /// Drawn triangles; every instance counts.
    pub triangles: u64,
    /// How pixels were lit.
    pub mode: Mode,
    /// Number of lights.
    pub lights: u64,
    /// Number of lights of each kind: `point`, `spot`, `rectangle`, `polygon`, `vpl` and `sun`. Suns stand in
    /// no list and do not count in [`lights`](Self::lights).
    #[serde(default)]
    pub light_kinds: BTreeMap<String, u64>,
    /// The model of area lights, such as `ltc`; absent without area lights.
    #[serde(default)]
    pub area_model: Option<String>,
    /// Factor on the radii of scattered lights; at 1 their mean is one metre.
    pub radius_scale: f64,
    /// Distribution of the radii of scattered lights: `gamma`, `equal` or `log-normal`.
    #[serde(default)]
    pub radii: Option<String>,
    /// The space in which lights were scattered: `core`, `bounds` or `cylinders`.
    #[serde(default)]
    pub light_places: Option<String>,
    /// The box in which lights were scattered: lower and upper corner, world space, metres.
    #[serde(default)]
    pub light_box: [[f64; 3]; 2],
    /// Number of the scene's own lights among [`lights`](Self::lights).
    #[serde(default)]
    pub own_lights: u64,
    /// Number of lights without a range in their file, among [`own_lights`](Self::own_lights); absent if there
    /// are none, and in older results.
    #[serde(default)]
    pub open_lights: Option<u64>,
    /// The largest intensity / distance^2 at the end of one of them.
    #[serde(default)]
    pub open_threshold: Option<f64>,
    /// With `--threshold`: the intensity / distance^2 at which all lights end.
    #[serde(default)]
    pub threshold: Option<f64>,
    /// How fall-off ends at a light's range: `windowed` or `hard`.
    #[serde(default)]
    pub cut: Option<String>,
    /// With `--compensate`: its number of lights.
    #[serde(default)]
    pub compensation: Option<f64>,
    /// With `--specular-reach`: the most ranges that a specular term reaches; absent if it ends with the diffuse term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular_reach: Option<f64>,
    /// With `--area-lod`: the solid angle below which an area light is a point, steradians; absent without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area_lod: Option<f64>,
    /// With `--shadows`: the shadow maps; absent without shadows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadows: Option<ShadowSetting>,
    /// Order of the lights in their buffer: `given`, `morton`, `bvh`, `gpu`, `gpuN` for a sort on the GPU in every
    /// Nth frame, or `gpuN%` for one as soon as boxes may have grown by N percent.
    #[serde(default)]
    pub light_order: Option<String>,
    /// How the lights move; absent if they stand still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSetting>,
    /// What is drawn over the opaque surfaces; absent if nothing is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<LayerSetting>,
    /// Samples per pixel; absent if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub msaa: Option<u32>,
    /// The seed of the scattered lights and particles.
    pub seed: u64,
    /// The camera's position, world space, metres.
    #[serde(default)]
    pub eye: [f64; 3],
    /// The camera's unit view direction, world space.
    #[serde(default)]
    pub forward: [f64; 3],
    /// Near and far plane; unknown in results of earlier versions, whose far planes were infinite except for
    /// orthographic cameras.
    #[serde(default)]
    pub planes: Option<Planes>,
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// Whether each frame differs: another pose along the scene's path, or lights that move. Times are then means.
    #[serde(default)]
    pub along_path: bool,
    /// Poses per lap along the path. Samples are stored lap after lap, so the number of laps is
    /// frames / poses. `null` for a still camera, and in older results, which have one lap.
    #[serde(default)]
    pub poses: Option<u32>,
}

impl Setting {
    /// The order of the lights; `None` if it is unknown.
    pub fn order(&self) -> Option<LightOrder> {
        self.light_order.as_ref()?.parse().ok()
    }
}

/// What is drawn over the opaque surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LayerSetting {
    /// Whether transparent surfaces are blended.
    pub transparent: bool,
    /// Number of particles.
    pub particles: u64,
    /// The rate at which fog scatters light, per metre; absent without fog.
    pub fog_per_m: Option<f64>,
}

/// The shadow maps of the lights, or the rays in place of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadowSetting {
    /// The model that was asked for, such as `maps:9,512` or `cdi:9`.
    pub model: String,
    /// Maps for each area light, or the most of them if frames subdivided. Fewer than the model's if more did not fit
    /// the atlas. With `cdi:N`, rays to each area light.
    pub maps_per_area_light: u32,
    /// Maps of all lights. With `cdi:N`, points of all lights, to which rays are cast.
    pub maps: u32,
    /// Faces of all maps; 0 with `cdi:N`.
    pub faces: u32,
    /// Width and height of the atlas, texels of 4 bytes; zeros with `cdi:N`.
    pub atlas_px: [u32; 2],
    /// Bytes of the depths by which strategies with `/occ` find hidden lights; absent without such strategies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub occluder_bytes: Option<u64>,
    /// The time that drawing all maps once takes, ms: on a GPU the median of seven draws. It is in no other time. With
    /// `/occ`, it includes the pass `occluders`. With `cdi:N`, the time of building the deep images once. Absent in older
    /// results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draw_ms: Option<f64>,
    /// With an adaptive model: how frames subdivided the lights. Absent otherwise, and in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<AdaptiveSetting>,
    /// With `cdi:N`: the deep images that rays cross. Absent otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deep: Option<DeepImages>,
}

/// How frames subdivided rectangles, before the frames on the clock. A frame of lights that move would take
/// [`ShadowSetting::draw_ms`], `banding_ms` and the time to shade.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveSetting {
    /// Maps of each rectangle in the end, in the order of the lights.
    pub maps_of_rectangles: Vec<u32>,
    /// Rectangles that had no maps left to divide further.
    pub full_rectangles: u32,
    /// Frames that were tested until no quad changed.
    pub frames: u32,
    /// The time of the pass `shadow-banding` after that, ms: on a GPU the median of seven. It is in no other time.
    /// Absent if there was nothing to test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub banding_ms: Option<f64>,
}

/// How lights move.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionSetting {
    /// The law, such as `drift`, or `file` for the animation of the scene's file.
    pub law: String,
    /// Metres per second; for `file` the factor on its clock.
    pub speed_m_s: f64,
    /// Who moves the lights: `cpu` or `gpu`.
    pub moved_by: String,
}
