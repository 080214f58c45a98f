//! Places in the image of a record that are worth explaining.

use serde::{Deserialize, Serialize};

/// The pixel whose image differs most from that of no culling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorstPixel {
    /// Its place: pixels from the left and from the top.
    pub pixel: [u32; 2],
    /// The frame of the path or of the motion that shows it; `null` for the still view.
    #[serde(default)]
    pub frame: Option<u32>,
    /// The largest ratio of a channel's difference to its value without culling (at least 1e-6); `null` if it is not
    /// finite.
    #[serde(default)]
    pub rel_diff: Option<f64>,
}

/// A light within range of a sample that is missing from the list that the sample reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MissedPair {
    /// The pixel of the sample, in the still view: pixels from the left and from the top.
    pub pixel: [u32; 2],
    /// The light's slot in the buffer, by which lists name it; `null` if the sample's position is not a number.
    #[serde(default)]
    pub light: Option<u32>,
    /// The light's index among all lights of the run, before they were ordered; `null` if only the GPU knows.
    #[serde(default)]
    pub given: Option<u32>,
}
