//! `results.json`: the data of a comparison. Every table and chart shows a part of it.
//!
//! One file holds one run: the machine, the command, and one [`Record`] per scene, mode and
//! strategy. The file keeps every sample of every pass, so that any statistic can be computed later.
//! Times are in milliseconds, sizes in bytes, differences in linear HDR radiance. `null` stands for a metric
//! that was not measured, and for a number that JSON cannot hold (NaN, infinite).
//!
//! A reader accepts every file whose [`schema_version`](Results::schema_version) it knows
//! ([`SCHEMA_VERSION`]). Within a version, fields are only added. The version rises when a field is removed,
//! renamed or changes its meaning.
//!
//! ```json
#![doc = include_str!("results/example.json")]
//! ```

mod bill;
mod fault;
mod file;
mod flat;
mod image;
mod indirect;
mod lack;
#[cfg(test)]
mod largest_numbers;
mod lists;
mod machine;
mod metrics;
mod operations;
mod passes;
mod places;
mod planes;
mod record;
mod renamed;
mod seal;
mod setting;
mod shown;
mod stats;
mod temporal;
mod times;
mod totals;
mod truth_image;
mod untested;

use serde::{Deserialize, Serialize, Serializer};
pub use shading::Mode;

pub use bill::{Bill, FrameKind, is_raster_pass, makes_lights, pass_kind};
pub(crate) use file::remove_temporaries;
pub use file::{ResultsError, write_atomically};
pub use image::{Errors, ImageFigures, Images};
pub use indirect::{CastTimes, DeepImageRun, DeepImages, RangeErrors, Vpls};
pub use lists::{HiddenFigures, ListFigures};
pub use machine::{DeviceType, Machine};
pub use operations::{EvaluatedTerms, Operations};
pub use passes::{PassKind, PassTimes, Passes, Spans};
pub use places::{MissedPair, WorstPixel};
pub use planes::{PlaneSource, Planes};
pub use record::Record;
pub(crate) use seal::{sealed, unsealed};
pub use setting::{AdaptiveSetting, LayerSetting, MotionSetting, Setting, ShadowSetting};
pub use stats::{Interval, mean, median, median_interval, percentile, standard_deviation};
pub use temporal::TemporalError;
pub use times::Times;
pub use truth_image::TruthImage;
pub use untested::Untested;

pub use crate::truth_level::TruthLevel;

/// The version of `results.json` that this program writes. It reads version 1 too, whose records were flat.
pub const SCHEMA_VERSION: u32 = 2;

/// One run of `lightbench compare`: the root of `results.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// The version of the file that these results come from. Files are written in [`SCHEMA_VERSION`].
    #[serde(serialize_with = "write_version")]
    pub schema_version: u32,
    /// The machine that it ran on.
    pub machine: Machine,
    /// The command line, program name first.
    pub command: Vec<String>,
    /// What the errors are measured against.
    pub truth: Truth,
    /// One entry per scene, mode and strategy, in the order of the command. Empty for a truth image.
    pub records: Vec<Record>,
    /// The truth image of a run of `lightbench truth`.
    #[serde(default)]
    pub truth_image: Option<TruthImage>,
    /// Deep images and rays of a run of `lightbench cdi`.
    #[serde(default)]
    pub deep_images: Option<DeepImageRun>,
    /// Lights left out because a field was NaN, infinite or out of range.
    #[serde(default)]
    pub rejected_lights: Vec<RejectedLight>,
    /// Strategies that were asked for and not run, because they cannot serve the scene, the device or the mode.
    #[serde(default)]
    pub refused: Vec<RefusedStrategy>,
    /// Warnings for readers of the figures, one sentence each.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// Writes this program's version, whatever version the results were read from.
fn write_version<S: Serializer>(_: &u32, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_u32(SCHEMA_VERSION)
}

/// The truth that the lists of all records are checked against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// How much was checked.
    pub level: TruthLevel,
    /// A (light, sample) pair does not count as missed if its distance to the edge of the light's range is
    /// below this share of the range.
    pub edge_tolerance: f64,
    /// Notes, one sentence each.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// A light that took no part in the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RejectedLight {
    /// The scene that it belongs to.
    pub scene: String,
    /// Its index among all lights of the run.
    pub index: u64,
    /// The faulty field and its value.
    pub reason: String,
}

/// A strategy that took no part in the run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RefusedStrategy {
    /// Its id.
    pub strategy: String,
    /// The mode that it refuses; `null` for all of them.
    #[serde(default)]
    pub mode: Option<Mode>,
    /// Why, in words.
    pub reason: String,
}

impl RefusedStrategy {
    /// The sentence that it was left out, and why.
    pub fn words(&self) -> String {
        format!("{} was left out: {}", self.strategy, self.reason)
    }
}

/// The clock that took the times of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Clock {
    /// Timestamp queries around each pass.
    #[serde(rename = "gpu-timestamps")]
    GpuTimestamps,
    /// Each pass submitted alone and waited for, timed by the host.
    #[serde(rename = "wall-clock-per-pass", alias = "wall-clock per pass")]
    WallClock,
}

impl Clock {
    /// The name in `results.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::GpuTimestamps => "gpu-timestamps",
            Self::WallClock => "wall-clock-per-pass",
        }
    }
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
            refused: Vec::new(),
            warnings: Vec::new(),
        }
    }
}
