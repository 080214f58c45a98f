//! Charts of errors along one sweep, one panel per metric, with the floor as a dashed line.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::grouping::grouped_by;
use crate::image_errors::{ERROR_METRICS, ErrorMetric};
use crate::report::format::{difference, number};
use crate::report::markup::{Html, html};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::shadows::cells::{Adaptive, Rays, adaptive, error, floor_of, maps, rays};

/// The metrics of the panels, the first in front.
const METRICS: [&str; 2] = ["flip", "rel_mse"];

/// What varies along the horizontal axis of a chart.
pub(crate) struct Sweep {
    /// The section of its jobs, and its name on the page.
    pub(crate) section: &'static str,
    pub(crate) title: &'static str,
    /// How to read it.
    pub(crate) note: &'static str,
    /// The axis: its label and its unit.
    pub(crate) axis: (&'static str, &'static str),
    /// Where a record stands on it.
    pub(crate) x: fn(&Entry<'_>) -> Option<u32>,
    /// The line that a record belongs to.
    pub(crate) series: fn(&Entry<'_>) -> String,
    /// Whether P of the same lights is known.
    pub(crate) has_floor: bool,
}

/// The charts of a sweep; nothing without errors.
pub(crate) fn swept(done: &Done, scene: &str, sweep: &Sweep, charts: &mut Charts) -> Html {
    let all = entries(done, scene, sweep.section);
    let mut shown: Vec<(String, Html)> = Vec::new();
    for metric in METRICS {
        let Some(metric) = ERROR_METRICS.iter().find(|known| known.id == metric) else { continue };
        let known = all.iter().filter_map(|entry| {
            let y = error(entry.record, metric.id)?;
            let x = (sweep.x)(entry)?;
            let tip = format!("{}\n{} {}", name(entry), metric.head, difference(y));
            Some(((sweep.series)(entry), Point::new(f64::from(x), y, tip)))
        });
        let lines = grouped_by(known);
        if lines.is_empty() {
            continue;
        }
        let mut series: Vec<Series> = lines
            .into_iter()
            .enumerate()
            .map(|(ix, (name, mut points))| {
                points.sort_by(|a, b| a.x.total_cmp(&b.x));
                Series::new(name, format!("series-{ix}"), Marks::LineAndPoints, points)
            })
            .collect();
        if let Some(floor) = floor_of(done, scene, metric.id).filter(|_| sweep.has_floor) {
            series.push(dashed("P, exact shares", floor, metric, &series));
        }
        let (label, unit) = sweep.axis;
        let place = Axis::new(label, unit, Scale::Log);
        let slug = format!("{scene}-{}", sweep.section);
        let body = against_truth(charts, &slug, sweep.title, metric, place, series);
        shown.push((metric.head.to_owned(), body));
    }
    panels("Metric of error", &shown)
}

/// A dashed line at one error, from the least to the greatest place of other lines.
pub(crate) fn dashed(name: &str, error: f64, metric: &ErrorMetric, others: &[Series]) -> Series {
    let tip = format!("{name}\n{} {}", metric.head, difference(error));
    let places = || others.iter().flat_map(|series| series.points.iter().map(|point| point.x));
    let ends = [f64::min, f64::max].map(|end| places().reduce(end));
    let points = ends.into_iter().flatten().map(|x| Point::new(x, error, tip.clone()));
    Series::new(name, "", Marks::Dashed, points.collect())
}

/// A chart of errors against the truth, with what the metric means.
pub(crate) fn against_truth(
    charts: &mut Charts,
    slug: &str,
    title: &str,
    metric: &ErrorMetric,
    place: Axis,
    series: Vec<Series>,
) -> Html {
    let error = Axis::new(format!("{} against the truth", metric.head), metric.unit, Scale::Log);
    let chart = XyChart::new(format!("{title}: {}", metric.head), [place, error], series);
    let mut body = charts.xy(&format!("{slug}-{}", metric.id), &chart);
    body += html!("<p class=\"note\">{}</p>\n", metric.about);
    body
}

/// `4 lights, 25 maps of 112\u{b2}, 9 taps`: the name of a record.
pub(crate) fn name(entry: &Entry<'_>) -> String {
    let record = entry.record;
    let lights = match record.setting.lights {
        1 => "1 light".to_owned(),
        lights => format!("{} lights", number(lights as f64)),
    };
    if let Some(Adaptive { px, down, maps: [least, most], .. }) = adaptive(record) {
        let count = if least == most { most.to_string() } else { format!("{least} to {most}") };
        let px = number(f64::from(px));
        return format!("{lights}, {count} maps of {px}\u{b2}, adaptive at 1/{down}");
    }
    if let Some(Rays { rays, images, px }) = rays(record) {
        let count = if rays == 1 { "1 ray".to_owned() } else { format!("{rays} rays") };
        let px = number(f64::from(px));
        return format!("{lights}, {count} through {images} images of {px}\u{b2}");
    }
    let Some(maps) = maps(record) else {
        let model = record.setting.shadows.as_ref().map(|shadows| shadows.model.as_str());
        return format!("{lights}, {}", model.unwrap_or("no shadows"));
    };
    let count = if maps.maps == 1 { "1 map".to_owned() } else { format!("{} maps", maps.maps) };
    let taps = if maps.taps == 1 { String::new() } else { format!(", {} taps", maps.taps) };
    format!("{lights}, {count} of {}\u{b2}{taps}", number(f64::from(maps.px)))
}
