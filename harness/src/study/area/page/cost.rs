//! The cost of area lights: times against the number of lights, by model, compared with spots.

use crate::chart::{Axis, Marks, Scale, Series, XyChart};
use crate::grouping::grouped_by;
use crate::report::column::{Better, Column};
use crate::report::finding::lights;
use crate::report::format::significant;
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};
use crate::results::Record;
use crate::study::area::page::models::{SPOTS, class, model};
use crate::study::data::{counts, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::lines::{fit, points};
use crate::study::page::part::Part;

fn shade(record: &Record) -> f64 {
    record.times.shade_ms
}

/// The records of one model, with its name.
type ModelLine<'a> = (&'a str, Vec<&'a Record>);

/// The records of each model, in the order of their lights.
fn by_model<'a>(done: &'a Done, scene: &'a str) -> Vec<ModelLine<'a>> {
    let all = entries(done, scene, "cost").into_iter();
    let mut lines = grouped_by(all.map(|entry| (model(entry.record), entry.record)));
    for (_, records) in &mut lines {
        records.sort_by_key(|record| record.setting.lights);
    }
    lines
}

/// A chart and the times, each over those of as many spots.
pub(crate) fn cost(done: &Done, scene: &str, charts: &mut Charts) -> Option<Part> {
    let lines = by_model(done, scene);
    if lines.is_empty() {
        return None;
    }
    let series = |(model, records): &ModelLine<'_>| {
        Series::new(*model, class(model), Marks::LineAndPoints, points(model, records, shade))
    };
    let axes = [Axis::new("Lights", "", Scale::Log), Axis::new("Shade", "ms", Scale::Log)];
    let title = "Shading time against lights, by model";
    let chart = XyChart::new(title, axes, lines.iter().map(series).collect());
    let body = charts.xy(&format!("{scene}-cost"), &chart) + times(done, scene, &lines);
    Some(Part::new(
        "cost",
        "Cost of area lights and of spots",
        "The time of the lighting pass only, with every light at every sample. The factor after \
         each time compares it with the same number of spots. The slope is that of the straight \
         line through the times; area : spot is its ratio to the slope of spots. The paper \
         measured about 2 for whole frames; its row among the claims shows both.",
        body,
    ))
}

/// The time of each model at each count of lights, and the straight line through these times.
fn times<'a>(done: &Done, scene: &str, lines: &'a [ModelLine<'a>]) -> Html {
    let spots = lines.iter().find(|(model, _)| *model == SPOTS);
    let slope = |(_, records): &ModelLine<'_>| {
        Some(fit(records, shade).filter(|fit| fit.points > 2)?.slope)
    };
    // A figure of a model over that of spots.
    let over_spots = |line: &ModelLine<'a>, figure: &dyn Fn(&ModelLine<'a>) -> Option<f64>| {
        let spots = spots.filter(|_| line.0 != SPOTS)?;
        Some(figure(line)? / figure(spots)?)
    };
    let at = |count: u64| {
        let time = move |(_, records): &ModelLine<'a>| {
            records.iter().find(|record| record.setting.lights == count).map(|record| shade(record))
        };
        Column::ms(lights(count), move |line: &&ModelLine<'a>| time(line)).note(move |line| {
            over_spots(line, &time).map_or_else(Html::default, |factor| {
                html!(" <span class=\"unit\">\u{d7} {}</span>", significant(factor))
            })
        })
    };
    let mut columns: Vec<_> = counts(&entries(done, scene, "cost")).into_iter().map(at).collect();
    let per_light = |line: &&ModelLine<'a>| Some(slope(line)? * 1e3);
    let ratio = |line: &&ModelLine<'a>| over_spots(line, &slope);
    columns.extend([
        Column::figure("a light", "\u{b5}s", Better::Less, per_light, significant),
        Column::figure("area : spot", "", Better::Less, ratio, significant),
    ]);
    Table::new("model", columns, lines.iter().map(|line| Row::new(line.0, line)).collect())
        .competing(|_| false)
        .dotted(|line| class(line.0))
        .html("Shading times by lights", Look::Plain)
}

/// The cost of an area light compared with a spot, at the most lights.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let lines = by_model(done, scene);
    let at_most = |model: &str| {
        let records = &lines.iter().find(|(known, _)| *known == model)?.1;
        records.last().map(|record| (record.setting.lights, shade(record)))
    };
    let sentence = || {
        let ((count, spots), (same, ltc)) = (at_most(SPOTS)?, at_most("ltc")?);
        (count == same).then(|| {
            format!(
                "In {scene} at {}, LTC takes {} times as long as spots (area : spot): LTC takes {} \
                 ms and spots take {} ms.",
                lights(count),
                significant(ltc / spots),
                significant(ltc),
                significant(spots)
            )
        })
    };
    sentence().into_iter().collect()
}
