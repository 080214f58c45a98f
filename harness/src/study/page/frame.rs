//! The page of a study, put together from its parts.

use serde_json::json;

use super::figure::Charts;
use super::part::Part;
use super::shots::Shots;
use crate::grouping::grouped_by;
use crate::report::finding::clock_notice;
use crate::report::format::short_adapter;
use crate::report::html::{PAGE, SCRIPT, fill, in_script, style};
use crate::report::markup::{Html, html, with_names_whole};
use crate::report::rank::listed;
use crate::report::terms::terms;
use crate::report::{page, raster};
use crate::results::{DeviceType, Results, TruthLevel};
use crate::strategy::{Row, rows};
use crate::study::claims;
use crate::study::manifest::Done;
use crate::study::motion;
use crate::study::slice::Study;

/// The style rules of study pages; those of a comparison's page apply too.
pub(crate) const STUDY_STYLE: &str = include_str!("study.css");

/// More data than this lie beside the page and not in it, bytes.
const MOST_DATA: usize = 8_000_000;

/// Names of jobs that a notice lists.
const NAMES: usize = 12;

/// A warning of more jobs than these is told once.
const ALIKE: usize = 3;

/// The file of all results.
pub(crate) const DATA: &str = "study-data.json";

/// A page with what lies beside it.
pub(crate) struct Page {
    pub(crate) html: String,
    pub(crate) charts: Charts,
    /// All results by job, as JSON.
    pub(crate) data: String,
    /// For the terminal: what was found, and what a reader has to know.
    pub(crate) words: Vec<String>,
}

/// Draws the page of the jobs that are done.
pub(crate) fn page(study: &Study, done: &Done) -> Page {
    let mut charts = Charts::default();
    let mut shots = Shots::new(done);
    let mut body = Html::default();
    let scenes = done.scenes();
    let found: Vec<Vec<String>> =
        scenes.iter().map(|scene| (study.findings)(done, scene)).collect();
    let mut words: Vec<String> = (study.headline)(done).into_iter().collect();
    let headline = words.first().cloned().unwrap_or_else(|| "Nothing is done yet.".to_owned());
    words.extend(found.iter().flatten().cloned());
    // Of several scenes, each lists its findings in its own section, and its first one at the top.
    let several = scenes.len() > 1;
    let most = if several { 1 } else { usize::MAX };
    let others: Vec<String> =
        found.iter().flat_map(|texts| texts.iter().take(most)).cloned().collect();
    let mut sections: Vec<Html> = Vec::new();
    for (scene, texts) in scenes.iter().copied().zip(&found) {
        let mut parts = (study.parts)(done, scene, &mut charts, &mut shots);
        parts.retain(|part| !part.body.is_empty());
        if !parts.is_empty() {
            let texts = if several { page::paragraphs("said", texts) } else { Html::default() };
            sections.push(section(scene, &texts, &parts));
        }
    }
    body += (study.front)(done);
    body += legend(done);
    if !done.results.is_empty() {
        let claims = claims::judge(done, study.paper);
        body += claims::claims_html(study.paper, &claims, is_software(done));
        words.extend(claims.iter().map(claims::Claim::text));
    }
    body += sections.into_iter().collect();
    body += (study.overall)(done);
    body += shots.templates();
    let notices = notices(study, done, shots.left_out);
    words.extend(notices.iter().cloned());
    let data = serde_json::to_string(&json!({
        "study": done.manifest,
        "results": done.results,
    }))
    .unwrap_or_else(|_| "null".to_owned());
    let embedded = if data.len() <= MOST_DATA { data.as_str() } else { "null" };
    let view = shots.view().to_string();
    let style = style(STUDY_STYLE);
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
            ("columns", page::columns(done.results.values())),
            ("terms", terms()),
            ("provenance", provenance(done)),
            ("data", in_script(embedded)),
            ("view", in_script(&view)),
            ("script", Html::trusted(SCRIPT)),
        ],
    );
    Page { html, charts, data, words }
}

const READING: &str = "<p>Frames are drawn in rounds. Each round draws a few frames of every \
                       method, the methods in random order, so that drift affects all methods \
                       alike. Along a path, a lap takes the place of a round. Whiskers and small \
                       figures are confidence intervals for the median over rounds. For each \
                       round, we take the ratio of two methods\u{2019} times. The methods \
                       <b>tie</b> if the confidence interval of the median ratio contains 1, or if \
                       the median ratio is within 0.5 % of 1. With two to five rounds, all methods \
                       share a rank, because so few rounds cannot show a difference. A \
                       <b>lossy</b> setting is shown with its error. A culling error is the \
                       difference from the image without culling, drawn by the same shader. A \
                       range error is the difference from the image under lights that have no \
                       range. A model error is the difference from the truth image, caused by a \
                       model of area lights. Every chart is also a file in <code>charts/</code>.</p>";

/// How to read an id, for the legend.
const IDS: &str = "A strategy puts samples into groups and gives each group a list of lights. A sample is \
                   a pixel that shows a surface. An id consists of the family, a size and options. In \
                   SC-E/48x48x40/bvh, the family is SC-E. Its clusters are tiles of 48 x 48 pixels, cut \
                   into 40 depth slices. /bvh is an option. All words are explained at the end of the page.";

/// The bounds and the source of lights, which several families share: what an id has, and what it means.
const SHARED: [(&str, &str); 3] = [
    ("-I", "implicit bounds: the whole volume of the group"),
    ("-E", "explicit bounds: the box or the depth range around the samples in the group"),
    (
        "/bvh",
        "hierarchy over the lights: a group first tests boxes around 64 lights each. Without it, a group tests \
         the list of all lights",
    ),
];

/// What the families on a page are, a line each; empty where no strategy has groups.
fn legend(done: &Done) -> Html {
    let records = || done.results.values().flat_map(|results| &results.records);
    let is_used = |row: &&Row| records().any(|record| record.strategy.family() == row.family);
    let used: Vec<&Row> = rows().filter(is_used).collect();
    if !used.iter().any(|row| row.has_groups) {
        return Html::default();
    }
    let line = |id: &str, words: String| html!("<dt>{}</dt><dd>{}.</dd>\n", id, words);
    let families: Html = used.iter().map(|row| line(row.family, row.description())).collect();
    let is_shared = |id: &str| match id {
        "/bvh" => records().any(|record| record.strategy.is_bvh()),
        ending => used.iter().any(|row| row.family.ends_with(ending)),
    };
    let shared = SHARED.iter().filter(|(id, _)| is_shared(id));
    let shared: Html = shared.map(|(id, words)| line(id, (*words).to_owned())).collect();
    html!(
        "<section class=\"families\" aria-labelledby=\"families\"><h2 id=\"families\">What the strategies are \
         called</h2>\n<p class=\"note\">{}</p>\n<dl class=\"columns\">\n{}{}</dl></section>\n",
        IDS,
        families,
        shared
    )
}

/// The section of a scene: what it found, links to its parts, and the parts.
fn section(scene: &str, texts: &Html, parts: &[Part]) -> Html {
    let links: Html = parts.iter().map(|part| part.link(scene)).collect();
    let parts: Html = parts.iter().map(|part| part.html(scene)).collect();
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

/// What a reader must know before trusting a figure.
fn notices(study: &Study, done: &Done, pictures_left_out: usize) -> Vec<String> {
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
                "{job}, {}: this method should lose nothing, but its lists or its image show a \
                 loss.",
                record.strategy
            ));
        }
    }
    let of_job = |(job, results): (&'_ String, &'_ Results)| -> Vec<(String, String)> {
        results.warnings.iter().map(|warning| (warning.clone(), job.clone())).collect()
    };
    let told = done.results.iter().filter(|_| study.tells_warnings).flat_map(of_job);
    for (warning, jobs) in grouped_by(told) {
        match jobs.len() {
            0..=ALIKE => notices.extend(jobs.iter().map(|job| format!("{job}: {warning}"))),
            count => notices.push(format!("{count} jobs: {warning}")),
        }
    }
    notices.extend(motion::notices(study, done));
    notices.extend((study.notices)(done));
    if pictures_left_out > 0 {
        notices.push(format!(
            "{pictures_left_out} pictures would make this page too large; they are in the folders \
             of their jobs."
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
            "<p class=\"note\">In {} of {} jobs, the lists were checked for every pair of a light \
                              and a sample. In the other jobs, each image was only compared with \
                              the image without culling, if the job has one.</p>\n",
            count,
            done.results.len()
        )
    } else {
        Html::default()
    };
    remark + page::provenance(&all)
}
