//! The main comparison: what is best at each count of lights, and why.

use std::collections::BTreeMap;

use super::super::comparison::{Comparison, comparisons};
use super::super::format::{number, short_adapter, significant};
use super::super::lead::{Lead, span};
use super::super::page;
use super::super::rank::{Ratio, listed, tie};
use super::data::class;
use super::figure::{Charts, panels, part};
use crate::chart::{Axis, BarChart, BarRow, Scale, Segment};
use crate::results::{PassKind, Record, Results};
use crate::study::Done;

/// From this ratio of the longest to the shortest bar on, the axis is logarithmic.
const LOG_ABOVE: f64 = 20.0;

/// The results of a section in the order of their lights, with the first comparison of each.
fn by_lights<'a>(
    done: &'a Done,
    scene: &'a str,
    section: &'a str,
) -> Vec<(&'a Results, Comparison<'a>)> {
    let mut all: Vec<(&Results, Comparison<'_>)> = done
        .of(scene, section)
        .filter_map(|(_, results)| Some((results, comparisons(results).into_iter().next()?)))
        .collect();
    all.sort_by_key(|(_, comparison)| comparison.first().lights);
    all
}

/// The result table and the passes of each count of lights, the most lights first.
pub(super) fn overview(done: &Done, scene: &str, charts: &mut Charts) -> String {
    let mut shown: Vec<(String, String)> = Vec::new();
    for (results, comparison) in by_lights(done, scene, "main").into_iter().rev() {
        let count = comparison.first().lights;
        let lights = format!("{} lights", number(count as f64));
        let classes: BTreeMap<&str, String> = comparison
            .records
            .iter()
            .map(|(_, r)| (r.strategy.as_str(), class(&r.strategy)))
            .collect();
        let caption = format!("{scene}, {lights}");
        let mut body = format!(
            "<p class=\"meta\">{}</p>\n",
            super::super::format::escape(&page::setting(comparison.first()))
        );
        body += &page::table(&caption, &comparison, &classes);
        body += &charts.bars(
            &format!("{scene}-passes-{count}"),
            &passes(format!("Passes that assign and shade, {lights}"), results, &comparison),
        );
        shown.push((lights, body));
    }
    part(
        scene,
        "main",
        "All strategies",
        "At the comparison paper\u{2019}s parameters, from the list of all lights and through the hierarchy \
         (/bvh). A heading sorts by its column.",
        &panels("Lights", &shown),
    )
}

fn passes(title: String, results: &Results, comparison: &Comparison<'_>) -> BarChart {
    let classes = page::pass_classes(results);
    let mut records: Vec<&Record> = comparison
        .records
        .iter()
        .map(|(_, record)| *record)
        .filter(|record| !record.is_control() && record.assign_and_shade_ms() > 0.0)
        .collect();
    records.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let rows: Vec<BarRow> = records.iter().map(|record| bar(record, &classes)).collect();
    let times = || records.iter().map(|record| record.assign_and_shade_ms());
    let ratio = times().fold(0.0, f64::max) / times().fold(f64::INFINITY, f64::min);
    let scale = if ratio > LOG_ABOVE { Scale::Log } else { Scale::LinearFromZero };
    let axis = Axis { label: "Assign + shade".to_owned(), unit: "ms".to_owned(), scale };
    BarChart { title, axis, rows, note: String::new() }
}

fn bar(record: &Record, classes: &BTreeMap<&str, String>) -> BarRow {
    let billed = record
        .passes
        .iter()
        .filter(|(_, times)| [PassKind::Assign, PassKind::Shade].contains(&times.kind));
    let segments: Vec<Segment> = billed
        .map(|(name, times)| Segment {
            name: name.to_owned(),
            class: classes.get(name).cloned().unwrap_or_default(),
            value: times.median_ms,
        })
        .collect();
    let parts: String = segments
        .iter()
        .map(|segment| format!("\n{} {} ms", segment.name, significant(segment.value)))
        .collect();
    BarRow {
        name: record.strategy.clone(),
        class: class(&record.strategy),
        segments,
        value_text: format!("{} ms", significant(record.assign_and_shade_ms())),
        tip: format!("{}{parts}", record.strategy),
    }
}

/// What a scene's comparison found, one sentence per count of lights, the most lights first.
pub(super) fn findings(done: &Done, scene: &str) -> Vec<String> {
    by_lights(done, scene, "main")
        .into_iter()
        .rev()
        .filter_map(|(_, comparison)| sentence(scene, &comparison))
        .collect()
}

/// `In atrium at 500 lights, A is fastest with 6.9 ms (6.8 to 7.0); next is B ...`, or
/// `A and B tie for fastest with 6.9 to 7.0 ms`.
fn sentence(scene: &str, comparison: &Comparison<'_>) -> Option<String> {
    let ranked = comparison.ranks();
    let lead = Lead::of_comparison(comparison)?;
    let leader = lead.leader();
    let lights = super::super::finding::lights(comparison.first().lights);
    let time = match lead.is_tie() {
        true => {
            let times = span(&lead.records, |record| Some(record.assign_and_shade_ms()));
            format!("{} ms", times.unwrap_or_default())
        }
        false => timed(leader),
    };
    let still = lead.still_lights();
    let mut text = format!("In {scene} at {lights}, {}{still} with {time}", lead.is_fastest());
    text += &lead.doubt();
    if let Some(next) = ranked.iter().find(|ranked| ranked.rank == 2) {
        let slower = Ratio::of(next.record, leader).map_or_else(String::new, |ratio| {
            format!(", {} to {} times as long", significant(ratio.low), significant(ratio.high))
        });
        text += &format!("; next is {} with {}{slower}", next.record.strategy, timed(next.record));
    }
    if let Some(faster) = comparison.speedup(leader) {
        text += &format!(". No culling takes {} times as long", significant(faster));
    }
    Some(text + ".")
}

fn ms(record: &Record) -> String {
    significant(record.assign_and_shade_ms())
}

/// `6.9 ms (6.8 to 7.0)`.
fn timed(record: &Record) -> String {
    let interval = record.interval_ms().map_or_else(String::new, |interval| {
        format!(" ({} to {})", significant(interval.low), significant(interval.high))
    });
    format!("{} ms{interval}", ms(record))
}

/// The headline: the fastest at the most lights, in each scene.
pub(super) fn headline(done: &Done) -> Option<String> {
    let first_of = |scene: &&str| {
        let (_, comparison) = by_lights(done, scene, "main").pop()?;
        let lead = Lead::of_comparison(&comparison)?;
        Some(((*scene).to_owned(), lead.headline(), comparison.first().lights))
    };
    let scenes = done.scenes();
    let all: Vec<(String, String, u64)> = scenes.iter().filter_map(first_of).collect();
    let most = all.iter().map(|(_, _, lights)| *lights).max()?;
    let adapter = done.results.values().next().map_or("", |r| short_adapter(&r.machine.adapter));
    let mut leads: Vec<(String, Vec<String>)> = Vec::new();
    for (scene, lead, _) in &all {
        match leads.iter_mut().find(|(known, _)| known == lead) {
            Some((_, scenes)) => scenes.push(scene.clone()),
            None => leads.push((lead.clone(), vec![scene.clone()])),
        }
    }
    let parts: Vec<String> =
        leads.iter().map(|(lead, scenes)| format!("{lead} in {}", listed(scenes))).collect();
    let lights = number(most as f64);
    Some(format!("On {adapter} at {lights} lights, {}.", parts.join("; ")))
}

/// Who shares the first rank, per count of lights.
pub(super) fn ties(done: &Done, scene: &str) -> Vec<String> {
    by_lights(done, scene, "main")
        .into_iter()
        .filter_map(|(_, comparison)| {
            let tie = tie(&comparison.ranks())?;
            let lights = super::super::finding::lights(comparison.first().lights);
            Some(format!("{scene}, {lights}: {tie}."))
        })
        .collect()
}
