//! The parts of the page that are text: tables, notices, provenance.

use std::collections::BTreeMap;

use super::comparison::{Comparison, comparisons};
use super::format::{number, significant};
use super::loss::{ERROR_COLUMNS, columns as columns_of};
use super::markup::{Html, html};
use super::metrics::{Better, METRICS, Metric};
use super::rank::{ALIKE, Ranked, competes};
use crate::results::{Clock, DeviceType, PassKind, Record, Results, TruthLevel};

/// Colours that the style sheet has for the passes of one kind.
const PASS_COLOURS: usize = 4;

/// The style class of each strategy, by id: its family's, as in every table and chart.
pub(super) fn strategy_classes(results: &Results) -> BTreeMap<&str, String> {
    let ids = results.records.iter().map(|record| &record.strategy);
    ids.map(|id| (id.as_str(), id.class())).collect()
}

/// The style class of each pass, by name: a hue per kind, a shade per pass.
pub(super) fn pass_classes(results: &Results) -> BTreeMap<&str, String> {
    let mut classes = BTreeMap::new();
    let mut next: [usize; 4] = [0; 4];
    for (name, times) in results.records.iter().flat_map(|record| record.times.passes.iter()) {
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
pub(super) fn with_names_whole(text: &str) -> Html {
    let word = |(ix, word): (usize, &str)| {
        let space = if ix == 0 { "" } else { " " };
        let is_name = word.contains('-') && word.chars().count() <= UNBROKEN;
        match is_name {
            true => html!("{}<span class=\"whole\">{}</span>", space, word),
            false => html!("{}{}", space, word),
        }
    };
    text.split(' ').enumerate().map(word).collect()
}

pub(super) fn paragraphs(class: &str, texts: &[String]) -> Html {
    let paragraph =
        |text: &String| html!("<p class=\"{}\">{}</p>\n", class, with_names_whole(text));
    texts.iter().map(paragraph).collect()
}

pub(super) fn notices(texts: &[String]) -> Html {
    if texts.is_empty() {
        return Html::default();
    }
    let items: Html = texts.iter().map(|text| html!("<li>{}</li>", text)).collect();
    html!("<ul class=\"notices\" aria-label=\"Before you trust a figure\">{}</ul>", items)
}

/// One section per comparison: the table, and places for the charts.
pub(super) fn comparisons_html(results: &Results) -> Html {
    let classes = strategy_classes(results);
    let section = |(ix, comparison): (usize, &Comparison<'_>)| {
        let first = comparison.first();
        let heading = format!("{}, {}", first.setting.scene, first.setting.mode.name());
        html!(
            "<section class=\"comparison\" data-comparison=\"{0}\" aria-labelledby=\"c{0}\">\n\
             <h2 id=\"c{0}\">{1}</h2>\n<p class=\"meta\">{2}</p>\n{3}\
             <figure class=\"bars\"></figure>\n<div class=\"pictures\"></div>\n\
             <figure class=\"samples\"></figure>\n</section>\n",
            ix,
            heading,
            setting(first),
            table(&heading, comparison, &classes),
        )
    };
    comparisons(results).iter().enumerate().map(section).collect()
}

/// The kind of light that stands in no list.
const SUN: &str = "sun";

pub(super) fn setting(record: &Record) -> String {
    let kinds: Vec<_> = record
        .setting
        .light_kinds
        .iter()
        .filter(|(kind, count)| **count > 0 && *kind != SUN)
        .map(|(kind, count)| format!("{} {kind}", number(*count as f64)))
        .collect();
    let mut parts = vec![if kinds.is_empty() {
        format!("{} lights", number(record.setting.lights as f64))
    } else {
        format!("{} lights ({})", number(record.setting.lights as f64), kinds.join(", "))
    }];
    match record.setting.light_kinds.get(SUN).copied().unwrap_or(0) {
        0 => {}
        1 => parts.push("1 sun".to_owned()),
        count => parts.push(format!("{count} suns")),
    }
    parts.push(format!(
        "{}\u{a0}\u{d7}\u{a0}{} pixels",
        record.setting.width, record.setting.height
    ));
    parts.push(format!("{} triangles", number(record.setting.triangles as f64)));
    if record.setting.scene_scale != 1.0 {
        parts.push(format!("scene scale {}", record.setting.scene_scale));
    }
    if record.setting.radius_scale != 1.0 {
        parts.push(format!("radius scale {}", record.setting.radius_scale));
    }
    parts.push(format!("{} frames", number(f64::from(record.times.frames))));
    parts.join(" \u{b7} ")
}

pub(super) fn table(
    caption: &str,
    comparison: &Comparison<'_>,
    classes: &BTreeMap<&str, String>,
) -> Html {
    let head = |metric: &Metric| {
        html!(
            "<th scope=\"col\" title=\"{}\"><button type=\"button\">{} <span class=\"unit\">{}</span></button></th>",
            metric.about,
            metric.head,
            metric.unit,
        )
    };
    let heads: Html = columns_of(comparison).map(head).collect();
    let mut rows = Html::default();
    for (_, record) in &comparison.records {
        let cells: Html =
            columns_of(comparison).map(|metric| cell(metric, comparison, record)).collect();
        rows += html!(
            "<tr><th scope=\"row\"><i class=\"dot {}\"></i>{}</th>{}</tr>\n",
            classes.get(record.strategy.as_str()).map_or("", String::as_str),
            with_names_whole(&comparison.name(record)),
            cells
        );
    }
    html!(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Results: {0}\">\n\
         <table class=\"results\"><caption>Results: {0}. A heading sorts by its column.</caption>\n\
         <thead><tr><th scope=\"col\"><button type=\"button\">strategy</button></th>{1}</tr></thead>\n\
         <tbody>\n{2}</tbody></table></div>\n",
        caption,
        heads,
        rows
    )
}

fn cell(metric: &Metric, comparison: &Comparison<'_>, record: &Record) -> Html {
    let value = (metric.value)(comparison, record);
    let class = match (metric.better, value) {
        (Better::Zero, Some(value)) if value != 0.0 => html!(" class=\"fault\""),
        (Better::Zero, Some(_)) if record.lists.untested.is_none() => html!(" class=\"good\""),
        (Better::Less | Better::More, Some(value))
            if competes(record) && is_best(metric, comparison, record, value) =>
        {
            html!(" class=\"best\"")
        }
        _ => Html::default(),
    };
    let sort = value.map_or_else(String::new, |value| value.to_string());
    let mut text = Html::from(metric.text(comparison, record));
    if metric.id == "both_ms" {
        text += interval(record);
    }
    html!("<td data-metric=\"{}\" data-value=\"{}\"{}>{}</td>", metric.id, sort, class, text)
}

/// Where the median of assigning and shading lies, in small; its tip says how surely.
pub(super) fn interval(record: &Record) -> Html {
    record.interval_ms().map_or_else(Html::default, |interval| {
        html!(
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
pub(super) fn columns() -> Html {
    let column = |metric: &Metric| {
        html!(
            "<dt>{} <span class=\"unit\">{}</span></dt><dd>{}</dd>\n",
            metric.head,
            metric.unit,
            metric.about
        )
    };
    METRICS.iter().chain(&ERROR_COLUMNS).map(column).collect()
}

/// Where, when and from what the figures came.
pub(super) fn provenance(results: &Results) -> Html {
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
        ("Clock", distinct(results, |r| clock(r.times.clock).to_owned())),
        ("Scene", distinct(results, |r| format!("{} ({})", r.setting.scene, r.setting.scene_hash))),
        ("Seed", distinct(results, |r| r.setting.seed.to_string())),
        (
            "Frames",
            distinct(results, |r| {
                format!("{} after {} to warm up", r.times.frames, r.times.warmup_frames)
            }),
        ),
        ("Truth", truth(results)),
        ("Schema", format!("results.json version {}", results.schema_version)),
    ];
    rows.retain(|(_, value)| !value.trim().is_empty());
    let row =
        |(name, value): &(&str, String)| html!("<div><dt>{}</dt><dd>{}</dd></div>\n", name, value);
    let rows: Html = rows.iter().map(row).collect();
    html!(
        "<dl class=\"provenance\">\n{}</dl>\n<pre class=\"command\"><code>{}</code></pre>",
        rows,
        shell_words(&results.command)
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
