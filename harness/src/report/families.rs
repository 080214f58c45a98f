//! The tables of all methods against the number of lights, for a document: each at its best sizes, and at some
//! sizes that a list gives.

use std::fmt::Write;

use super::format::significant;
use super::rank::{first, is_timed, ranks};
use super::raster;
use crate::grouping::distinct;
use crate::results::{Record, Results};
use crate::strategy::StrategyId;

/// Stands where a method was not measured.
const NOT_MEASURED: &str = "–";

/// One row per method at the best of its measured sizes and sources, one column per file of results, as Markdown.
/// A method is a family with all segments of its id but sizes and source. A cell holds the time to assign and
/// shade, and the size and source that took it. Bold are the fastest of a column that lost no light, and those
/// that tie with it. Lossy settings have no row.
pub fn best_sizes_markdown(columns: &[Results]) -> String {
    let records = || columns.iter().flat_map(|results| &results.records);
    let methods = distinct(records().filter(|record| is_shown(record)).map(method));
    let rows = methods.into_iter().map(|name| {
        let of_column = |results| {
            let all = of_method(results, &name);
            all.min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
        };
        let cells = columns.iter().map(|results| {
            of_column(results).map(|record| match size(&record.strategy) {
                size if size.is_empty() => cell(results, record),
                size => format!("{} ({size})", cell(results, record)),
            })
        });
        let cells = cells.collect();
        (format!("`{name}`"), cells)
    });
    markdown("method", columns, rows)
}

/// One row per id, one column per file of results, as Markdown. A cell holds the time to assign and shade from the
/// faster of both sources of lights. Bold are the fastest of the column among these rows, and those that tie with it.
pub fn chosen_sizes_markdown(columns: &[Results], ids: &[&str]) -> String {
    let rows = ids.iter().map(|id| {
        let cells = columns.iter().map(|results| {
            let all = results.records.iter().filter(|record| is_shown(record));
            let same = all.filter(|record| without_source(&record.strategy) == *id);
            let fastest =
                same.min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))?;
            let source = if fastest.strategy.is_bvh() { " (bvh)" } else { "" };
            let chosen = results.records.iter().filter(|record| {
                is_shown(record) && ids.contains(&without_source(&record.strategy).as_str())
            });
            Some(cell_among(results, fastest, chosen) + source)
        });
        let cells = cells.collect();
        let name = StrategyId::read(id).row().map_or("", |row| row.name);
        (format!("`{id}` | {name}"), cells)
    });
    markdown("strategy | plain name", columns, rows)
}

/// Whether a record has a row: it was timed, and its setting gives up no light.
fn is_shown(record: &Record) -> bool {
    is_timed(record) && !record.is_lossy && !record.is_control()
}

fn of_method<'a>(results: &'a Results, name: &str) -> impl Iterator<Item = &'a Record> {
    let records = results.records.iter().filter(|record| is_shown(record));
    records.filter(move |record| method(record) == name)
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

fn cell(results: &Results, record: &Record) -> String {
    cell_among(results, record, results.records.iter().filter(|record| is_shown(record)))
}

/// The time of a record, bold where it shares the first rank among others.
fn cell_among<'a>(
    results: &Results,
    record: &Record,
    others: impl Iterator<Item = &'a Record>,
) -> String {
    let time = significant(record.assign_and_shade_ms()) + raster::mark(&results.machine, record);
    let ranked = ranks(others);
    match first(&ranked).iter().any(|leader| leader.strategy == record.strategy) {
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
