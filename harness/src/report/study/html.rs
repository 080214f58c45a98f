//! The page of a study, put together from its parts.

use serde_json::json;

use super::super::finding::clock_notice;
use super::super::format::short_adapter;
use super::super::html::{PAGE, SCRIPT, STYLE, fill, in_script};
use super::super::markup::{Html, html, with_names_whole};
use super::super::page;
use super::super::rank::listed;
use super::super::terms::terms;
use super::super::{frames, raster};
use super::figure::Charts;
use super::shots::Shots;
use super::{
    accuracy, area, area_cost, area_pictures, cdi, claims, culling, endless, overview, path,
    scaling, sizes, views,
};
use crate::chart::{CHART_CSS, page_colours};
use crate::results::{DeviceType, Results, TruthLevel};
use crate::study::Done;

/// The page's own rules, beside those of a comparison's page.
pub(super) const STUDY_STYLE: &str = include_str!("study.css");

/// More data than this lie beside the page and not in it, bytes.
const MOST_DATA: usize = 8_000_000;

/// Names of jobs that a notice lists.
const NAMES: usize = 12;

/// The file of all results.
pub(super) const DATA: &str = "study-data.json";

/// A page with what lies beside it.
pub(super) struct Page {
    pub(super) html: String,
    pub(super) charts: Charts,
    /// All results by job, as JSON.
    pub(super) data: String,
    /// For the terminal: what was found, and what a reader has to know.
    pub(super) words: Vec<String>,
}

/// The page of what is done of a study.
pub(super) fn page(done: &Done) -> Page {
    let mut charts = Charts::default();
    let mut shots = Shots::new(done);
    let study = done.manifest.study.as_str();
    let mut body = Html::default();
    let scenes = done.scenes();
    let found: Vec<Vec<String>> = scenes.iter().map(|scene| findings(done, scene)).collect();
    let mut words: Vec<String> = headline(done).into_iter().collect();
    let headline = words.first().cloned().unwrap_or_else(|| "Nothing is done yet.".to_owned());
    words.extend(found.iter().flatten().cloned());
    // Of several scenes, each says what it found at its own place, and the most important above.
    let several = scenes.len() > 1;
    let most = if several { 1 } else { usize::MAX };
    let others: Vec<String> =
        found.iter().flat_map(|texts| texts.iter().take(most)).cloned().collect();
    let mut sections: Vec<Html> = Vec::new();
    for (scene, texts) in scenes.iter().copied().zip(&found) {
        let html = match study {
            "comparison" => [
                accuracy::accuracy(done, scene, &mut charts, &mut shots),
                scaling::scaling(done, scene, &mut charts),
                path::path(done, scene, &mut charts),
                frames::part_of_study(done, scene),
                views::views(done, scene, &mut charts, &mut shots),
                sizes::sizes(done, scene, &mut charts),
                overview::overview(done, scene, &mut charts),
            ]
            .into_iter()
            .collect(),
            "area" => [
                area::area(done, scene, &mut charts, &mut shots),
                area_pictures::pictures(done, scene, &mut shots),
                area_cost::cost(done, scene, &mut charts),
            ]
            .into_iter()
            .collect(),
            "endless" => endless::endless(done, scene, &mut charts, &mut shots),
            "cdi" => cdi::cdi_parts(done, scene, &mut charts, &mut shots),
            _ => culling::culling(done, scene, &mut charts),
        };
        if !html.is_empty() {
            let texts = if several { page::paragraphs("said", texts) } else { Html::default() };
            sections.push(section(scene, &texts, &html));
        }
    }
    if let Some(paper) = claims::paper(study).filter(|_| !done.results.is_empty()) {
        let claims = claims::claims(done, paper);
        body += claims::claims_html(paper, &claims, is_software(done));
        words.extend(claims.iter().map(claims::Claim::text));
    }
    body += sections.into_iter().collect();
    if study == "comparison" {
        body += sizes::best_overall(done);
    }
    body += shots.templates();
    let notices = notices(done, shots.left_out);
    words.extend(notices.iter().cloned());
    let data = serde_json::to_string(&json!({
        "study": done.manifest,
        "results": done.results,
    }))
    .unwrap_or_else(|_| "null".to_owned());
    let embedded = if data.len() <= MOST_DATA { data.as_str() } else { "null" };
    let view = shots.view().to_string();
    let style = [STYLE, &page_colours(), CHART_CSS, STUDY_STYLE].join("\n");
    let html = fill(
        PAGE,
        &[
            ("title", title(done).into()),
            ("style", Html::trusted(style)),
            ("headline", with_names_whole(&headline)),
            ("findings", page::paragraphs("finding", &others)),
            ("notices", page::notices(&notices)),
            ("comparisons", body),
            ("reading", Html::trusted(READING)),
            ("file", DATA.into()),
            ("link", DATA.into()),
            ("columns", page::columns()),
            ("terms", terms()),
            ("provenance", provenance(done)),
            ("data", in_script(embedded)),
            ("view", in_script(&view)),
            ("script", Html::trusted(SCRIPT)),
        ],
    );
    Page { html, charts, data, words }
}

const READING: &str = "<p>Frames are drawn in rounds, every method once a round in an order drawn at \
    random, so that what drifts hits all alike. Whiskers and small figures are intervals of the median \
    over rounds. Two methods <b>tie</b> where the interval of their ratio, round by round, \
    holds 1. A <b>lossy</b> setting is shown at its error: culling error is against no culling with the same \
    shader, the error of the lights\u{2019} range against lights without one, that of a \
    model of area lights against a truth image. Every chart is a file in \
    <code>charts/</code> too.</p>";

fn section(scene: &str, texts: &Html, parts: &Html) -> Html {
    // The parts that the scene has, as links: names and titles are HTML already.
    let mut links = Html::default();
    for part in parts.as_str().split("<div class=\"part\" id=\"").skip(1) {
        let id = part.split('"').next().unwrap_or_default();
        let title = part.split_once("<h3>").and_then(|(_, rest)| rest.split_once("</h3>"));
        if let Some((title, _)) = title {
            let (id, title) = (Html::trusted(id), Html::trusted(title));
            links += html!("<a href=\"#{}\">{}</a>", id, title);
        }
    }
    html!(
        "<section class=\"scene\" data-scene=\"{0}\" aria-labelledby=\"scene-{0}\">\n\
         <h2 id=\"scene-{0}\">{0}</h2>\n{1}<nav class=\"parts\" aria-label=\"Parts of {0}\">{2}</nav>\n\
         {3}</section>\n",
        scene,
        texts,
        links,
        parts
    )
}

fn title(done: &Done) -> String {
    let adapter = any(done).map_or("no adapter yet", |r| short_adapter(&r.machine.adapter));
    format!("{} study, {adapter} \u{b7} lightbench", done.manifest.study)
}

fn any(done: &Done) -> Option<&Results> {
    done.manifest.jobs.iter().find_map(|job| done.results.get(&job.name))
}

fn is_software(done: &Done) -> bool {
    done.results.values().any(|results| results.machine.device_type == DeviceType::Cpu)
}

/// What stands above all.
fn headline(done: &Done) -> Option<String> {
    match done.manifest.study.as_str() {
        "comparison" => overview::headline(done),
        "area" => area::headline(done),
        "endless" => endless::headline(done),
        "cdi" => cdi::headline(done),
        _ => culling::headline(done),
    }
}

/// What a scene found, a sentence each, the most important first.
fn findings(done: &Done, scene: &str) -> Vec<String> {
    match done.manifest.study.as_str() {
        "comparison" => {
            let mut all = overview::findings(done, scene);
            all.extend(accuracy::cheapest(done, scene, 1e-2));
            all
        }
        "area" => [area::findings(done, scene), area_cost::findings(done, scene)].concat(),
        "endless" => endless::findings(done, scene),
        "cdi" => cdi::findings(done, scene),
        _ => culling::findings(done, scene),
    }
}

/// What a reader has to know before trusting a figure.
fn notices(done: &Done, pictures_left_out: usize) -> Vec<String> {
    let mut notices = Vec::new();
    let missing = done.missing();
    if !missing.is_empty() {
        let total = done.manifest.jobs.len();
        let mut names: Vec<String> =
            missing.iter().take(NAMES).map(|name| (*name).to_owned()).collect();
        if missing.len() > NAMES {
            names.push(format!("{} more", missing.len() - NAMES));
        }
        notices.push(format!(
            "{} of {total} jobs are done; missing: {}.",
            total - missing.len(),
            listed(&names)
        ));
    }
    notices.extend(any(done).and_then(clock_notice));
    let records = || done.results.values().flat_map(|results| &results.records);
    notices.extend(any(done).and_then(|first| raster::notice(&first.machine, records())));
    let distinct = |of: fn(&Results) -> &str| {
        let mut values: Vec<&str> = done.results.values().map(of).collect();
        values.sort_unstable();
        values.dedup();
        values
    };
    for (what, values) in [
        ("adapters", distinct(|r| &r.machine.adapter)),
        ("commits", distinct(|r| &r.machine.commit)),
    ] {
        if values.len() > 1 {
            notices.push(format!("The jobs ran on several {what}: {}.", listed(&values)));
        }
    }
    for (job, results) in &done.results {
        for record in results.records.iter().filter(|r| !r.is_lossy && !r.is_lossless()) {
            notices.push(format!(
                "{job}, {}: it states no loss, and its lists or its image show one.",
                record.strategy
            ));
        }
        notices.extend(results.warnings.iter().map(|warning| format!("{job}: {warning}")));
    }
    for scene in done.scenes() {
        notices.extend(overview::ties(done, scene));
    }
    if done.manifest.study == "cdi" {
        notices.extend(cdi::notices(done));
    }
    if pictures_left_out > 0 {
        notices.push(format!(
            "{pictures_left_out} pictures are not on this page, which would be too large: they lie in the \
             folders of their jobs."
        ));
    }
    notices
}

fn provenance(done: &Done) -> Html {
    let Some(results) = any(done) else {
        return html!(
            "<pre class=\"command\"><code>{}</code></pre>",
            page::shell_words(&done.manifest.identity)
        );
    };
    // One results file that speaks for all: the machine of the first, the records of all.
    let mut all = results.clone();
    all.command.clone_from(&done.manifest.identity);
    all.records = done.results.values().flat_map(|results| results.records.clone()).collect();
    let checked = |results: &&Results| results.truth.level == TruthLevel::Full;
    let count = done.results.values().filter(checked).count();
    let remark = if count < done.results.len() {
        html!(
            "<p class=\"note\">The lists of {} of {} jobs were checked, pair by pair; of the others the \
             image alone, where there is one of no culling.</p>\n",
            count,
            done.results.len()
        )
    } else {
        Html::default()
    };
    remark + page::provenance(&all)
}
