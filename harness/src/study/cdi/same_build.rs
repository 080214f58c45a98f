//! Whether the build of the deep images shows in the image.

use crate::image_errors::ERROR_METRICS;
use crate::report::format::{ABSENT, difference};
use crate::report::markup::{Html, html};
use crate::study::against_truth::MODELS;
use crate::study::cdi::lights::METRIC;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::table;

/// What the build of the deep images changes in the image: nothing in the paper.
pub(crate) fn by_build(entries: &[Entry<'_>]) -> Html {
    let of = |entry: &Entry<'_>| {
        let vpls = entry.record.setting.vpls.as_ref()?;
        let errors = &vpls.build_errors;
        let cell = |id: &str| {
            let error = errors.get(id).copied().flatten();
            error.map_or_else(|| ABSENT.to_owned(), difference)
        };
        let mut row = vec![vpls.deep.as_ref()?.build.clone()];
        row.extend(ERROR_METRICS.iter().map(|metric| cell(metric.id)));
        (!errors.is_empty()).then_some(row)
    };
    let rows: Vec<Vec<String>> = entries.iter().filter_map(of).collect();
    if rows.is_empty() {
        return Html::default();
    }
    let mut heads = vec!["build"];
    heads.extend(ERROR_METRICS.iter().map(|metric| metric.head));
    let title = "Errors against the image through deep images of one pass";
    html!("<h4>{}</h4>\n", title) + table(title, &heads, &rows)
}

/// How far the image through deep images of a pass a direction is from that of one pass: its mean error,
/// and the share of pixels that differ by more than a twentieth.
pub(crate) fn image_by_build(done: &Done, scene: &str) -> Option<(f64, f64)> {
    entries(done, scene, MODELS).iter().find_map(|entry| {
        let vpls = entry.record.setting.vpls.as_ref()?;
        let is_brute = vpls.deep.as_ref()?.build.starts_with("per-direction");
        let of = |id: &str| vpls.build_errors.get(id).copied().flatten();
        Some((of(METRIC)?, of("pixels_off")?)).filter(|_| is_brute)
    })
}
