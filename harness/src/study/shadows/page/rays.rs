//! Rays through deep images beside maps: the chart of errors, and what they take.

use super::charts::{Sweep, name, swept};
use crate::report::format::{difference, significant};
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::shadows::cells::{METRIC, error, fell_back, maps, on_software, rays};
use crate::study::shadows::jobs::{MAPS, RAYS, SIDES};

const SWEEP: Sweep = Sweep {
    section: RAYS,
    title: "Rays through deep images in place of maps",
    note: "Rays and maps have the same points on the lights, so only the test differs. Images of more pixels have finer \
           shadows. One set of images serves all lights. The dashed line is P.",
    axis: ("Points of each light", ""),
    x: |entry| Some(entry.record.setting.shadows.as_ref()?.maps_per_area_light),
    series: |entry| match (rays(entry.record), maps(entry.record)) {
        (Some(rays), _) => format!("rays, images of {}\u{b2}", rays.px),
        (None, Some(maps)) => format!("maps of {}\u{b2}", maps.px),
        (None, None) => "no shadows".to_owned(),
    },
    has_floor: true,
};

/// The part of a scene's page; empty without records.
pub(super) fn part(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    Part::new(RAYS, SWEEP.title, SWEEP.note, swept(done, scene, &SWEEP, charts))
}

fn shade_ms(record: &Record) -> Option<f64> {
    Some(record.times.shade_ms).filter(|ms| ms.is_finite())
}

/// The image of the least error.
fn best<'a>(all: impl Iterator<Item = Entry<'a>>) -> Option<(Entry<'a>, f64)> {
    let known = all.filter_map(|entry| Some((entry, error(entry.record, METRIC)?)));
    known.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The rays of the least error, the maps of the least error from as many points, and where a GPU took times, the maps of the least
/// error among those that take no longer to shade.
pub(super) fn finding(done: &Done, scene: &str) -> Option<String> {
    let all = entries(done, scene, RAYS);
    let of_rays = all.iter().copied().filter(|entry| rays(entry.record).is_some());
    let (entry, flip) = best(of_rays)?;
    let count = rays(entry.record)?.rays;
    let mut told =
        format!("In {scene}, FLIP against the truth is {} with {}", difference(flip), name(&entry));
    let every_map = [RAYS, MAPS, SIDES].map(|section| entries(done, scene, section)).concat();
    let is_map = |entry: &Entry<'_>| maps(entry.record).is_some() && !fell_back(entry.record);
    let alike = every_map.iter().copied().filter(is_map);
    let alike = alike.filter(|entry| maps(entry.record).is_some_and(|maps| maps.maps == count));
    if let Some((other, flip)) = best(alike) {
        told += &format!(", and {} with {}", difference(flip), name(&other));
    }
    told += ".";
    if on_software(done) {
        return Some(told);
    }
    let ms = shade_ms(entry.record)?;
    told += &format!(" The rays take {} ms to shade", significant(ms));
    if !every_map.iter().filter(|entry| is_map(entry)).any(|entry| shade_ms(entry.record).is_some())
    {
        return Some(told + ".");
    }
    let is_fast = |entry: &Entry<'_>| {
        shade_ms(entry.record).is_some_and(|other| Order::of_figures(other, ms) != Order::More)
    };
    let faster = every_map.iter().copied().filter(is_map).filter(is_fast);
    told += &match best(faster) {
        None => ", less than all maps that were measured.".to_owned(),
        Some((other, flip)) => format!(
            ". Of the maps that take at most 5 % longer, {} have the least FLIP, {}.",
            name(&other),
            difference(flip)
        ),
    };
    Some(told)
}
