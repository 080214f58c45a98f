//! What the terminal shows of results: tables per comparison, then what a reader has to know.

use std::fmt::Write;

use super::bill::bill_text;
use super::comparison::{Comparison, comparisons};
use super::finding::notices;
use super::format::{number, short_adapter, significant};
use super::loss::loss_table;
use super::metrics::{metrics, table};
use super::pass_bars::time_ms;
use super::table::TABLE_WIDTH;
use crate::results::Results;

/// The result tables of all comparisons as plain text, then the notices.
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
        text += &table("strategy", &comparison, comparison.all(), metrics()).text();
        text += &loss_table(&comparison);
        text += &bill_text(&comparison);
        push_passes(&mut text, &comparison);
        text.push('\n');
    }
    for notice in notices(results) {
        push_wrapped(&mut text, &notice);
    }
    text
}

/// Appends the time of each pass, if the lights are virtual point lights: those of making the lights before the
/// frames, if frames do not make them, then those of each method.
fn push_passes(text: &mut String, comparison: &Comparison<'_>) {
    let line = |name: &str, times: Vec<(&str, f64)>| {
        let sum: f64 = times.iter().map(|(_, ms)| ms).sum();
        let words: Vec<String> =
            times.iter().map(|(pass, ms)| format!("{pass} {}", significant(*ms))).collect();
        format!("{name}, ms: {} = {}", words.join(" + "), significant(sum))
    };
    let Some(vpls) = &comparison.first().indirect else { return };
    text.push('\n');
    if !vpls.are_made_in_frames() {
        let made = vpls.passes.iter().map(|(pass, times)| (pass, times.median_ms));
        let read_back = vpls.read_back_ms.map(|ms| ("read back, ordered, uploaded", ms));
        push_wrapped(text, &line("Lights, made once", made.chain(read_back).collect()));
    }
    for record in comparison.all() {
        let passes = record.times.passes.iter();
        let passes = passes.map(|(pass, times)| (pass, time_ms(record, times))).collect();
        push_wrapped(text, &line(record.strategy.as_str(), passes));
    }
}

/// Appends a paragraph in lines that are no wider than a table.
pub(crate) fn push_wrapped(text: &mut String, paragraph: &str) {
    let mut width = 0;
    for word in paragraph.split_whitespace() {
        let size = word.chars().count();
        if width > 0 && width + 1 + size > TABLE_WIDTH {
            text.push('\n');
            width = 0;
        } else if width > 0 {
            text.push(' ');
            width += 1;
        }
        text.push_str(word);
        width += size;
    }
    text.push('\n');
}
