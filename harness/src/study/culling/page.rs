//! The culling survey: times along a path against 0 to 1,500 lights, in both modes. What the survey
//! claims of them is judged in `claims`.

use crate::chart::{Axis, Marks, Scale, XyChart};
use crate::report::column::{Better, Column};
use crate::report::finding::lights;
use crate::report::fit::Fit;
use crate::report::format::{number, significant};
use crate::report::markup::Html;
use crate::report::rank::{ALIKE, listed};
use crate::report::table::{Look, Row, Table};
use crate::results::Record;
use crate::study::data::{Entry, Line, counts, entries, lines, marked_name};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::lines::{fit, times_series};
use crate::study::page::part::Part;

/// The sections of the study: how pixels are lit.
const MODES: [&str; 2] = ["deferred", "forward"];

/// What stands above forward times of a data-centre GPU.
const FORWARD_CAUTION: &str = " This GPU runs fragment shaders on only a few of its processors: \
                               compare these times with each other, not with deferred ones or \
                               with those of another GPU.";

/// What stands above deferred times of a data-centre GPU.
const DEFERRED_CAUTION: &str = " This GPU runs fragment shaders on only a few of its processors: \
                                RasterSphere and Clay shade there, the other methods in a compute \
                                pass.";

fn frame(record: &Record) -> f64 {
    record.times.frame_ms
}

/// A chart, the fits and the times of each mode.
pub(crate) fn modes(done: &Done, scene: &str, charts: &mut Charts) -> Vec<Part> {
    MODES
        .iter()
        .filter_map(|mode| {
            let all = entries(done, scene, mode);
            if all.is_empty() {
                return None;
            }
            let linear = |label, unit| Axis::new(label, unit, Scale::LinearFromZero);
            let axes = [linear("Lights", ""), linear("Frame, mean along the path", "ms")];
            let series = lines(&all)
                .iter()
                .map(|(id, records)| times_series(id, records, frame, Marks::LineAndPoints))
                .collect();
            let title = format!("Frame time against lights, {mode}");
            let chart = XyChart::new(title, axes, series);
            let body = charts.xy(&format!("{scene}-{mode}"), &chart) + times(&all);
            let caution = match done.results.values().any(|r| r.machine.weak_raster().is_some()) {
                true if *mode == "forward" => FORWARD_CAUTION,
                true => DEFERRED_CAUTION,
                false => "",
            };
            let text = format!(
                "Times are of whole frames, mean over the frames of the path. Slope and offset \
                 belong to the straight line through these times. The relMSE is the error against \
                 no culling, at the most lights. The survey\u{2019}s own clusters are those of 40 x \
                 40 pixels and 24 slices, capped at 128 lights.{caution}"
            );
            Some(Part::new(mode, format!("Times, {mode}"), text, body))
        })
        .collect()
}

/// The time of a frame at each count of lights, the straight line through these times, and the error at the
/// most lights.
fn times<'a>(entries: &[Entry<'a>]) -> Html {
    let at = |count: u64| {
        let time = move |(_, records): &Line<'a>| {
            let found = records.iter().find(|record| record.setting.lights == count);
            found.map(|record| frame(record))
        };
        Column::ms(number(count as f64), time)
    };
    let mut columns: Vec<Column<'a, Line<'a>>> = counts(entries).into_iter().map(at).collect();
    columns.extend([
        Column::figure(
            "slope",
            "\u{b5}s per 1,000 lights",
            Better::Less,
            |line: &Line<'a>| Some(straight(line)?.slope * 1e6),
            significant,
        ),
        Column::ms("offset", |line: &Line<'a>| Some(straight(line)?.offset)),
        Column::figure(
            "R\u{b2}",
            "",
            Better::More,
            |line: &Line<'a>| Some(straight(line)?.r2),
            |r2| format!("{r2:.3}"),
        ),
        Column::figure(
            "relMSE",
            "",
            Better::Less,
            |(_, records): &Line<'a>| error(records.last()?),
            significant,
        ),
    ]);
    let row = |line: Line<'a>| Row::new(marked_name(entries, line.0), line);
    Table::new("method", columns, lines(entries).into_iter().map(row).collect())
        .competing(|_| false)
        .dotted(|(id, _)| id.class())
        .html("Frame times by lights", Look::Plain)
}

/// The straight line through the times of a method, from three counts of lights on.
fn straight((_, records): &Line<'_>) -> Option<Fit> {
    fit(records, frame).filter(|fit| fit.points > 2)
}

/// The error of a record against no culling; `None` where it was not compared.
fn error(record: &Record) -> Option<f64> {
    record.image.errors.get("rel_mse").copied().flatten().filter(|_| !record.is_control())
}

/// A record's time, and its error where a knob loses light.
fn time_and_error(record: &Record) -> String {
    let time = format!("{} {} ms", record.strategy, significant(record.times.frame_ms));
    match error(record).filter(|_| record.is_lossy) {
        Some(error) => format!("{time} (lossy, relMSE {})", significant(error)),
        None => time,
    }
}

/// The methods of a mode at the most lights, fastest first; the control is none.
fn by_time<'a>(done: &'a Done, scene: &'a str, mode: &'a str) -> Vec<&'a Record> {
    let all = entries(done, scene, mode);
    let most = counts(&all).last().copied();
    let mut records: Vec<&Record> = all
        .iter()
        .map(|entry| entry.record)
        .filter(|r| {
            Some(r.setting.lights) == most && !r.is_control() && r.times.frame_ms.is_finite()
        })
        .collect();
    records.sort_by(|a, b| a.times.frame_ms.total_cmp(&b.times.frame_ms));
    records
}

/// All methods at the most lights, in each mode.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let sentence = |mode: &&str| {
        let records = by_time(done, scene, mode);
        let times: Vec<String> = records.iter().map(|record| time_and_error(record)).collect();
        Some(format!(
            "In {scene} at {}, {mode}, the mean times of a frame along the path are: {}.",
            lights(records.first()?.setting.lights),
            listed(&times)
        ))
    };
    MODES.iter().filter_map(sentence).collect()
}

/// The fastest without a loss in each mode by mean frame, the survey's statistic, in the first scene that has
/// figures. Frames that are alike tie, whether their methods cull or not.
pub(crate) fn headline(done: &Done) -> Option<String> {
    done.scenes().into_iter().find_map(|scene| {
        let fastest = |mode: &&str| {
            let mut records = by_time(done, scene, mode);
            records.retain(|record| record.shows_no_loss());
            let first = *records.first()?;
            let alike =
                |record: &&&Record| record.times.frame_ms <= first.times.frame_ms * (1.0 + ALIKE);
            let names: Vec<&str> =
                records.iter().take_while(alike).map(|record| record.strategy.as_str()).collect();
            let verb = if names.len() > 1 { "tie" } else { "is fastest" };
            let time = significant(first.times.frame_ms);
            Some((
                first.setting.lights,
                format!("{} {verb} with {mode} lighting ({time} ms a frame)", listed(&names)),
            ))
        };
        let all: Vec<(u64, String)> = MODES.iter().filter_map(fastest).collect();
        let most = all.first()?.0;
        // Modes may have been measured at other counts of lights.
        let part = |(count, words): &(u64, String)| match *count == most {
            true => words.clone(),
            false => format!("at {}, {words}", lights(*count)),
        };
        let parts: Vec<String> = all.iter().map(part).collect();
        Some(format!("In {scene} at {}, without a loss: {}.", lights(most), parts.join("; ")))
    })
}
