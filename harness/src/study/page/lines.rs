//! Times against the number of lights: points of a chart, and the straight line through them.

use crate::chart::{Marks, Point, Series};
use crate::report::fit::Fit;
use crate::report::format::{number, significant};
use crate::results::Record;
use crate::strategy::StrategyId;

/// A time of a record, ms.
pub(crate) type Time = fn(&Record) -> f64;

/// The straight line through the times of a strategy.
pub(crate) fn fit(records: &[&Record], time: impl Fn(&Record) -> f64) -> Option<Fit> {
    let points: Vec<(f64, f64)> =
        records.iter().map(|record| (record.setting.lights as f64, time(record))).collect();
    Fit::through(&points)
}

/// A strategy's times against its lights.
pub(crate) fn times_series(
    id: &StrategyId,
    records: &[&Record],
    time: Time,
    marks: Marks,
) -> Series {
    let points = points(id.as_str(), records, time);
    Series::new(id.short(), id.class(), marks, points)
}

/// Times against lights, with the name of what took them.
pub(crate) fn points(name: &str, records: &[&Record], time: Time) -> Vec<Point> {
    let point = |record: &&Record| {
        let y = time(record);
        let lights = number(record.setting.lights as f64);
        Point {
            x: record.setting.lights as f64,
            y,
            y_range: record.interval_ms().map(|interval| [interval.low, interval.high]),
            tip: format!("{name}\n{lights} lights\n{} ms", significant(y)),
            ..Point::default()
        }
    };
    records.iter().map(point).collect()
}

/// A line through points, each with a tip that names the units of both figures.
pub(crate) fn tipped_line(
    name: &str,
    class: &str,
    [x_unit, y_unit]: [&str; 2],
    points: impl Iterator<Item = (f64, f64)>,
) -> Series {
    let point = |(x, y): (f64, f64)| {
        Point::new(x, y, format!("{name}\n{} {x_unit}\n{} {y_unit}", number(x), significant(y)))
    };
    Series::new(name, class, Marks::LineAndPoints, points.map(point).collect())
}
