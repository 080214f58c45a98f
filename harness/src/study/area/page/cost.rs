//! The cost of area lights: times against the number of lights, by model, compared with spots.

use crate::chart::{Axis, Marks, Scale, Series, XyChart};
use crate::report::finding::lights;
use crate::report::format::{ABSENT, significant};
use crate::report::markup::{Html, html};
use crate::results::Record;
use crate::study::area::page::models::{SPOTS, class, model, name};
use crate::study::data::{counts, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, table, unit};
use crate::study::page::lines::{fit, points};
use crate::study::page::part::Part;

fn shade(record: &Record) -> f64 {
    record.times.shade_ms
}

/// The records of one model, with its name.
type ModelLine<'a> = (&'a str, Vec<&'a Record>);

/// The records of each model, in the order of their lights.
fn by_model<'a>(done: &'a Done, scene: &'a str) -> Vec<ModelLine<'a>> {
    let mut lines: Vec<ModelLine<'a>> = Vec::new();
    for entry in entries(done, scene, "cost") {
        let own = model(entry.record);
        match lines.iter_mut().find(|(known, _)| *known == own) {
            Some((_, records)) => records.push(entry.record),
            None => lines.push((own, vec![entry.record])),
        }
    }
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
    let series = |(model, records): &ModelLine<'_>| Series {
        name: (*model).to_owned(),
        class: class(model),
        marks: Marks::LineAndPoints,
        points: points(model, records, shade),
        ..Series::default()
    };
    let chart = XyChart {
        title: "Shading time against lights, by model".to_owned(),
        x: Axis { label: "Lights".to_owned(), unit: String::new(), scale: Scale::Log },
        y: Axis { label: "Shade".to_owned(), unit: "ms".to_owned(), scale: Scale::Log },
        series: lines.iter().map(series).collect(),
        note: String::new(),
    };
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

fn times(done: &Done, scene: &str, lines: &[ModelLine<'_>]) -> Html {
    let counts = counts(&entries(done, scene, "cost"));
    let spots = lines.iter().find(|(own, _)| *own == SPOTS).map(|(_, records)| records);
    let at = |records: &[&Record], count: u64| {
        records.iter().find(|record| record.setting.lights == count).map(|record| shade(record))
    };
    let slope = |records: &[&Record]| fit(records, shade).filter(|fit| fit.points > 2);
    let rows: Vec<Vec<Html>> = lines
        .iter()
        .map(|(own, records)| {
            let mut row = vec![name(own)];
            row.extend(counts.iter().map(|&count| {
                let Some(time) = at(records, count) else { return ABSENT.into() };
                match spots.and_then(|spots| at(spots, count)).filter(|_| *own != SPOTS) {
                    Some(spot) => html!(
                        "{} <span class=\"unit\">\u{d7} {}</span>",
                        significant(time),
                        significant(time / spot)
                    ),
                    None => significant(time).into(),
                }
            }));
            let line = slope(records);
            row.push(
                line.map_or_else(|| ABSENT.into(), |line| significant(line.slope * 1e3).into()),
            );
            let ratio = line.zip(spots.and_then(|spots| slope(spots))).filter(|_| *own != SPOTS);
            row.push(ratio.map_or_else(
                || ABSENT.into(),
                |(line, spot)| significant(line.slope / spot.slope).into(),
            ));
            row
        })
        .collect();
    let mut heads: Vec<Html> = vec!["model".into()];
    heads.extend(counts.iter().map(|count| unit(&lights(*count), "ms")));
    heads.extend([unit("a light", "\u{b5}s"), "area : spot".into()]);
    table("Shading times by lights", &heads, &rows)
}

/// The cost of an area light compared with a spot, at the most lights.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let lines = by_model(done, scene);
    let at_most = |own: &str| {
        let records = &lines.iter().find(|(known, _)| *known == own)?.1;
        records.last().map(|record| (record.setting.lights, shade(record)))
    };
    let sentence = || {
        let ((count, spots), (same, ltc)) = (at_most(SPOTS)?, at_most("ltc")?);
        (count == same).then(|| {
            format!(
                "In {scene} at {}, LTC takes {} times as long as spots (area : spot): {} and {} \
                 ms.",
                lights(count),
                significant(ltc / spots),
                significant(ltc),
                significant(spots)
            )
        })
    };
    sentence().into_iter().collect()
}
