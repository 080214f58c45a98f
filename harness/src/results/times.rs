//! The times of a record.

use serde::{Deserialize, Serialize};

use super::{Clock, Passes, Spans, passes::nan_from_null};

/// How long it took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// What took the times.
    pub clock: Clock,
    /// Frames timed: the number of samples of each pass.
    pub frames: u32,
    /// Frames drawn before the clock started.
    pub warmup_frames: u32,
    /// Rounds in which the frames were drawn, each with all methods in turn; along a path its laps.
    /// See [`round_times_ms`](Self::round_times_ms). 0 where unknown.
    #[serde(default)]
    pub rounds: u32,
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
    /// Time in which the CPU put the lights in order and built the hierarchy over them, ms: once,
    /// for lights that stand still.
    #[serde(default)]
    pub light_build_ms: Option<f64>,
}
