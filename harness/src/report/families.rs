//! The tables of all methods against the number of lights, for a document: each at its best sizes, and at some
//! sizes that a list gives.

use std::fmt::Write;

use super::format::significant;
use super::rank::{first, indistinguishable, is_timed, ranks};
use super::raster;
use crate::grouping::distinct;
use crate::results::{Record, Results};
use crate::strategy::StrategyId;

/// Stands where a method was not measured.
const NOT_MEASURED: &str = "\u{2013}";

/// One row per method at the best of its measured sizes and sources, one column per file of results, as Markdown.
/// A method is a family with all segments of its id but sizes and source. A cell holds the time to assign and
/// shade, and the sizes and sources that took it: several where they tie. Bold are the fastest of a column and those that
/// tie with it. Methods that lose light, on purpose or not, have no row.
pub fn best_sizes_markdown(columns: &[Results]) -> String {
    let records = || columns.iter().flat_map(|results| &results.records);
    let methods = distinct(records().filter(|record| is_shown(record)).map(method));
    let rows = methods.into_iter().map(|name| {
        let cell = |results: &Results| {
            let of_method: Vec<&Record> =
                shown(results).filter(|record| method(record) == name).collect();
            let best = fastest(of_method.iter().copied())?;
            let same = |record: &&&Record| {
                std::ptr::eq(**record, best) || indistinguishable(record, best) == Some(true)
            };
            let sizes = of_method.iter().filter(same).map(|record| size(&record.strategy));
            let sizes: Vec<String> = sizes.filter(|size| !size.is_empty()).collect();
            let sizes = match sizes.is_empty() {
                true => String::new(),
                false => format!(" ({})", sizes.join("; ")),
            };
            Some(time(results, best, shown(results)) + &sizes)
        };
        (format!("`{name}`"), columns.iter().map(cell).collect())
    });
    markdown("method", columns, rows)
}

/// One row per id, one column per file of results, as Markdown. A cell holds the time to assign and shade; where both
/// sources of lights were measured, that of the faster one. Bold are the fastest of a column among these rows, and those
/// that tie with it.
///
/// # Errors
///
/// Names an id that no file holds.
pub fn chosen_sizes_markdown(columns: &[Results], ids: &[&str]) -> Result<String, String> {
    let is_chosen = |record: &Record| ids.contains(&without_source(&record.strategy).as_str());
    let mut rows = Vec::new();
    for id in ids {
        let cell = |results: &Results| {
            let same = shown(results).filter(|record| without_source(&record.strategy) == *id);
            let best = fastest(same)?;
            let source = if best.strategy.is_bvh() { " (bvh)" } else { "" };
            let chosen = shown(results).filter(|record| is_chosen(record));
            Some(time(results, best, chosen) + source)
        };
        let cells: Vec<Option<String>> = columns.iter().map(cell).collect();
        if cells.iter().all(Option::is_none) {
            return Err(format!("{id} was not measured with any number of lights, or loses light"));
        }
        let name = StrategyId::read(id).row().map_or("", |row| row.name);
        rows.push((format!("`{id}` | {name}"), cells));
    }
    Ok(markdown("strategy | plain name", columns, rows.into_iter()))
}

/// Whether a record has a row: it was timed, and it shows no loss.
fn is_shown(record: &Record) -> bool {
    is_timed(record) && record.shows_no_loss() && !record.is_control()
}

fn shown(results: &Results) -> impl Iterator<Item = &Record> {
    results.records.iter().filter(|record| is_shown(record))
}

fn fastest<'a>(records: impl Iterator<Item = &'a Record>) -> Option<&'a Record> {
    records.min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
}

/// The id without its sizes and its source: `T-E1/mask`.
fn method(record: &Record) -> String {
    let id = &record.strategy;
    let parameters = &id.options().parameters;
    let segments =
        id.as_str().split('/').filter(|segment| segment != parameters && *segment != "bvh");
    segments.collect::<Vec<_>>().join("/")
}

/// The parameters and the source of an id: `48x48, bvh`.
fn size(id: &StrategyId) -> String {
    let parameters = id.options().parameters.clone();
    let source = id.is_bvh().then(|| "bvh".to_owned());
    let parts = [Some(parameters).filter(|text| !text.is_empty()), source];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn without_source(id: &StrategyId) -> String {
    let plain = id.with(|options| options.source = None);
    plain.map_or_else(|_| id.to_string(), |plain| plain.to_string())
}

/// The time of a record, bold where it shares the first rank among others.
fn time<'a>(
    results: &Results,
    record: &Record,
    others: impl Iterator<Item = &'a Record>,
) -> String {
    let time = significant(record.assign_and_shade_ms()) + raster::mark(&results.machine, record);
    let ranked = ranks(others);
    match first(&ranked).iter().any(|leader| std::ptr::eq(*leader, record)) {
        true => format!("**{time}**"),
        false => time,
    }
}

fn markdown(
    head: &str,
    columns: &[Results],
    rows: impl Iterator<Item = (String, Vec<Option<String>>)>,
) -> String {
    let lights = |results: &Results| {
        let count = results.records.first().map_or(0, |record| record.setting.lights);
        super::lights(count)
    };
    let heads: Vec<String> = columns.iter().map(lights).collect();
    let rules = "---|".repeat(heads.len() + head.matches('|').count() + 1);
    let mut table = format!("| {head} | {} |\n|{rules}\n", heads.join(" | "));
    for (name, cells) in rows {
        let cells: Vec<String> =
            cells.into_iter().map(|cell| cell.unwrap_or_else(|| NOT_MEASURED.to_owned())).collect();
        let _ = writeln!(table, "| {name} | {} |", cells.join(" | "));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassKind, PassTimes, Passes};

    /// Results of six rounds with these ids and times, ms.
    fn results(lights: u64, methods: &[(&str, f64)]) -> Results {
        let mut results: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let example = results.records[0].clone();
        let record = |(id, ms): &(&str, f64)| {
            let mut record = Record { strategy: StrategyId::read(id), ..example.clone() };
            record.is_lossy = false;
            record.setting.lights = lights;
            (record.image.differing_channels, record.image.max_abs_diff) = (Some(0), Some(0.0));
            (record.lists.missed_pairs, record.lists.untested) = (Some(0), None);
            record.times.passes = Passes::default();
            record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, vec![*ms; 6]));
            (record.times.frames, record.times.rounds) = (6, 6);
            record.set_times();
            record
        };
        results.records = methods.iter().map(record).collect();
        results
    }

    #[test]
    fn the_best_size_of_each_method_is_shown_and_ties_are_told() {
        let few = results(100, &[("T-I/16x16", 0.3), ("T-I/32x32", 0.2), ("SC-E/8x8x8", 0.25)]);
        let many = [("T-I/16x16/bvh", 0.5), ("T-I/32x32", 0.501), ("SC-E/8x8x8/bvh", 0.9)];
        let table = best_sizes_markdown(&[few, results(1_000, &many)]);
        assert_eq!(
            table,
            "| method | 100 lights | 1,000 lights |\n|---|---|---|\n\
             | `T-I` | **0.200** (32x32) | **0.500** (16x16, bvh; 32x32) |\n\
             | `SC-E` | 0.250 (8x8x8) | 0.900 (8x8x8, bvh) |\n"
        );
    }

    #[test]
    fn what_lost_light_leads_no_column_and_has_no_row() {
        let mut wrong = results(100, &[("T-I/16x16", 0.1), ("SC-E/8x8x8", 0.25)]);
        wrong.records[0].image.differing_channels = Some(3);
        wrong.records[0].image.max_abs_diff = Some(0.5);
        let table = best_sizes_markdown(std::slice::from_ref(&wrong));
        assert!(!table.contains("T-I") && table.contains("**0.250**"), "{table}");
        let error = chosen_sizes_markdown(&[wrong], &["T-I/16x16"]).expect_err("no row");
        assert!(error.starts_with("T-I/16x16 was not measured"), "{error}");
    }

    #[test]
    fn chosen_rows_compete_only_with_each_other_and_name_the_source() {
        let all = [("T-I/16x16", 0.1), ("SC-E/8x8x8", 0.3), ("SC-E/8x8x8/bvh", 0.25)];
        let ids = ["SC-E/8x8x8"];
        let table = chosen_sizes_markdown(&[results(100, &all)], &ids).expect("a table");
        assert!(table.ends_with("explicit bounds | **0.250** (bvh) |\n"), "{table}");
        let unknown = chosen_sizes_markdown(&[results(100, &all)], &["SC-E/9x9x9"]);
        assert!(unknown.is_err());
    }
}
