//! Far area lights as points (`--area-lod`): what the image loses, by the solid angle below which a light is a point.
//!
//! The lights cast no shadows, so that errors come from the points alone, beside those of the pipeline.

use super::cells::{METRIC, error, on_software};
use super::jobs::{LOD, LOD_TRUTH, extent_of, lit};
use super::page::charts::{against_truth, dashed};
use crate::{
    chart::{Axis, Marks, Point, Scale, Series},
    cli::StudyArgs,
    image_errors::ERROR_METRICS,
    report::{
        column::Column,
        format::{difference, significant},
        markup::Html,
        table::{Look, Row, Table},
    },
    results::{Errors, Record},
    strategy::BASELINE,
    study::{
        claims::order::Order,
        data::{Entry, entries},
        job::Job,
        manifest::Done,
        page::{error_columns::error_columns, figure::Charts, part::Part},
        scene::StudyScene,
    },
};

/// The number of lights.
const LIGHTS: &str = "16";

/// The solid angles below which they become points, steradians: in full and quick.
const ANGLES: [&[&str]; 2] = [&["0.003", "0.01", "0.03", "0.1", "0.3", "1"], &["0.01", "0.3"]];

/// The jobs of a scene: the truth, all lights with their outlines, and each solid angle.
pub(crate) fn jobs(args: &StudyArgs, scene: &StudyScene, range_m: f32) -> Vec<Job> {
    let study = extent_of(args);
    let drawn = lit(args, scene, study.lights_size, range_m);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).chain(["--lights", LIGHTS]).collect();
    let truth = [&["truth"], &drawn[..], &["--samples", study.lights_samples]].concat();
    let timed = ["--frames", study.frames, "--warmup", study.warmup, "--truth", "none"];
    let compare = |variant: &str, more: &[&str]| {
        let words = [&["compare", "--strategies", BASELINE], &drawn[..], &timed, more].concat();
        Job::new(scene, LOD, variant, &words)
    };
    let mut jobs = vec![Job::new(scene, LOD_TRUTH, "", &truth), compare("off", &[])];
    let angles = ANGLES[usize::from(args.quick)];
    jobs.extend(angles.iter().map(|angle| compare(angle, &["--area-lod", angle])));
    jobs
}

const NOTE: &str = "An area light that looks smaller than the solid angle is lit as a point. The dashed line is the image in \
     which all lights keep their outlines. Errors are those against the truth without shadows. Times of a software adapter \
     say nothing of a GPU.";

/// The part of a scene's page; empty without records.
pub(crate) fn part(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = entries(done, scene, LOD);
    let mut body = Html::default();
    if !all.is_empty() {
        body = chart(scene, &all, charts);
        body += table(&all);
    }
    Part::new(LOD, "Far area lights as points", NOTE, body)
}

/// The image in which all lights keep their outlines.
fn whole<'a>(all: &[Entry<'a>]) -> Option<&'a Record> {
    all.iter().map(|entry| entry.record).find(|record| record.setting.area_lod.is_none())
}

fn chart(scene: &str, all: &[Entry<'_>], charts: &mut Charts) -> Html {
    let Some(metric) = ERROR_METRICS.iter().find(|known| known.id == METRIC) else {
        return Html::default();
    };
    let point = |entry: &Entry<'_>| {
        let angle = entry.record.setting.area_lod?;
        let error = error(entry.record, metric.id)?;
        let tip = format!("{} sr\n{} {}", significant(angle), metric.head, difference(error));
        Some(Point::new(angle, error, tip))
    };
    let mut points: Vec<Point> = all.iter().filter_map(point).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    if points.is_empty() {
        return Html::default();
    }
    let mut series =
        vec![Series::new("points below the angle", "series-0", Marks::LineAndPoints, points)];
    if let Some(floor) = whole(all).and_then(|record| error(record, metric.id)) {
        series.push(dashed("all outlines", floor, metric, &series));
    }
    let place = Axis::new("A light is a point below", "sr", Scale::Log);
    let title = "Error of far area lights as points";
    against_truth(charts, &format!("{scene}-{LOD}"), title, metric, place, series)
}

fn table(all: &[Entry<'_>]) -> Html {
    fn errors_of(record: &Record) -> &Errors {
        &record.image.truth_errors
    }
    let row = |entry: &Entry<'_>| {
        let name = match entry.record.setting.area_lod {
            Some(angle) => format!("points below {} sr{}", significant(angle), entry.mark()),
            None => format!("all outlines{}", entry.mark()),
        };
        Row::new(name, entry.record.clone())
    };
    let mut columns: Vec<Column<'_, Record>> = error_columns(errors_of).collect();
    columns.push(Column::ms("shade", |record: &Record| Some(record.times.shade_ms)).id("shade_ms"));
    Table::new("image", columns, all.iter().map(row).collect())
        .competing(|_| false)
        .html("Far area lights as points", Look::Plain)
}

/// The largest solid angle up to which no error is clearly above that of all outlines, and the shading time that it saves:
/// times only where a GPU took them.
pub(crate) fn finding(done: &Done, scene: &str) -> Option<String> {
    let all = entries(done, scene, LOD);
    let whole = whole(&all)?;
    let floor = error(whole, METRIC)?;
    let mut by_angle: Vec<(f64, &Record)> = all
        .iter()
        .filter_map(|entry| Some((entry.record.setting.area_lod?, entry.record)))
        .collect();
    by_angle.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_kept = |record: &Record| {
        error(record, METRIC).is_some_and(|error| Order::of_figures(floor, error) != Order::Less)
    };
    let kept = by_angle.iter().take_while(|(_, record)| is_kept(record)).last();
    let outlines = format!("all outlines have a FLIP of {} against the truth", difference(floor));
    let Some(&(angle, record)) = kept else {
        return Some(format!(
            "In {scene}, {outlines}, and the smallest tested solid angle of --area-lod raises it by more than 5 %."
        ));
    };
    let times = match on_software(done) {
        true => String::new(),
        false => format!(
            " Shading then takes {} instead of {} ms.",
            significant(record.times.shade_ms),
            significant(whole.times.shade_ms)
        ),
    };
    Some(format!(
        "In {scene}, {outlines}. With points below {} sr (--area-lod) it is at most 5 % above that ({}).{times}",
        significant(angle),
        difference(error(record, METRIC)?)
    ))
}
