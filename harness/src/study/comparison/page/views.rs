//! The views with the least and the most depth discontinuity: heat maps and lengths of lists.

use crate::chart::Histogram;
use crate::grouping::distinct;
use crate::report::format::{number, significant};
use crate::report::markup::{Html, html};
use crate::results::Record;
use crate::strategy::StrategyId;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::part::Part;
use crate::study::page::shots::Shots;

/// Those that a reader sees first.
const FIRST: [&str; 4] = ["T-E", "SC-E", "G", "M/2"];

/// Both views of each strategy.
pub(crate) fn views(done: &Done, scene: &str, charts: &mut Charts, shots: &mut Shots<'_>) -> Part {
    let all = entries(done, scene, "views");
    let culled = all.iter().filter(|entry| entry.record.culls());
    let mut ids = distinct(culled.map(|entry| &entry.record.strategy));
    ids.sort_by_key(|id| FIRST.iter().position(|first| *first == id.short()).unwrap_or(usize::MAX));
    let select = |ids: &[&StrategyId], view: Option<bool>| -> Vec<Entry<'_>> {
        let is_of_id = |entry: &&Entry<'_>| ids.contains(&&entry.record.strategy);
        let seen = |entry: &&Entry<'_>| view.is_none_or(|low| is_of_view(entry, low));
        let mut chosen: Vec<Entry<'_>> =
            all.iter().filter(is_of_id).filter(seen).copied().collect();
        chosen.sort_by_key(|entry| ids.iter().position(|id| **id == entry.record.strategy));
        chosen
    };
    let first: Vec<&StrategyId> =
        ids.iter().filter(|id| FIRST.contains(&id.short().as_str())).copied().collect();
    let mut shown: Vec<(String, Html)> = Vec::new();
    if first.len() > 1 {
        let (mut maps, mut drawn) = (Html::default(), Html::default());
        for low in [true, false] {
            let entries = select(&first, Some(low));
            let Some(view) = entries.first().map(view) else { continue };
            maps += heat_maps(&entries, "views four", shots);
            let title = format!("Lists by length, {view}: {}", counted(&entries));
            drawn += histograms(&format!("{scene}-views-{view}"), &title, &entries, charts);
        }
        let names: Vec<String> = first.iter().map(|id| id.short()).collect();
        shown.push((names.join(", "), html!("{}<div class=\"pair\">{}</div>\n", maps, drawn)));
    }
    for id in &ids {
        let entries = select(&[*id], None);
        let title = format!("Lists by length, {id}: {}", counted(&entries));
        let slug = format!("{scene}-views-{}", id.short());
        let mut body = heat_maps(&entries, "views", shots);
        body += histograms(&slug, &title, &entries, charts);
        shown.push((id.short(), body));
    }
    Part::new(
        "views",
        "Views of low and high depth discontinuity",
        "These are two views from the path. The view of low depth discontinuity has the fewest \
         edges in depth, and the view of high depth discontinuity has the most. Two neighbouring \
         pixels form such an edge if one is more than 10 % deeper than the other. A tile that \
         holds near and far surfaces also lists the lights between them. A cluster does not. The \
         lists of G and M do not depend on the view. Heat maps show how many lights each \
         pixel\u{2019}s list holds. Colours go from blue (none) to red (150). Lists of more than \
         150 lights are green.",
        panels("Strategy", &shown),
    )
}

/// The heat maps of records, each with the mean length of its lists and its times.
fn heat_maps(entries: &[Entry<'_>], class: &str, shots: &mut Shots<'_>) -> Html {
    let mut figures = Html::default();
    for entry in entries {
        let record = entry.record;
        let heat = record.image.files.heat_map.as_deref();
        let Some(picture) = heat.and_then(|heat| shots.file(&entry.job.name, heat)) else {
            continue;
        };
        let listed = record
            .lists
            .listed_per_sample
            .map_or_else(String::new, |listed| format!("; {} lights a pixel", significant(listed)));
        figures += html!(
            "<figure><img data-picture=\"{0}\" alt=\"Lights per pixel, {1}, {2}\" width=\"{3}\" height=\"{4}\">\
             <figcaption><b>{1}, {2}</b>{5}; assign {6} ms, shade {7} ms.</figcaption></figure>\n",
            picture,
            record.strategy.short(),
            view(entry),
            record.setting.width,
            record.setting.height,
            listed,
            significant(record.times.assign_ms),
            significant(record.times.shade_ms),
        );
    }
    match figures.is_empty() {
        true => figures,
        false => html!("<div class=\"{}\">{}</div>\n", class, figures),
    }
}

/// The lists that histograms count: those of all groups, as in the comparison paper, or in older results
/// those that a pixel reads.
fn lengths(record: &Record) -> &[u64] {
    if record.lists.lengths_all.is_empty() {
        &record.lists.lengths_read
    } else {
        &record.lists.lengths_all
    }
}

fn counted(entries: &[Entry<'_>]) -> &'static str {
    match entries.iter().all(|entry| entry.record.lists.lengths_all.is_empty()) {
        true => "groups that some pixel reads",
        false => "all groups whose list is not empty",
    }
}

/// The lengths of the lists of records, side by side.
fn histograms(slug: &str, title: &str, entries: &[Entry<'_>], charts: &mut Charts) -> Html {
    let all: Vec<Histogram> = entries
        .iter()
        .filter(|entry| lengths(entry.record).iter().any(|groups| *groups > 0))
        .map(|entry| histogram(entry.record, view(entry)))
        .collect();
    if all.is_empty() { Html::default() } else { charts.histograms(slug, title, &all) }
}

/// Whether a record is of the view with the least or the most discontinuity in depth. A record without that
/// setting is of neither.
pub(crate) fn is_of_view(entry: &Entry<'_>, is_low: bool) -> bool {
    let wanted = if is_low { "low" } else { "high" };
    entry.job.settings.text("depth_discontinuity") == Some(wanted)
}

fn view(entry: &Entry<'_>) -> &'static str {
    match entry.job.settings.text("depth_discontinuity") {
        Some("low") => "low discontinuity",
        Some("high") => "high discontinuity",
        _ => "unknown discontinuity",
    }
}

fn histogram(record: &Record, view: &str) -> Histogram {
    let bin = |bin: usize| match bin {
        0 | 1 => bin.to_string(),
        _ => {
            let first = 1_u64 << (bin - 1).min(62);
            format!("{}\u{2013}{}", number(first as f64), number((first * 2 - 1) as f64))
        }
    };
    // Most cells of a dense grid hold no light: their bar would hide all others.
    let lengths = lengths(record);
    let without = usize::from(!record.lists.lengths_all.is_empty());
    let note = match lengths.first().filter(|_| without > 0) {
        Some(empty) => format!("{} groups hold no light", number(*empty as f64)),
        None => String::new(),
    };
    Histogram {
        title: format!("{}, {view}", record.strategy.short()),
        x_label: "Lights in a list".to_owned(),
        bins: lengths.iter().enumerate().skip(without).map(|(ix, n)| (bin(ix), *n)).collect(),
        class: record.strategy.class(),
        note,
    }
}
