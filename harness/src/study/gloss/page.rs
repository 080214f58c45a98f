//! The page of gloss: errors and costs by reach, as a table, a chart and pictures.

use super::jobs::REACH;
use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::grouping::grouped_by;
use crate::report::column::{Better, Column};
use crate::report::format::{difference, number, percent, short_adapter, significant};
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::{Mode, Record};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::page::pictures::figure;
use crate::study::page::shots::Shots;

const TABLE_NOTE: &str = "The reach is the most ranges that a specular term extends; 1 ends it with the diffuse term. Errors are those \
     against lights without a range, so they also count the diffuse light that ranges cut off, which no reach gives \
     back. Missing energy is the luminance that an image lacks, as a share of all luminance. Channels that differ are \
     counted against no culling with the same reach, in deferred and forward mode together. Lists, times and errors \
     are of deferred mode.";

const CHART_NOTE: &str = "Each point is a reach. A line joins the reaches of one method, from 1.";

const PICTURES_NOTE: &str = "The same exposure and tone curve for all. The light that an image lacks is the difference from lights without a \
     range.";

/// The error that charts and sentences show.
const ERROR: &str = "highlights";

/// The most ranges that specular terms of a record reach.
fn reach(record: &Record) -> f64 {
    record.setting.specular_reach.unwrap_or(1.0)
}

fn error(record: &Record, id: &str) -> Option<f64> {
    record.image.unbounded_errors.get(id).copied().flatten()
}

/// The records of clusters in one mode, by reach.
fn clusters<'a>(done: &'a Done, scene: &'a str, mode: Mode) -> Vec<Entry<'a>> {
    let mut all = entries(done, scene, REACH);
    all.retain(|entry| entry.record.setting.mode == mode && !entry.record.is_baseline());
    all
}

/// Whether lights come through the hierarchy.
fn is_bvh(record: &Record) -> bool {
    record.strategy.is_bvh()
}

/// The parts of a scene's section.
pub(crate) fn parts(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let all = clusters(done, scene, Mode::Deferred);
    vec![
        Part::new("reach", "Error and cost by reach", TABLE_NOTE, table(done, scene, &all)),
        Part::new("chart", "Speed against accuracy", CHART_NOTE, chart(scene, &all, charts)),
        Part::new("pictures", "What ranges cut off", PICTURES_NOTE, pictures(&all, shots)),
    ]
}

/// A row per method and reach.
fn table(done: &Done, scene: &str, all: &[Entry<'_>]) -> Html {
    if all.is_empty() {
        return Html::default();
    }
    let forward = clusters(done, scene, Mode::Forward);
    let error_of = |id: &'static str, head, unit, show| {
        let value = move |record: &&Record| error(record, id);
        Column::figure(head, unit, Better::Less, value, show).id(id)
    };
    let differing = |record: &&Record| {
        let same = |other: &&Entry<'_>| other.record.strategy == record.strategy;
        let other = forward.iter().find(same).and_then(|e| e.record.image.differing_channels);
        let channels = record.image.differing_channels?;
        Some((channels + other.unwrap_or(0)) as f64)
    };
    let columns = [
        Column::figure("reach", "ranges", Better::Neither, |r: &&Record| Some(reach(r)), number),
        Column::figure(
            "listed",
            "/sample",
            Better::Less,
            |record: &&Record| record.lists.listed_per_sample,
            significant,
        )
        .id("listed"),
        Column::ms("assign", |record: &&Record| Some(record.times.assign_ms)),
        Column::ms("shade", |record: &&Record| Some(record.times.shade_ms)),
        Column::ms("assign + shade", |record: &&Record| Some(record.assign_and_shade_ms()))
            .id("both_ms"),
        error_of("missing_energy", "missing energy", "%", percent),
        error_of("highlights", "highlights", "", difference),
        error_of("rel_mse", "relMSE", "", difference),
        error_of("flip", "FLIP", "", difference),
        Column::figure("channels that differ", "", Better::Zero, differing, number).id("differing"),
    ];
    let records = all.iter().map(|entry| entry.record);
    let rows = records.map(|record| Row::new(record.strategy.to_string(), record)).collect();
    Table::new("method", columns, rows)
        .competing(|_| false)
        .dotted(|record| record.strategy.class())
        .html("Error and cost by reach", Look::Plain)
}

/// The error against the time to assign and shade.
fn chart(scene: &str, all: &[Entry<'_>], charts: &mut Charts) -> Html {
    let point = |record: &Record| {
        let ms = record.assign_and_shade_ms();
        let error = error(record, ERROR).filter(|error| error.is_finite() && ms.is_finite())?;
        let tip = format!(
            "{}\n{} ms\nerror of highlights {}",
            record.strategy,
            significant(ms),
            difference(error)
        );
        Some(Point { label: number(reach(record)), ..Point::new(ms, error, tip) })
    };
    let by_source = grouped_by(all.iter().map(|entry| (is_bvh(entry.record), entry.record)));
    let series = by_source.into_iter().map(|(is_bvh, records)| {
        let name = if is_bvh { "through the hierarchy" } else { "from the linear list" };
        let points: Vec<Point> = records.iter().filter_map(|record| point(record)).collect();
        let class = records.first().map(|record| record.strategy.class()).unwrap_or_default();
        Series::new(name, class, Marks::LineAndPoints, points)
    });
    let axes = [
        Axis::new("Assign + shade", "ms", Scale::Log),
        Axis::new("Error of highlights against lights without a range", "", Scale::Log),
    ];
    let series: Vec<Series> = series.collect();
    if series.iter().all(|series| series.points.is_empty()) {
        return Html::default();
    }
    let chart = XyChart::new("Error by reach", axes, series);
    charts.xy(&format!("{scene}-reach"), &chart)
}

/// The image of the shortest and of the longest reach, that of lights without a range, and what both images lack.
fn pictures(all: &[Entry<'_>], shots: &mut Shots<'_>) -> Html {
    let linear: Vec<&Entry<'_>> = all.iter().filter(|entry| !is_bvh(entry.record)).collect();
    let (Some(first), Some(last)) = (linear.first(), linear.last()) else {
        return Html::default();
    };
    // One exposure for all.
    let exposure = first.record.image.files.exposure.unwrap_or(1.0);
    let mut shown = Html::default();
    let truth = first.record.image.files.raw_unbounded.as_deref();
    let truth = truth.and_then(|name| shots.linear(&first.job.name, name, exposure));
    shown += figure(truth, "Lights without a range", "no culling.");
    for entry in [first, last] {
        let (job, files) = (entry.job.name.as_str(), &entry.record.image.files);
        let (Some(raw), Some(unbounded)) = (files.raw.as_deref(), files.raw_unbounded.as_deref())
        else {
            continue;
        };
        let image = shots.linear(job, raw, exposure);
        let lost = shots.lost(job, [raw, unbounded], exposure);
        let name = format!("Reach {}", number(reach(entry.record)));
        shown += figure(image, &name, "specular terms end there, or before.");
        shown += figure(lost, &format!("{name}, what is missing"), "exposed as the others.");
    }
    html!("<div class=\"views\">{}</div>\n", shown)
}

/// The records of one source with the shortest and the longest reach.
fn ends<'a>(all: &[Entry<'a>]) -> Option<[&'a Record; 2]> {
    let through: Vec<&Record> =
        all.iter().map(|entry| entry.record).filter(|record| is_bvh(record)).collect();
    let (first, last) = (through.first()?, through.last()?);
    (reach(first) < reach(last)).then_some([*first, *last])
}

/// What a reach gains and costs in one scene.
fn sentence(done: &Done, scene: &str) -> Option<String> {
    let [near, far] = ends(&clusters(done, scene, Mode::Deferred))?;
    let [near_error, far_error] = [error(near, ERROR)?, error(far, ERROR)?];
    Some(format!(
        "in {scene}, a reach of {} ranges takes the error of highlights against lights without a range from {} to {}, listed lights per \
         sample from {} to {}, and assign + shade from {} to {} ms",
        number(reach(far)),
        difference(near_error),
        difference(far_error),
        significant(near.lists.listed_per_sample?),
        significant(far.lists.listed_per_sample?),
        significant(near.assign_and_shade_ms()),
        significant(far.assign_and_shade_ms()),
    ))
}

/// The first scene that has figures.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let sentence = done.scenes().into_iter().find_map(|scene| sentence(done, scene))?;
    let adapter = short_adapter(&done.results.values().next()?.machine.adapter);
    Some(format!("On {adapter}, {sentence}."))
}

/// What a scene found.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let mut all: Vec<String> = sentence(done, scene)
        .map(|sentence| sentence.replacen("in ", "In ", 1) + ".")
        .into_iter()
        .collect();
    let modes = [Mode::Deferred, Mode::Forward].map(|mode| clusters(done, scene, mode)).concat();
    let wrong: Vec<&Entry<'_>> =
        modes.iter().filter(|entry| entry.record.image.differing_channels != Some(0)).collect();
    if let Some(first) = wrong.first() {
        all.push(format!(
            "In {scene}, {} images differ from no culling with the same reach, the first that of {} in mode {}.",
            wrong.len(),
            first.record.strategy,
            first.record.setting.mode.name()
        ));
    }
    all
}
