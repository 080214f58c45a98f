//! P against T by roughness: what multiplying by visible shares costs, whatever the shares come from.
//!
//! A visible share takes from diffuse and specular light alike. The smoother a surface, the fewer points of an emitter its
//! highlight shows, and the less their visibility has to do with that of the whole emitter. Each pair of truth images has
//! one roughness on all surfaces.

use super::cells::{METRIC, finite};
use super::jobs::{FEW, SEPARATED_BY, TRUTH_BY, extent_of, lit};
use super::page::charts::against_truth;
use crate::{
    chart::{Axis, Marks, Point, Scale, Series},
    cli::StudyArgs,
    image_errors::ERROR_METRICS,
    report::{
        format::{difference, significant},
        markup::Html,
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

/// The setting of both: the roughness of all surfaces.
const ROUGHNESS: &str = "roughness";

/// Roughnesses, in full and quick.
const ROUGHNESSES: [&[&str]; 2] = [&["0.1", "0.2", "0.4", "0.7", "1"], &["0.2", "1"]];

/// The jobs of a scene: T and P of each roughness.
pub(crate) fn jobs(args: &StudyArgs, scene: &StudyScene, range_m: f32) -> Vec<Job> {
    let study = extent_of(args);
    let lit = lit(args, scene, study.lights_size, range_m);
    let lit: Vec<&str> = lit.iter().map(String::as_str).collect();
    let few = FEW.to_string();
    let truth = |section: &str, roughness: &str, more: &[&str]| {
        let words = ["--samples", study.samples, "--lights", &few, "--roughness", roughness];
        let words = [&["truth", "--shadows"], &lit[..], &words, more].concat();
        Job::new(scene, section, roughness, &words).with(ROUGHNESS, roughness)
    };
    let pair = |roughness: &&str| {
        [truth(TRUTH_BY, roughness, &[]), truth(SEPARATED_BY, roughness, &["--separated"])]
    };
    ROUGHNESSES[usize::from(args.quick)].iter().flat_map(pair).collect()
}

const NOTE: &str = "P has the exact visible share of each light, times its exact light without shadows. T is the truth. All \
     surfaces have one roughness and are no metal. A model of visible shares is closer to T than P only where \
     its own errors happen to cancel those of P.";

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
        let error = finite(&image.against_errors, metric.id)?;
        let tip =
            format!("roughness {}\n{} {}", significant(*roughness), metric.head, difference(error));
        Some(Point::new(*roughness, error, tip))
    };
    let points: Vec<Point> = all.iter().filter_map(point).collect();
    let series = Series::new("P, exact shares", "series-0", Marks::LineAndPoints, points);
    let place = Axis::new("Roughness of all surfaces", "", Scale::Log);
    let title = "Error of exact visible shares by roughness";
    against_truth(charts, &format!("{scene}-{SEPARATED_BY}"), title, metric, place, vec![series])
}

fn table(all: &[(f64, &TruthImage)]) -> Html {
    fn errors_of(image: &TruthImage) -> &Errors {
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
        difference(finite(&first.1.against_errors, METRIC)?),
        significant(first.0),
        difference(finite(&last.1.against_errors, METRIC)?),
        significant(last.0)
    ))
}
