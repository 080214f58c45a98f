//! The result table for the terminal.

use std::fmt::Write;

use super::comparison::{Comparison, comparisons};
use super::finding::notices;
use super::format::{number, short_adapter};
use super::loss::push_losses;
use super::metrics::{METRICS, Metric};
use crate::results::Results;

/// No line of a table is wider, in characters; only a name that is wider by itself.
pub const TABLE_WIDTH: usize = 100;

/// The result tables of all comparisons as plain text, with what a reader has to know below.
pub fn render_table(results: &Results) -> String {
    let mut text = String::new();
    for comparison in comparisons(results) {
        let first = comparison.first();
        let _ = writeln!(
            text,
            "{}, {}, {} lights, {}x{}, on {} ({})",
            first.setting.scene,
            first.setting.mode.name(),
            number(first.setting.lights as f64),
            first.setting.width,
            first.setting.height,
            short_adapter(&results.machine.adapter),
            first.times.clock.name(),
        );
        push_table(&mut text, &comparison);
        push_losses(&mut text, &comparison);
        text.push('\n');
    }
    for notice in notices(results) {
        push_wrapped(&mut text, &notice);
    }
    text
}

/// One column: its two lines of heading, then a cell per record.
fn column(metric: &Metric, comparison: &Comparison<'_>) -> Vec<String> {
    let cells = comparison.records.iter().map(|(_, record)| metric.text(comparison, record));
    [metric.terminal.to_owned(), metric.unit.to_owned()].into_iter().chain(cells).collect()
}

fn push_table(text: &mut String, comparison: &Comparison<'_>) {
    let columns: Vec<Vec<String>> = METRICS
        .iter()
        .filter(|metric| !metric.terminal.is_empty() && metric.is_shown(comparison))
        .map(|metric| column(metric, comparison))
        .collect();
    let widths: Vec<usize> = columns.iter().map(|cells| widest(cells)).collect();
    let names = comparison.records.iter().map(|(_, record)| comparison.name(record));
    let names: Vec<String> =
        ["strategy".to_owned(), String::new()].into_iter().chain(names).collect();

    let numbers: usize = widths.iter().sum();
    let gap = if widest(&names) + numbers + 2 * widths.len() <= TABLE_WIDTH { 2 } else { 1 };
    let room = TABLE_WIDTH.saturating_sub(numbers + gap * widths.len());
    let name_width = widest(&names).min(room);
    for (row, name) in names.iter().enumerate() {
        let mut line = format!("{name:name_width$}");
        // A name that is too long stands on a line of its own.
        if chars(name) > name_width {
            let _ = writeln!(text, "{name}");
            line = " ".repeat(name_width);
        }
        for (cells, width) in columns.iter().zip(&widths) {
            let _ = write!(line, "{:gap$}{:>width$}", "", cells[row]);
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
}

pub(super) fn push_wrapped(text: &mut String, paragraph: &str) {
    let mut width = 0;
    for word in paragraph.split_whitespace() {
        let space = if width == 0 { 0 } else { 1 };
        if width > 0 && width + space + chars(word) > TABLE_WIDTH {
            text.push('\n');
            width = 0;
        } else if space == 1 {
            text.push(' ');
            width += 1;
        }
        text.push_str(word);
        width += chars(word);
    }
    text.push('\n');
}

fn widest(cells: &[String]) -> usize {
    cells.iter().map(|cell| chars(cell)).max().unwrap_or(0)
}

fn chars(text: &str) -> usize {
    text.chars().count()
}
