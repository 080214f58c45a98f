//! `results.json`: the product of a comparison, of which every table and chart is a view.
//!
//! One file holds one run: the machine, the command, and one [`Record`] per scene, mode and
//! strategy. Every sample of every pass is kept, so that a statistic can be computed later.
//! Times are milliseconds, sizes bytes, differences linear HDR radiance. A metric that was not
//! measured is `null`; so is a number that JSON cannot hold (NaN, infinite).
//!
//! A reader accepts any file whose [`schema_version`](Results::schema_version) it knows
//! ([`SCHEMA_VERSION`]). Fields are only ever added within a version; a field that is removed,
//! renamed or given another meaning raises it.
//!
//! ```json
#![doc = include_str!("results/example.json")]
//! ```

mod bill;
mod file;
mod indirect;
mod lack;
mod machine;
mod metrics;
mod operations;
mod passes;
mod planes;
mod record;
mod renamed;
mod seal;
mod shown;
mod stats;
mod truth_image;
mod untested;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
pub use shading::Mode;

pub use bill::{Bill, FrameKind, is_raster_pass, pass_kind};
pub(crate) use file::remove_temporaries;
pub use file::{ResultsError, write_atomically};
pub use indirect::{CastTimes, DeepImageRun, DeepImages, RangeErrors, Vpls};
pub use machine::{DeviceType, Machine};
pub use operations::{EvaluatedTerms, Operations};
pub use passes::{PassKind, PassTimes, Passes, Spans};
pub use planes::{PlaneSource, Planes};
pub(crate) use seal::{sealed, unsealed};
pub use stats::{Interval, mean, median, median_interval, percentile, standard_deviation};
pub use truth_image::TruthImage;
pub use untested::Untested;

use passes::nan_from_null;

/// The version of `results.json` that this program writes and reads.
pub const SCHEMA_VERSION: u32 = 1;

/// One run of `lightbench compare`: the root of `results.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Where it ran.
    pub machine: Machine,
    /// The command line, program name first.
    pub command: Vec<String>,
    /// What the errors are measured against.
    pub truth: Truth,
    /// One entry per scene, mode and strategy, in the order of the command; none of a truth image.
    pub records: Vec<Record>,
    /// The truth image, where this is a run of `lightbench truth`.
    #[serde(default)]
    pub truth_image: Option<TruthImage>,
    /// Deep images and rays, where this is a run of `lightbench cdi`.
    #[serde(default)]
    pub deep_images: Option<DeepImageRun>,
    /// Lights left out because a field was NaN, infinite or out of range.
    #[serde(default)]
    pub rejected_lights: Vec<RejectedLight>,
    /// Whatever a reader of the figures has to know, one sentence each.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// What the errors of all records are measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// How much was checked.
    pub level: TruthLevel,
    /// A (light, sample) pair closer to the edge of the light's range than this share of the
    /// range is not counted as missed.
    pub edge_tolerance: f64,
    /// Further remarks, one sentence each.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// How much of a run was checked against the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TruthLevel {
    /// Every (light, sample) pair, on the CPU in f64.
    Full,
    /// Images only.
    None,
}

/// A light that took no part in the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RejectedLight {
    /// The scene that it belongs to.
    pub scene: String,
    /// Its index among the lights that were handed over.
    pub index: u64,
    /// The field at fault, and its value.
    pub reason: String,
}

/// What took the times of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Clock {
    /// Timestamp queries around each pass.
    #[serde(rename = "gpu-timestamps")]
    GpuTimestamps,
    /// Each pass submitted alone and waited for, timed by the host.
    #[serde(rename = "wall-clock per pass")]
    WallClock,
}

impl Clock {
    /// As in `results.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::GpuTimestamps => "gpu-timestamps",
            Self::WallClock => "wall-clock per pass",
        }
    }
}

/// One strategy on one scene in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
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
    /// The strategy's id with its parameters: `DC-I/64x64x24`.
    pub strategy: crate::strategy::StrategyId,
    /// The strategy's parameters, by name.
    #[serde(default)]
    pub strategy_parameters: BTreeMap<String, serde_json::Value>,
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
    /// Light operations, where they were counted.
    #[serde(default)]
    pub operations: Option<Operations>,
    /// Factor on the radii of scattered lights; at 1 their mean is one metre.
    pub radius_scale: f64,
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
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// Frames timed: the number of samples of each pass.
    pub frames: u32,
    /// Frames drawn before the clock started.
    pub warmup_frames: u32,
    /// The seed of the scattered lights.
    pub seed: u64,
    /// The virtual point lights that took part, where there were any.
    #[serde(default)]
    pub vpls: Option<Vpls>,
    /// Lights of usual brightness, where brightness was compensated.
    #[serde(default)]
    pub compensation: Option<f64>,
    /// What took the times.
    pub clock: Clock,
    /// The passes of a frame, in the order in which they ran.
    pub passes: Passes,
    /// Median over frames of the passes that assign lights, summed per frame, ms.
    #[serde(deserialize_with = "nan_from_null")]
    pub assign_ms: f64,
    /// Median over frames of the passes that light pixels, summed per frame, ms.
    #[serde(deserialize_with = "nan_from_null")]
    pub shade_ms: f64,
    /// Median over frames of all passes, summed per frame, ms.
    #[serde(deserialize_with = "nan_from_null")]
    pub frame_ms: f64,
    /// What passes took together, from the first to the last, frame by frame: the second total.
    /// `null` in older results, and where each pass was submitted alone.
    #[serde(default)]
    pub spans: Option<Spans>,
    /// Median over frames (mean along a path) of the time from the first pass that assigns lights to
    /// the end of the last that lights pixels, gaps between them included, ms.
    #[serde(default)]
    pub span_ms: Option<f64>,
    /// The same from the first pass of the frame to its last, ms.
    #[serde(default)]
    pub frame_span_ms: Option<f64>,
    /// Groups that the strategy divides the view into.
    pub groups: u64,
    /// Groups with at least one light in their list.
    pub occupied_groups: u64,
    /// Entries of all lists together.
    pub list_entries: u64,
    /// Entries of the longest list.
    pub longest_list: u64,
    /// Mean number of lights in the list that a sample reads.
    #[serde(default)]
    pub listed_per_sample: Option<f64>,
    /// Mean number of lights whose range reaches a sample: what a perfect list would hold.
    #[serde(default)]
    pub contributing_per_sample: Option<f64>,
    /// (light, sample) pairs within range that the sample's list does not hold: 0, or the image
    /// is wrong.
    #[serde(default)]
    pub missed_pairs: Option<u64>,
    /// (light, sample) pairs within range that were looked up in the lists.
    #[serde(default)]
    pub checked_pairs: Option<u64>,
    /// View samples: pixels that show a surface; 0 where lists were not checked.
    pub samples: u64,
    /// Why the run certifies nothing: its view shows no surface, or no light reaches what it shows.
    /// `null` where it was tested, and in older results.
    #[serde(default)]
    pub untested: Option<Untested>,
    /// Largest difference of a channel to the image of no culling, linear HDR; `null` where
    /// there was no such image, or the difference is not finite.
    #[serde(default)]
    pub max_abs_diff: Option<f64>,
    /// Largest difference of a channel over that channel's value without culling.
    #[serde(default)]
    pub max_rel_diff: Option<f64>,
    /// Channels (three per pixel) of which any bit differs from the image of no culling.
    #[serde(default)]
    pub differing_channels: Option<u64>,
    /// GPU memory of groups and lists, bytes.
    pub lists_bytes: u64,
    /// GPU memory of everything that assignment needs, bytes: lists, marks, bounds, pools, the
    /// hierarchy over the lights, and images that the renderer draws only for this method. `null` in
    /// older results, and for methods without lists.
    #[serde(default)]
    pub memory_bytes: Option<u64>,
    /// Groups that some sample reads, by the length of their list: none, 1, 2 to 3, 4 to 7 and so
    /// on. Empty where lists were not checked.
    #[serde(default)]
    pub histogram: Vec<u64>,
    /// All groups, read or not, by the length of their list, likewise. Empty where lists were not
    /// checked.
    #[serde(default)]
    pub all_groups: Vec<u64>,
    /// Rounds in which the frames were drawn, each with all methods in turn; along a path its laps.
    /// See [`round_times_ms`](Self::round_times_ms). 0 where unknown.
    #[serde(default)]
    pub rounds: u32,
    /// Whether each frame was drawn from another pose along the scene's path; times are then means.
    #[serde(default)]
    pub along_path: bool,
    /// Poses of one lap along the path. Samples are stored lap after lap, so there are
    /// `frames / poses` laps. `null` from a still camera, and in older results, which have one lap.
    #[serde(default)]
    pub poses: Option<u32>,
    /// Distribution of the radii of scattered lights: `gamma`, `equal` or `log-normal`.
    #[serde(default)]
    pub radii: Option<String>,
    /// What was scattered into: `core`, `bounds` or `cylinders`.
    #[serde(default)]
    pub light_places: Option<String>,
    /// Intensity over squared distance at which the ranges of lights end, where one was given.
    #[serde(default)]
    pub threshold: Option<f64>,
    /// How fall-off ends at a light's range: `windowed` or `hard`.
    #[serde(default)]
    pub cut: Option<String>,
    /// Whether a knob of the method loses light on purpose.
    #[serde(default)]
    pub is_lossy: bool,
    /// Errors against no culling with the same shader, by metric; means over the compared frames
    /// along a path.
    #[serde(default)]
    pub errors: Errors,
    /// Errors against lights without a range, by metric.
    #[serde(default)]
    pub unbounded_errors: Errors,
    /// Errors against the truth image of a study, by metric: those of the model of area lights, never
    /// of culling.
    #[serde(default)]
    pub truth_errors: Errors,
    /// Order of the lights in their buffer: `given`, `morton` or `bvh`.
    #[serde(default)]
    pub light_order: Option<String>,
    /// Time in which the CPU put the lights in order and built the hierarchy over them, ms: once,
    /// for lights that stand still.
    #[serde(default)]
    pub light_build_ms: Option<f64>,
    /// The largest relative difference that the method states of itself; none where it states
    /// that no bit differs.
    #[serde(default)]
    pub tolerance: Option<f64>,
    /// Groups that fell back to all lights because a list did not fit.
    pub overflowed_groups: u64,
    /// Pictures, beside `results.json`.
    #[serde(default)]
    pub images: Images,
    /// What a reader of this record has to know.
    #[serde(default)]
    pub note: Option<String>,
}

/// Errors by metric; `null` where one is not finite.
pub type Errors = BTreeMap<String, Option<f64>>;

/// The pictures of a record: names of files beside `results.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Images {
    /// The tone-mapped image.
    #[serde(default)]
    pub image: Option<String>,
    /// The linear image, an EXR file of 32-bit floats.
    #[serde(default)]
    pub raw: Option<String>,
    /// The linear image of no culling.
    #[serde(default)]
    pub raw_baseline: Option<String>,
    /// The linear image of lights without a range.
    #[serde(default)]
    pub raw_unbounded: Option<String>,
    /// The factor before the tone curve that the pictures share.
    #[serde(default)]
    pub exposure: Option<f64>,
    /// The tone-mapped image of no culling; needed where the run has no record of it.
    #[serde(default)]
    pub baseline: Option<String>,
    /// The absolute difference to no culling, linear, times the amplification.
    #[serde(default)]
    pub difference: Option<String>,
    /// Lights per pixel over the scene: blue at none, red at 150, green above.
    #[serde(default)]
    pub heat_map: Option<String>,
    /// The factor on the difference; 1 where absent.
    #[serde(default)]
    pub difference_amplification: Option<f64>,
}

impl Results {
    /// Results without records, of this program's version.
    pub fn new(machine: Machine, command: Vec<String>, truth: Truth) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            machine,
            command,
            truth,
            records: Vec::new(),
            truth_image: None,
            deep_images: None,
            rejected_lights: Vec::new(),
            warnings: Vec::new(),
        }
    }
}
