//! The parts of a page that are text: paragraphs, notices, settings, the meaning of columns, provenance.

use super::comparison::{Comparison, comparisons};
use super::format::number;
use super::living;
use super::loss::errors_of;
use super::markup::{Html, html, with_names_whole};
use super::metrics::{Measured, Metric, metrics};
use crate::digits::rounded;
use crate::grouping;
use crate::results::{Clock, DeviceType, LayerSetting, Record, Results, TruthLevel};

pub(crate) fn paragraphs(class: &str, texts: &[String]) -> Html {
    let paragraph =
        |text: &String| html!("<p class=\"{}\">{}</p>\n", class, with_names_whole(text));
    texts.iter().map(paragraph).collect()
}

pub(crate) fn notices(texts: &[String]) -> Html {
    if texts.is_empty() {
        return Html::default();
    }
    let items: Html = texts.iter().map(|text| html!("<li>{}</li>", text)).collect();
    html!("<ul class=\"notices\" aria-label=\"Before you trust a figure\">{}</ul>", items)
}

/// The kind of light that is in no list.
const SUN: &str = "sun";

pub(crate) fn setting(record: &Record) -> String {
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
        parts.push(format!("scene scale {}", rounded(record.setting.scene_scale)));
    }
    if let Some(roughness) = record.setting.roughness {
        parts.push(format!("all surfaces of roughness {}", rounded(roughness)));
    }
    if record.setting.radius_scale != 1.0 {
        parts.push(format!("radius scale {}", rounded(record.setting.radius_scale)));
    }
    if let Some(motion) = living::motion_words(&record.setting) {
        parts.push(format!("lights move: {motion}"));
    }
    parts.extend(record.setting.layers.iter().flat_map(layer_words));
    parts.extend(record.setting.msaa.map(|samples| format!("{samples} samples per pixel")));
    parts.push(format!("{} frames", number(f64::from(record.times.frames))));
    parts.join(" \u{b7} ")
}

/// What is drawn over the opaque surfaces.
fn layer_words(layers: &LayerSetting) -> Vec<String> {
    let mut words = Vec::new();
    if layers.transparent {
        words.push("transparent surfaces".to_owned());
    }
    match layers.particles {
        0 => {}
        1 => words.push("1 particle".to_owned()),
        count => words.push(format!("{} particles", number(count as f64))),
    }
    words.extend(layers.fog_per_m.map(|fog| format!("fog {} per metre", rounded(fog))));
    words
}

/// What each column means: all columns that a table of these results may have.
pub(crate) fn columns<'r>(all: impl IntoIterator<Item = &'r Results>) -> Html {
    let comparisons: Vec<Comparison<'r>> = all.into_iter().flat_map(comparisons).collect();
    let errors = comparisons.iter().map(errors_of).find(|errors| !errors.is_empty());
    let about = |column: &Metric<'_>| {
        html!(
            "<dt>{} <span class=\"unit\">{}</span></dt><dd>{}</dd>\n",
            column.head,
            column.unit,
            column.about
        )
    };
    let columns = metrics().into_iter().chain(errors.into_iter().flatten());
    columns.filter(|column| is_shown(column, &comparisons)).map(|column| about(&column)).collect()
}

/// Whether a table shows a column: an optional one only where it has a value.
fn is_shown<'a>(column: &Metric<'a>, comparisons: &'a [Comparison<'a>]) -> bool {
    let has_value = |comparison: &'a Comparison<'a>| {
        let mut records = comparison.all();
        records.any(|record| column.value(&Measured { comparison, record }).is_some())
    };
    !column.is_optional || comparisons.iter().any(has_value)
}

/// Where, when and from what the figures came.
pub(crate) fn provenance(results: &Results) -> Html {
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
        ("Frames", frames(results)),
        ("Check of lists", truth(results)),
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
    grouping::distinct(results.records.iter().map(value)).join("; ")
}

/// How many frames were timed: `8, 16 or 24 timed frames, after at least 4 frames of warm-up`.
fn frames(results: &Results) -> String {
    let times = results.records.iter().map(|record| &record.times);
    let groups = grouping::grouped_by(times.map(|times| (times.warmup_frames, times.frames)));
    let words = groups.into_iter().map(|(warmup, mut counts)| {
        counts.sort_unstable();
        counts.dedup();
        let counts: Vec<String> = counts.iter().map(u32::to_string).collect();
        let counts = match counts.as_slice() {
            [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
            one => one.concat(),
        };
        format!("{counts} timed frames per strategy, after at least {warmup} frames of warm-up")
    });
    words.collect::<Vec<_>>().join("; ")
}

fn device(kind: DeviceType) -> &'static str {
    match kind {
        DeviceType::DiscreteGpu => "discrete GPU",
        DeviceType::IntegratedGpu => "integrated GPU",
        DeviceType::VirtualGpu => "virtual GPU",
        DeviceType::Cpu => "software adapter (CPU)",
        DeviceType::Other => "other device",
    }
}

fn clock(clock: Clock) -> &'static str {
    match clock {
        Clock::GpuTimestamps => "GPU timestamps around each pass",
        Clock::WallClock => "wall clock, each pass submitted separately",
    }
}

fn truth(results: &Results) -> String {
    match results.truth.level {
        TruthLevel::Full => format!(
            "every pair of a light and a sample is checked, on the CPU in double precision. A pair is \
             left out if the distance from the sample to the edge of the light\u{2019}s support is \
             less than {:e} of the light\u{2019}s range",
            results.truth.edge_tolerance
        ),
        TruthLevel::None => "the lists were not checked, only images".to_owned(),
    }
}

/// A command line that a POSIX shell splits into the same words.
pub(crate) fn shell_words(words: &[String]) -> String {
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
