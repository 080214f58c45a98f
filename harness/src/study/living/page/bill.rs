//! What each pass costs with lights that move, as bars and as a table, and what memory they need.

use super::times::name;
use crate::chart::{Axis, BarChart, Marks, Scale, Series, XyChart};
use crate::report::bill::columns;
use crate::report::colours::Colours;
use crate::report::column::{Better, Column};
use crate::report::format::{mebibytes, number, significant};
use crate::report::markup::Html;
use crate::report::page::setting;
use crate::report::pass_bars::{Counted, pass_bar, spread};
use crate::report::table::{Look, Row, Table};
use crate::results::{Record, Results};
use crate::study::data::{counts, entries, lines};
use crate::study::living::jobs::{KINDS, LIGHTS};
use crate::study::living::movement::Movement;
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::lines::points;
use crate::study::page::part::Part;

/// From this ratio of the longest to the shortest bar on, the axis is logarithmic.
const LOG_ABOVE: f64 = 20.0;

/// Bars and a table for each number of lights, the most lights first.
pub(crate) fn bill(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = entries(done, scene, LIGHTS);
    let panel = |count: u64| {
        let here = all.iter().map(|entry| entry.record);
        let here: Vec<&Record> = here.filter(|r| r.setting.lights == count).collect();
        let title = format!("{} lights", number(count as f64));
        let slug = format!("{scene}-bill-{count}");
        let body = bars(done, &slug, &format!("What each pass costs, {title}"), &here, charts);
        (title.clone(), body + table(&title, here))
    };
    let shown: Vec<(String, Html)> = counts(&all).into_iter().rev().map(panel).collect();
    Part::new(
        "bill",
        "What each pass costs",
        "Means along the path. Green passes exist only because the lights move: upload (the CPU checks, \
         converts and copies them), order (the GPU sorts them; the share of a frame, if not every frame sorts) \
         and boxes (the GPU copies them to their places and boxes them). Methods that read the plain list pay \
         for the upload only. The build of a hierarchy over still lights is off the clock.",
        panels("Lights", &shown),
    )
}

fn bars(done: &Done, slug: &str, title: &str, records: &[&Record], charts: &mut Charts) -> Html {
    let Some(any) = done.results.values().next() else { return Html::default() };
    let empty = Results::new(any.machine.clone(), Vec::new(), any.truth.clone());
    let owned = records.iter().map(|record| (*record).clone()).collect();
    let results = Results { records: owned, ..empty };
    let colours = Colours::new(&results);
    let counted = Counted::AssignAndShade;
    let scale = match spread(counted, records) > LOG_ABOVE {
        true => Scale::Log,
        false => Scale::LinearFromZero,
    };
    let bar = |record: &&Record| {
        pass_bar(record, name(&record.strategy, Movement::of(record)), counted, &colours)
    };
    let chart = BarChart {
        title: title.to_owned(),
        axis: Axis::new("Assign + shade", "ms", scale),
        rows: ordered(records).iter().map(bar).collect(),
        note: String::new(),
    };
    if records.is_empty() { Html::default() } else { charts.bars(slug, &chart) }
}

/// By strategy, then by the way in which lights move.
fn ordered<'a>(records: &[&'a Record]) -> Vec<&'a Record> {
    let mut records = records.to_vec();
    let place = |record: &Record| Movement::ALL.iter().position(|m| *m == Movement::of(record));
    let ids: Vec<_> = records.iter().map(|record| record.strategy.clone()).collect();
    records.sort_by_key(|record| (ids.iter().position(|id| *id == record.strategy), place(record)));
    records
}

/// The bill of some records, with their totals and their memory.
fn table(label: &str, records: Vec<&Record>) -> Html {
    let both = |record: &&Record| Some(record.assign_and_shade_ms());
    let mut all = vec![Column::ms("assign + shade", both)];
    all.push(Column::ms("span", |record: &&Record| record.times.span_ms).optional());
    all.extend(columns(records.iter().copied(), |record: &&Record| record));
    let bytes = |record: &&Record| record.lists.assignment_bytes.map(|bytes| bytes as f64);
    all.push(Column::figure("memory", "MiB", Better::Less, bytes, mebibytes).optional());
    let row = |record: &'_ Record| name(&record.strategy, Movement::of(record));
    let rows = ordered(&records).into_iter().map(|record| Row::new(row(record), record)).collect();
    Table::new("strategy", all, rows)
        .competing(|_| false)
        .dotted(|record| record.strategy.class())
        .html(&format!("What each pass costs, {label}"), Look::Plain)
}

/// Memory against the number of lights: a line per strategy with lights that move, dashes with still ones.
pub(crate) fn memory(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = entries(done, scene, LIGHTS);
    let bytes = |record: &Record| record.lists.assignment_bytes.unwrap_or(0) as f64 / 1_048_576.0;
    let mut series = Vec::new();
    for (id, records) in lines(&all) {
        for (movement, marks) in
            [(Movement::Still, Marks::Dashed), (Movement::Gpu, Marks::LineAndPoints)]
        {
            let known = |record: &&Record| record.lists.assignment_bytes.is_some();
            let of_movement = records.iter().copied().filter(|r| Movement::of(r) == movement);
            let of_movement: Vec<&Record> = of_movement.filter(known).collect();
            let mut points = points(&name(id, movement), &of_movement, bytes);
            for (point, record) in points.iter_mut().zip(&of_movement) {
                point.y_range = None;
                let lights = number(record.setting.lights as f64);
                let mib = significant(point.y);
                point.tip = format!("{}\n{lights} lights\n{mib} MiB", name(id, movement));
            }
            let label = if marks == Marks::Dashed { String::new() } else { id.short() };
            series.push(Series::new(label, id.class(), marks, points));
        }
    }
    let axes = [Axis::new("Lights", "", Scale::Log), Axis::new("Memory", "MiB", Scale::Log)];
    let chart = XyChart::new("Memory against lights", axes, series);
    let body = match chart.series.is_empty() {
        true => Html::default(),
        false => charts.xy(&format!("{scene}-memory"), &chart),
    };
    Part::new(
        "memory",
        "Memory",
        "GPU memory of everything that assignment needs. Lines: the GPU moves the lights, and methods that read \
         the hierarchy also need what sorts, copies and boxes them. Dashes: still lights.",
        body,
    )
}

/// The bill under points, spots and polygons at once.
pub(crate) fn kinds(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all: Vec<&Record> = entries(done, scene, KINDS).iter().map(|entry| entry.record).collect();
    let meta = all.first().map_or_else(String::new, |record| format!(" {}.", setting(record)));
    let title = "What each pass costs, three kinds of lights";
    let bars = bars(done, &format!("{scene}-kinds"), title, &all, charts);
    Part::new(
        "kinds",
        "Three kinds of lights",
        format!("A third each are points, spots and polygons. All of them move.{meta}"),
        bars + table("three kinds of lights", all),
    )
}
