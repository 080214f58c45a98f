//! The main comparison: the best strategy at each count of lights, with its passes.

use crate::chart::{BarChart, Scale};
use crate::grouping::{distinct, grouped_by};
use crate::report::colours::Colours;
use crate::report::comparison::{Comparison, comparisons};
use crate::report::format::{number, short_adapter, significant};
use crate::report::lead::{Lead, span};
use crate::report::markup::{Html, html};
use crate::report::page;
use crate::report::pass_bars::{Counted, pass_bars, spread};
use crate::report::rank::{Ratio, first, listed, ranks, tie};
use crate::report::section::result_table;
use crate::results::{Record, Results};
use crate::study::data::{Entry, counts, entries, poses, stand};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::part::Part;

/// From this ratio of the longest to the shortest bar on, the axis is logarithmic.
const LOG_ABOVE: f64 = 20.0;

/// The ranking at each count of lights, few lights first, each with one comparison: times along the
/// path where the path has the methods that lead from the still camera, else from the still camera.
fn rankings(done: &Done, scene: &str) -> Vec<Results> {
    let (path, still) = (entries(done, scene, "path"), entries(done, scene, "main"));
    let mut all = counts(&path);
    all.extend(counts(&still));
    all.sort_unstable();
    all.dedup();
    let chosen = |count| {
        let (along, still) = (at(&path, count), at(&still, count));
        let ranked = ranks(still.iter().map(|entry| entry.record));
        let has = |record: &&Record| along.iter().any(|e| e.record.strategy == record.strategy);
        let covers = !along.is_empty() && first(&ranked).iter().all(has);
        merged(done, if covers { &along } else { &still })
    };
    all.into_iter().filter_map(chosen).collect()
}

/// The records at a count of lights.
fn at<'a>(entries: &[Entry<'a>], lights: u64) -> Vec<Entry<'a>> {
    entries.iter().filter(|entry| entry.record.setting.lights == lights).copied().collect()
}

/// The still comparisons that stand beside a ranking along the path: examples.
fn examples(done: &Done, scene: &str) -> Vec<Results> {
    let still = entries(done, scene, "main");
    let along = |results: &&Results| results.records.iter().any(|record| record.setting.along_path);
    let example =
        |results: &Results| merged(done, &at(&still, results.records.first()?.setting.lights));
    rankings(done, scene).iter().filter(along).filter_map(example).collect()
}

/// Records of several jobs as if they came from one.
fn merged(done: &Done, entries: &[Entry<'_>]) -> Option<Results> {
    let results = done.results.get(&entries.first()?.job.name)?;
    let records = entries.iter().map(|entry| entry.record.clone()).collect();
    let empty =
        Results::new(results.machine.clone(), results.command.clone(), results.truth.clone());
    Some(Results { records, ..empty })
}

/// The first comparison of results, which is made of one count of lights.
fn comparison(results: &Results) -> Option<Comparison<'_>> {
    comparisons(results).into_iter().next()
}

/// The result table and the passes of each count of lights, the most lights first.
pub(crate) fn overview(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let mut shown: Vec<(String, Html)> = Vec::new();
    for results in rankings(done, scene).iter().rev() {
        shown.extend(panel(scene, "", results, charts));
    }
    for results in examples(done, scene).iter().rev() {
        shown.extend(panel(scene, "still-", results, charts));
    }
    Part::new(
        "main",
        "All strategies",
        "All strategies run at the comparison paper\u{2019}s parameters. They test the list of all \
         lights, or the hierarchy over the lights (/bvh). Times along the path are means over its \
         poses. Findings and claims use the times along the path wherever these were measured. A \
         table of one pose is an example with pictures and lists, and its ranks hold for that \
         pose only. Click a heading to sort by its column.",
        panels("Lights", &shown),
    )
}

/// A count of lights with its table and its bars.
fn panel(
    scene: &str,
    slug: &str,
    results: &Results,
    charts: &mut Charts,
) -> Option<(String, Html)> {
    let comparison = comparison(results)?;
    let first = comparison.first();
    let most = comparison.records.iter().map(|(_, r)| *r).max_by_key(|r| poses(r))?;
    let count = first.setting.lights;
    let lights = format!("{} lights", number(count as f64));
    let title = format!("{lights}, {}", stand(most));
    let mut fewer: Vec<String> = Vec::new();
    for (_, record) in &comparison.records {
        if poses(record) != poses(most) {
            fewer.push(format!("{} for {}", stand(record), record.strategy));
        }
    }
    let fewer = match fewer.is_empty() {
        true => String::new(),
        false => format!(" \u{b7} slow strategies have fewer: {}", listed(&fewer)),
    };
    let meta = format!("{} \u{b7} {}{fewer}", page::setting(most), stand(most));
    let mut body = html!("<p class=\"meta\">{}</p>\n", meta);
    body += result_table(&format!("{scene}, {title}"), &comparison);
    body += charts.bars(
        &format!("{scene}-passes-{slug}{count}"),
        &passes(format!("Passes that assign and shade, {title}"), results, &comparison),
    );
    Some((title, body))
}

fn passes(title: String, results: &Results, comparison: &Comparison<'_>) -> BarChart {
    let mut records: Vec<&Record> = comparison
        .all()
        .filter(|record| !record.is_control() && record.assign_and_shade_ms() > 0.0)
        .collect();
    records.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let counted = Counted::AssignAndShade;
    let scale = match spread(counted, &records) > LOG_ABOVE {
        true => Scale::Log,
        false => Scale::LinearFromZero,
    };
    pass_bars(title, scale, counted, &records, &Colours::new(results))
}

/// The findings of a scene: one sentence per count of lights, the most lights first.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let all = rankings(done, scene);
    all.iter().rev().filter_map(|results| sentence(scene, &comparison(results)?)).collect()
}

/// `In atrium at 500 lights, A is fastest. It takes 6.9 ms (mean of 240 poses, confidence interval 6.8 to
/// 7.0 ms). The next fastest is B ...`, or `A and B tie for fastest. They take 6.9 to 7.0 ms (means of 240
/// poses)`.
fn sentence(scene: &str, comparison: &Comparison<'_>) -> Option<String> {
    let ranked = comparison.ranks();
    let lead = Lead::of_comparison(comparison)?;
    let leader = lead.leader();
    let lights = crate::report::finding::lights(comparison.first().setting.lights);
    let time = match lead.is_tie() {
        true => {
            let times = span(&lead.records, |record| Some(record.assign_and_shade_ms()));
            let means = if poses(leader) > 1 { "means of " } else { "" };
            format!("They take {} ms ({means}{})", times.unwrap_or_default(), stand(leader))
        }
        false => format!("It takes {}", timed(leader)),
    };
    let (of_lights, doubt) = (lead.lights(), lead.doubt());
    let mut text =
        format!("In {scene} at {lights}, {}{of_lights}{doubt}. {time}", lead.is_fastest());
    if let Some(cost) = lead.cost_of_lights() {
        text += &format!(". {}", cost.trim_end_matches('.'));
    }
    if let Some(next) = ranked.iter().find(|ranked| ranked.rank == 2) {
        let slower = Ratio::between(next.record, leader).map_or_else(String::new, |ratio| {
            let ends = [ratio.low, ratio.high].map(significant);
            let range = if ends[0] == ends[1] { ends[0].clone() } else { ends.join(" to ") };
            format!(", {range} times as long")
        });
        text += &format!(
            ". The next fastest is {} with {}{slower}",
            comparison.name(next.record),
            timed(next.record)
        );
    }
    if let Some(faster) = comparison.speedup(leader) {
        text += &format!(
            ". The strategy None, which does not cull, takes {} times as long as the fastest",
            significant(faster)
        );
    }
    Some(text + ".")
}

fn ms(record: &Record) -> String {
    significant(record.assign_and_shade_ms())
}

/// `6.9 ms (mean of 240 poses, confidence interval 6.8 to 7.0 ms)`.
fn timed(record: &Record) -> String {
    let mean = if poses(record) > 1 { "mean of " } else { "" };
    let interval = record.interval_ms().map_or_else(String::new, |interval| {
        let ends = [interval.low, interval.high].map(significant);
        format!(", confidence interval {} to {} ms", ends[0], ends[1])
    });
    format!("{} ms ({mean}{}{interval})", ms(record), stand(record))
}

/// The headline: the fastest at the most lights, in each scene.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let mut most = None;
    let leads = grouped_by(done.scenes().into_iter().filter_map(|scene| {
        let results = rankings(done, scene).pop()?;
        let comparison = comparison(&results)?;
        let lead = Lead::of_comparison(&comparison)?;
        most = most.max(Some(comparison.first().setting.lights));
        let limits = lead.lights() + &lead.doubt();
        Some(([lead.is_fastest(), limits, lead.meaning()], scene))
    }));
    let adapter = done.results.values().next().map_or("", |r| short_adapter(&r.machine.adapter));
    let part = |([fastest, limits, _], scenes): &([String; 3], Vec<&str>)| {
        format!("{fastest} in {}{limits}", listed(scenes))
    };
    let parts: Vec<String> = leads.iter().map(part).collect();
    let meanings = distinct(leads.iter().map(|([_, _, meaning], _)| meaning.as_str())).concat();
    let lights = number(most? as f64);
    Some(format!("On {adapter} at {lights} lights, {}.{meanings}", parts.join("; ")))
}

/// Who shares the first rank, per count of lights.
pub(crate) fn ties(done: &Done, scene: &str) -> Vec<String> {
    let sentence = |results: &Results| {
        let comparison = comparison(results)?;
        let tie = tie(&comparison.ranks())?;
        let lights = crate::report::finding::lights(comparison.first().setting.lights);
        Some(format!("{scene}, {lights}: {tie}."))
    };
    rankings(done, scene).iter().filter_map(sentence).collect()
}
