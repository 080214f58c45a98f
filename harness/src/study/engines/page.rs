//! The page of the engines' defaults: a table, pictures and charts per number of lights, and how the engines
//! differ from what was measured.

use super::cases::{Case, Method, cases, size_px};
use crate::report::column::{Better, Column};
use crate::report::error_words;
use crate::report::finding::lights;
use crate::report::format::{ABSENT, difference, factor, mebibytes, number, percent};
use crate::report::frontier::{TIME_AND_MEMORY_NOTE, time_against_memory};
use crate::report::markup::{Html, html, with_names_whole};
use crate::report::metrics::interval;
use crate::report::rank::competes;
use crate::report::table::{Look, Row, Table};
use crate::results::Record;
use crate::strategy::{
    StrategyId,
    engines::{ENGINES, Engine, engine_of},
};
use crate::study::manifest::Done;
use crate::study::page::errors_plot::Plot;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::part::Part;
use crate::study::page::pictures::figure;
use crate::study::page::shots::{Shots, Wanted};

const TABLE_NOTE: &str = "Each engine\u{2019}s row is one of our strategies with the grid, the slices and the limits of that engine. All \
     methods light the image in the same pass, so only their lists differ. Times and image errors are means along the \
     path. Listed lights and lost pairs are those of the still camera. A pair is a sample and a light that reaches it. \
     A pair is lost if the light is missing from the list of the sample. Missing energy is the luminance that is lost, \
     as a share of all luminance. The last three columns show the same strategy without the limits that lose light, \
     and its time as a multiple of the default\u{2019}s. Lossy methods are not ranked: only figures of lossless ones \
     are bold as the best of their column.";

const PICTURES_NOTE: &str = "The defaults that lose light, from the still camera: the image, the image without culling, and the light that the \
     first lacks. All three have the same exposure and tone curve.";

const ERRORS_NOTE: &str = "An error is the difference from the image without culling, mean over the compared poses of the path. A line \
     joins each default to the same strategy without limits, which lies in the strip at error 0. The staircase joins \
     the settings that no other setting beats in both time and error.";

/// The parts of a scene's section.
pub(crate) fn parts(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let cases = cases(done, scene);
    let by_lights = |show: &mut dyn FnMut(&Case<'_>) -> Html| {
        // The most lights show the most.
        let shown = cases.iter().rev().map(|case| (lights(case.lights), show(case)));
        let shown: Vec<(String, Html)> = shown.filter(|(_, body)| !body.is_empty()).collect();
        panels("Lights", &shown)
    };
    let tables = cases.iter().map(table).collect();
    let pictures = by_lights(&mut |case| pictures(case, shots));
    let errors = by_lights(&mut |case| errors(case, scene, charts, shots));
    let memory = by_lights(&mut |case| memory(case, scene, charts));
    vec![
        Part::new("defaults", "What the defaults cost", TABLE_NOTE, tables),
        Part::new("pictures", "What is lost", PICTURES_NOTE, pictures),
        Part::new("errors", "Speed against accuracy", ERRORS_NOTE, errors),
        Part::new("memory", "Speed against memory", TIME_AND_MEMORY_NOTE, memory),
    ]
}

/// The defaults and the methods for scale with one number of lights; empty where nothing was timed.
fn table(case: &Case<'_>) -> Html {
    let mut methods = case.methods();
    methods.retain(|method| method.timed.is_some());
    let name = |method: &Method<'_>| match method.engine {
        Some(engine) => engine.title.to_owned(),
        None => method.id.row().map_or_else(String::new, |row| row.name.to_owned()),
    };
    let rows: Vec<Row<Method<'_>>> =
        methods.into_iter().map(|method| Row::new(name(&method), method)).collect();
    if rows.is_empty() {
        return Html::default();
    }
    let title = lights(case.lights);
    let table = Table::new("engine", columns(), rows)
        .competing(|method| method.timed.is_some_and(competes))
        .dotted(|method| method.id.class())
        .noted(|method| small_id(method.id))
        .html(&format!("Defaults of engines at {title}"), Look::Sortable);
    html!("<h4>{}</h4>\n{}", title, table)
}

fn columns<'a>() -> Vec<Column<'a, Method<'a>>> {
    let ms = |id, head, time: fn(&Record) -> f64| {
        let value = move |method: &Method<'_>| method.timed.map(time).filter(|ms| ms.is_finite());
        Column::ms(head, value).id(id)
    };
    let error = |id, head, unit, show| {
        let value = move |method: &Method<'_>| method.error(id);
        Column::figure(head, unit, Better::Zero, value, show).id(id)
    };
    let bytes = |method: &Method<'_>| method.timed?.lists.assignment_bytes.map(|all| all as f64);
    let listed = |method: &Method<'_>| method.seen?.record.lists.listed_per_sample;
    let lossless_ms =
        |method: &Method<'_>| Some(method.lossless.as_ref()?.1?.assign_and_shade_ms());
    vec![
        ms("assign_ms", "assign", |record| record.times.assign_ms),
        ms("shade_ms", "shade", |record| record.times.shade_ms),
        ms("both_ms", "assign + shade", Record::assign_and_shade_ms)
            .best(|method| method.leads)
            .note(|method| method.timed.map_or_else(Html::default, interval)),
        Column::figure("memory", "MiB", Better::Less, bytes, mebibytes).id("memory_bytes"),
        Column::figure("listed", "/sample", Better::Less, listed, number).id("listed"),
        Column::figure("lost pairs", "%", Better::Zero, Method::lost_pairs, percent).id("lost"),
        error("missing_energy", "missing energy", "%", percent),
        error("flip", "FLIP", "", difference),
        Column::markup("nearest lossless setting", "", |method: &Method<'_>| {
            match &method.lossless {
                Some((id, _)) => with_names_whole(id.as_str()),
                None if method.engine.is_some() => "the default".into(),
                None => ABSENT.into(),
            }
        }),
        Column::ms("its time", lossless_ms).id("lossless_ms"),
        Column::figure(
            "takes",
            "\u{d7}",
            Better::Neither,
            |method: &Method<'_>| method.cost().map(|cost| cost.ratio),
            factor,
        )
        .id("cost")
        .note(|method| match method.cost() {
            Some(cost) if cost.ties => html!(" <small class=\"interval\">tie</small>"),
            _ => Html::default(),
        }),
    ]
}

/// The image of each default that loses light, the image without culling, and the light that is lost.
fn pictures(case: &Case<'_>, shots: &mut Shots<'_>) -> Html {
    let mut shown = Html::default();
    for method in case.defaults() {
        let Some(entry) = method.seen.filter(|entry| !entry.record.is_lossless()) else { continue };
        let (job, files) = (entry.job.name.as_str(), &entry.record.image.files);
        let mut keep = |name: &Option<String>| shots.file(job, name.as_deref()?);
        let Some(image) = keep(&files.tone_mapped) else { continue };
        let truth = keep(&files.baseline);
        let raw = files.raw.as_deref().zip(files.raw_baseline.as_deref());
        let lost = raw.zip(files.exposure).and_then(|((image, reference), exposure)| {
            shots.lost(job, [image, reference], exposure)
        });
        let (name, errors) = (method.name(), error_words(entry.record));
        shown += html!(
            "<h4>{}{}</h4>\n<div class=\"views\">{}{}{}</div>\n",
            name,
            small_id(method.id),
            figure(Some(image), &name, &format!("{errors}.")),
            figure(truth, "No culling", "every light."),
            figure(lost, "Lost light", "exposed as the other two.")
        );
    }
    shown
}

/// An id in small, below a name. It may be broken at its slashes.
fn small_id(id: &StrategyId) -> Html {
    let part = |(ix, part): (usize, &str)| match ix {
        0 => Html::from(part),
        _ => html!("/<wbr>{}", part),
    };
    let parts: Html = id.as_str().split('/').enumerate().map(part).collect();
    html!("<small class=\"interval\">{}</small>", parts)
}

/// Errors against times: a series per engine, which holds its default and the lossless setting of that.
fn errors(case: &Case<'_>, scene: &str, charts: &mut Charts, shots: &mut Shots<'_>) -> Html {
    let slug = format!("errors-{}", case.lights);
    let mut entries = case.path.clone();
    entries.retain(|entry| !entry.record.is_baseline());
    let plot = Plot {
        slug: &slug,
        title: "Error of the engines\u{2019} defaults",
        entries,
        errors: |record| &record.image.errors,
        series: |record| match engine_of(&record.strategy, size_px(record)) {
            Some(engine) => engine.name.to_owned(),
            None => record.strategy.to_string(),
        },
        class: |record| record.strategy.class(),
        shape: |_| None,
        name: |record| record.strategy.to_string(),
        label: |_| String::new(),
        wanted: Wanted::Pair,
        time: "Assign + shade, mean along the path",
        first: "missing_energy",
        ms: Record::assign_and_shade_ms,
    };
    plot.html(scene, charts, shots)
}

fn memory(case: &Case<'_>, scene: &str, charts: &mut Charts) -> Html {
    let chart = time_against_memory(&case.records());
    chart.map_or_else(Html::default, |chart| {
        charts.xy(&format!("{scene}-memory-{}", case.lights), &chart)
    })
}

/// What differs from each engine, and where its settings are public.
pub(crate) fn differences(done: &Done) -> Html {
    if done.results.is_empty() {
        return Html::default();
    }
    let entry = |engine: &Engine| {
        html!(
            "<dt>{}</dt><dd>{}.<br><small>Settings: {}.</small></dd>\n",
            engine.title,
            engine.differs,
            engine.source
        )
    };
    let entries: Html = ENGINES.iter().map(entry).collect();
    html!(
        "<section class=\"engines\" aria-labelledby=\"engines\"><h2 id=\"engines\">How the engines differ from what \
         was measured</h2>\n<p class=\"note\">No engine ran here. One of our strategies with an engine\u{2019}s public \
         settings stands in for it. It tests lights on the GPU, lists them in ascending order, and shades deferred. \
         What else differs:</p>\n<dl class=\"columns\">\n{}</dl></section>\n",
        entries
    )
}
