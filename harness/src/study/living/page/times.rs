//! Times against the number of lights, still and moving, and what they say at each number.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::grouping::{distinct, grouped_by};
use crate::report::bill::build_ms;
use crate::report::finding::lights;
use crate::report::format::{number, percent, short_adapter, significant};
use crate::report::lead::Lead;
use crate::report::living::cost_words;
use crate::report::rank::{ALIKE, first, listed, ranks};
use crate::results::Record;
use crate::strategy::StrategyId;
use crate::study::data::{counts, entries, stand};
use crate::study::living::jobs::LIGHTS;
use crate::study::living::movement::Movement;
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::lines::points;
use crate::study::page::part::Part;

/// The records of a section whose lights move in one way.
fn moved<'a>(records: &[&'a Record], movement: Movement) -> Vec<&'a Record> {
    records.iter().copied().filter(|record| Movement::of(record) == movement).collect()
}

/// The records of the section of all numbers of lights.
fn all<'a>(done: &'a Done, scene: &'a str) -> Vec<&'a Record> {
    entries(done, scene, LIGHTS).into_iter().map(|entry| entry.record).collect()
}

fn at<'a>(records: &[&'a Record], count: u64) -> Vec<&'a Record> {
    records.iter().copied().filter(|record| record.setting.lights == count).collect()
}

/// The fastest of some records that show no loss.
fn fastest<'a>(records: &[&'a Record]) -> Option<&'a Record> {
    first(&ranks(records.iter().copied())).first().copied()
}

/// A chart of the fastest strategy, and one of each strategy: a line per way to move lights.
pub(crate) fn times(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = all(done, scene);
    let by_count = counts(&entries(done, scene, LIGHTS));
    let mut shown = Vec::new();
    let best = |movement| {
        let at_count = |count: &u64| fastest(&moved(&at(&all, *count), movement));
        by_count.iter().filter_map(at_count).map(best_point).collect()
    };
    let title = "The fastest strategy: time against lights";
    shown.push(("Fastest".to_owned(), chart(&format!("{scene}-fastest"), title, best, charts)));
    for id in distinct(all.iter().map(|record| &record.strategy)) {
        let of_id = |movement| {
            let mut records = moved(&all, movement);
            records.retain(|record| record.strategy == *id);
            records.sort_by_key(|record| record.setting.lights);
            points(id.as_str(), &records, Record::assign_and_shade_ms)
        };
        let slug = format!("{scene}-times-{}", id.as_str().replace('/', "-"));
        let title = format!("{id}: time against lights");
        shown.push((id.to_string(), chart(&slug, &title, of_id, charts)));
    }
    shown.retain(|(_, body)| !body.is_empty());
    Part::new(
        "times",
        "Time against the number of lights",
        "All passes that assign and shade, means along the path. While the lights stand still, the CPU has \
         built the hierarchy beforehand, and no time contains that. Once they move, the times contain what \
         each frame needs: the upload, if the CPU moves them; their order; the boxes around them. The scene \
         grows with the number of lights, so that as many of them reach a sample.",
        panels("Strategy", &shown),
    )
}

/// A point of the fastest strategy, with its name in the tip.
fn best_point(record: &Record) -> Point {
    let name = format!("{} ({})", record.strategy, Movement::of(record).name());
    points(&name, &[record], Record::assign_and_shade_ms).pop().unwrap_or_default()
}

/// A line per way to move lights; empty where no line has a point.
fn chart(
    slug: &str,
    title: &str,
    points: impl Fn(Movement) -> Vec<Point>,
    charts: &mut Charts,
) -> crate::report::markup::Html {
    let line = |movement: Movement| {
        Series::new(movement.name(), movement.class(), Marks::LineAndPoints, points(movement))
    };
    let axes = [Axis::new("Lights", "", Scale::Log), Axis::new("Assign + shade", "ms", Scale::Log)];
    let chart = XyChart::new(title, axes, Movement::ALL.map(line).to_vec());
    match chart.series.is_empty() {
        true => Default::default(),
        false => charts.xy(slug, &chart),
    }
}

/// A sentence per number of lights, the most lights first.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let all = all(done, scene);
    let by_count = counts(&entries(done, scene, LIGHTS));
    by_count.iter().rev().filter_map(|count| sentence(scene, &at(&all, *count))).collect()
}

/// `In atrium at 1,000 lights, A is fastest with 0.20 ms (lights move: drift; 24 poses). ...`.
fn sentence(scene: &str, records: &[&Record]) -> Option<String> {
    let living = moved(records, Movement::Gpu);
    let lead = Lead::from_ranks(&ranks(living.iter().copied()))?;
    let leader = lead.leader();
    let mut text = format!(
        "In {scene} at {}{}, {} with {} ms ({}){}. {}",
        lights(leader.setting.lights),
        lead.lights(),
        lead.is_fastest(),
        ms(leader),
        stand(leader),
        lead.doubt(),
        cost_words(leader),
    );
    if let Some(still) = fastest(&moved(records, Movement::Still)) {
        let build = build_ms(still).map_or_else(String::new, |build| {
            format!(
                ", with a hierarchy that the CPU built in {} ms off the clock",
                significant(build)
            )
        });
        let more = leader.assign_and_shade_ms() / still.assign_and_shade_ms() - 1.0;
        let than = match more {
            _ if more.abs() < ALIKE => "as long".to_owned(),
            _ if more < 0.0 => format!("{} % longer", percent(-more / (1.0 + more))),
            _ => format!("{} % less", percent(more / (1.0 + more))),
        };
        text += &format!(" Still lights take {than}: {} {} ms{build}.", still.strategy, ms(still));
    }
    for (movement, words) in
        [(Movement::Sorted, "Sorted in every frame"), (Movement::Cpu, "Moved by the CPU")]
    {
        if let Some(record) = fastest(&moved(records, movement)) {
            text += &format!(" {words}: {} {} ms.", record.strategy, ms(record));
        }
    }
    Some(text)
}

fn ms(record: &Record) -> String {
    significant(record.assign_and_shade_ms())
}

/// The fastest at the most lights that move, in each scene, beside still lights.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let mut most = None;
    let found = grouped_by(done.scenes().into_iter().filter_map(|scene| {
        let all = all(done, scene);
        let living = moved(&all, Movement::Gpu);
        let count = living.iter().map(|record| record.setting.lights).max()?;
        let here = at(&all, count);
        let lead = Lead::from_ranks(&ranks(moved(&here, Movement::Gpu)))?;
        most = most.max(Some(count));
        let still = fastest(&moved(&here, Movement::Still))
            .map_or_else(String::new, |still| format!("; still lights take {} ms", ms(still)));
        let limits = lead.lights() + &lead.doubt();
        let words = format!("{}{limits} with {} ms{still}", lead.is_fastest(), ms(lead.leader()));
        Some(([words, lead.meaning()], scene))
    }));
    let adapter = done.results.values().next().map_or("", |r| short_adapter(&r.machine.adapter));
    let parts: Vec<String> = found
        .iter()
        .map(|([words, _], scenes)| format!("in {}, {words}", listed(scenes)))
        .collect();
    let meanings = distinct(found.iter().map(|([_, meaning], _)| meaning.as_str())).concat();
    Some(format!(
        "On {adapter} at {} lights, {}.{meanings}",
        number(most? as f64),
        parts.join("; ")
    ))
}

/// The name of a strategy with the way in which its lights move.
pub(crate) fn name(id: &StrategyId, movement: Movement) -> String {
    format!("{id}, {}", movement.name())
}
