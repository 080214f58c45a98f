//! T, P, no shadows, and a few images of the sweep of maps.

use super::charts::name;
use crate::report::format::difference;
use crate::report::markup::{Html, html};
use crate::study::against_truth::truth_of;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::pictures::figure;
use crate::study::page::shots::Shots;
use crate::study::shadows::cells::{METRIC, atlas, error, without};
use crate::study::shadows::jobs::{MAPS, SEPARATED};

/// The pictures of a scene; nothing without T.
pub(crate) fn pictures(done: &Done, scene: &str, shots: &mut Shots<'_>) -> Html {
    let Some((job, truth)) = truth_of(done, scene) else { return Html::default() };
    let exposure = truth.exposure;
    let Some(key) = shots.linear(&job.name, &truth.raw, exposure) else { return Html::default() };
    let mut shown = figure(Some(key), "T", "the truth with shadows");
    for (job, results) in done.section(scene, SEPARATED) {
        let raw = results.truth_image.as_ref().map(|separated| separated.raw.as_str());
        let key = raw.and_then(|raw| shots.linear(&job.name, raw, exposure));
        shown += figure(key, "P", "exact visible shares");
    }
    for entry in without(done, scene).into_iter().chain(chosen(done, scene)) {
        let raw = entry.record.image.files.raw.as_deref();
        let key = raw.and_then(|raw| shots.linear(&entry.job.name, raw, exposure));
        let told = error(entry.record, METRIC).map(|error| format!("FLIP {}", difference(error)));
        shown += figure(key, &name(&entry), &told.unwrap_or_default());
    }
    html!("<div class=\"views\">{}</div>\n", shown)
}

/// The first, the best and the last image of the largest atlas.
fn chosen<'a>(done: &'a Done, scene: &'a str) -> Vec<Entry<'a>> {
    let mut all = entries(done, scene, MAPS);
    let largest = all.iter().filter_map(atlas).max();
    all.retain(|entry| atlas(entry) == largest);
    let errors: Vec<f64> =
        all.iter().map(|entry| error(entry.record, METRIC).unwrap_or(f64::INFINITY)).collect();
    let best = (0..all.len()).min_by(|a, b| errors[*a].total_cmp(&errors[*b]));
    let mut at =
        [Some(0), best, all.len().checked_sub(1)].into_iter().flatten().collect::<Vec<_>>();
    at.dedup();
    at.into_iter().filter_map(|ix| all.get(ix).copied()).collect()
}
