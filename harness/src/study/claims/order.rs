//! Orders two figures, if repetitions can decide.
//!
//! One rule for all claims:
//!
//! - Six rounds or laps, or more: two figures tie where the interval of their ratio includes 1, or its
//!   median is within 0.5 % of 1, as in [ranks](crate::report::rank::ranks).
//! - Fewer: the noise is unknown, so figures that are less than 5 % apart are not ordered.
//! - Slopes and offsets of fitted lines: less than 2 % apart is a tie.

use crate::report::rank::{Ratio, SURE};
use crate::results::{Record, mean, median, median_interval};

/// Without six rounds or laps, smaller differences decide nothing. This limit is ours: times of one job
/// that ran twice differ by less.
const TOO_FEW_LAPS: f64 = 0.05;

/// Slopes and offsets of fitted lines tie within this share of each other. Our limit.
const FITTED: f64 = 0.02;

/// How one figure compares with another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Less,
    Tie,
    More,
    /// There are too few rounds or laps to order a difference this small.
    Unsure,
}

impl Order {
    fn of_ratio(ratio: Ratio) -> Self {
        if ratio.coverage < SURE {
            return Self::within(ratio.median, TOO_FEW_LAPS, Self::Unsure);
        }
        match ratio.is_tie() {
            true => Self::Tie,
            false if ratio.median < 1.0 => Self::Less,
            false => Self::More,
        }
    }

    /// Orders by a ratio; within `limit` of 1, or without a ratio, the answer is `alike`.
    fn within(ratio: f64, limit: f64, alike: Self) -> Self {
        match ratio.is_finite() && (ratio - 1.0).abs() > limit {
            false => alike,
            true if ratio < 1.0 => Self::Less,
            true => Self::More,
        }
    }

    /// Orders single figures, without repetitions.
    pub(crate) fn of_figures(figure: f64, other: f64) -> Self {
        Self::within(figure / other, TOO_FEW_LAPS, Self::Unsure)
    }

    /// Orders slopes or offsets of fitted lines. A negative one is less than a positive one, whatever
    /// their ratio.
    pub(crate) fn of_fits(figure: f64, other: f64) -> Self {
        if figure > 0.0 && other > 0.0 {
            return Self::within(figure / other, FITTED, Self::Tie);
        }
        match figure.partial_cmp(&other) {
            Some(std::cmp::Ordering::Less) => Self::Less,
            Some(std::cmp::Ordering::Greater) => Self::More,
            _ => Self::Tie,
        }
    }

    /// Orders the times to assign and shade: by rounds or laps if both have them, otherwise by the
    /// figures.
    pub(crate) fn of_times(record: &Record, other: &Record) -> Self {
        match Ratio::between(record, other) {
            Some(ratio) => Self::of_ratio(ratio),
            None => Self::of_figures(record.assign_and_shade_ms(), other.assign_and_shade_ms()),
        }
    }

    /// Orders the times of whole frames: by rounds or laps if both have them, otherwise by the figures.
    pub(crate) fn of_frames(record: &Record, other: &Record) -> Self {
        let times = [record, other].map(frame_rounds_ms);
        let same = (record.setting.along_path, record.times.frames)
            == (other.setting.along_path, other.times.frames);
        match same {
            true => {
                Self::of_laps(&times[0], &times[1], [record.times.frame_ms, other.times.frame_ms])
            }
            false => Self::of_figures(record.times.frame_ms, other.times.frame_ms),
        }
    }

    /// Orders figures that were taken once per lap; `wholes` decide if there is only one lap.
    pub(crate) fn of_laps(laps: &[f64], others: &[f64], wholes: [f64; 2]) -> Self {
        let ratios: Vec<f64> = laps.iter().zip(others).map(|(lap, other)| lap / other).collect();
        match median_interval(&ratios).filter(|_| laps.len() == others.len()) {
            Some(interval) => Self::of_ratio(Ratio {
                median: median(&ratios),
                low: interval.low,
                high: interval.high,
                coverage: interval.coverage,
            }),
            None => Self::of_figures(wholes[0], wholes[1]),
        }
    }
}

/// The whole frame of each round, ms: the mean of a lap along the path, the median of a round from a still
/// camera.
fn frame_rounds_ms(record: &Record) -> Vec<f64> {
    let frames = record.times.passes.per_frame_ms(None);
    let rounds = if record.setting.along_path { record.laps() } else { record.times.rounds };
    let length = frames.len().div_ceil(rounds.max(1) as usize).max(1);
    let time = if record.setting.along_path { mean } else { median };
    frames.chunks(length).map(time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_figures_need_a_difference_of_five_per_cent() {
        assert_eq!(Order::of_figures(1.0, 1.04), Order::Unsure);
        assert_eq!(Order::of_figures(1.0, 1.1), Order::Less);
        assert_eq!(Order::of_figures(1.1, 1.0), Order::More);
        assert_eq!(Order::of_figures(1.0, f64::NAN), Order::Unsure);
    }

    #[test]
    fn fitted_figures_tie_within_two_per_cent_and_may_be_below_zero() {
        // SC-I and SC-E of 2026-11-25: 0.65 % apart.
        assert_eq!(Order::of_fits(0.920, 0.926), Order::Tie);
        assert_eq!(Order::of_fits(0.90, 0.93), Order::Less);
        assert_eq!(Order::of_fits(-1.0, 0.5), Order::Less);
        assert_eq!(Order::of_fits(0.5, -1.0), Order::More);
        assert_eq!(Order::of_fits(0.0, 0.0), Order::Tie);
    }

    #[test]
    fn six_laps_decide_and_fewer_need_a_difference_of_five_per_cent() {
        let laps = [1.0, 1.1, 0.9, 1.2, 0.8, 1.05];
        assert_eq!(Order::of_laps(&laps, &[1.0; 6], [1.0, 1.1]), Order::Tie);
        assert_eq!(Order::of_laps(&[1.0; 6], &[1.02; 6], [1.0, 1.02]), Order::Less);
        assert_eq!(Order::of_laps(&[1.0; 5], &[1.02; 5], [1.0, 1.02]), Order::Unsure);
        assert_eq!(Order::of_laps(&[1.0; 2], &[1.1; 2], [1.0, 1.1]), Order::Less);
        assert_eq!(Order::of_laps(&[1.0], &[1.1], [1.0, 1.1]), Order::Less);
        // DC-E and SC-E of one lap of 1,200 poses: 1 % apart.
        assert_eq!(Order::of_laps(&[0.2656], &[0.2684], [0.2656, 0.2684]), Order::Unsure);
    }
}
