//! P against T by roughness: what multiplying by visible shares costs, whatever the shares come from.
//!
//! A visible share takes from diffuse and specular light alike. The smoother a surface, the fewer points of an emitter its
//! highlight shows, and the less their visibility has to do with that of the whole emitter. Each pair of truth images has
//! one roughness on all surfaces.

use super::cells::METRIC;
use super::jobs::{Extent, Lights};
use crate::{
    chart::{Axis, Marks, Point, Scale, Series, XyChart},
    image_errors::ERROR_METRICS,
    report::{
        format::{difference, significant},
        markup::{Html, html},
        table::{Look, Row, Table},
    },
    results::{Errors, TruthImage},
    study::{
        job::Job,
        manifest::Done,
        page::{error_columns::error_columns, figure::Charts, part::Part},
        scene::StudyScene,
    },
};

/// The section of P at each roughness.
pub(crate) const SEPARATED_BY: &str = "separated-roughness";
/// The section of T at each roughness.
pub(crate) const TRUTH_BY: &str = "truth-roughness";

/// The setting of both: the roughness of all surfaces.
const ROUGHNESS: &str = "roughness";

/// The jobs of a scene.
pub(crate) fn jobs(scene: &StudyScene, extent: &Extent, lights: &Lights) -> Vec<Job> {
    let truth = |section: &str, roughness: f64, more: &[&str]| {
        let value = roughness.to_string();
        let words = ["--samples", extent.samples, "--lights", &lights.count, "--roughness", &value];
        let words = [&["truth", "--shadows"], &lights.options()[..], &words, more].concat();
        Job::new(scene, section, &value, &words).with(ROUGHNESS, &value)
    };
    let pair = |roughness: &f64| {
        [truth(TRUTH_BY, *roughness, &[]), truth(SEPARATED_BY, *roughness, &["--separated"])]
    };
    extent.roughnesses.iter().flat_map(pair).collect()
}

const NOTE: &str = "P has the exact visible share of each light, times its exact light without shadows. T is the truth. All \
     surfaces have one roughness and are no metal. No model of visible shares has a smaller error than P, but for what its \
     own errors happen to make up for.";

/// The errors of P by roughness, ascending.
fn errors<'a>(done: &'a Done, scene: &'a str) -> Vec<(f64, &'a TruthImage)> {
    let known = done.section(scene, SEPARATED_BY).filter_map(|(job, results)| {
        let image = results.truth_image.as_ref()?;
        let roughness = job.settings.number(ROUGHNESS)?;
        (!image.against_errors.is_empty()).then_some((roughness, image))
    });
    let mut all: Vec<(f64, &TruthImage)> = known.collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

fn error(image: &TruthImage, metric: &str) -> Option<f64> {
    image.against_errors.get(metric).copied().flatten().map(f64::abs)
}

/// The part of a scene's page; empty without errors.
pub(crate) fn part(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = errors(done, scene);
    let mut body = Html::default();
    if !all.is_empty() {
        body = chart(scene, &all, charts);
        body += table(&all);
    }
    Part::new(SEPARATED_BY, "What visible shares cost, by roughness", NOTE, body)
}

fn chart(scene: &str, all: &[(f64, &TruthImage)], charts: &mut Charts) -> Html {
    let Some(metric) = ERROR_METRICS.iter().find(|known| known.id == METRIC) else {
        return Html::default();
    };
    let point = |(roughness, image): &(f64, &TruthImage)| {
        let error = error(image, metric.id)?;
        let tip =
            format!("roughness {}\n{} {}", significant(*roughness), metric.head, difference(error));
        Some(Point::new(*roughness, error, tip))
    };
    let points: Vec<Point> = all.iter().filter_map(point).collect();
    let series = Series::new("P, exact shares", "series-0", Marks::LineAndPoints, points);
    let axes = [
        Axis::new("Roughness of all surfaces", "", Scale::Log),
        Axis::new(format!("{} against the truth", metric.head), metric.unit, Scale::Log),
    ];
    let title = format!("Error of exact visible shares by roughness: {}", metric.head);
    let mut body = charts.xy(
        &format!("{scene}-{SEPARATED_BY}-{}", metric.id),
        &XyChart::new(title, axes, vec![series]),
    );
    body += html!("<p class=\"note\">{}</p>\n", metric.about);
    body
}

fn table(all: &[(f64, &TruthImage)]) -> Html {
    fn errors_of<'r>(image: &'r TruthImage) -> &'r Errors {
        &image.against_errors
    }
    let row = |(roughness, image): &(f64, &TruthImage)| {
        Row::new(format!("P, roughness {}", significant(*roughness)), (*image).clone())
    };
    Table::new("image", error_columns(errors_of), all.iter().map(row).collect())
        .competing(|_| false)
        .html("Exact visible shares against the truth, by roughness", Look::Plain)
}

/// `In atrium, exact visible shares (P) have a FLIP of 0.0121 where all surfaces have roughness 0.1, and of 0.0008 at
/// roughness 1.`
pub(crate) fn finding(done: &Done, scene: &str) -> Option<String> {
    let all = errors(done, scene);
    let (first, last) = (all.first()?, all.last()?);
    (first.0 < last.0).then_some(())?;
    Some(format!(
        "In {scene}, exact visible shares (P) have a FLIP of {} where all surfaces have roughness {}, and of {} at \
         roughness {}.",
        difference(error(first.1, METRIC)?),
        significant(first.0),
        difference(error(last.1, METRIC)?),
        significant(last.0)
    ))
}
