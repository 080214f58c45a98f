//! Charts of errors against times, one panel per metric, with the frontier: the points that no other
//! point beats in both.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::image_errors::{ERROR_METRICS, ErrorMetric};
use crate::report::format::{difference, significant};
use crate::report::frontier::frontier;
use crate::report::markup::{Html, html};
use crate::results::{Errors, Record};
use crate::study::data::Entry;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::shots::{Shots, Wanted};

/// The metric that a reader sees first, unless a plot chooses another one.
pub(crate) const FIRST: &str = "rel_mse";

/// A chart of errors against times.
pub(crate) struct Plot<'a> {
    pub(crate) slug: &'a str,
    pub(crate) title: &'a str,
    pub(crate) entries: Vec<Entry<'a>>,
    pub(crate) errors: fn(&Record) -> &Errors,
    /// The name of the series that a record belongs to.
    pub(crate) series: fn(&Record) -> String,
    /// The class that colours that series.
    pub(crate) class: fn(&Record) -> String,
    /// The shape of a record's points, where it tells something beside the colour.
    pub(crate) shape: fn(&Record) -> Option<usize>,
    /// The name of a record.
    pub(crate) name: fn(&Record) -> String,
    /// The label of a point.
    pub(crate) label: fn(&Record) -> String,
    pub(crate) wanted: Wanted,
    pub(crate) time: &'a str,
    /// The metric that a reader sees first.
    pub(crate) first: &'a str,
    /// That time of a record, ms: assigning and shading, or more.
    pub(crate) ms: fn(&Record) -> f64,
}

impl Plot<'_> {
    /// Draws one panel per metric, the first metric in front, and leaves a place for pictures below.
    pub(crate) fn html(&self, scene: &str, charts: &mut Charts, shots: &mut Shots<'_>) -> Html {
        let mut metrics: Vec<&ErrorMetric> = ERROR_METRICS
            .iter()
            .filter(|metric| self.entries.iter().any(|e| self.error(e.record, metric).is_some()))
            .collect();
        metrics.sort_by_key(|metric| metric.id != self.first);
        let keys: Vec<Option<String>> =
            self.entries.iter().map(|entry| shots.keep(*entry, self.wanted)).collect();
        let opens = keys.iter().any(Option::is_some);
        let all: Vec<(String, Html)> = metrics
            .into_iter()
            .map(|metric| {
                let slug = format!("{scene}-{}-{}", self.slug, metric.id);
                let mut body = charts.xy(&slug, &self.chart(metric, &keys));
                body += html!("<p class=\"note\">{}</p>\n", metric.about);
                (metric.head.to_owned(), body)
            })
            .collect();
        let body = panels("Metric of error", &all);
        if body.is_empty() {
            return body;
        }
        let viewer = match opens {
            true => html!("<div class=\"viewer\" hidden></div>\n"),
            false => Html::default(),
        };
        html!(
            "<div class=\"plot-of-errors\" data-errors=\"{}\">{}{}</div>\n",
            self.slug,
            body,
            viewer
        )
    }

    fn error(&self, record: &Record, metric: &ErrorMetric) -> Option<f64> {
        // Only bias has a sign.
        let error = (self.errors)(record).get(metric.id).copied().flatten().map(f64::abs);
        error.filter(|error| error.is_finite())
    }

    fn chart(&self, metric: &ErrorMetric, keys: &[Option<String>]) -> XyChart {
        let known: Vec<(String, &Record, Point)> = self
            .entries
            .iter()
            .zip(keys)
            .filter_map(|(entry, key)| {
                let error = self.error(entry.record, metric)?;
                let point = self.point(entry.record, metric, error, key.clone());
                Some(((self.series)(entry.record), entry.record, point))
            })
            .filter(|(_, _, point)| point.x.is_finite())
            .collect();
        let sound = known.iter().filter(|(_, record, _)| !record.strategy.has_flaw());
        let best = frontier(sound.map(|(_, _, point)| (point.x, point.y)));
        let mut names: Vec<(&str, String, Option<usize>)> = Vec::new();
        for (name, record, _) in &known {
            if names.iter().all(|(known, ..)| known != name) {
                names.push((name, (self.class)(record), (self.shape)(record)));
            }
        }
        let mut series = Vec::new();
        for (ix, (name, class, shape)) in names.iter().enumerate() {
            let points_of = |on: bool| {
                let of_series = known.iter().filter(|(known, _, _)| known == name);
                let mut points: Vec<Point> = of_series
                    .filter(|(_, _, point)| best.contains(&(point.x, point.y)) == on)
                    .map(|(_, _, point)| point.clone())
                    .collect();
                points.sort_by(|a, b| a.x.total_cmp(&b.x));
                points
            };
            let mut curve: Vec<Point> = known
                .iter()
                .filter(|(known, _, _)| known == name)
                .map(|(_, _, point)| Point { x: point.x, y: point.y, ..Point::default() })
                .collect();
            curve.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
            let like = Series {
                name: (*name).to_owned(),
                class: class.clone(),
                shape: Some(shape.unwrap_or(ix)),
                ..Series::default()
            };
            series.push(Series { points: points_of(false), faded: true, ..like.clone() });
            series.push(Series { points: points_of(true), ..like.clone() });
            let line = Marks::Line;
            series.push(Series { points: curve, faded: true, marks: line, ..like });
        }
        // The lines carry no names: they would be written over the labels.
        for series in &mut series {
            if series.marks == Marks::Line || (series.faded && series.points.is_empty()) {
                series.name.clear();
            }
        }
        let names_once = |series: &mut Vec<Series>| {
            let mut seen: Vec<String> = Vec::new();
            for series in series.iter_mut().filter(|series| !series.points.is_empty()) {
                if seen.contains(&series.name) {
                    series.name.clear();
                } else {
                    seen.push(series.name.clone());
                }
            }
        };
        names_once(&mut series);
        series.push(Series {
            marks: Marks::Steps,
            points: best.iter().map(|&(x, y)| Point { x, y, ..Point::default() }).collect(),
            ..Series::default()
        });
        XyChart {
            title: format!("{}: {}", self.title, metric.head),
            x: Axis { label: self.time.to_owned(), unit: "ms".to_owned(), scale: Scale::Log },
            y: Axis {
                label: format!("Error, {}", metric.head),
                unit: metric.unit.to_owned(),
                scale: Scale::Log,
            },
            series,
            note: String::new(),
        }
    }

    fn point(&self, record: &Record, metric: &ErrorMetric, y: f64, key: Option<String>) -> Point {
        let x = (self.ms)(record);
        let before = x - record.assign_and_shade_ms();
        let mut tip = format!(
            "{}\n{} ms\n{} {}",
            (self.name)(record),
            significant(x),
            metric.head,
            difference(y)
        );
        if key.is_some() {
            tip += "\nopens its pictures";
        }
        Point {
            x,
            y,
            x_range: record
                .interval_ms()
                .map(|interval| [before + interval.low, before + interval.high]),
            y_range: None,
            label: (self.label)(record),
            key: key.unwrap_or_default(),
            tip,
        }
    }
}
