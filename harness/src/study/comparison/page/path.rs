//! Times frame by frame along the camera's path.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::report::format::{number, percent, significant};
use crate::report::markup::Html;
use crate::results::{Record, mean, median, standard_deviation};
use crate::study::claims::order::Order;
use crate::study::data::{Entry, counts, entries, laps, lines, poses};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, name, panels, table, unit};
use crate::study::page::part::Part;

/// From this ratio of the greatest to the least mean on, the axis of times is logarithmic.
const LOG_ABOVE: f64 = 8.0;

/// How a record's times vary along the path. The time of a pose is its mean over laps.
#[derive(Clone, Debug)]
pub(crate) struct Spread {
    /// Mean over poses, ms.
    pub(crate) mean: f64,
    /// Standard deviation over poses, ms.
    pub(crate) deviation: f64,
    /// The deviation over the mean.
    pub(crate) relative: f64,
    /// The slowest pose, ms.
    pub(crate) worst: f64,
    /// The slowest over the median pose.
    pub(crate) worst_over_median: f64,
    /// The standard deviation of each lap, ms.
    deviations: Vec<f64>,
}

impl Spread {
    /// `None` without poses, or where their times say nothing.
    pub(crate) fn of(record: &Record) -> Option<Self> {
        let times = record.pose_times_ms();
        let worst = times.iter().copied().fold(f64::NAN, f64::max);
        let (mean, deviation) = (mean(&times), standard_deviation(&times));
        let worst_over_median = worst / median(&times);
        let relative = deviation / mean;
        let sound = mean > 0.0 && relative.is_finite() && worst_over_median.is_finite();
        let deviations = laps(record).iter().map(|lap| standard_deviation(lap)).collect();
        sound.then_some(Self { mean, deviation, relative, worst, worst_over_median, deviations })
    }

    /// Whose standard deviation is the lesser, lap by lap where there are laps.
    pub(crate) fn compare(&self, other: &Self) -> Order {
        let wholes = [self.deviation, other.deviation];
        Order::of_laps(&self.deviations, &other.deviations, wholes)
    }
}

/// Lines of frame times, and what they come to, per count of lights.
pub(crate) fn path(done: &Done, scene: &str, charts: &mut Charts) -> Part {
    let all = entries(done, scene, "path");
    let mut shown: Vec<(String, Html)> = Vec::new();
    for count in counts(&all).into_iter().rev() {
        let own: Vec<Entry<'_>> =
            all.iter().filter(|entry| entry.record.setting.lights == count).copied().collect();
        let title = format!("Pose by pose, {} lights", number(count as f64));
        let body = charts.xy(&format!("{scene}-path-{count}"), &chart(title.clone(), &own))
            + spreads(&title, &own);
        shown.push((format!("{} lights", number(count as f64)), body));
    }
    Part::new(
        "path",
        "Along the path",
        "Assigning and shading at each pose of the camera, mean over laps. SD is the standard deviation \
         over poses, by which the comparison paper ranks; SD / mean and worst / median stand beside it. \
         Slow methods have fewer poses.",
        panels("Lights", &shown),
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
            let times = record.pose_times_ms();
            let point = |(pose, y): (usize, &f64)| Point {
                x: 100.0 * pose as f64 / times.len() as f64,
                y: *y,
                tip: format!("{}\npose {pose}\n{} ms", record.strategy, significant(*y)),
                ..Point::default()
            };
            Series {
                name: id.short(),
                class: id.class(),
                marks: Marks::Line,
                points: times.iter().enumerate().map(point).collect(),
                ..Series::default()
            }
        })
        .collect();
    XyChart {
        title,
        x: Axis { label: "Along the path".to_owned(), unit: "%".to_owned(), scale: Scale::Linear },
        y: Axis { label: "Assign + shade".to_owned(), unit: "ms".to_owned(), scale },
        series,
        note: String::new(),
    }
}

fn spreads(title: &str, entries: &[Entry<'_>]) -> Html {
    let rows: Vec<Vec<Html>> = entries
        .iter()
        .filter_map(|entry| Some((entry.record, Spread::of(entry.record)?)))
        .map(|(record, spread)| {
            vec![
                name(&record.strategy),
                significant(spread.mean).into(),
                significant(spread.deviation).into(),
                percent(spread.relative).into(),
                significant(spread.worst_over_median).into(),
                significant(spread.worst).into(),
                number(poses(record) as f64).into(),
                number(laps(record).len() as f64).into(),
            ]
        })
        .collect();
    let heads = [
        "strategy".into(),
        unit("mean", "ms"),
        unit("SD", "ms"),
        unit("SD / mean", "%"),
        unit("worst / median", "\u{d7}"),
        unit("worst", "ms"),
        "poses".into(),
        "laps".into(),
    ];
    table(title, &heads, &rows)
}
