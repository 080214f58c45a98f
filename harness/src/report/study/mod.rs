//! The report of a study: one page, each chart as a file beside it, and the data.
//!
//! A study may be half done, or one shard of several: what lacks is named, and what was not
//! measured is left out. The parts of the page, in the order in which a reader sees them: findings
//! and notices, the [claims] of the comparison paper, then per scene [speed against
//! accuracy](accuracy), [scaling], the [path], two [views], the [sizes] of groups, and [all
//! strategies](overview); for the culling survey, [times against lights](culling); for models of area
//! lights, their [errors](area) against a truth image, [pictures](area_pictures) and [cost](area_cost);
//! for many polygon lights, [light operations and times](endless) by normal cones; for deep images, the
//! [paper's tables](cdi), [builds](cdi_builds), [ranges](cdi_ranges) and [indirect light](cdi_light) with
//! [what it says](cdi_verdicts).

mod accuracy;
mod area;
mod area_cost;
mod area_pictures;
mod cdi;
mod cdi_builds;
mod cdi_light;
mod cdi_ranges;
mod cdi_times;
mod cdi_verdicts;
mod claims;
mod culling;
mod data;
mod endless;
mod endless_charts;
mod endless_data;
mod errors_plot;
mod figure;
mod html;
mod order;
mod overview;
mod path;
mod scaling;
mod shots;
mod sizes;
mod views;

use std::path::Path;

use super::terminal::push_wrapped;
use crate::error::HarnessError;
use crate::results::write_atomically;
use crate::study::Done;

pub use claims::claims_markdown;
pub(super) use figure::part;

/// Writes the report of a study into a folder, `index.html`, `charts/*.svg` and
/// `study-data.json`; returns what to print: what was found, what the comparison paper's claims
/// come to, what lacks, and where the report is.
///
/// # Errors
///
/// Names the path that refused.
pub fn write_study(done: &Done, out: &Path) -> Result<String, HarnessError> {
    let page = html::page(done);
    let charts = out.join("charts");
    for (name, svg) in &page.charts.files {
        write_atomically(&charts.join(name), svg.as_bytes())?;
    }
    let data = out.join(html::DATA);
    write_atomically(&data, page.data.as_bytes())?;
    let index = out.join("index.html");
    write_atomically(&index, page.html.as_bytes())?;
    let mut text = String::new();
    for words in &page.words {
        push_wrapped(&mut text, words);
    }
    text += &format!(
        "report   {}\ncharts   {}\ndata     {}\n",
        index.display(),
        charts.display(),
        data.display()
    );
    Ok(text)
}
