//! Claims on group sizes and intersection tests: sections 4.3.1, 4.3.2 and 4.5.

use crate::grouping::grouped_by;
use crate::report::format::{percent, significant};
use crate::report::rank::{first, listed, ranks};
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Tally, Verdict};
use crate::study::comparison::claims::pairs::Pairs;
use crate::study::data::{Entry, entries, means, tests as tests_of};
use crate::study::manifest::Done;

/// The sizes that the paper selects (table 4.3).
const SELECTED: [(&str, &str); 7] = [
    ("T-I", "28x28"),
    ("T-E", "28x28"),
    ("DC-I", "128x128x64"),
    ("DC-E", "64x64x40"),
    ("SC-I", "48x48x40"),
    ("SC-E", "48x48x40"),
    ("G", "20x20x20"),
];

/// The test that the paper selects, and the union of all that makes sense.
const BEST: &str = "hs+sat-n";
const FULL: &str = "hs+sat-e+sat-p+sat-v";

/// Up to this relative difference two shading times are about the same.
const ABOUT: f64 = 0.03;

/// The records of the search for sizes of a family: from the list of all lights, as in the paper, where
/// they were measured so.
fn searched<'a>(all: &[Entry<'a>], name: &str) -> Vec<&'a Record> {
    let from_source = |bvh: bool| -> Vec<&Record> {
        let records = all.iter().map(|entry| entry.record);
        records.filter(|r| r.strategy.family() == name && r.strategy.is_bvh() == bvh).collect()
    };
    let linear = from_source(false);
    if linear.is_empty() { from_source(true) } else { linear }
}

/// ` (measured only with /bvh)` where the records are not the paper's.
fn source(records: &[&Record]) -> &'static str {
    match records.iter().any(|record| record.strategy.is_bvh()) {
        true => " (measured only with /bvh)",
        false => "",
    }
}

fn time(record: &Record) -> f64 {
    record.assign_and_shade_ms()
}

/// Whether a grid has as many cells along each side of its box.
fn is_cubic(record: &Record) -> bool {
    let mut counts = record.strategy.sizes().map(|(_, count)| count);
    let first = counts.next();
    counts.all(|count| Some(&count) == first.as_ref())
}

/// The paper's size leads each family, or ties with what leads.
pub(crate) fn sizes(done: &Done, scene: &str) -> Answer {
    let all = entries(done, scene, "sizes");
    let (mut good, mut decided, mut figures) = (0, 0, Vec::new());
    let (mut basis, mut notes, mut missing) = (String::new(), Vec::new(), Vec::new());
    for (name, selected) in SELECTED {
        let mut records = searched(&all, name);
        // The paper tried grids of equal counts only.
        records.retain(|record| name != "G" || is_cubic(record));
        let ranked = ranks(records.iter().copied());
        let best = first(&ranked);
        let chosen = records.iter().find(|record| record.strategy.size() == selected);
        let (Some(chosen), Some(leader)) = (chosen, best.first()) else {
            missing.push(name);
            continue;
        };
        basis = format!("{}{}", means(chosen), source(&records));
        decided += 1;
        notes.extend(chosen.strategy.stand_in().map(|what| format!("with {what}")));
        let name = chosen.strategy.short();
        if best.iter().any(|record| record.strategy == chosen.strategy) {
            good += 1;
            let ms = significant(time(chosen));
            figures.push(format!("{name}: {selected} takes {ms} ms, and no size is faster"));
        } else {
            figures.push(format!(
                "{name}: {selected} takes {} ms, {} % longer than {}",
                significant(time(chosen)),
                percent(time(chosen) / time(leader) - 1.0),
                leader.strategy.size()
            ));
        }
    }
    if decided == 0 {
        return Answer::unknown("the paper's sizes among others");
    }
    if !missing.is_empty() {
        notes.push(format!("{} not measured", listed(&missing)));
    }
    let verdict = Verdict::of_parts(good, decided, "families");
    // Other verdicts name them.
    if verdict == Verdict::Fails && !missing.is_empty() {
        figures.push(format!("not measured in this scene: {}", listed(&missing)));
    }
    let verdict = verdict.qualified(&notes);
    let figure = format!("{basis}; {}", figures.join("; "));
    Answer { figure, verdict }
}

/// Grids whose cells are about cubes against grids with the same number of cells along each side.
pub(crate) fn grids(done: &Done, scene: &str) -> Answer {
    let records = searched(&entries(done, scene, "sizes"), "G");
    let least = |cubic: bool| {
        let grids = records.iter().filter(|record| is_cubic(record) == cubic);
        grids.min_by(|a, b| time(a).total_cmp(&time(b)))
    };
    let (Some(equal), Some(shaped)) = (least(true), least(false)) else {
        return Answer::unknown(
            "a grid with the proportions of its box, and grids with the same count along each side",
        );
    };
    let mut pairs = Pairs::default();
    let names = [shaped, equal].map(|record| record.strategy.size());
    pairs.add(names[0], names[1], Order::of_times(shaped, equal));
    let figure = format!(
        "{}{}; {} takes {} ms. The best grid with the same count along each side is {} with {} ms",
        means(shaped),
        source(&records),
        names[0],
        significant(time(shaped)),
        names[1],
        significant(time(equal))
    );
    Answer { figure, verdict: pairs.verdict() }
}

/// The records of each family of the search for tests.
fn tested<'a>(done: &'a Done, scene: &'a str) -> Vec<(&'a str, Vec<&'a Record>)> {
    let all = entries(done, scene, "tests").into_iter();
    grouped_by(all.map(|entry| (entry.record.strategy.family(), entry.record)))
}

/// HS+SAT-N leads in each family, or ties with what leads.
pub(crate) fn tests(done: &Done, scene: &str) -> Answer {
    let (mut figures, mut good, mut decided) = (Vec::new(), 0, 0);
    let mut basis = String::new();
    for (name, records) in tested(done, scene) {
        let meant = records.iter().find(|record| tests_of(record).as_deref() == Some(BEST));
        let ranked = ranks(records.iter().copied());
        let best = first(&ranked);
        let Some(meant) = meant.filter(|_| !best.is_empty()) else { continue };
        basis = means(meant);
        decided += 1;
        good += usize::from(best.iter().any(|record| record.strategy == meant.strategy));
        let shown = |record: &Record, verb: &str| {
            let union = tests_of(record).unwrap_or_default().to_uppercase();
            format!("{union} {verb} {} ms", significant(time(record)))
        };
        let fastest = ranked
            .iter()
            .map(|ranked| ranked.record)
            .filter(|record| tests_of(record).as_deref() != Some(BEST))
            .min_by(|a, b| time(a).total_cmp(&time(b)))
            .map_or_else(String::new, |other| {
                format!(". The fastest other combination is {}", shown(other, "with"))
            });
        figures.push(format!("{name}: {}{fastest}", shown(meant, "takes")));
    }
    if decided == 0 {
        return Answer::unknown("intersection tests");
    }
    let figure = format!("{basis}; {}", figures.join("; "));
    Answer { figure, verdict: Verdict::of_parts(good, decided, "families") }
}

/// The union of all tests shades about as fast as HS+SAT-N, and assigns slower.
pub(crate) fn full_union(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for (name, records) in tested(done, scene) {
        let find =
            |tests: &str| records.iter().find(|record| tests_of(record).as_deref() == Some(tests));
        let (Some(best), Some(full)) = (find(BEST), find(FULL)) else { continue };
        let shade = full.times.shade_ms / best.times.shade_ms;
        tally.count((shade - 1.0).abs() <= ABOUT);
        let order = Order::of_figures(best.times.assign_ms, full.times.assign_ms);
        tally.count(order == Order::Less);
        tally.figures.push(format!(
            "{name}: shade takes {} ms with {} and {} ms with {}. Assign takes {} ms with the \
             first and {} ms with the second",
            significant(best.times.shade_ms),
            BEST.to_uppercase(),
            significant(full.times.shade_ms),
            FULL.to_uppercase(),
            significant(best.times.assign_ms),
            significant(full.times.assign_ms)
        ));
    }
    tally.answer("measures", "HS+SAT-N and the union of all tests")
}
