//! Times frame by frame along the camera's path.

use super::super::format::{number, percent, significant};
use super::data::{Entry, class, counts, entries, lines, short};
use super::figure::{Charts, name, panels, part, table};
use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::results::{Record, mean, median, standard_deviation};
use crate::study::Done;

/// From this ratio of the greatest to the least mean on, the axis of times is logarithmic.
const LOG_ABOVE: f64 = 8.0;

/// How a record's times vary along the path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    /// Mean over poses, ms; the time at a pose is its mean over laps.
    pub(super) mean: f64,
    /// Standard deviation over frames, ms.
    pub(super) deviation: f64,
    /// The deviation over the mean.
    pub(super) relative: f64,
    /// The slowest frame, ms.
    pub(super) worst: f64,
    /// The slowest over the median frame.
    pub(super) worst_over_median: f64,
}

impl Spread {
    /// `None` without frames, or where their times say nothing.
    pub(super) fn of(record: &Record) -> Option<Self> {
        let times = record.pose_times_ms();
        let worst = times.iter().copied().fold(f64::NAN, f64::max);
        let (mean, deviation) = (mean(&times), standard_deviation(&times));
        let worst_over_median = worst / median(&times);
        let relative = deviation / mean;
        let sound = mean > 0.0 && relative.is_finite() && worst_over_median.is_finite();
        sound.then_some(Self { mean, deviation, relative, worst, worst_over_median })
    }
}

/// Lines of frame times, and what they come to, per count of lights.
pub(super) fn path(done: &Done, scene: &str, charts: &mut Charts) -> String {
    let all = entries(done, scene, "path");
    let mut shown: Vec<(String, String)> = Vec::new();
    for count in counts(&all).into_iter().rev() {
        let own: Vec<Entry<'_>> =
            all.iter().filter(|entry| entry.record.lights == count).copied().collect();
        let title = format!("Frame by frame, {} lights", number(count as f64));
        let body = charts.xy(&format!("{scene}-path-{count}"), &chart(title.clone(), &own))
            + &spreads(&title, &own);
        shown.push((format!("{} lights", number(count as f64)), body));
    }
    part(
        scene,
        "path",
        "Along the path",
        "Assigning and shading at each frame, the camera at another place each time. SD is the standard \
         deviation over frames; the frame\u{2019}s own noise is in it.",
        &panels("Lights", &shown),
    )
}

fn chart(title: String, entries: &[Entry<'_>]) -> XyChart {
    let lines = lines(entries);
    let means: Vec<f64> =
        entries.iter().filter_map(|e| Spread::of(e.record)).map(|spread| spread.mean).collect();
    let most = means.iter().copied().fold(0.0, f64::max);
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let scale = if most > LOG_ABOVE * least { Scale::Log } else { Scale::LinearFromZero };
    let series = lines
        .iter()
        .flat_map(|(id, records)| records.iter().map(move |record| (id, record)))
        .map(|(id, record)| {
            let point = |(frame, y): (usize, &f64)| Point {
                x: frame as f64,
                y: *y,
                tip: format!("{}\nframe {frame}\n{} ms", record.strategy, significant(*y)),
                ..Point::default()
            };
            Series {
                name: short(id),
                class: class(id),
                marks: Marks::Line,
                points: record.pose_times_ms().iter().enumerate().map(point).collect(),
                ..Series::default()
            }
        })
        .collect();
    XyChart {
        title,
        x: Axis { label: "Frame".to_owned(), unit: String::new(), scale: Scale::Linear },
        y: Axis { label: "Assign + shade".to_owned(), unit: "ms".to_owned(), scale },
        series,
        note: String::new(),
    }
}

fn spreads(title: &str, entries: &[Entry<'_>]) -> String {
    let rows: Vec<Vec<String>> = entries
        .iter()
        .filter_map(|entry| Some((entry.record, Spread::of(entry.record)?)))
        .map(|(record, spread)| {
            vec![
                name(&record.strategy),
                significant(spread.mean),
                significant(spread.deviation),
                percent(spread.relative),
                significant(spread.worst_over_median),
                significant(spread.worst),
            ]
        })
        .collect();
    let heads = [
        "strategy",
        "mean <span class=\"unit\">ms</span>",
        "SD <span class=\"unit\">ms</span>",
        "SD / mean <span class=\"unit\">%</span>",
        "worst / median <span class=\"unit\">\u{d7}</span>",
        "worst <span class=\"unit\">ms</span>",
    ];
    table(title, &heads, &rows)
}
