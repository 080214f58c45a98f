//! The result table for a document.

use std::fmt::Write;

use super::comparison::{Comparison, comparisons};
use super::format::significant;
use super::loss::error_columns;
use super::metrics::METRICS;
use crate::results::{PassKind, Record, Results};

/// The columns of a document's table, by id, in order; errors follow where a method may lose light.
const COLUMNS: [&str; 9] = [
    "both_ms",
    "speedup",
    "speedup_sphere",
    "shade_ms",
    "assign_ms",
    "listed",
    "efficiency",
    "missed",
    "differing",
];

/// The result tables of all comparisons as GitHub-flavoured Markdown, one after the other. The
/// assignment's time is followed by that of its passes.
pub fn render_markdown(results: &Results) -> String {
    comparisons(results).iter().map(table).collect::<Vec<_>>().join("\n")
}

fn table(comparison: &Comparison<'_>) -> String {
    let known = || COLUMNS.iter().flat_map(|id| METRICS.iter().find(|metric| metric.id == *id));
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
        let _ = writeln!(text, "| {} |{cells}", record.strategy);
    }
    text
}

/// The passes of the assignment, where there are several: ` (bounds 0.0294, cull 0.0239)`.
fn passes(record: &Record) -> String {
    let assign = |(name, times): (&str, &crate::results::PassTimes)| {
        (times.kind == PassKind::Assign).then(|| format!("{name} {}", significant(times.median_ms)))
    };
    let passes: Vec<String> = record.passes.iter().filter_map(assign).collect();
    if passes.len() < 2 { String::new() } else { format!(" ({})", passes.join(", ")) }
}
