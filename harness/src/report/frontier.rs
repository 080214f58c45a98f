//! Frontiers: the points that no other point beats in both of two figures; and time against memory.

use super::format::{mebibytes, significant};
use super::rank::{competes, is_timed};
use crate::chart::{Axis, Marks, Point, Scale, Series, XyChart};
use crate::results::{Record, Results};

/// The points that no other beats in one and equals in the other, from left to right.
pub(crate) fn frontier(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
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

/// What the title of a chart of time against memory says.
pub(crate) const TIME_AND_MEMORY: &str = "Time against memory, without a loss";

/// How to read that chart.
pub(crate) const TIME_AND_MEMORY_NOTE: &str = "Each point is a strategy that culls without a loss. Points at the lower left are best. The staircase joins the \
     strategies that no other beats in both time and memory; the others are faded. Two times that tie may change \
     places. Strategies with /bvh hold for still lights where the CPU built their hierarchy beforehand.";

const MIB: f64 = 1_048_576.0;

/// The chart of assign + shade against GPU memory, as a file; `None` where fewer than two records have both figures.
pub fn memory_chart(results: &Results) -> Option<String> {
    Some(time_against_memory(&results.records.iter().collect::<Vec<_>>())?.to_svg_file())
}

/// Assign + shade against GPU memory, of the records that cull without a loss. `None` where fewer than two of them
/// have both figures.
pub(crate) fn time_against_memory(records: &[&Record]) -> Option<XyChart> {
    let place = |record: &Record| {
        let bytes = record.lists.assignment_bytes.filter(|_| competes(record))?;
        is_timed(record).then(|| (record.assign_and_shade_ms(), bytes as f64 / MIB))
    };
    let placed: Vec<(&Record, (f64, f64))> =
        records.iter().filter_map(|record| Some((*record, place(record)?))).collect();
    if placed.len() < 2 {
        return None;
    }
    let best = frontier(placed.iter().map(|(_, place)| *place));
    let mut series: Vec<Series> = placed
        .iter()
        .map(|(record, place)| {
            // The legend names those whose names find no room beside them.
            let is_best = best.contains(place);
            let name = if is_best { record.strategy.as_str() } else { "" };
            let points = vec![point(record, *place)];
            let series = Series::new(name, record.strategy.class(), Marks::Points, points);
            Series { faded: !is_best, shape: (!is_best).then_some(0), ..series }
        })
        .collect();
    let steps = best.iter().map(|&(x, y)| Point { x, y, ..Point::default() }).collect();
    series.push(Series::new("", "", Marks::Steps, steps));
    let axes = [
        Axis::new("Assign + shade", "ms", Scale::Log),
        Axis::new("GPU memory for assignment", "MiB", Scale::Log),
    ];
    Some(XyChart::new(TIME_AND_MEMORY, axes, series))
}

fn point(record: &Record, (x, y): (f64, f64)) -> Point {
    let memory = mebibytes(y * MIB);
    let tip = format!("{}\n{} ms\n{memory} MiB", record.strategy, significant(x));
    let x_range = record.interval_ms().map(|interval| [interval.low, interval.high]);
    Point { x_range, ..Point::new(x, y, tip) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassKind, PassTimes, Results};

    #[test]
    fn the_frontier_holds_what_nothing_beats() {
        let points = [(3.0, 0.0), (1.0, 5.0), (2.0, 2.0), (2.5, 2.0), (4.0, 0.0), (2.0, 9.0)];
        assert_eq!(frontier(points.into_iter()), [(1.0, 5.0), (2.0, 2.0), (3.0, 0.0)]);
        assert!(frontier([(f64::NAN, 1.0), (1.0, f64::INFINITY)].into_iter()).is_empty());
    }

    fn record(strategy: &str, ms: f64, mib: u64) -> Record {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        record.strategy = strategy.into();
        record.times.passes = Default::default();
        record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, vec![ms]));
        record.set_times();
        record.lists.assignment_bytes = Some(mib << 20);
        (record.lists.missed_pairs, record.image.max_abs_diff, record.image.differing_channels) =
            (Some(0), Some(0.0), Some(0));
        record
    }

    #[test]
    fn only_lossless_methods_with_memory_stand_against_time_and_only_the_best_are_named() {
        let slow_and_large = record("T-I/28x28", 3.0, 9);
        let mut lossy = record("T-E/28x28/cap4", 0.5, 1);
        lossy.is_lossy = true;
        let mut unknown = record("HG", 0.1, 1);
        unknown.lists.assignment_bytes = None;
        let all = [
            record("SC-E/48x48x40", 1.0, 8),
            record("G/20x20x20", 2.0, 4),
            slow_and_large,
            lossy,
            unknown,
            record("None", 0.01, 1),
        ];
        let all: Vec<&Record> = all.iter().collect();
        let chart = time_against_memory(&all).expect("three points");
        let shown = |faded: bool| -> Vec<(&str, &str)> {
            let is_kind = |s: &&Series| s.faded == faded && s.marks == Marks::Points;
            let of_kind = chart.series.iter().filter(is_kind);
            of_kind.map(|series| (series.name.as_str(), series.points[0].tip.as_str())).collect()
        };
        let names: Vec<&str> = shown(false).iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["SC-E/48x48x40", "G/20x20x20"]);
        assert_eq!(shown(true), [("", "T-I/28x28\n3.00 ms\n9.00 MiB")]);
        let steps = chart.series.last().expect("the staircase");
        let steps: Vec<(f64, f64)> = steps.points.iter().map(|point| (point.x, point.y)).collect();
        assert_eq!(steps, [(1.0, 8.0), (2.0, 4.0)]);
        assert!(time_against_memory(&all[..1]).is_none(), "one point is no chart");
    }
}
