//! The temporal error of a record.

use serde::{Deserialize, Serialize};

/// How much the error of an image changes from one frame to the next. The error `E(t)` of frame `t` is its image
/// minus that of no culling, so what moves in both does not count. Linear HDR; `null` where not finite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TemporalError {
    /// Frames that were compared, each with the one before.
    pub frames: u32,
    /// Mean of `|E(t) - E(t - 1)|` over channels, pixels and frames.
    pub mean: Option<f64>,
    /// The largest `|E(t) - E(t - 1)|` of a channel.
    pub worst: Option<f64>,
    /// Where that is: pixels from the left and from the top.
    pub worst_pixel: [u32; 2],
    /// The later frame of the two between which that is, from 0.
    pub worst_frame: u32,
}

impl TemporalError {
    /// Whether the error changes at all.
    pub fn changes(&self) -> bool {
        self.worst != Some(0.0)
    }
}
