//! Errors of an image against a reference: one row per metric.
//!
//! All metrics except FLIP compare linear HDR values, before exposure. FLIP compares what the eye sees, after
//! the same exposure and tone curve for both images.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool};
use shading::{HdrImage, luminance};

use crate::results::Errors;

/// Side of the tiles over which [`tile`](ErrorMetric) sums, pixels.
pub const TILE_PX: usize = 16;

/// A pixel counts as wrong if it differs by more than this share of the reference plus 1/100 of the mean.
const OFF: f64 = 0.05;

/// An image and its reference, both of the same size.
#[derive(Clone, Copy)]
pub struct ImagePair<'a> {
    /// The image.
    pub image: &'a HdrImage,
    /// The reference.
    pub reference: &'a HdrImage,
    /// The factor before the tone curve, for FLIP.
    pub exposure: f32,
}

/// An error metric: 0 is no error, closer to 0 is better. Only bias has a sign.
pub struct ErrorMetric {
    /// Its id in `results.json`.
    pub id: &'static str,
    /// Its name in tables and charts.
    pub head: &'static str,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// What it means, one sentence.
    pub about: &'static str,
    value: fn(&Sums, &ImagePair<'_>) -> f64,
}

/// All metrics of error, in order.
pub static ERROR_METRICS: &[ErrorMetric] = &[
    ErrorMetric {
        id: "missing_energy",
        head: "missing energy",
        unit: "",
        about: "Luminance that is lost in pixels that are darker than they should be, as a share \
                of the total luminance that the image should have.",
        value: |sums, _| share(sums.darker, sums.reference),
    },
    ErrorMetric {
        id: "rel_mse",
        head: "relMSE",
        unit: "",
        about: "Mean over channels of (a - b)^2 / (b^2 + (0.1 \u{d7} L)^2). Here a is the channel, \
                b is what it should be, and L is the mean luminance that the image should have.",
        value: |sums, pair| rel_mse(sums, pair),
    },
    ErrorMetric {
        id: "bias",
        head: "bias",
        unit: "",
        about: "Luminance of the whole image minus what it should be, as a share of what it should \
                be. Negative means too dark.",
        value: |sums, _| share(sums.image - sums.reference, sums.reference),
    },
    ErrorMetric {
        id: "tile",
        head: "worst tile",
        unit: "",
        about: "Largest error of the mean luminance of a tile of 16 x 16 pixels, divided by the \
                mean luminance that the whole image should have.",
        value: |sums, pair| worst_tile(sums, pair),
    },
    ErrorMetric {
        id: "pixels_off",
        head: "pixels off",
        unit: "",
        about: "Share of pixels whose luminance is off by more than 5 % of what it should be, plus \
                1 % of the mean luminance.",
        value: |sums, pair| pixels_off(sums, pair),
    },
    ErrorMetric {
        id: "mean_error",
        head: "mean error",
        unit: "",
        about: "Mean over pixels of the absolute difference of luminance, divided by the mean \
                luminance that the image should have.",
        value: |sums, _| share(sums.off, sums.reference),
    },
    ErrorMetric {
        id: "log_error",
        head: "log error",
        unit: "",
        about: "Mean over channels of |log2((a + e) / (b + e))|. Here a is the channel, b is what \
                it should be, and e is 1 % of the mean luminance. 1 means off by a factor of two, \
                up or down.",
        value: |sums, pair| log_error(sums, pair.image.pixels.iter().zip(&pair.reference.pixels)),
    },
    ErrorMetric {
        id: "highlights",
        head: "highlights",
        unit: "",
        about: "The log error of the brightest 1 % of the pixels, by the brighter of both images. \
                It shows highlights that are missing and highlights that should not be there.",
        value: |sums, pair| log_error(sums, brightest(pair)),
    },
    ErrorMetric {
        id: "flip",
        head: "FLIP",
        unit: "",
        about: "Mean FLIP after exposure and tone curve, at 67 pixels per degree (Andersson et al. \
                2020): what an eye sees when it flips between the two.",
        value: |_, pair| flip(pair),
    },
];

/// Errors by metric, in the order of [`ERROR_METRICS`]. Not finite if a pixel is not finite.
pub fn errors(pair: &ImagePair<'_>) -> Vec<(&'static str, f64)> {
    if pair.image.pixels == pair.reference.pixels {
        return no_errors();
    }
    let sums = Sums::add_up(pair);
    ERROR_METRICS.iter().map(|metric| (metric.id, (metric.value)(&sums, pair))).collect()
}

/// The errors of an image that is its reference.
pub fn no_errors() -> Vec<(&'static str, f64)> {
    ERROR_METRICS.iter().map(|metric| (metric.id, 0.0)).collect()
}

/// Errors as results store them, without those that are not finite.
pub fn stored(errors: impl IntoIterator<Item = (&'static str, f64)>) -> Errors {
    let finite = |error: f64| error.is_finite().then_some(error);
    errors.into_iter().map(|(id, error)| (id.to_owned(), finite(error))).collect()
}

/// Sums of luminance over the pixels.
struct Sums {
    pixels: f64,
    image: f64,
    reference: f64,
    /// Of the missing luminance where the image is darker.
    darker: f64,
    /// Of the absolute differences.
    off: f64,
}

impl Sums {
    fn add_up(pair: &ImagePair<'_>) -> Self {
        let mut sums = Self { pixels: 0.0, image: 0.0, reference: 0.0, darker: 0.0, off: 0.0 };
        for (a, b) in luminances(pair) {
            sums.pixels += 1.0;
            sums.image += a;
            sums.reference += b;
            sums.darker += (b - a).max(0.0);
            sums.off += (b - a).abs();
        }
        sums
    }

    fn mean(&self) -> f64 {
        self.reference / self.pixels.max(1.0)
    }
}

/// Luminance of the image and of the reference, pixel by pixel.
fn luminances<'a>(pair: &ImagePair<'a>) -> impl Iterator<Item = (f64, f64)> + 'a {
    let pixels = pair.image.pixels.iter().zip(&pair.reference.pixels);
    pixels.map(|(a, b)| (luminance(a), luminance(b)))
}

/// `part` / `whole`; 0 / 0 is 0.
fn share(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

fn rel_mse(sums: &Sums, pair: &ImagePair<'_>) -> f64 {
    let floor = (0.1 * sums.mean()).powi(2).max(f64::MIN_POSITIVE);
    let channels = pair.image.pixels.iter().flatten().zip(pair.reference.pixels.iter().flatten());
    let sum: f64 = channels
        .map(|(&a, &b)| {
            let (a, b) = (f64::from(a), f64::from(b));
            (a - b).powi(2) / (b.powi(2) + floor)
        })
        .sum();
    sum / (3.0 * sums.pixels.max(1.0))
}

/// The floor of [`log_error`], as a share of the reference's mean luminance.
const LOG_FLOOR: f64 = 0.01;

/// The mean error in doublings, over all channels.
fn log_error<'a>(sums: &Sums, pixels: impl Iterator<Item = (&'a [f32; 3], &'a [f32; 3])>) -> f64 {
    let floor = (LOG_FLOOR * sums.mean()).max(f64::MIN_POSITIVE);
    let (mut sum, mut count) = (0.0, 0.0);
    for (a, b) in pixels {
        for (a, b) in a.iter().zip(b) {
            let [a, b] = [a, b].map(|value| f64::from(*value).max(0.0) + floor);
            sum += (a / b).log2().abs();
            count += 1.0;
        }
        // A comparison with what is no number loses it.
        if !a.iter().chain(b).all(|value| value.is_finite()) {
            return f64::NAN;
        }
    }
    sum / f64::max(count, 1.0)
}

/// The brightest 1 % of the pixels (at least one), by the larger luminance of both images.
fn brightest<'a>(
    pair: &ImagePair<'a>,
) -> impl Iterator<Item = (&'a [f32; 3], &'a [f32; 3])> + use<'a> {
    let mut pixels: Vec<_> = pair.image.pixels.iter().zip(&pair.reference.pixels).collect();
    let kept = pixels.len().div_ceil(100);
    if kept < pixels.len() {
        let brightness = |(a, b): &(&[f32; 3], &[f32; 3])| luminance(a).max(luminance(b));
        pixels.select_nth_unstable_by(kept, |a, b| brightness(b).total_cmp(&brightness(a)));
        pixels.truncate(kept);
    }
    pixels.into_iter()
}

fn worst_tile(sums: &Sums, pair: &ImagePair<'_>) -> f64 {
    let worst = tiles(pair).into_iter().map(f64::abs).fold(0.0, f64::max);
    share(worst, sums.mean())
}

/// The left and top pixel of the tile with the largest error; `None` for an image without pixels.
pub fn worst_tile_at(pair: &ImagePair<'_>) -> Option<[u32; 2]> {
    let columns = (pair.image.width as usize).div_ceil(TILE_PX).max(1);
    let all = tiles(pair);
    let worst = (0..all.len()).max_by(|&a, &b| all[a].abs().total_cmp(&all[b].abs()))?;
    Some([worst % columns, worst / columns].map(|tile| (tile * TILE_PX) as u32))
}

/// The error of the mean luminance of each tile, row by row.
fn tiles(pair: &ImagePair<'_>) -> Vec<f64> {
    let columns = (pair.image.width as usize).div_ceil(TILE_PX).max(1);
    let width = (pair.image.width as usize).max(1);
    let mut tiles: Vec<(f64, f64)> = Vec::new();
    for (ix, (a, b)) in luminances(pair).enumerate() {
        let tile = ix / width / TILE_PX * columns + ix % width / TILE_PX;
        if tiles.len() <= tile {
            tiles.resize(tile + 1, (0.0, 0.0));
        }
        tiles[tile].0 += a - b;
        tiles[tile].1 += 1.0;
    }
    tiles.into_iter().map(|(off, pixels)| off / pixels).collect()
}

fn pixels_off(sums: &Sums, pair: &ImagePair<'_>) -> f64 {
    let mean = sums.mean();
    let off = luminances(pair).filter(|(a, b)| (a - b).abs() > OFF * b + 0.01 * mean).count();
    off as f64 / sums.pixels.max(1.0)
}

fn flip(pair: &ImagePair<'_>) -> f64 {
    let HdrImage { width, height, .. } = *pair.image;
    let [image, reference] =
        [pair.image, pair.reference].map(|image| image.tone_mapped(pair.exposure));
    let reference = FlipImageRgb8::with_data(width, height, &reference);
    let image = FlipImageRgb8::with_data(width, height, &image);
    let map = nv_flip::flip(reference, image, DEFAULT_PIXELS_PER_DEGREE);
    f64::from(FlipPool::from_image(&map).mean())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: impl Fn(usize) -> f32) -> HdrImage {
        HdrImage { width: 64, height: 32, pixels: (0..64 * 32).map(|ix| [values(ix); 3]).collect() }
    }

    fn error_of(image: &HdrImage, reference: &HdrImage, id: &str) -> f64 {
        let all = errors(&ImagePair { image, reference, exposure: 1.0 });
        all.into_iter().find(|(known, _)| *known == id).map(|(_, value)| value).unwrap()
    }

    #[test]
    fn the_same_image_has_no_error() {
        let grey = image(|ix| 0.1 + ix as f32 * 1e-4);
        for metric in ERROR_METRICS {
            assert_eq!(error_of(&grey, &grey, metric.id), 0.0, "{}", metric.id);
        }
        // One bit is enough for the sums to be taken.
        let mut other = grey.clone();
        other.pixels[77][0] += 1e-3;
        let sees = |id: &str| !["pixels_off", "highlights"].contains(&id);
        for metric in ERROR_METRICS.iter().filter(|m| sees(m.id)) {
            let error = error_of(&other, &grey, metric.id);
            let is_brighter = metric.id == "missing_energy";
            assert!((error > 0.0) != is_brighter && error < 1e-2, "{}: {error}", metric.id);
        }
    }

    #[test]
    fn errors_of_made_up_images_are_known() {
        let reference = image(|_| 1.0);
        // Every fourth pixel is half as bright.
        let darker = image(|ix| if ix % 4 == 0 { 0.5 } else { 1.0 });
        assert!((error_of(&darker, &reference, "missing_energy") - 0.125).abs() < 1e-12);
        assert!((error_of(&darker, &reference, "bias") + 0.125).abs() < 1e-12);
        assert!((error_of(&darker, &reference, "pixels_off") - 0.25).abs() < 1e-12);
        assert!((error_of(&darker, &reference, "rel_mse") - 0.25 * 0.25 / 1.01).abs() < 1e-12);
        assert!((error_of(&darker, &reference, "tile") - 0.125).abs() < 1e-12);
        // Other pixels are brighter by as much: no bias, but missing energy.
        let both = image(|ix| [0.5, 1.5, 1.0, 1.0][ix % 4]);
        assert!(error_of(&both, &reference, "bias").abs() < 1e-12);
        assert!((error_of(&both, &reference, "missing_energy") - 0.125).abs() < 1e-12);
        // One dark tile of eight.
        let tile = image(|ix| if ix % 64 < 16 && ix / 64 < 16 { 0.0 } else { 1.0 });
        assert!((error_of(&tile, &reference, "tile") - 1.0).abs() < 1e-12);
        // It is found, at the right place.
        let tile = image(|ix| if ix % 64 / 16 == 2 && ix / 64 / 16 == 1 { 0.0 } else { 1.0 });
        let pair = ImagePair { image: &tile, reference: &reference, exposure: 1.0 };
        assert_eq!(worst_tile_at(&pair), Some([32, 16]));
    }

    #[test]
    fn missing_and_doubled_highlights_raise_the_error() {
        // Five bright pixels of 2,048, a hundred times as bright as the rest.
        let with = |bright: f32| image(|ix| if ix % 400 == 7 { bright } else { 1.0 });
        let reference = with(100.0);
        let highlights = |bright| error_of(&with(bright), &reference, "highlights");
        // Five of the 21 brightest pixels are one doubling off, with a floor of a hundredth of the mean.
        assert!((highlights(50.0) - 6.0 / 21.0).abs() < 0.01, "{}", highlights(50.0));
        assert!((highlights(200.0) - highlights(50.0)).abs() < 0.01);
        assert!(highlights(1.0) > 1.5);
        // The metrics of means hardly see it.
        assert!(error_of(&with(200.0), &reference, "log_error") < 0.004);
        let both = error_of(
            &image(|ix| if ix % 2 == 0 { 2.0 } else { 0.5 }),
            &image(|_| 1.0),
            "log_error",
        );
        let expected = 0.5 * ((2.01_f64 / 1.01).log2() + (1.01_f64 / 0.51).log2());
        assert!((both - expected).abs() < 1e-9, "{both} {expected}");
    }

    #[test]
    fn flip_grows_with_the_visible_difference() {
        let reference = image(|ix| if ix % 64 < 32 { 0.2 } else { 0.6 });
        let at = |gain: f32| {
            let pixels = reference.pixels.iter().map(|p| p.map(|v| v * gain)).collect();
            error_of(&HdrImage { pixels, ..reference.clone() }, &reference, "flip")
        };
        assert!(at(1.05) > 0.005 && at(1.5) > 2.0 * at(1.05) && at(3.0) < 1.0);
    }

    #[test]
    fn empty_and_non_finite_images_do_not_panic() {
        let black = image(|_| 0.0);
        let lit = image(|_| 1.0);
        let nan = image(|_| f32::NAN);
        for pair in [(&lit, &black), (&nan, &lit), (&lit, &nan)] {
            for metric in ERROR_METRICS {
                let _ = error_of(pair.0, pair.1, metric.id);
            }
        }
        assert_eq!(error_of(&lit, &black, "missing_energy"), 0.0);
        assert!(!error_of(&lit, &black, "bias").is_finite());
        let empty = HdrImage { width: 0, height: 0, pixels: Vec::new() };
        assert!(errors(&ImagePair { image: &empty, reference: &empty, exposure: 1.0 }).len() > 5);
    }
}
