//! The section of a comparison on its page: table, passes, memory, pictures, lengths of lists, samples.

use std::collections::BTreeSet;

use super::bill::{bill_html, build_note};
use super::colours::Colours;
use super::comparison::{Comparison, comparisons};
use super::frontier::{TIME_AND_MEMORY, TIME_AND_MEMORY_NOTE, time_against_memory};
use super::looks::{list_lengths, pictures};
use super::loss::columns;
use super::markup::{Html, html};
use super::metrics::table;
use super::page::setting;
use super::panels::{Panel, panels};
use super::pass_bars::{Counted, pass_bars, spread};
use super::samples::samples;
use super::table::Look;
use crate::chart::Scale;
use crate::results::{Record, Results};

/// From this ratio of the longest to the shortest frame on, a reader first sees the logarithmic axis.
const LOG_ABOVE: f64 = 60.0;

/// One section per comparison. `kept` names the pictures that the page has.
pub(crate) fn sections(results: &Results, kept: &BTreeSet<&str>) -> Html {
    let colours = Colours::new(results);
    let section = |(ix, comparison): (usize, &Comparison<'_>)| {
        let first = comparison.first();
        let heading = format!("{}, {}", first.setting.scene, first.setting.mode.name());
        let records: Vec<&Record> = comparison.all().collect();
        let body = result_table(&format!("Results: {heading}"), comparison)
            + frame_times(&records, &colours)
            + bill_html(&format!("What each pass costs: {heading}"), comparison)
            + memory(&records)
            + pictures(comparison, kept)
            + list_lengths(comparison)
            + samples(&records, &colours);
        html!(
            "<section class=\"comparison\" data-comparison=\"{0}\" aria-labelledby=\"c{0}\">\n\
             <h2 id=\"c{0}\">{1}</h2>\n<p class=\"meta\">{2}</p>\n{3}</section>\n",
            ix,
            heading,
            setting(first),
            body,
        )
    };
    comparisons(results).iter().enumerate().map(section).collect()
}

/// The table of a comparison, whose headings sort.
pub(crate) fn result_table(label: &str, comparison: &Comparison<'_>) -> Html {
    table("strategy", comparison, comparison.all(), columns(comparison))
        .dotted(|row| row.record.strategy.class())
        .noted(|row| build_note(row.record))
        .html(label, Look::Sortable)
}

/// Where the time of a frame goes, on a linear and on a logarithmic axis.
fn frame_times(records: &[&Record], colours: &Colours<'_>) -> Html {
    const TITLE: &str = "Where the time of a frame goes";
    let draw = |name: &str, scale| {
        let chart = pass_bars(TITLE.to_owned(), scale, Counted::Frame, records, colours);
        // Charts escape their text themselves.
        let drawing = Html::trusted(chart.to_svg());
        let body = html!(
            "<figure class=\"bars\"><div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}, {}\">\
             {}</div></figure>\n",
            TITLE,
            name,
            drawing
        );
        Panel { name: name.to_owned(), class: String::new(), body }
    };
    let mut shown = vec![draw("Linear", Scale::LinearFromZero), draw("Logarithmic", Scale::Log)];
    if spread(Counted::Frame, records) > LOG_ABOVE {
        shown.reverse();
    }
    panels("Axis", &html!("<h3>{}</h3>", TITLE), &shown)
}

/// Time against memory; empty where fewer than two methods without a loss have both.
fn memory(records: &[&Record]) -> Html {
    let Some(chart) = time_against_memory(records) else { return Html::default() };
    // Charts escape their text themselves.
    let drawing = Html::trusted(chart.to_svg());
    html!(
        "<h3>{0}</h3>\n<p class=\"note\">{1}</p>\n<figure class=\"bars plot\"><div class=\"scroll\" \
         role=\"region\" tabindex=\"0\" aria-label=\"{0}\">{2}</div></figure>\n",
        TIME_AND_MEMORY,
        TIME_AND_MEMORY_NOTE,
        drawing
    )
}
