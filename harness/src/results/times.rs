//! The times of a record.

use serde::{Deserialize, Serialize};

use super::{Clock, Passes, Spans, passes::nan_from_null};

/// The times of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// The clock that took the times.
    pub clock: Clock,
    /// Timed frames: the number of samples of each pass.
    pub frames: u32,
    /// The least number of frames drawn before timing started.
    pub warmup_frames: u32,
    /// Rounds in which the frames were drawn, each with all methods in turn; along a path its laps.
    /// See [`Record::round_times_ms`](super::Record::round_times_ms). 0 where unknown.
    #[serde(default)]
    pub rounds: u32,
    /// The passes of a frame, in the order in which they ran.
    pub passes: Passes,
    /// Time of all passes that assign lights, ms: their sum per frame, median over frames.
    #[serde(deserialize_with = "nan_from_null")]
    pub assign_ms: f64,
    /// Time of all passes that light pixels, ms: their sum per frame, median over frames.
    #[serde(deserialize_with = "nan_from_null")]
    pub shade_ms: f64,
    /// Time of all passes, ms: their sum per frame, median over frames.
    #[serde(deserialize_with = "nan_from_null")]
    pub frame_ms: f64,
    /// The second total: the time from the first pass to the last, frame by frame. `null` in older results, and
    /// if each pass was submitted alone.
    #[serde(default)]
    pub spans: Option<Spans>,
    /// The time from the start of the first pass that assigns lights to the end of the last that lights pixels,
    /// including gaps, ms: median over frames, mean along a path.
    #[serde(default)]
    pub span_ms: Option<f64>,
    /// The same from the first pass of the frame to its last, ms.
    #[serde(default)]
    pub frame_span_ms: Option<f64>,
    /// Time in which the CPU ordered the lights and built the hierarchy over them, ms. It happens once, for
    /// still lights.
    #[serde(default)]
    pub light_build_ms: Option<f64>,
    /// Bytes that the last frame uploaded of lights that the CPU moves: the pass `upload`, which is timed by
    /// wall clock.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upload_bytes: Option<u64>,
}
