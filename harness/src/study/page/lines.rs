//! Times against the number of lights: points of a chart, and the straight line through them.

use crate::chart::{Marks, Point, Series};
use crate::report::fit::Fit;
use crate::report::format::{number, significant};
use crate::results::Record;
use crate::study::data::{class, short};

/// A time of a record, ms.
pub(crate) type Time = fn(&Record) -> f64;

/// The straight line through the times of a strategy.
pub(crate) fn fit(records: &[&Record], time: Time) -> Option<Fit> {
    let points: Vec<(f64, f64)> =
        records.iter().map(|record| (record.setting.lights as f64, time(record))).collect();
    Fit::through(&points)
}

/// A strategy's times against its lights.
pub(crate) fn points(id: &str, records: &[&Record], time: Time, marks: Marks) -> Series {
    let point = |record: &&Record| {
        let y = time(record);
        let lights = number(record.setting.lights as f64);
        Point {
            x: record.setting.lights as f64,
            y,
            y_range: record.interval_ms().map(|interval| [interval.low, interval.high]),
            tip: format!("{id}\n{lights} lights\n{} ms", significant(y)),
            ..Point::default()
        }
    };
    let points = records.iter().map(point).collect();
    Series { name: short(id), class: class(id), marks, points, ..Series::default() }
}
