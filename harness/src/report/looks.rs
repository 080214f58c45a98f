//! What a comparison looks like: a viewer of pictures per strategy, and the lengths of its lists.

use std::collections::BTreeSet;

use super::comparison::Comparison;
use super::explained::explain_command;
use super::format::{number, significant};
use super::markup::{Html, html};
use super::panels::{Panel, panels};
use super::picture_pair::{PicturePair, picture, verdict};
use crate::chart::{Histogram, histograms_svg};
use crate::results::Record;

/// More histograms than this are folded.
const MOST_OPEN: usize = 6;

/// The viewer of a comparison's pictures, of those that were kept.
pub(crate) fn pictures(comparison: &Comparison<'_>, kept: &BTreeSet<&str>) -> Html {
    let known =
        |name: &Option<String>| name.as_deref().filter(|name| kept.contains(name)).is_some();
    let has_one = |record: &Record| {
        known(&record.image.files.tone_mapped) || known(&record.image.files.difference)
    };
    if !comparison.records.iter().any(|(_, record)| has_one(record)) {
        return html!("<p class=\"note\">No pictures were kept.</p>\n");
    }
    let baseline =
        comparison.baseline().and_then(|record| record.image.files.tone_mapped.as_deref());
    let all = || comparison.records.iter().map(|(_, record)| *record);
    let mut shown: Vec<&Record> = all().filter(|record| !record.is_baseline()).collect();
    if shown.is_empty() {
        shown = all().collect();
    }
    let viewer = |record: &&Record| Panel {
        name: record.strategy.to_string(),
        class: record.strategy.class(),
        body: html!(
            "<div class=\"stage\">\n{}</div>\n",
            viewer(record, baseline, kept, explain_command(comparison.command, record, None))
        ),
    };
    let shown: Vec<Panel> = shown.iter().map(viewer).collect();
    html!(
        "<div class=\"pictures\">{}</div>\n",
        panels("Strategy", &html!("<h3>What it looks like</h3>"), &shown)
    )
}

fn viewer(
    record: &Record,
    baseline: Option<&str>,
    kept: &BTreeSet<&str>,
    explain: Option<String>,
) -> Html {
    let images = &record.image.files;
    let known = |name: Option<&'_ str>| name.filter(|name| kept.contains(name)).map(str::to_owned);
    let image = known(images.tone_mapped.as_deref());
    let reference = known(baseline).or_else(|| known(images.baseline.as_deref()));
    let difference = known(images.difference.as_deref());
    let pair = PicturePair {
        scene: &record.setting.scene,
        name: record.strategy.as_str(),
        size: [record.setting.width, record.setting.height],
        image: image.as_deref(),
        reference: reference.as_deref(),
        reference_name: "no culling",
        difference: difference.as_deref(),
        gain: images.difference_amplification,
        verdict: verdict(record),
        explain: explain.filter(|_| !record.is_control()),
    };
    if record.is_control() {
        return pair.still(&"The surfaces alone, without lights.".into());
    }
    if record.is_baseline() {
        return pair.still(&"No culling: every light at every sample.".into());
    }
    let heat = known(images.heat_map.as_deref());
    pair.main()
        + pair.difference(record.image.differing_channels == Some(0))
        + heat_map(record, &pair, heat.as_deref())
}

/// Lights per pixel over the scene, with the scale of its colours.
fn heat_map(record: &Record, pair: &PicturePair<'_>, heat: Option<&str>) -> Html {
    if heat.is_none() {
        return Html::default();
    }
    let alternative = format!("Lights in the list of each pixel, {}", record.strategy);
    let mean = record.lists.listed_per_sample.map_or_else(String::new, |listed| {
        format!("{} lists {} lights per pixel on average.", record.strategy, significant(listed))
    });
    html!(
        "<figure class=\"difference\"><div style=\"aspect-ratio:{}/{}\"{}>{}</div>\
         <figcaption><b>Lights per pixel.</b> {}\
         <div class=\"heat-scale\" aria-hidden=\"true\"><span>0</span><i class=\"heat-ramp\"></i>\
         <span>150</span><i class=\"heat-above\"></i><span>more</span></div></figcaption></figure>\n",
        record.setting.width,
        record.setting.height,
        pair.explainable(),
        picture(heat, &alternative),
        mean
    )
}

/// The lengths of the lists that pixels read, a histogram per strategy; empty where none was counted.
pub(crate) fn list_lengths(comparison: &Comparison<'_>) -> Html {
    let records = comparison.records.iter().map(|(_, record)| *record);
    let all: Vec<Histogram> = records
        .filter(|record| record.lists.lengths_read.iter().any(|groups| *groups > 0))
        .map(|record| Histogram {
            title: record.strategy.to_string(),
            x_label: "Lights in a list".to_owned(),
            bins: bins(&record.lists.lengths_read),
            class: record.strategy.class(),
            note: String::new(),
        })
        .collect();
    if all.is_empty() {
        return Html::default();
    }
    // Charts escape their text themselves.
    let drawing = Html::trusted(histograms_svg("Lists by length", &all));
    let open = if all.len() > MOST_OPEN { "" } else { " open" };
    html!(
        "<details class=\"lengths\"{}><summary><h3>Lists by length</h3></summary>\n\
         <p class=\"note\">Groups that at least one pixel reads, counted by the number of lights in their list.\
         </p>\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Lists by length\">{}</div>\
         </details>\n",
        open,
        drawing
    )
}

/// A histogram of lists with its bins' names: 0, 1, 2 to 3, 4 to 7 and so on.
pub(crate) fn bins(lengths: &[u64]) -> Vec<(String, u64)> {
    let name = |ix: usize| match ix {
        0 | 1 => ix.to_string(),
        _ => {
            let first = 1_u64 << (ix - 1).min(62);
            format!("{}\u{2013}{}", number(first as f64), number((first * 2 - 1) as f64))
        }
    };
    lengths.iter().enumerate().map(|(ix, groups)| (name(ix), *groups)).collect()
}
