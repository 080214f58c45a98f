//! The result table for a document.

use std::fmt::Write;

use super::comparison::{Comparison, comparisons};
use super::format::significant;
use super::loss::error_columns;
use super::metrics::{METRICS, Metric};
use crate::results::{PassKind, Record, Results};

/// The columns of a document's table, by id, in order, those without a value left out; errors follow where a
/// method may lose light.
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

/// The result tables of all comparisons as GitHub-flavoured Markdown, one after the other. The
/// assignment's time is followed by that of its passes.
pub fn render_markdown(results: &Results) -> String {
    comparisons(results).iter().map(table).collect::<Vec<_>>().join("\n")
}

fn table(comparison: &Comparison<'_>) -> String {
    let has_value = |metric: &&'static Metric| {
        comparison.records.iter().any(|(_, record)| (metric.value)(comparison, record).is_some())
    };
    let column = |id: &&str| METRICS.iter().find(|metric| metric.id == *id).filter(has_value);
    let known = || COLUMNS.iter().filter_map(column);
    let metrics = || known().chain(error_columns(comparison));
    let heads: String = metrics().map(|m| format!(" {} {} |", m.head, m.unit)).collect();
    let mut text = format!("| strategy |{heads}\n|---|{}\n", "---|".repeat(metrics().count()));
    // The control assigns and shades nothing.
    for (_, record) in comparison.records.iter().filter(|(_, record)| !record.is_control()) {
        let mut cells = String::new();
        for metric in metrics() {
            let _ = write!(cells, " {}", metric.text(comparison, record));
            if metric.id == "assign_ms" {
                cells += &passes(record);
            }
            cells += " |";
        }
        let _ = writeln!(text, "| {} |{cells}", comparison.name(record));
    }
    text
}

/// The passes of the assignment, where there are several: ` (bounds 0.0294, cull 0.0239)`.
fn passes(record: &Record) -> String {
    let assign = |(name, times): (&str, &crate::results::PassTimes)| {
        let time_ms = || record.time_of(|other, _| other == name);
        (times.kind == PassKind::Assign).then(|| format!("{name} {}", significant(time_ms())))
    };
    let passes: Vec<String> = record.times.passes.iter().filter_map(assign).collect();
    if passes.len() < 2 { String::new() } else { format!(" ({})", passes.join(", ")) }
}
