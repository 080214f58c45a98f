//! The parts of the page that are text: tables, notices, provenance.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::comparison::{Comparison, comparisons};
use super::format::{escape, number, significant};
use super::loss::{ERROR_COLUMNS, columns as columns_of};
use super::metrics::{Better, METRICS, Metric};
use super::rank::{ALIKE, Ranked, competes};
use crate::results::{Clock, DeviceType, PassKind, Record, Results, TruthLevel};

/// Colours that the style sheet has for strategies other than no culling.
pub(super) const STRATEGY_COLOURS: usize = 9;

/// Colours that it has for the passes of one kind.
const PASS_COLOURS: usize = 4;

/// The style class of each strategy, by id: the same in every table and chart.
pub(super) fn strategy_classes(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next = 0;
    for record in &results.records {
        classes.entry(record.strategy.as_str()).or_insert_with(|| {
            if record.is_baseline() || record.is_control() {
                return "strategy-none".to_owned();
            }
            next += 1;
            format!("strategy-{}", (next - 1) % STRATEGY_COLOURS)
        });
    }
    classes
}

/// The style class of each pass, by name: a hue per kind, a shade per pass.
pub(super) fn pass_classes(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next: [usize; 4] = [0; 4];
    for (name, times) in results.records.iter().flat_map(|record| record.passes.iter()) {
        let (kind, label) = match times.kind {
            PassKind::Scene => (0, "scene"),
            PassKind::Assign => (1, "assign"),
            PassKind::Shade => (2, "shade"),
            PassKind::Other => (3, "other"),
        };
        classes.entry(name).or_insert_with(|| {
            next[kind] += 1;
            format!("pass-{label}-{}", (next[kind] - 1) % PASS_COLOURS)
        });
    }
    classes
}

/// Names up to this long, in characters, are not broken over lines.
const UNBROKEN: usize = 24;

/// Text as HTML in which no name such as `DC-I/64x64x24` is broken at its hyphen.
pub(super) fn with_names_whole(text: &str) -> String {
    let word = |word: &str| {
        let html = escape(word);
        let is_name = word.contains('-') && word.chars().count() <= UNBROKEN;
        if is_name { format!("<span class=\"whole\">{html}</span>") } else { html }
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

pub(super) fn paragraphs(class: &str, texts: &[String]) -> String {
    texts
        .iter()
        .map(|text| {
            format!(
                "<p class=\"{class}\">{}</p>
",
                with_names_whole(text)
            )
        })
        .collect()
}

pub(super) fn notices(texts: &[String]) -> String {
    if texts.is_empty() {
        return String::new();
    }
    let items: String = texts.iter().map(|text| format!("<li>{}</li>", escape(text))).collect();
    format!("<ul class=\"notices\" aria-label=\"Before you trust a figure\">{items}</ul>")
}

/// One section per comparison: the table, and places for the charts.
pub(super) fn comparisons_html(results: &Results) -> String {
    let classes = strategy_classes(results);
    let mut html = String::new();
    for (ix, comparison) in comparisons(results).iter().enumerate() {
        let first = comparison.first();
        let heading = format!("{}, {}", first.scene, first.mode.name());
        let _ = write!(
            html,
            "<section class=\"comparison\" data-comparison=\"{ix}\" aria-labelledby=\"c{ix}\">\n\
             <h2 id=\"c{ix}\">{}</h2>\n<p class=\"meta\">{}</p>\n{}\
             <figure class=\"bars\"></figure>\n<div class=\"pictures\"></div>\n\
             <figure class=\"samples\"></figure>\n</section>\n",
            escape(&heading),
            escape(&setting(first)),
            table(&heading, comparison, &classes),
        );
    }
    html
}

/// The kind of light that stands in no list.
const SUN: &str = "sun";

pub(super) fn setting(record: &Record) -> String {
    let kinds: Vec<_> = record
        .light_kinds
        .iter()
        .filter(|(kind, count)| **count > 0 && *kind != SUN)
        .map(|(kind, count)| format!("{} {kind}", number(*count as f64)))
        .collect();
    let mut parts = vec![if kinds.is_empty() {
        format!("{} lights", number(record.lights as f64))
    } else {
        format!("{} lights ({})", number(record.lights as f64), kinds.join(", "))
    }];
    match record.light_kinds.get(SUN).copied().unwrap_or(0) {
        0 => {}
        1 => parts.push("1 sun".to_owned()),
        count => parts.push(format!("{count} suns")),
    }
    parts.push(format!("{}\u{a0}\u{d7}\u{a0}{} pixels", record.width, record.height));
    parts.push(format!("{} triangles", number(record.triangles as f64)));
    if record.scene_scale != 1.0 {
        parts.push(format!("scene scale {}", record.scene_scale));
    }
    if record.radius_scale != 1.0 {
        parts.push(format!("radius scale {}", record.radius_scale));
    }
    parts.push(format!("{} frames", number(f64::from(record.frames))));
    parts.join(" \u{b7} ")
}

pub(super) fn table(
    caption: &str,
    comparison: &Comparison<'_>,
    classes: &BTreeMap<&str, String>,
) -> String {
    let mut heads = String::new();
    for metric in columns_of(comparison) {
        let _ = write!(
            heads,
            "<th scope=\"col\" title=\"{}\"><button type=\"button\">{} <span class=\"unit\">{}</span></button></th>",
            escape(metric.about),
            escape(metric.head),
            escape(metric.unit),
        );
    }
    let mut rows = String::new();
    for (_, record) in &comparison.records {
        let cells: String =
            columns_of(comparison).map(|metric| cell(metric, comparison, record)).collect();
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\"><i class=\"dot {}\"></i>{}</th>{cells}</tr>",
            classes.get(record.strategy.as_str()).map_or("", String::as_str),
            with_names_whole(&comparison.name(record)),
        );
    }
    format!(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Results: {0}\">\n\
         <table class=\"results\"><caption>Results: {0}. A heading sorts by its column.</caption>\n\
         <thead><tr><th scope=\"col\"><button type=\"button\">strategy</button></th>{heads}</tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n",
        escape(caption)
    )
}

fn cell(metric: &Metric, comparison: &Comparison<'_>, record: &Record) -> String {
    let value = (metric.value)(comparison, record);
    let class = match (metric.better, value) {
        (Better::Zero, Some(value)) if value != 0.0 => " class=\"fault\"",
        (Better::Zero, Some(_)) => " class=\"good\"",
        (Better::Less | Better::More, Some(value))
            if competes(record) && is_best(metric, comparison, record, value) =>
        {
            " class=\"best\""
        }
        _ => "",
    };
    let sort = value.map_or_else(String::new, |value| value.to_string());
    let mut text = metric.text(comparison, record);
    if metric.id == "both_ms" {
        text += &interval(record);
    }
    format!("<td data-metric=\"{}\" data-value=\"{sort}\"{class}>{text}</td>", metric.id)
}

/// Where the median of assigning and shading lies, in small; its tip says how surely.
pub(super) fn interval(record: &Record) -> String {
    record.interval_ms().map_or_else(String::new, |interval| {
        format!(
            "<small class=\"interval\" title=\"{} % of such intervals hold the median\">\
             {}\u{2013}{}</small>",
            significant(interval.coverage * 100.0),
            significant(interval.low),
            significant(interval.high)
        )
    })
}

/// Columns that follow from the time by which methods are ranked.
const RANKED: [&str; 4] = ["both_ms", "speedup", "speedup_sphere", "efficiency"];

/// Whether no competitor is better and at least one is worse. By what methods are ranked by, all
/// that share the first rank are best; by other figures all that are as good as alike.
fn is_best(metric: &Metric, comparison: &Comparison<'_>, record: &Record, value: f64) -> bool {
    if RANKED.contains(&metric.id) {
        let ranked = comparison.ranks();
        let is_first = |r: &Ranked<'_>| r.rank == 1 && std::ptr::eq(r.record, record);
        return ranked.iter().any(is_first) && ranked.iter().any(|ranked| ranked.rank > 1);
    }
    let better = |a: f64, b: f64| match metric.better {
        Better::More => a > b * (1.0 + ALIKE),
        _ => a < b / (1.0 + ALIKE),
    };
    let competitors = || comparison.records.iter().filter(|(_, record)| competes(record));
    let others = || competitors().filter_map(|(_, record)| (metric.value)(comparison, record));
    others().all(|other| !better(other, value)) && others().any(|other| better(value, other))
}

/// What each column means.
pub(super) fn columns() -> String {
    METRICS
        .iter()
        .chain(&ERROR_COLUMNS)
        .map(|metric| {
            let (head, unit, about) =
                (escape(metric.head), escape(metric.unit), escape(metric.about));
            format!("<dt>{head} <span class=\"unit\">{unit}</span></dt><dd>{about}</dd>\n")
        })
        .collect()
}

/// Where, when and from what the figures came.
pub(super) fn provenance(results: &Results) -> String {
    let machine = &results.machine;
    let mut rows: Vec<(&str, String)> = vec![
        ("Adapter", machine.adapter.clone()),
        ("Driver", machine.driver.clone()),
        ("Back end", format!("{}, {}", machine.backend, device(machine.device_type))),
        ("Processor", machine.cpu.clone()),
        ("System", machine.os.clone()),
        ("Date", machine.date.clone()),
        ("Commit", machine.commit.clone()),
        ("Compiler", machine.rustc.clone().unwrap_or_default()),
        ("Clock", distinct(results, |r| clock(r.clock).to_owned())),
        ("Scene", distinct(results, |r| format!("{} ({})", r.scene, r.scene_hash))),
        ("Seed", distinct(results, |r| r.seed.to_string())),
        (
            "Frames",
            distinct(results, |r| format!("{} after {} to warm up", r.frames, r.warmup_frames)),
        ),
        ("Truth", truth(results)),
        ("Schema", format!("results.json version {}", results.schema_version)),
    ];
    rows.retain(|(_, value)| !value.trim().is_empty());
    let rows: String = rows
        .iter()
        .map(|(name, value)| format!("<div><dt>{name}</dt><dd>{}</dd></div>\n", escape(value)))
        .collect();
    let command = escape(&shell_words(&results.command));
    format!(
        "<dl class=\"provenance\">\n{rows}</dl>\n<pre class=\"command\"><code>{command}</code></pre>"
    )
}

/// The distinct values over all records, in order of appearance.
fn distinct(results: &Results, value: fn(&Record) -> String) -> String {
    let mut values: Vec<String> = Vec::new();
    for value in results.records.iter().map(value) {
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values.join("; ")
}

fn device(kind: DeviceType) -> &'static str {
    match kind {
        DeviceType::DiscreteGpu => "discrete GPU",
        DeviceType::IntegratedGpu => "integrated GPU",
        DeviceType::VirtualGpu => "virtual GPU",
        DeviceType::Cpu => "software adapter (CPU)",
        DeviceType::Other => "another kind of device",
    }
}

fn clock(clock: Clock) -> &'static str {
    match clock {
        Clock::GpuTimestamps => "GPU timestamps around each pass",
        Clock::WallClock => "wall clock, each pass submitted alone",
    }
}

fn truth(results: &Results) -> String {
    match results.truth.level {
        TruthLevel::Full => format!(
            "every (light, sample) pair on the CPU in f64, but those within {:e} of the range's edge",
            results.truth.edge_tolerance
        ),
        TruthLevel::None => "images only; the lists were not checked".to_owned(),
    }
}

/// A command line that a POSIX shell splits into the same words.
pub(super) fn shell_words(words: &[String]) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    let quoted: Vec<_> = words
        .iter()
        .map(|word| {
            if !word.is_empty() && word.chars().all(plain) {
                word.clone()
            } else {
                format!("'{}'", word.replace('\'', "'\\''"))
            }
        })
        .collect();
    quoted.join(" ")
}

#[cfg(test)]
mod tests {
    use super::shell_words;

    #[test]
    fn the_command_can_be_pasted() {
        let words = ["lightbench", "--scene", "it's a.gltf", ""].map(str::to_owned);
        assert_eq!(shell_words(&words), r"lightbench --scene 'it'\''s a.gltf' ''");
    }
}
