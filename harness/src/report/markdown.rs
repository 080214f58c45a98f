//! The result table for a document.

use super::bill::build_column;
use super::column::Column;
use super::comparison::{Comparison, comparisons};
use super::format::significant;
use super::loss::errors_of;
use super::metrics::{Measured, Metric, metrics, table};
use crate::results::{PassKind, PassTimes, Record, Results};

/// The columns of a document's table, by id, in order. The columns of errors follow where a strategy may
/// lose light.
const COLUMNS: [&str; 11] = [
    "both_ms",
    "span_ms",
    "speedup",
    "speedup_sphere",
    "shade_ms",
    "assign_ms",
    "listed",
    "efficiency",
    "missed",
    "differing",
    "memory_bytes",
];

/// The result tables of all comparisons as GitHub-flavoured Markdown, one after the other. The times of the
/// single passes follow the time to assign.
pub fn render_markdown(results: &Results) -> String {
    comparisons(results).iter().map(markdown).collect::<Vec<_>>().join("\n")
}

fn markdown(comparison: &Comparison<'_>) -> String {
    let mut known = metrics();
    let mut columns = Vec::new();
    for id in COLUMNS {
        if let Some(place) = known.iter().position(|column| column.id == id) {
            let column = known.swap_remove(place).optional();
            columns.push(if id == "assign_ms" { add_passes(column) } else { column });
        }
    }
    columns.push(build_column(|row: &Measured<'_>| row.record));
    columns.extend(errors_of(comparison));
    // The control assigns and shades nothing.
    let records = comparison.all().filter(|record| !record.is_control());
    table("strategy", comparison, records, columns).markdown()
}

/// The column of the time to assign, with the times of the single passes.
fn add_passes<'a>(assign: Metric<'a>) -> Metric<'a> {
    let (head, unit) = (assign.head.clone(), assign.unit.clone());
    Column::words(head, unit, move |row: &Measured<'a>| assign.text(row) + &passes(row.record))
}

/// The passes of the assignment, where there are several: ` (bounds 0.0294, cull 0.0239)`.
fn passes(record: &Record) -> String {
    let assign = |(name, times): (&str, &PassTimes)| {
        let time_ms = || record.time_of(|other, _| other == name);
        (times.kind == PassKind::Assign).then(|| format!("{name} {}", significant(time_ms())))
    };
    let passes: Vec<String> = record.times.passes.iter().filter_map(assign).collect();
    if passes.len() < 2 { String::new() } else { format!(" ({})", passes.join(", ")) }
}
