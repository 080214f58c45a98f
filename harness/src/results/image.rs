//! The image of a record.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{TemporalError, WorstPixel};

/// The differences and errors of an image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageFigures {
    /// Largest difference of a channel to the image of no culling, linear HDR; `null` without such an image
    /// and for a difference that is not finite.
    #[serde(default)]
    pub max_abs_diff: Option<f64>,
    /// Largest ratio of a channel's difference to its value without culling.
    #[serde(default)]
    pub max_rel_diff: Option<f64>,
    /// Channels (three per pixel) that differ in any bit from the image of no culling.
    #[serde(default)]
    pub differing_channels: Option<u64>,
    /// The pixel with the largest ratio, the first of several; absent if no channel differs, and in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_pixel: Option<WorstPixel>,
    /// The largest relative difference that the method allows itself; `null` for a method that promises
    /// identical bits.
    #[serde(default)]
    pub tolerance: Option<f64>,
    /// How much the error changes from frame to frame; `null` unless frames that follow each other were compared.
    #[serde(default)]
    pub temporal: Option<TemporalError>,
    /// Errors against no culling with the same shader, by metric; along a path, means over the compared
    /// frames.
    #[serde(default)]
    pub errors: Errors,
    /// Errors against lights without a range, by metric.
    #[serde(default)]
    pub unbounded_errors: Errors,
    /// Errors against the truth image of a study or of `--against`, by metric. They come from shading, never
    /// from culling.
    #[serde(default)]
    pub truth_errors: Errors,
    /// Pictures, beside `results.json`.
    #[serde(default, alias = "images")]
    pub files: Images,
}

/// Errors by metric; `null` for one that is not finite.
pub type Errors = BTreeMap<String, Option<f64>>;

/// The pictures of a record: names of files beside `results.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Images {
    /// The tone-mapped image.
    #[serde(default, alias = "image")]
    pub tone_mapped: Option<String>,
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
    /// The tone-mapped image of no culling, for runs without a record of it.
    #[serde(default)]
    pub baseline: Option<String>,
    /// The absolute difference to no culling, linear, times the amplification.
    #[serde(default)]
    pub difference: Option<String>,
    /// Lights per pixel, drawn over the scene: blue for 0, red for 150, green above.
    #[serde(default)]
    pub heat_map: Option<String>,
    /// The factor on the difference; 1 where absent.
    #[serde(default)]
    pub difference_amplification: Option<f64>,
}
