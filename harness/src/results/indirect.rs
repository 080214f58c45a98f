//! Results of indirect light: virtual point lights, deep images, and rays through them.

use serde::{Deserialize, Serialize};

use super::{Errors, Passes, median, passes::nan_from_null};
use crate::drift::unsteady;

/// The virtual point lights of a record, and the times of making them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vpls {
    /// Side of the reflective shadow map, pixels.
    pub rsm_px: u32,
    /// The rule for ranges: `average`, `maximum`, `random`, `random-discard`, `constant-discard` or
    /// `infinite`.
    pub ranges: String,
    /// Rays per light; 0 if none were cast.
    pub rays: u32,
    /// Whether the first ray follows the mirrored primary light instead of the normal.
    #[serde(default)]
    pub is_reflected: bool,
    /// Whether each ray was corrected by a second look-up.
    #[serde(default)]
    pub is_corrected: bool,
    /// Factor on the measured ranges.
    pub range_scale: f64,
    /// Bounds of ranges that do not come from rays, metres. Both are equal for a constant range.
    #[serde(default, alias = "random_m")]
    pub given_ranges_m: Option<[f64; 2]>,
    /// The largest width of blocks of merged pixels, metres; 0 without merging.
    pub spacing_m: f64,
    /// Distance below which a light gets no brighter, metres.
    pub clamp_m: f64,
    /// Lights before any was left out for its range.
    pub candidates: u64,
    /// Lights left out because their range was too short.
    pub too_small: u64,
    /// Lights left out because their range was too long, or because no ray met a surface.
    pub too_large: u64,
    /// Lights that remain.
    pub kept: u64,
    /// Mean range of the remaining lights, metres.
    pub mean_range_m: f64,
    /// The deep images, if rays were cast.
    #[serde(default)]
    pub deep: Option<DeepImages>,
    /// Whether Fresnel's term reduces the diffuse light that the lights emit. In results without this field
    /// the lights are 4 to 7 % too bright.
    #[serde(default)]
    pub has_fresnel: bool,
    /// For deep images that were not built in one pass: errors, by metric, of the image against that of the
    /// same lights with ranges from deep images built in one pass.
    #[serde(default)]
    pub build_errors: Errors,
    /// The passes and their times: the shadow map, the lights, and the deep images. Empty if every frame makes
    /// the lights: then these passes are among those of the record.
    pub passes: Passes,
    /// The wall-clock time to read the lights back, to order them on the CPU, and to upload them, ms. `None`
    /// if they stay on the GPU, and in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read_back_ms: Option<f64>,
}

impl Vpls {
    /// A summary: `1,042 of 2,515 lights, ranges average, 3.15 m on average, made in 1.15 ms`.
    pub fn summary(&self) -> String {
        let made = match self.are_made_in_frames() {
            true => "made in every frame".to_owned(),
            false => format!("made in {:.3} ms", self.total_ms()),
        };
        format!(
            "{} of {} lights, ranges {}, {:.2} m on average, {made}",
            self.kept, self.candidates, self.ranges, self.mean_range_m,
        )
    }

    /// Whether every frame makes the lights.
    pub fn are_made_in_frames(&self) -> bool {
        self.passes.iter().next().is_none()
    }

    /// Why their times are unsteady ([`unsteady`]); `None` for steady times.
    pub fn unsteady(&self) -> Option<String> {
        unsteady(&self.passes.per_frame_ms(None))
    }

    /// All steps together, ms: the sum of their medians.
    pub fn total_ms(&self) -> f64 {
        self.passes.iter().map(|(_, times)| times.median_ms).sum()
    }
}

/// Deep images: their settings and their size.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DeepImages {
    /// Rings of directions over the hemisphere.
    pub stacks: u32,
    /// Directions of a ring.
    pub slices: u32,
    /// How the directions are spread: `stacks` or `squares`.
    #[serde(default)]
    pub spread: String,
    /// Side of an image, pixels.
    pub size_px: u32,
    /// Samples of surfaces along each side of a pixel.
    pub oversampling: u32,
    /// How they were built: `compute`, `fragment`, `per-direction`,
    /// `per-direction-batched`, `linked-lists`, `conservative`.
    pub build: String,
    /// Side of a pixel, metres.
    pub footprint_m: f64,
    /// Surface samples; 0 for builds without any.
    pub samples: u64,
    /// Depths in all lists.
    pub fragments: u64,
    /// Depths in the longest list.
    pub longest_list: u64,
    /// GPU memory, bytes.
    pub bytes: u64,
}

impl DeepImages {
    /// Directions over the hemisphere.
    pub fn directions(&self) -> u32 {
        self.stacks.saturating_mul(self.slices)
    }
}

/// The results of `lightbench cdi`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeepImageRun {
    /// The scene's id, or its file's name.
    pub scene: String,
    /// Hash of everything in the scene that reaches the GPU, hexadecimal.
    pub scene_hash: String,
    /// Drawn triangles; every instance counts.
    pub triangles: u64,
    /// The deep images.
    pub deep: DeepImages,
    /// The passes that build them, with their times.
    pub passes: Passes,
    /// Rays cast from every pixel of reflective shadow maps.
    #[serde(default)]
    pub casts: Vec<CastTimes>,
    /// Rays compared with exact ones.
    #[serde(default)]
    pub range_errors: Option<RangeErrors>,
    /// The same rays, each corrected by a second look-up.
    #[serde(default)]
    pub corrected_errors: Option<RangeErrors>,
}

impl DeepImageRun {
    /// Time of a whole build, ms: the median over frames of its passes' sum.
    pub fn build_ms(&self) -> f64 {
        median(&self.passes.per_frame_ms(None))
    }

    /// Why the times of its builds are unsteady; `None` for steady times.
    pub fn unsteady(&self) -> Option<String> {
        unsteady(&self.passes.per_frame_ms(None))
    }
}

impl CastTimes {
    /// Why its times are unsteady; `None` for steady times.
    pub fn unsteady(&self) -> Option<String> {
        [&self.cast_ms, &self.corrected_ms, &self.random_ms].into_iter().find_map(|ms| unsteady(ms))
    }
}

/// Times of finding the ranges of virtual point lights.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CastTimes {
    /// Side of the reflective shadow map, pixels.
    pub rsm_px: u32,
    /// Whether the map shows the middle of the scene, where almost every pixel shows a surface.
    #[serde(default)]
    pub is_middle: bool,
    /// Virtual point lights: pixels that show a surface.
    pub lights: u64,
    /// Rays per light.
    pub rays: u32,
    /// Times of casting them, ms, one per frame.
    pub cast_ms: Vec<f64>,
    /// Times of casting them with a second look-up each, ms.
    #[serde(default)]
    pub corrected_ms: Vec<f64>,
    /// Times of giving as many lights random ranges, ms.
    pub random_ms: Vec<f64>,
}

/// How far rays through deep images are from exact ones, in footprints: sides of a pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RangeErrors {
    /// Rays that were compared.
    pub rays: u64,
    /// Rays of which both or neither met a surface.
    pub agree: u64,
    /// Rays that met a surface, and none in the deep images.
    pub lost: u64,
    /// Rays that met none, and one in the deep images.
    pub invented: u64,
    /// Absolute errors of the distances of rays that met one in both, in footprints: at every 20th of
    /// them, from the least to the greatest.
    pub error_quantiles: Vec<f64>,
    /// Of those rays, how many err by less than 1/4, 1/2, 1, 2, 4, 8 footprints, and by more: one count
    /// a bin.
    pub histogram: Vec<u64>,
    /// Of those rays, how many found a surface nearer, by more than a footprint, than the exact one.
    pub too_near: u64,
    /// How many found one farther, by more than a footprint.
    pub too_far: u64,
    /// Median of the errors of ranges over their lights: the average of a light's rays against that of
    /// exact ones, in footprints.
    #[serde(deserialize_with = "nan_from_null")]
    pub median_range_error: f64,
}

impl RangeErrors {
    /// Upper ends of the bins of [`histogram`](Self::histogram), the last open.
    pub const BINS: [f64; 6] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0];

    /// The median of the absolute errors, in footprints; NaN without any.
    pub fn median(&self) -> f64 {
        let middle = self.error_quantiles.len() / 2;
        self.error_quantiles.get(middle).copied().unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_keeps_the_errors_of_zero_rays() {
        let none = RangeErrors { median_range_error: f64::NAN, ..RangeErrors::default() };
        let json = serde_json::to_string(&none).expect("serialises");
        let back: RangeErrors = serde_json::from_str(&json).expect("parses");
        assert!(back.median_range_error.is_nan() && back.median().is_nan());
    }
}
