//! The result of `lightbench truth`.

use serde::{Deserialize, Serialize};

use super::Errors;

/// A truth image: what a view should look like, rendered on the CPU.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruthImage {
    /// The scene's id, or its file's name.
    pub scene: String,
    /// Hash of everything in the scene that reaches the GPU, hexadecimal.
    pub scene_hash: String,
    /// Number of lights.
    pub lights: u64,
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// The linear image, an EXR file of 32-bit floats beside `results.json`.
    pub raw: String,
    /// The tone-mapped image.
    pub image: String,
    /// Picture of the standard error of each channel / mean luminance of the image: black for 0, white from
    /// 1/100 on.
    pub error_image: String,
    /// The standard error of each channel, an EXR file like `raw`; `None` in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw_error: Option<String>,
    /// The factor before the tone curve.
    pub exposure: f64,
    /// Root mean square of the pixels' standard errors of luminance / mean luminance.
    pub standard_error: f64,
    /// Whether surfaces cast shadows.
    pub shadows: bool,
    /// Whether each light's radiance without shadows is multiplied by the share of the light that a surface sees.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_separated: bool,
    /// Surfaces that light may meet before it meets the visible one.
    pub bounces: u32,
    /// Whether the light that comes straight from lights is left out.
    #[serde(default)]
    pub is_indirect: bool,
    /// Whether light bounces off surfaces without a specular term, as virtual point lights emit it.
    #[serde(default)]
    pub is_matte: bool,
    /// Samples per pixel, if samples were drawn.
    pub samples: u32,
    /// Seed of the samples; `None` in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_seed: Option<u64>,
    /// Errors from rounding depth and G-buffer, by metric: the same light on the surfaces of the G-buffer
    /// against this truth. Empty with shadows, and in older results, whose truths come from the G-buffer.
    #[serde(default, skip_serializing_if = "Errors::is_empty")]
    pub gbuffer_errors: Errors,
    /// With `--against`: errors against another truth image, by metric.
    #[serde(default, skip_serializing_if = "Errors::is_empty")]
    pub against_errors: Errors,
    /// Render time on the CPU, seconds.
    pub seconds: f64,
}
