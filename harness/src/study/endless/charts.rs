//! Charts of one case of polygon lights: times, outer specular operations and operations that nobody
//! sees, by the number of cones.

use crate::chart::{Axis, BarChart, BarRow, Scale, Segment};
use crate::report::format::significant;
use crate::report::markup::Html;
use crate::results::{Operations, Record};
use crate::study::endless::cases::{Case, seen, setting};
use crate::study::page::figure::{Charts, time_bar};

/// The charts that a case has figures for.
pub(crate) fn charts_of(case: &Case<'_>, scene: &str, charts: &mut Charts) -> Html {
    let slug = |what: &str| format!("{scene}-{}-{}-{what}", case.place, case.lights);
    let culled: Vec<&Record> = case.culled().collect();
    let mut html = Html::default();
    let bar = |record: &&Record| time_bar(setting(&record.strategy), String::new(), record);
    let times = BarChart {
        title: "Assign and shade by cones".to_owned(),
        axis: axis("Assign + shade", "ms"),
        rows: culled.iter().map(bar).collect(),
        note: String::new(),
    };
    html += charts.bars(&slug("times"), &times);
    let outer =
        case.position().and_then(|record| record.lists.operations).map(|all| all.outer_specular);
    if let Some(all) = outer.filter(|all| *all > 0) {
        let share = |operations: &Operations| operations.outer_specular as f64 / all as f64 * 100.0;
        let title = "Outer specular operations, as a share of those by position only";
        html += counted(&culled, title, "Outer specular operations", "%", share)
            .map_or_else(Html::default, |chart| charts.bars(&slug("outer"), &chart));
    }
    // The share of visible terms among those that a setting lists, not among those that it should list.
    let waste = |operations: &Operations| match seen(operations) {
        0 => f64::NAN,
        seen => operations.listed() as f64 / seen as f64,
    };
    let title = "Listed terms per visible listed term";
    html + counted(&culled, title, "Listed over perceptible", "", waste)
        .map_or_else(Html::default, |chart| charts.bars(&slug("perceptible"), &chart))
}

fn axis(label: &str, unit: &str) -> Axis {
    Axis::new(label, unit, Scale::LinearFromZero)
}

/// Bars of a figure of operations; `None` where none were counted.
fn counted(
    records: &[&Record],
    title: &str,
    label: &str,
    unit: &str,
    value: impl Fn(&Operations) -> f64,
) -> Option<BarChart> {
    let row = |record: &&Record| {
        let value = value(record.lists.operations.as_ref()?);
        value.is_finite().then(|| BarRow {
            name: setting(&record.strategy),
            class: String::new(),
            segments: vec![Segment {
                name: label.to_owned(),
                class: record.strategy.class(),
                value,
            }],
            value_text: format!("{} {unit}", significant(value)).trim_end().to_owned(),
            tip: format!("{}\n{label} {} {unit}", record.strategy, significant(value)),
        })
    };
    let rows: Vec<BarRow> = records.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| BarChart {
        title: title.to_owned(),
        axis: axis(label, unit),
        rows,
        note: String::new(),
    })
}
