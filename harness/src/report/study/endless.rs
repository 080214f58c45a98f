//! Many polygon lights through clusters with normal cones: the paper's table and charts, by place and
//! number of lights.

use super::super::finding::lights;
use super::super::format::{ABSENT, difference, escape, number, percent, significant};
use super::super::lead::Lead;
use super::super::rank::{Ratio, listed as listed_words, ranks};
use super::data::Entry;
use super::endless_charts::charts_of;
use super::endless_data::{Case, PLACES, cases, cones, listed, paper, setting};
use super::figure::{Charts, panels, part, table};
use super::shots::Shots;
use crate::results::Record;
use crate::study::Done;

/// A part per place, with a panel per count of lights.
pub(super) fn endless(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> String {
    let cases = cases(done, scene);
    let mut html = String::new();
    for (place, title) in PLACES {
        let shown: Vec<(String, String)> = cases
            .iter()
            .filter(|case| case.place == place)
            .map(|case| {
                let body = view(case, shots) + &operations(case) + &charts_of(case, scene, charts);
                (lights(case.lights), body)
            })
            .collect();
        html += &part(
            scene,
            place,
            title,
            "Light operations are evaluations of one term of one light at one sample; outer ones are specular \
             and beyond the reach of the light\u{2019}s diffuse term; perceptible ones would be seen. Position \
             is clusters without cones. A cut leaves out specular light below a radiance, and its error is \
             against no culling. Behind a figure stands, in brackets, the paper\u{2019}s, from a GTX 1060 at \
             1280 x 720 in another scene.",
            &panels("Lights", &shown),
        );
    }
    html
}

/// What the camera sees.
fn view(case: &Case<'_>, shots: &mut Shots<'_>) -> String {
    let key = case.entries.iter().find_map(|Entry { job, record }| {
        shots.file(&job.name, record.images.baseline.as_deref()?)
    });
    let Some(key) = key else { return String::new() };
    format!(
        "<div class=\"views\"><figure><img data-picture=\"{}\" alt=\"{1}\"><figcaption><b>{1}</b>, without \
         culling.</figcaption></figure></div>\n",
        escape(&key),
        escape(&case.name()),
    )
}

/// The paper's table with ours.
fn operations(case: &Case<'_>) -> String {
    let rows: Vec<Vec<String>> = case.entries.iter().map(|entry| row(case, entry.record)).collect();
    let unit = |head: &str, unit: &str| format!("{head} <span class=\"unit\">{unit}</span>");
    let heads = [
        "cones".to_owned(),
        "diffuse".to_owned(),
        "specular".to_owned(),
        "outer specular".to_owned(),
        "perceptible".to_owned(),
        "both terms".to_owned(),
        unit("assign", "ms"),
        unit("shade", "ms"),
        unit("total", "ms"),
        "relMSE".to_owned(),
        "FLIP".to_owned(),
    ];
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    table(&format!("Light operations and times, {}", case.name()), &heads, &rows)
}

fn row(case: &Case<'_>, record: &Record) -> Vec<String> {
    let counted = record.operations;
    let count =
        |value: Option<u64>| value.map_or_else(|| ABSENT.to_owned(), |value| number(value as f64));
    let theirs = match record.culls() {
        true => paper(case.place, case.lights, cones(&record.strategy)),
        false => None,
    };
    // The paper has one setting of each number of cones: beside our cuts it is not said again.
    let theirs = theirs.filter(|_| !record.is_lossy);
    let beside = |own: String, theirs: Option<String>| match theirs {
        Some(theirs) => format!("{own} <span class=\"unit\">({theirs})</span>"),
        None => own,
    };
    let error = |id: &str| {
        let error = record.errors.get(id).copied().flatten();
        error.map_or_else(|| ABSENT.to_owned(), difference)
    };
    let ms = |own: f64, paper: Option<f64>| beside(significant(own), paper.map(significant));
    vec![
        escape(&setting(&record.strategy)),
        count(counted.map(|all| all.diffuse)),
        count(counted.map(|all| all.specular)),
        count(counted.map(|all| all.outer_specular)),
        count(counted.map(|all| all.perceptible)),
        beside(
            count(counted.as_ref().map(listed)),
            theirs.as_ref().and_then(|theirs| theirs.listed).map(|all| number(all as f64)),
        ),
        ms(record.assign_ms, theirs.as_ref().map(|theirs| theirs.assign_ms)),
        ms(record.shade_ms, theirs.as_ref().map(|theirs| theirs.shade_ms)),
        ms(
            record.assign_and_shade_ms(),
            theirs.as_ref().map(|theirs| theirs.assign_ms + theirs.shade_ms),
        ),
        error("rel_mse"),
        error("flip"),
    ]
}

/// The fastest exact setting of each case, and what it evaluates in vain.
pub(super) fn findings(done: &Done, scene: &str) -> Vec<String> {
    cases(done, scene).iter().filter_map(|case| sentence(scene, case)).collect()
}

/// The fastest exact setting by position or cones, and all that cannot be told apart from it.
fn lead<'a>(case: &Case<'a>) -> Option<Lead<'a>> {
    Lead::of(&ranks(case.entries.iter().map(|entry| entry.record)))
}

/// The settings of a lead: `1 cone`, `1 cone and 6 cones`.
fn settings(lead: &Lead<'_>) -> String {
    let names: Vec<String> = lead.records.iter().map(|record| setting(&record.strategy)).collect();
    listed_words(&names)
}

fn sentence(scene: &str, case: &Case<'_>) -> Option<String> {
    let (lead, position) = (lead(case)?, case.position()?);
    let best = lead.leader();
    let time = |record: &Record| significant(record.assign_and_shade_ms());
    let place = format!(
        "In {scene} at location {} under {}",
        case.place.to_uppercase(),
        lights(case.lights)
    );
    if std::ptr::eq(best, position) && !lead.is_tie() {
        return Some(format!(
            "{place}, position alone is fastest without a loss: {} ms.",
            time(best)
        ));
    }
    if !Ratio::of(best, position).is_some_and(|ratio| ratio.is_faster()) {
        return Some(format!(
            "{place}, no number of cones is faster without a loss than position alone, {} ms.",
            time(position)
        ));
    }
    let verb = if lead.is_tie() { "tie for least time" } else { "takes least time" };
    let mut text = format!(
        "{place}, {} {verb} without a loss: {} ms, position alone {} ms",
        settings(&lead),
        time(best),
        time(position),
    );
    if let (Some(own), Some(all)) = (best.operations, position.operations) {
        let fewer = 1.0 - listed(&own) as f64 / listed(&all).max(1) as f64;
        text += &format!(", with {} % fewer operations", percent(fewer));
    }
    Some(text + ".")
}

/// How often each setting is the fastest, in the first scene that has figures.
pub(super) fn headline(done: &Done) -> Option<String> {
    let scene = done.scenes().into_iter().find(|scene| !cases(done, scene).is_empty())?;
    let cases = cases(done, scene);
    let mut wins: Vec<(String, usize)> = Vec::new();
    for lead in cases.iter().filter_map(lead) {
        let tie = if lead.is_tie() { "a tie of " } else { "" };
        let name = format!("{tie}{}", settings(&lead));
        match wins.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => wins.push((name, 1)),
        }
    }
    wins.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let all: usize = wins.iter().map(|(_, count)| count).sum();
    let parts: Vec<String> =
        wins.iter().map(|(name, count)| format!("{name} in {count} of {all} cases")).collect();
    (!parts.is_empty())
        .then(|| format!("Least time without a loss in {scene}: {}.", listed_words(&parts)))
}
