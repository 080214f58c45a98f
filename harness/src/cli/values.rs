//! Parsers of option values. An error completes the sentence `--option is VALUE: it must be ...`.

use std::str::FromStr;

use assign::{AssignError, FrustumTests, LightOrder};

use shading::{ACCEPTED_AREA_MODELS, ACCEPTED_SHADOW_MODELS, AreaModel, ShadowModel};

use crate::digits::grouped;

/// The most lights that can be scattered.
pub const MAX_LIGHTS: u32 = 1 << 24;
const MAX_SIDE: u32 = 16_384;
/// The most frames that can be timed.
pub(super) const MAX_FRAMES: u32 = 100_000;
/// The most poses along a path at which images are compared.
pub(crate) const MAX_CHECKS: u32 = 8;
/// The largest side of a reflective shadow map, pixels.
const MAX_RSM: u32 = 2048;
const SCALES: (f64, f64) = (1e-6, 1e6);

/// An image size, pixels: `640x360`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| {
            let side: u32 = text.parse().ok()?;
            (1..=MAX_SIDE).contains(&side).then_some(side)
        };
        text.split_once(['x', 'X'])
            .and_then(|(width, height)| Some(Self { width: side(width)?, height: side(height)? }))
            .ok_or_else(|| "WIDTHxHEIGHT in pixels, each from 1 to 16,384".to_owned())
    }
}

/// The far plane: a view depth in metres, such as `100`, or `infinite`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FarPlane {
    /// At a view depth, metres.
    At(f64),
    /// There is no far plane.
    Infinite,
}

impl FromStr for FarPlane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "infinite" {
            return Ok(Self::Infinite);
        }
        number(text, SCALES.0, 1e9)
            .map(Self::At)
            .ok_or_else(|| "a number of metres from 1e-6 to 1e9, or infinite".to_owned())
    }
}

/// Ids of strategies in the order given, none empty and none repeated: `None,DC-I/64x64x24`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Strategies(pub Vec<String>);

impl FromStr for Strategies {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ids: Vec<String> = text.split(',').map(|id| id.trim().to_owned()).collect();
        let once = |(ix, id): (usize, &String)| !id.is_empty() && !ids[..ix].contains(id);
        if ids.iter().enumerate().all(once) {
            Ok(Self(ids))
        } else {
            Err("ids separated by commas, each given once and none empty".to_owned())
        }
    }
}

/// Directions of deep images over the hemisphere: `13x13`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionCounts {
    /// Rings between the horizon and the pole.
    pub stacks: u32,
    /// Directions of a ring.
    pub slices: u32,
}

impl FromStr for DirectionCounts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| whole(text, 1, 64);
        text.split_once(['x', 'X'])
            .and_then(|(stacks, slices)| {
                Some(Self { stacks: side(stacks)?, slices: side(slices)? })
            })
            .ok_or_else(|| "STACKSxSLICES, each from 1 to 64".to_owned())
    }
}

impl std::fmt::Display for DirectionCounts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.stacks, self.slices)
    }
}

/// Two lengths in metres, the second at least as large as the first: `0.5,20`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The least.
    pub low_m: f64,
    /// The greatest.
    pub high_m: f64,
}

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (low, high) = text.split_once(',').unwrap_or((text, ""));
        let metres = |text: &str| number(text.trim(), 0.0, 1e9);
        metres(low)
            .zip(metres(high))
            .filter(|(low, high)| low <= high && *high > 0.0)
            .map(|(low_m, high_m)| Self { low_m, high_m })
            .ok_or_else(|| {
                "LOW,HIGH in metres, each from 0 to 1e9, LOW at most HIGH, HIGH above 0".to_owned()
            })
    }
}

/// Sides of reflective shadow maps: `256,512`, or `none`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sizes(pub Vec<u32>);

impl FromStr for Sizes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self(Vec::new()));
        }
        let all: Option<Vec<u32>> =
            text.split(',').map(|size| whole(size.trim(), 16, MAX_RSM)).collect();
        all.map(Self)
            .ok_or_else(|| "none, or sizes from 16 to 2,048 separated by commas".to_owned())
    }
}

pub(super) fn rsm(text: &str) -> Result<u32, String> {
    let size = whole(text, 0, MAX_RSM).filter(|size| *size == 0 || *size >= 16);
    size.ok_or_else(|| "0, or a whole number from 16 to 2,048".to_owned())
}

pub(super) fn metres(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1e6).ok_or_else(|| "a number of metres from 0 to 1e6".to_owned())
}

pub(super) fn scale(text: &str) -> Result<f64, String> {
    number(text, SCALES.0, SCALES.1).ok_or_else(|| "a number from 1e-6 to 1e6".to_owned())
}

pub(super) fn threshold(text: &str) -> Result<f64, String> {
    number(text, 1e-9, 1e9).ok_or_else(|| "a number from 1e-9 to 1e9".to_owned())
}

pub(super) fn share(text: &str) -> Result<f64, String> {
    number(text, 0.0, 1.0).ok_or_else(|| "a number from 0 to 1".to_owned())
}

pub(super) fn part(text: &str) -> Result<f64, String> {
    let accepted = || "a number above 0 and at most 1".to_owned();
    share(text).ok().filter(|part| *part > 0.0).ok_or_else(accepted)
}

pub(super) fn area_model(text: &str) -> Result<AreaModel, String> {
    text.parse().map_err(|_| ACCEPTED_AREA_MODELS.to_owned())
}

pub(super) fn shadow_model(text: &str) -> Result<ShadowModel, String> {
    text.parse().map_err(|_| ACCEPTED_SHADOW_MODELS.to_owned())
}

pub(super) fn table_size(text: &str) -> Result<usize, String> {
    let size = whole(text, 2, 1024).ok_or("a whole number from 2 to 1,024")?;
    Ok(size as usize)
}

pub(super) fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {}", u64::MAX))
}

pub(super) fn text(text: &str) -> Result<String, String> {
    if text.trim().is_empty() { Err("a name".to_owned()) } else { Ok(text.to_owned()) }
}

/// A parser of whole numbers within bounds.
pub(super) fn whole_from(
    least: u32,
    most: u32,
) -> impl Fn(&str) -> Result<u32, String> + Clone + Send + Sync {
    move |text| {
        let [low, high] = [least, most].map(|end| grouped(&end.to_string()));
        whole(text, least, most).ok_or_else(|| format!("a whole number from {low} to {high}"))
    }
}

/// A parser of numbers within bounds.
pub(super) fn number_from(
    least: f64,
    most: f64,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync {
    let shown = |end: f64| if end >= 1e5 { format!("{end:e}") } else { end.to_string() };
    move |text| {
        let (low, high) = (shown(least), shown(most));
        number(text, least, most).ok_or_else(|| format!("a number from {low} to {high}"))
    }
}

fn number(text: &str, least: f64, most: f64) -> Option<f64> {
    // No range contains NaN.
    text.parse().ok().filter(|number| (least..=most).contains(number))
}

fn whole(text: &str, least: u32, most: u32) -> Option<u32> {
    text.parse().ok().filter(|number| (least..=most).contains(number))
}

pub(super) fn tests(text: &str) -> Result<FrustumTests, String> {
    accepted(text.parse())
}

pub(super) fn light_order(text: &str) -> Result<LightOrder, String> {
    accepted(text.parse())
}

/// Turns a refused value into the text of what is accepted.
fn accepted<T>(parsed: Result<T, AssignError>) -> Result<T, String> {
    parsed.map_err(|error| match error {
        AssignError::Parameter { accepted, .. } => accepted,
        other => other.to_string(),
    })
}
