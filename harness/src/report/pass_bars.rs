//! Bars of passes: where the time of each strategy goes.

use super::colours::Colours;
use super::format::{percent, significant};
use crate::chart::{Axis, BarChart, BarRow, Scale, Segment};
use crate::results::{PassKind, PassTimes, Record};

/// What a chart of passes counts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Counted {
    /// All passes of a frame.
    Frame,
    /// The passes that assign lights and light pixels.
    AssignAndShade,
}

impl Counted {
    fn counts(self, kind: PassKind) -> bool {
        self == Self::Frame || matches!(kind, PassKind::Assign | PassKind::Shade)
    }

    fn total_ms(self, record: &Record) -> f64 {
        match self {
            Self::Frame => record.times.frame_ms,
            Self::AssignAndShade => record.assign_and_shade_ms(),
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Frame => "Frame",
            Self::AssignAndShade => "Assign + shade",
        }
    }
}

/// The longest bar over the shortest; 1 where there is none.
pub(crate) fn spread(counted: Counted, records: &[&Record]) -> f64 {
    let times = || {
        records
            .iter()
            .map(|record| counted.total_ms(record))
            .filter(|ms| ms.is_finite() && *ms > 0.0)
    };
    let ratio = times().fold(0.0, f64::max) / times().fold(f64::INFINITY, f64::min);
    if ratio > 1.0 { ratio } else { 1.0 }
}

/// A bar per record and a segment per pass.
pub(crate) fn pass_bars(
    title: String,
    scale: Scale,
    counted: Counted,
    records: &[&Record],
    colours: &Colours<'_>,
) -> BarChart {
    let bar = |record: &&Record| pass_bar(record, record.strategy.to_string(), counted, colours);
    let axis = Axis { label: counted.label().to_owned(), unit: "ms".to_owned(), scale };
    let note = match scale {
        Scale::Log => {
            "Each dot is a pass. The upright mark is the sum. The axis is logarithmic: equal steps \
                       are equal factors."
        }
        Scale::Linear | Scale::LinearFromZero => "Each segment is a pass.",
    };
    BarChart { title, axis, rows: records.iter().map(bar).collect(), note: note.to_owned() }
}

/// A bar of a record under a name, a segment per pass.
pub(crate) fn pass_bar(
    record: &Record,
    name: String,
    counted: Counted,
    colours: &Colours<'_>,
) -> BarRow {
    let total = counted.total_ms(record);
    let is_counted = |(_, times): &(&str, &PassTimes)| counted.counts(times.kind);
    let segments: Vec<Segment> = record
        .times
        .passes
        .iter()
        .filter(is_counted)
        .map(|(name, times)| Segment {
            name: name.to_owned(),
            class: colours.pass(name).to_owned(),
            value: time_ms(record, times),
        })
        .filter(|segment| segment.value.is_finite())
        .collect();
    let line = |segment: &Segment| {
        let share = match total > 0.0 {
            true => format!(" ({} %)", percent(segment.value / total)),
            false => String::new(),
        };
        format!("\n{} {} ms{share}", segment.name, significant(segment.value))
    };
    let lines: String = segments.iter().map(line).collect();
    let value_text = match total.is_finite() {
        true => format!("{} ms", significant(total)),
        false => "not measured".to_owned(),
    };
    BarRow {
        class: record.strategy.class(),
        tip: format!("{name}: {value_text}{lines}"),
        name,
        segments,
        value_text,
    }
}

/// The time of a pass: the median, or along a path the mean, in which a frame without the pass counts as 0.
pub(crate) fn time_ms(record: &Record, times: &PassTimes) -> f64 {
    if !record.setting.along_path || times.samples.is_empty() {
        return times.median_ms;
    }
    let measured = times.samples.iter().filter(|sample| sample.is_finite());
    measured.sum::<f64>() / times.samples.len() as f64
}
