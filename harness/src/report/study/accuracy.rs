//! Speed against accuracy: what each lossy knob gains in time and costs in error.

use super::super::format::{difference, escape, significant};
use super::super::rank::Ratio;
use super::data::{Entry, class, entries, family, knob, lines};
use super::figure::{Charts, panels, part};
use super::shots::{Shots, Wanted};
use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::errors::{ERROR_METRICS, ErrorMetric};
use crate::results::{Errors, Record};
use crate::study::Done;

/// The metric that a reader sees first.
const FIRST: &str = "rel_mse";

/// A chart of errors against times.
struct Plot<'a> {
    slug: &'a str,
    title: &'a str,
    entries: Vec<Entry<'a>>,
    errors: fn(&Record) -> &Errors,
    /// The series that a record belongs to: its name and the id that colours it.
    series: fn(&Record) -> String,
    /// The shape of a record's points, where it tells something beside the colour.
    shape: fn(&Record) -> Option<usize>,
    /// What is written beside a point.
    label: fn(&Record) -> String,
    wanted: Wanted,
    time: &'a str,
}

/// The three charts of a scene.
pub(super) fn accuracy(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> String {
    let mut html = String::new();
    let label = |record: &Record| knob(&record.strategy).unwrap_or("lossless").to_owned();
    let series = |record: &Record| family(&record.strategy).to_owned();
    let caps = Plot {
        slug: "caps",
        title: "Culling error of capped lists",
        entries: entries(done, scene, "caps"),
        errors: |record| &record.errors,
        series,
        shape: |_| None,
        label,
        wanted: Wanted::Pair,
        time: "Assign + shade",
    };
    let reuse = Plot {
        slug: "reuse",
        title: "Culling error of lists used for several frames of the path",
        entries: entries(done, scene, "reuse"),
        time: "Assign + shade, mean along the path",
        ..caps
    };
    html += &caps.html(scene, charts, shots);
    html += &reuse.html(scene, charts, shots);
    let html = part(
        scene,
        "accuracy",
        "Speed against accuracy: culling error",
        "The error against no culling with the same shader; left and low is good. The staircase joins \
         the settings that none beats in both; the others are faded. Exact images lie in the lane of \
         zeros. A point whose pictures were kept opens them.",
        &html,
    );
    let ranges = Plot {
        slug: "ranges",
        title: "Error of the lights\u{2019} range",
        entries: entries(done, scene, "ranges"),
        errors: |record| &record.unbounded_errors,
        series: |record| {
            let cut = record.cut.as_deref().unwrap_or("windowed");
            format!("{}, {cut}", family(&record.strategy))
        },
        shape: |record| Some(usize::from(record.cut.as_deref() == Some("hard"))),
        label: |record| record.threshold.map_or_else(String::new, |t| t.to_string()),
        wanted: Wanted::Unbounded,
        time: "Assign + shade",
    };
    html + &part(
        scene,
        "ranges",
        "Speed against accuracy: the lights\u{2019} range",
        "Another error, never to be mixed with the one above: that of ending lights at the distance at \
         which their intensity falls to a threshold, against lights without a range. It does not \
         depend on the strategy, whose lists are exact; the time does. Points are labelled with the \
         threshold.",
        &ranges.html(scene, charts, shots),
    )
}

impl Plot<'_> {
    /// One panel per metric, the first that is known in front; a place for pictures below.
    fn html(&self, scene: &str, charts: &mut Charts, shots: &mut Shots<'_>) -> String {
        let mut metrics: Vec<&ErrorMetric> = ERROR_METRICS
            .iter()
            .filter(|metric| self.entries.iter().any(|e| self.error(e.record, metric).is_some()))
            .collect();
        metrics.sort_by_key(|metric| metric.id != FIRST);
        let keys: Vec<Option<String>> =
            self.entries.iter().map(|entry| shots.keep(*entry, self.wanted)).collect();
        let opens = keys.iter().any(Option::is_some);
        let all: Vec<(String, String)> = metrics
            .into_iter()
            .map(|metric| {
                let slug = format!("{scene}-{}-{}", self.slug, metric.id);
                let mut body = charts.xy(&slug, &self.chart(metric, &keys));
                body += &format!("<p class=\"note\">{}</p>\n", escape(metric.about));
                (metric.head.to_owned(), body)
            })
            .collect();
        let body = panels("Metric of error", &all);
        if body.is_empty() {
            return body;
        }
        let viewer = if opens { "<div class=\"viewer\" hidden></div>\n" } else { "" };
        format!(
            "<div class=\"plot-of-errors\" data-errors=\"{}\">{body}{viewer}</div>\n",
            self.slug
        )
    }

    fn error(&self, record: &Record, metric: &ErrorMetric) -> Option<f64> {
        // Bias alone has a sign.
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
        let best = frontier(known.iter().map(|(_, _, point)| (point.x, point.y)));
        let mut names: Vec<(&str, String, Option<usize>)> = Vec::new();
        for (name, record, _) in &known {
            if names.iter().all(|(known, ..)| known != name) {
                names.push((name, class(&record.strategy), (self.shape)(record)));
            }
        }
        let mut series = Vec::new();
        for (ix, (name, class, shape)) in names.iter().enumerate() {
            let of = |on: bool| {
                let own = known.iter().filter(|(known, _, _)| known == name);
                let mut points: Vec<Point> = own
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
            series.push(Series { points: of(false), faded: true, ..like.clone() });
            series.push(Series { points: of(true), ..like.clone() });
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
        let x = record.assign_and_shade_ms();
        let mut tip = format!(
            "{}\n{} ms\n{} {}",
            record.strategy,
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
            x_range: record.interval_ms().map(|interval| [interval.low, interval.high]),
            y_range: None,
            label: (self.label)(record),
            key: key.unwrap_or_default(),
            tip,
        }
    }
}

/// The points that no other beats in one and equals in the other, from left to right.
pub(super) fn frontier(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        points.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if best.last().is_none_or(|last| point.1 < last.1) {
            best.push(point);
        }
    }
    best
}

/// The cheapest setting of a section whose error stays below a bound, in words.
pub(super) fn cheapest(done: &Done, scene: &str, bound: f64) -> Option<String> {
    let entries = entries(done, scene, "caps");
    let fastest = |lossy: bool| {
        lines(&entries)
            .into_iter()
            .flat_map(|(_, records)| records)
            .filter(|record| record.is_lossy == lossy)
            .filter(|record| record.assign_and_shade_ms().is_finite())
            .filter(|record| {
                let error = record.errors.get(FIRST).copied().flatten();
                error.is_some_and(|error| match lossy {
                    true => error > 0.0 && error <= bound,
                    false => error == 0.0,
                })
            })
            .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
    };
    let (lossy, lossless) = (fastest(true)?, fastest(false)?);
    let [time, exact] = [lossy, lossless].map(Record::assign_and_shade_ms);
    let error = difference(lossy.errors.get(FIRST).copied().flatten().unwrap_or(0.0));
    let is_faster = Ratio::of(lossy, lossless).is_some_and(|ratio| ratio.is_faster());
    Some(if is_faster {
        format!(
            "A relMSE of {error} buys {} % of the time: {} takes {} ms, {}, the fastest exact one \
             of the same run, {} ms.",
            significant((1.0 - time / exact) * 100.0),
            lossy.strategy,
            significant(time),
            lossless.strategy,
            significant(exact)
        )
    } else {
        format!(
            "No cap with a relMSE of at most {bound} is certainly faster than the fastest exact one, {} \
             with {} ms.",
            lossless.strategy,
            significant(exact)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::frontier;

    #[test]
    fn the_frontier_holds_what_nothing_beats() {
        let points = [(3.0, 0.0), (1.0, 5.0), (2.0, 2.0), (2.5, 2.0), (4.0, 0.0), (2.0, 9.0)];
        assert_eq!(frontier(points.into_iter()), [(1.0, 5.0), (2.0, 2.0), (3.0, 0.0)]);
        assert!(frontier([(f64::NAN, 1.0), (1.0, f64::INFINITY)].into_iter()).is_empty());
    }
}
