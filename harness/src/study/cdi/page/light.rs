//! Indirect light by virtual point lights against the path-traced image: errors by how ranges are found,
//! and pictures. [`verdicts`](crate::study::cdi::verdicts) judges the errors.

use crate::report::column::{Better, Column};
use crate::report::format::{ABSENT, number, percent, significant};
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::{Errors, Record, TruthImage, Vpls};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::cdi::jobs;
use crate::study::cdi::lights::{METRIC, RULES, rule, setting, total_ms};
use crate::study::cdi::same_build::by_build;
use crate::study::cdi::times;
use crate::study::cdi::verdicts::{about_ties, best};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::error_columns::error_columns;
use crate::study::page::errors_plot::Plot;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::part::Part;
use crate::study::page::pictures::{figure, linear};
use crate::study::page::shots::{Shots, Wanted};

/// Gain of difference pictures, relative to the images.
const GAIN: f32 = 4.0;

/// The curve that a record is on: over factors and spans, each size of the map by itself; rays that are set
/// otherwise by themselves.
fn series(record: &Record) -> String {
    let Some(vpls) = &record.indirect else { return String::new() };
    let side = vpls.rsm_px;
    match vpls.ranges.as_str() {
        "random" => format!("random, {side}\u{b2}"),
        "infinite" => "infinite".to_owned(),
        _ if !jobs::is_usual(vpls) => "rays, otherwise set".to_owned(),
        _ => format!("{}, {side}\u{b2}", rule(record)),
    }
}

fn class(record: &Record) -> String {
    let is_cast = |vpls: &Vpls| vpls.rays > 0 && !jobs::is_usual(vpls);
    if record.indirect.as_ref().is_some_and(is_cast) {
        return "series-5".to_owned();
    }
    RULES
        .iter()
        .find(|(_, _, name)| *name == rule(record))
        .map_or("strategy-none", |(_, class, _)| class)
        .to_owned()
}

fn title(record: &Record) -> String {
    format!("{}: {}", rule(record), setting(record))
}

/// Errors, times and pictures.
pub(crate) fn indirect(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let all = entries(done, scene, MODELS);
    let known: Vec<Entry<'_>> =
        all.iter().filter(|entry| !entry.record.image.truth_errors.is_empty()).copied().collect();
    let Some((_, truth)) = truth_of(done, scene).filter(|_| !known.is_empty()) else {
        return Vec::new();
    };
    let rows = errors_table(&known) + by_build(&known);
    let plot = Plot {
        slug: "indirect",
        title: "Error of indirect light against time",
        entries: known,
        errors: |record| &record.image.truth_errors,
        series,
        class,
        // A mark for each size of the map.
        shape: |record| {
            let side = record.indirect.as_ref()?.rsm_px;
            [256, 128, 64, 512].iter().position(|known| *known == side)
        },
        name: title,
        label: |record| {
            record.indirect.as_ref().map_or(String::new(), |vpls| number(f64::from(vpls.rsm_px)))
        },
        wanted: Wanted::Truth,
        time: "Lights, assign and shade",
        first: METRIC,
        ms: total_ms,
    };
    let body = plot.html(scene, charts, shots) + rows;
    let errors = Part::new("indirect", "Indirect light against the truth", about(truth), body);
    [Some(errors), pictures(done, scene, shots)].into_iter().flatten().collect()
}

fn about(truth: &TruthImage) -> String {
    format!(
        "The truth is one bounce of the primary light at {} x {}, without its direct light. The \
         CPU path-traced it in {} s, with a standard error of {} % of the mean. Times include the \
         shadow map, the deep images, the lights, their lists and shading. The number beside a \
         point is the side of the shadow map in pixels, with one light per pixel. Brightness is \
         not compensated. {}",
        truth.width,
        truth.height,
        significant(truth.seconds),
        percent(truth.standard_error),
        about_ties(truth)
    )
}

fn truth_errors<'r>(record: &'r &Record) -> &'r Errors {
    &record.image.truth_errors
}

fn errors_table(entries: &[Entry<'_>]) -> Html {
    let lights_ms = |record: &&Record| match &record.indirect {
        Some(vpls) => times::shown(vpls.total_ms(), vpls.unsteady().is_none()),
        None => ABSENT.into(),
    };
    let mean_range_m = |record: &&Record| Some(record.indirect.as_ref()?.mean_range_m);
    let both_ms = |record: &&Record| Some(record.assign_and_shade_ms());
    let mut columns = vec![
        Column::figure("mean range", "m", Better::Neither, mean_range_m, significant),
        Column::markup("lights", "ms", lights_ms),
        Column::figure("assign + shade", "ms", Better::Less, both_ms, significant),
    ];
    columns.extend(error_columns(truth_errors));
    let rows = entries.iter().map(|entry| Row::new(title(entry.record), entry.record)).collect();
    Table::new("ranges", columns, rows)
        .competing(|_| false)
        .dotted(|record| class(record))
        .html("Errors of indirect light against the truth", Look::Plain)
}

/// The best of each rule, over all that was tried, beside the truth.
fn pictures(done: &Done, scene: &str, shots: &mut Shots<'_>) -> Option<Part> {
    let (truth_job, truth) = truth_of(done, scene)?;
    let exposure = truth.exposure;
    let reference = linear(done, &truth_job.name, Some(&truth.raw))?;
    let truth_key = shots.linear(&truth_job.name, &truth.raw, exposure);
    let direct = done
        .section(scene, jobs::DIRECT)
        .find_map(|(job, results)| Some((job, results.truth_image.as_ref()?)))
        .and_then(|(job, image)| shots.file(&job.name, &image.image));
    let mut shown = Vec::new();
    for (_, _, name) in RULES {
        let Some(Entry { job, record, .. }) = best(&entries(done, scene, MODELS), name, |_| true)
        else {
            continue;
        };
        let raw = record.image.files.raw.as_deref();
        let Some(image) = linear(done, &job.name, raw) else { continue };
        let picture = raw.and_then(|raw| shots.linear(&job.name, raw, exposure));
        let gain = GAIN * exposure as f32;
        let apart = shots.drawn(format!("{}:difference", job.name), || {
            image.difference_png(&reference, gain).ok()
        });
        let caption = |text: &str| format!("{text}, {}.", setting(record));
        let body =
            figure(direct.clone(), "Zero bounces, path-traced", "what the light reaches itself.")
                + figure(
                    truth_key.clone(),
                    "One bounce alone, path-traced",
                    "the truth of indirect light.",
                )
                + figure(
                    picture,
                    &format!("One bounce by lights with {name} ranges"),
                    &format!("{}.", setting(record)),
                )
                + figure(
                    apart,
                    &format!("Difference \u{d7} {}", significant(f64::from(gain))),
                    &caption("absolute and linear; black means none; light behind walls is a leak"),
                );
        shown.push((name.to_owned(), html!("<div class=\"views\">{}</div>\n", body)));
    }
    let text = "Each rule is shown at its setting of least mean error. Indirect images use the \
                exposure of the truth.";
    Some(Part::new("pictures", "What ranges look like", text, panels("Ranges", &shown)))
}
