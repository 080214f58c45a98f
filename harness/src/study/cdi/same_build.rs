//! Whether the build of the deep images shows in the image.

use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::Errors;
use crate::study::against_truth::MODELS;
use crate::study::cdi::lights::METRIC;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::error_columns::error_columns;

/// A table of how much the build of the deep images changes the image; the paper sees no change.
pub(crate) fn by_build<'a>(entries: &[Entry<'a>]) -> Html {
    let row = |entry: &Entry<'a>| {
        let vpls = entry.record.indirect.as_ref()?;
        let build = &vpls.deep.as_ref()?.build;
        (!vpls.build_errors.is_empty()).then(|| Row::new(build, &vpls.build_errors))
    };
    let rows: Vec<Row<&'a Errors>> = entries.iter().filter_map(row).collect();
    if rows.is_empty() {
        return Html::default();
    }
    let title = "Errors against the image through deep images of one pass";
    let table = Table::new("build", error_columns(own_errors), rows);
    html!("<h4>{}</h4>\n", title) + table.competing(|_| false).html(title, Look::Plain)
}

/// The errors that a row consists of.
fn own_errors<'r>(errors: &'r &Errors) -> &'r Errors {
    errors
}

/// The error of the image through deep images of one pass per direction against the image through those
/// of one pass: mean error, and the share of pixels that differ by more than a twentieth.
pub(crate) fn image_by_build(done: &Done, scene: &str) -> Option<(f64, f64)> {
    entries(done, scene, MODELS).iter().find_map(|entry| {
        let vpls = entry.record.indirect.as_ref()?;
        let is_brute = vpls.deep.as_ref()?.build.starts_with("per-direction");
        let error = |id: &str| vpls.build_errors.get(id).copied().flatten();
        Some((error(METRIC)?, error("pixels_off")?)).filter(|_| is_brute)
    })
}
