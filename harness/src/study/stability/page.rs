//! What was seen in one scenario: what breaks there, its picture, and each method with the command that shows it.

use scenes::stability::{Figure, Scenario};

use super::cells::{Case, Cell, Method, cell, flawed_methods, methods};
use super::jobs::{FLAWED, STILL, scenario_of};
use super::matrix::anchor;
use super::outcome::Outcome;
use super::sentences::has_failed;
use crate::report::explained::{explain_command, worst_places};
use crate::report::format::{ABSENT, difference, significant};
use crate::report::markup::{Html, html};
use crate::report::page::shell_words;
use crate::report::picture_pair::{PicturePair, verdict};
use crate::report::terms::inline;
use crate::results::{Mode, Record, mean, standard_deviation};
use crate::strategy::BASELINE;
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::page::pictures::figure;
use crate::study::page::shots::Shots;

const NOTE: &str = "Each row is a method. Open it for the command that shows it again, and for its pictures \
                    where the image differs.";

/// The parts of a scenario's section.
pub(crate) fn parts(done: &Done, scene: &str, _: &mut Charts, shots: &mut Shots<'_>) -> Vec<Part> {
    let Some(scenario) = scenario_of(scene) else { return Vec::new() };
    let cells = |methods: Vec<Method>| -> Vec<Cell<'_>> {
        methods.iter().map(|method| cell(done, scene, method)).collect()
    };
    let (sound, flawed) = (cells(methods(done)), cells(flawed_methods(done)));
    let mut body =
        picture(scenario, &sound, shots) + figures(scenario, sound.iter().chain(&flawed));
    for (title, cells) in [("Methods", &sound), ("Methods that fail on purpose", &flawed)] {
        let rows: Html = cells.iter().map(|cell| shown(scene, cell, shots)).collect();
        if !rows.is_empty() {
            body += html!("<h4>{}</h4>\n<div class=\"cells\">\n{}</div>\n", title, rows);
        }
    }
    vec![Part::new("cells", scenario.breaks.trim_end_matches('.'), NOTE, body)]
}

/// The scenario without culling, and what the figure below it is about.
fn picture(scenario: &Scenario, sound: &[Cell<'_>], shots: &mut Shots<'_>) -> Html {
    let none = sound.iter().find(|cell| cell.method.name() == BASELINE);
    let picture = none.and_then(|cell| {
        let case = cell.cases.iter().find(|case| case.job.section == STILL)?;
        shots.file(&case.job.name, case.entry?.record.image.files.tone_mapped.as_deref()?)
    });
    let words = match scenario.figure {
        Figure::None => "",
        Figure::FalsePositives => {
            "the figure below is the listed lights that do not reach a sample, per sample."
        }
        Figure::ListedOverContributing => {
            "the figure below is listed lights over contributing ones."
        }
        Figure::TemporalError => {
            "the figure below is how much the error changes from frame to frame."
        }
        Figure::FrameTime => "the figure below is the spread of the time to assign and shade.",
    };
    figure(picture, "No culling", words)
}

/// The figure of each method, where one figure says more.
fn figures<'a>(scenario: &Scenario, cells: impl Iterator<Item = &'a Cell<'a>>) -> Html {
    let value = |record: &Record| -> Option<String> {
        match scenario.figure {
            Figure::None => None,
            Figure::FalsePositives => {
                let listed = record.lists.listed_per_sample?;
                let needed = record.lists.contributing_per_sample?;
                Some(significant(listed - needed))
            }
            Figure::ListedOverContributing => {
                let listed = record.lists.listed_per_sample?;
                let needed = record.lists.contributing_per_sample.filter(|needed| *needed > 0.0)?;
                Some(significant(listed / needed))
            }
            Figure::TemporalError => temporal(record),
            Figure::FrameTime => {
                let frames = record.frames_ms();
                let (mean, deviation) = (mean(&frames), standard_deviation(&frames));
                let worst = frames.iter().copied().fold(0.0, f64::max);
                (frames.len() > 1 && mean > 0.0).then(|| {
                    format!(
                        "mean {} ms, SD {} ms, worst {} ms",
                        significant(mean),
                        significant(deviation),
                        significant(worst)
                    )
                })
            }
        }
    };
    let line = |cell: &Cell<'_>| {
        let deferred = |case: &&Case<'_>| case.mode == Some(Mode::Deferred);
        let of_case = |case: &Case<'_>| {
            let value = value(case.entry?.record)?;
            let section = case.job.section.replace('-', " ");
            let is_plain = [STILL, FLAWED].contains(&case.job.section.as_str());
            Some(if is_plain { value } else { format!("{section}: {value}") })
        };
        let values: Vec<String> = cell.cases.iter().filter(deferred).filter_map(of_case).collect();
        let value = Some(values.join("; ")).filter(|value| !value.is_empty())?;
        Some(html!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", cell.method.name(), value))
    };
    let rows: Html = cells.filter_map(line).collect();
    if rows.is_empty() {
        return Html::default();
    }
    html!(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\"><table class=\"figures\">\
         <thead><tr><th scope=\"col\">method</th><th scope=\"col\">{0}</th></tr></thead><tbody>\n{1}</tbody></table>\
         </div>\n",
        scenario.figure.name(),
        rows
    )
}

/// How much the error of an image changes from one frame to the next.
fn temporal(record: &Record) -> Option<String> {
    let temporal = record.image.temporal.as_ref()?;
    let worst = temporal.worst?;
    if worst == 0.0 {
        return Some("0".to_owned());
    }
    let ([x, y], frame) = (temporal.worst_pixel, temporal.worst_frame);
    Some(format!(
        "mean {}, worst {} at pixel {x}, {y} of frame {frame}",
        difference(temporal.mean?),
        difference(worst)
    ))
}

/// A method: a line, and below it each of its runs.
fn shown(scene: &str, cell: &Cell<'_>, shots: &mut Shots<'_>) -> Html {
    let (Some(outcome), Some(worst)) = (cell.outcome(), cell.worst()) else {
        return Html::default();
    };
    let runs: Html = cell.cases.iter().map(run).collect();
    let flaw = match &cell.method {
        Method::Sound(_) => Html::default(),
        Method::Flawed(flaw) => {
            html!("<p>{} <small>Source: {}.</small></p>\n", flaw.fails, flaw.source)
        }
    };
    let pictures = if has_failed(cell) { pictures(cell, shots) } else { Html::default() };
    html!(
        "<details id=\"{}\"><summary><i class=\"cell {}\">{}</i> <b>{}</b> {}</summary>\n{}<ul>{}</ul>\n{}</details>\n",
        anchor(scene, &cell.method),
        outcome.name(),
        outcome.sign(),
        cell.method.name(),
        worst.words,
        flaw,
        runs,
        pictures
    )
}

/// One run: where, what was seen, and the command.
fn run(case: &Case<'_>) -> Html {
    let mode = case.mode.map_or("both modes", Mode::name);
    let command = command(case);
    let places = case.entry.and_then(|entry| worst_places(&entry.job.command, entry.record));
    html!(
        "<li><i class=\"cell {}\">{}</i> {}, {}: {} {}<pre class=\"command\"><code>{}</code></pre></li>\n",
        case.outcome.name(),
        case.outcome.sign(),
        case.job.section.replace('-', " "),
        mode,
        if case.words.is_empty() { ABSENT.to_owned() } else { case.words.clone() },
        places.as_deref().map(inline).unwrap_or_default(),
        command
    )
}

/// The command that shows a run again: that of its job, with its method only.
fn command(case: &Case<'_>) -> String {
    let mut words = case.job.command.clone();
    let mut set = |option: &str, value: &str| {
        if let Some(at) =
            words.iter().position(|word| word == option).filter(|at| at + 1 < words.len())
        {
            words[at + 1] = value.to_owned();
        }
    };
    set("--strategies", &format!("None,{}", case.id));
    if let Some(mode) = case.mode {
        set("--mode", mode.name());
    }
    set("--pictures", "all");
    shell_words(&words)
}

/// The pictures of the run that shows the failure best.
fn pictures(cell: &Cell<'_>, shots: &mut Shots<'_>) -> Html {
    let failed = |case: &&Case<'_>| matches!(case.outcome, Outcome::Lossy | Outcome::Wrong);
    let error = |case: &&Case<'_>| {
        // An error that is not finite is the largest.
        let stored = case.entry.and_then(|entry| entry.record.image.errors.get("rel_mse").copied());
        stored.map_or(0.0, |error| error.unwrap_or(f64::INFINITY))
    };
    let kept = |case: &&Case<'_>| {
        case.entry.is_some_and(|entry| entry.record.image.files.difference.is_some())
    };
    let shown = cell.cases.iter().filter(failed).filter(kept);
    let Some(entry) =
        shown.max_by(|a, b| error(a).total_cmp(&error(b))).and_then(|case| case.entry)
    else {
        return Html::default();
    };
    let files = &entry.record.image.files;
    let mut keep = |file: &Option<String>| shots.file(&entry.job.name, file.as_deref()?);
    let (image, reference) = (keep(&files.tone_mapped), keep(&files.baseline));
    let (difference, heat) = (keep(&files.difference), keep(&files.heat_map));
    let pair = PicturePair {
        scene: &entry.record.setting.scene,
        name: &cell.method.name(),
        size: [entry.record.setting.width, entry.record.setting.height],
        image: image.as_deref(),
        reference: reference.as_deref(),
        reference_name: "no culling",
        difference: difference.as_deref(),
        gain: files.difference_amplification,
        verdict: verdict(entry.record),
        explain: explain_command(&entry.job.command, entry.record, None),
    };
    let stage = html!("<div class=\"stage\">{}{}</div>\n", pair.main(), pair.difference(false));
    stage
        + html!(
            "<div class=\"views\">{}</div>\n",
            figure(heat, "Lights per sample", "blue is 0, red 150 or more.")
        )
}
