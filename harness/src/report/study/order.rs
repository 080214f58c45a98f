//! Which of two records has the lesser figure, as far as repetitions tell.

use super::super::rank::Ratio;
use crate::results::{Record, median, median_interval};

/// Nearer to 1, a ratio is a tie, as in [ranks](super::super::rank::ranks).
const ALIKE: f64 = 0.005;

/// How one figure compares with another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Less,
    Tie,
    More,
}

impl Order {
    fn of_ratio(ratio: Ratio) -> Self {
        match ratio.is_tie() {
            true => Self::Tie,
            false if ratio.median < 1.0 => Self::Less,
            false => Self::More,
        }
    }

    /// Of single figures, without repetitions.
    pub(super) fn of_figures(figure: f64, other: f64) -> Self {
        let ratio = figure / other;
        match (ratio - 1.0).abs() <= ALIKE || !ratio.is_finite() {
            true => Self::Tie,
            false if ratio < 1.0 => Self::Less,
            false => Self::More,
        }
    }

    /// Of the times to assign and shade: by rounds or laps where both have them, else by the figures.
    pub(super) fn of_times(record: &Record, other: &Record) -> Self {
        match Ratio::of(record, other) {
            Some(ratio) => Self::of_ratio(ratio),
            None => Self::of_figures(record.assign_and_shade_ms(), other.assign_and_shade_ms()),
        }
    }

    /// Of figures that were taken once a lap; `wholes` decide where there is one lap.
    pub(super) fn of_laps(laps: &[f64], others: &[f64], wholes: [f64; 2]) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_per_cent_is_a_tie() {
        assert_eq!(Order::of_figures(1.0, 1.004), Order::Tie);
        assert_eq!(Order::of_figures(1.0, 1.006), Order::Less);
        assert_eq!(Order::of_figures(1.0, f64::NAN), Order::Tie);
    }

    #[test]
    fn laps_that_disagree_are_a_tie_and_one_lap_is_decided_by_its_figure() {
        let laps = [1.0, 1.1, 0.9, 1.2, 0.8, 1.05];
        assert_eq!(Order::of_laps(&laps, &[1.0; 6], [1.0, 1.1]), Order::Tie);
        assert_eq!(Order::of_laps(&[1.0; 6], &[1.1; 6], [1.0, 1.1]), Order::Less);
        // Five laps tell nothing apart.
        assert_eq!(Order::of_laps(&[1.0; 5], &[1.1; 5], [1.0, 1.1]), Order::Tie);
        assert_eq!(Order::of_laps(&[1.0], &[1.1], [1.0, 1.1]), Order::Less);
    }
}
