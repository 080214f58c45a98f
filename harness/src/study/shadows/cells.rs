//! What the page and the claims read of a record: its shadow maps and its errors.

use shading::ShadowModel;

use super::jobs::{ATLAS, DISTANCE, MAPS, NONE, PIPELINE, SEPARATED};
use crate::results::{DeviceType, Errors, Record};
use crate::study::claims::order::Order;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;

/// The metric by which claims and sentences compare images.
pub(crate) const METRIC: &str = "flip";

/// The shadow maps of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Maps {
    /// Maps of each area light.
    pub(crate) maps: u32,
    /// The side of a face, texels.
    pub(crate) px: u32,
    /// Texels that a look-up compares.
    pub(crate) taps: u32,
}

/// The shadow maps of a record; `None` without maps, and where frames subdivided the lights.
pub(crate) fn maps(record: &Record) -> Option<Maps> {
    let setting = record.setting.shadows.as_ref()?;
    match setting.model.parse().ok()? {
        ShadowModel::Maps { px, taps, .. } => {
            Some(Maps { maps: setting.maps_per_area_light, px, taps })
        }
        ShadowModel::None
        | ShadowModel::Adaptive { .. }
        | ShadowModel::Pcss { .. }
        | ShadowModel::Paraboloids { .. }
        | ShadowModel::Cdi { .. } => None,
    }
}

/// The rays of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rays {
    /// Rays to each area light.
    pub(crate) rays: u32,
    /// Deep images that they cross, one for each direction.
    pub(crate) images: u32,
    /// The side of an image, pixels.
    pub(crate) px: u32,
}

/// The rays of a record; `None` without rays.
pub(crate) fn rays(record: &Record) -> Option<Rays> {
    let setting = record.setting.shadows.as_ref()?;
    let ShadowModel::Cdi { rays } = setting.model.parse().ok()? else { return None };
    let deep = setting.deep.as_ref()?;
    Some(Rays { rays, images: deep.directions(), px: deep.size_px })
}

/// The shadow maps of a record whose frames subdivided the lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Adaptive {
    /// The side of a face, texels.
    pub(crate) px: u32,
    /// Pixels along an axis of which one was tested for bands.
    pub(crate) down: u32,
    /// The fewest and the most maps of a rectangle.
    pub(crate) maps: [u32; 2],
    /// Frames until the maps had settled.
    pub(crate) frames: u32,
    /// The time of the test for bands, ms; `None` if there was nothing to test.
    pub(crate) banding_ms: Option<f64>,
}

/// The shadow maps of a record whose frames subdivided the lights; `None` of others.
pub(crate) fn adaptive(record: &Record) -> Option<Adaptive> {
    let setting = record.setting.shadows.as_ref()?;
    let ShadowModel::Adaptive { px, down, .. } = setting.model.parse().ok()? else { return None };
    let found = setting.adaptive.as_ref()?;
    let maps = found.maps_of_rectangles.iter().copied();
    let maps = [maps.clone().min().unwrap_or_default(), maps.max().unwrap_or_default()];
    let banding_ms = found.banding_ms.filter(|ms| ms.is_finite());
    Some(Adaptive { px, down, maps, frames: found.frames, banding_ms })
}

/// The time of a frame whose lights move, ms: drawing all maps, the test for bands if there is one, and shading.
pub(crate) fn moving_ms(record: &Record) -> Option<f64> {
    let shadows = record.setting.shadows.as_ref()?;
    let test = shadows.adaptive.as_ref().and_then(|adaptive| adaptive.banding_ms);
    let sum = shadows.draw_ms? + test.unwrap_or(0.0) + record.times.shade_ms;
    sum.is_finite().then_some(sum)
}

/// The distance between camera and light of a job that approaches it, metres.
pub(crate) fn distance_m(entry: &Entry<'_>) -> Option<f64> {
    entry.job.settings.number(DISTANCE)
}

/// An error against T, without its sign; `None` where it was not measured.
pub(crate) fn error(record: &Record, metric: &str) -> Option<f64> {
    finite(&record.image.truth_errors, metric)
}

/// An error without its sign; `None` where it was not measured.
pub(crate) fn finite(errors: &Errors, metric: &str) -> Option<f64> {
    let error = errors.get(metric).copied().flatten().map(f64::abs);
    error.filter(|error| error.is_finite())
}

/// The errors of P against T; `None` where they were not measured.
pub(crate) fn floor<'a>(done: &'a Done, scene: &'a str) -> Option<&'a Errors> {
    let truth = |(_, results): (_, &'a crate::results::Results)| results.truth_image.as_ref();
    let errors = &done.section(scene, SEPARATED).find_map(truth)?.against_errors;
    (!errors.is_empty()).then_some(errors)
}

/// An error of P against T.
pub(crate) fn floor_of(done: &Done, scene: &str, metric: &str) -> Option<f64> {
    finite(floor(done, scene)?, metric)
}

/// The error of the pipeline without shadows against the truth without shadows; `None` where it was not measured.
pub(crate) fn pipeline_of(done: &Done, scene: &str, metric: &str) -> Option<f64> {
    error(entries(done, scene, PIPELINE).first()?.record, metric)
}

/// The record without shadows.
pub(crate) fn without<'a>(done: &'a Done, scene: &'a str) -> Option<Entry<'a>> {
    entries(done, scene, NONE).first().copied()
}

/// The side of the atlas that a job fills, texels; `None` of jobs with a fixed side of maps.
pub(crate) fn atlas(entry: &Entry<'_>) -> Option<u32> {
    entry.job.settings.number(ATLAS).map(|px| px as u32)
}

/// Whether a software adapter measured anything: its times say nothing of a GPU.
pub(crate) fn on_software(done: &Done) -> bool {
    done.results.values().any(|results| results.machine.device_type == DeviceType::Cpu)
}

/// One number of maps in an atlas, with its error.
pub(crate) type Step = (Maps, f64);

/// The errors by the number of maps in an atlas of this side, ascending. A device that got fewer maps than asked for
/// has none of that number.
pub(crate) fn steps(done: &Done, scene: &str, atlas_px: u32) -> Vec<Step> {
    let mut steps: Vec<Step> = entries(done, scene, MAPS)
        .iter()
        .filter(|entry| atlas(entry) == Some(atlas_px) && !fell_back(entry.record))
        .filter_map(|entry| Some((maps(entry.record)?, error(entry.record, METRIC)?)))
        .collect();
    steps.sort_by_key(|(maps, _)| maps.maps);
    steps
}

/// Whether area lights got fewer maps than their model asks for.
pub(crate) fn fell_back(record: &Record) -> bool {
    record.setting.shadows.as_ref().is_some_and(|setting| {
        let asked = setting.model.parse().map_or(0, ShadowModel::maps);
        setting.maps_per_area_light < asked
    })
}

/// The sides of the atlases of [`MAPS`] that were measured, ascending.
pub(crate) fn atlases(done: &Done, scene: &str) -> Vec<u32> {
    let mut all: Vec<u32> = entries(done, scene, MAPS).iter().filter_map(atlas).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The step of the least error, and those that are not clearly above it, in the order of their maps. Errors of single
/// images tie by the rule of single figures ([`Order::of_figures`]).
pub(crate) fn least(steps: &[Step]) -> Vec<Step> {
    let Some(least) = steps.iter().map(|step| step.1).min_by(f64::total_cmp) else {
        return Vec::new();
    };
    let ties = |step: &&Step| step.1 == least || Order::of_figures(least, step.1) != Order::Less;
    steps.iter().filter(ties).copied().collect()
}
