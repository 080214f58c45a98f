//! Times frame by frame along the camera's path.

use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::report::column::{Better, Column};
use crate::report::format::{number, percent, significant};
use crate::report::markup::Html;
use crate::report::table::{Look, Row, Table};
use crate::results::{Record, mean, median, standard_deviation};
use crate::study::claims::order::Order;
use crate::study::data::{Entry, counts, entries, laps, lines, poses};
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
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
    pub(crate) fn measure(record: &Record) -> Option<Self> {
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
        let at_count: Vec<Entry<'_>> =
            all.iter().filter(|entry| entry.record.setting.lights == count).copied().collect();
        let title = format!("Pose by pose, {} lights", number(count as f64));
        let body = charts.xy(&format!("{scene}-path-{count}"), &chart(title.clone(), &at_count))
            + spreads(&title, &at_count);
        shown.push((format!("{} lights", number(count as f64)), body));
    }
    Part::new(
        "path",
        "Along the path",
        "The chart shows the time to assign and shade at each pose of the camera, as a mean over \
         laps. SD is the standard deviation over poses, by which the comparison paper ranks. The \
         table also shows SD / mean. The column \u{201c}worst / median\u{201d} is the time of \
         the slowest pose divided by the time of the median pose. Slow strategies have fewer \
         poses.",
        panels("Lights", &shown),
    )
}

fn chart(title: String, entries: &[Entry<'_>]) -> XyChart {
    let lines = lines(entries);
    let means: Vec<f64> = entries
        .iter()
        .filter_map(|e| Spread::measure(e.record))
        .map(|spread| spread.mean)
        .collect();
    let most = means.iter().copied().fold(0.0, f64::max);
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let scale = if most > LOG_ABOVE * least { Scale::Log } else { Scale::LinearFromZero };
    let series = lines
        .iter()
        .flat_map(|(id, records)| records.iter().map(move |record| (id, record)))
        .map(|(id, record)| {
            let times = record.pose_times_ms();
            let point = |(pose, ms): (usize, &f64)| {
                let tip = format!("{}\npose {pose}\n{} ms", record.strategy, significant(*ms));
                Point::new(100.0 * pose as f64 / times.len() as f64, *ms, tip)
            };
            let points = times.iter().enumerate().map(point).collect();
            Series::new(id.short(), id.class(), Marks::Line, points)
        })
        .collect();
    let axes =
        [Axis::new("Along the path", "%", Scale::Linear), Axis::new("Assign + shade", "ms", scale)];
    XyChart::new(title, axes, series)
}

/// A strategy's record with how its times vary.
type Varied<'a> = (&'a Record, Spread);

/// A column of times.
fn ms<'a>(head: &str, value: fn(&Spread) -> f64) -> Column<'a, Varied<'a>> {
    Column::ms(head, move |row: &Varied<'a>| Some(value(&row.1)))
}

/// How the times of each strategy vary. Ranks stand in the main table, so no figure is marked as the best.
fn spreads<'a>(title: &str, entries: &[Entry<'a>]) -> Html {
    let row = |entry: &Entry<'a>| {
        let record = entry.record;
        let name = format!("{}{}", record.strategy, entry.mark());
        Some(Row::new(name, (record, Spread::measure(record)?)))
    };
    let count = |of: fn(&Record) -> usize| move |row: &Varied<'_>| Some(of(row.0) as f64);
    let columns = [
        ms("mean", |spread| spread.mean),
        ms("SD", |spread| spread.deviation),
        Column::figure(
            "SD / mean",
            "%",
            Better::Less,
            |row: &Varied<'_>| Some(row.1.relative),
            percent,
        ),
        Column::figure(
            "worst / median",
            "\u{d7}",
            Better::Less,
            |row: &Varied<'_>| Some(row.1.worst_over_median),
            significant,
        ),
        ms("worst", |spread| spread.worst),
        Column::figure("poses", "", Better::Neither, count(poses), number),
        Column::figure("laps", "", Better::Neither, count(|record| laps(record).len()), number),
    ];
    Table::new("strategy", columns, entries.iter().filter_map(row).collect())
        .competing(|_| false)
        .dotted(|row| row.0.strategy.class())
        .html(title, Look::Plain)
}
