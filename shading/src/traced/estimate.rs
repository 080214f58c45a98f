//! Sampled values with their standard errors.

use std::ops::Add;

use glam::DVec3;

use super::numbers::{Numbers, Point, SEQUENCES};

/// A value and its variance, each channel separately.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The mean of the samples.
    pub mean: DVec3,
    /// The variance of that mean; 0 if it is exact.
    pub variance: DVec3,
}

impl Estimate {
    /// A value without error.
    pub fn exact(value: DVec3) -> Self {
        Self { mean: value, variance: DVec3::ZERO }
    }

    /// The mean of `count` independent samples, and its variance from their spread (Welford 1962).
    /// One sample has no spread. Its variance is then the square of its value, which exceeds the
    /// true one where samples are mostly 0.
    pub fn of_samples(count: u32, mut sample: impl FnMut() -> DVec3) -> Self {
        let (mut mean, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        for number in 1..=count {
            let value = sample();
            let off = value - mean;
            mean += off / f64::from(number);
            squares += off * (value - mean);
        }
        let variance = match count {
            0 => DVec3::ZERO,
            1 => mean * mean,
            _ => squares / (f64::from(count) * f64::from(count - 1)),
        };
        Self { mean, variance }
    }

    /// The mean over `count` points of Sobol sequences: of 8 sequences, or of one per point if
    /// there are fewer points. The variance follows from the spread of the sequences' means.
    pub(super) fn of_points(
        count: u32,
        numbers: Numbers,
        mut value: impl FnMut(Point) -> DVec3,
    ) -> Self {
        let sequences = SEQUENCES.min(count);
        let mut sequence = 0;
        Self::of_samples(sequences, || {
            let points = count / sequences + u32::from(sequence < count % sequences);
            let sum: DVec3 = (0..points).map(|ix| value(numbers.point(sequence, ix))).sum();
            sequence += 1;
            sum / f64::from(points)
        })
    }

    /// A share of a known whole, over `count` points of 8 Sobol sequences: the mean of the first
    /// values over the mean of the second, per channel, times the whole. The variance is that of a
    /// ratio (Cochran 1977, section 6.3): it follows from the differences between each sequence and
    /// the common share.
    pub(super) fn of_shares(
        count: u32,
        numbers: Numbers,
        whole: DVec3,
        mut values: impl FnMut(Point) -> (DVec3, DVec3),
    ) -> Self {
        let sequences = SEQUENCES.min(count);
        let of_sequence = |sequence: u32| {
            let points = count / sequences + u32::from(sequence < count % sequences);
            let (mut part, mut all) = (DVec3::ZERO, DVec3::ZERO);
            for ix in 0..points {
                let value = values(numbers.point(sequence, ix));
                (part, all) = (part + value.0, all + value.1);
            }
            (part, all)
        };
        let sums: Vec<(DVec3, DVec3)> = (0..sequences).map(of_sequence).collect();
        let total = |of: fn(&(DVec3, DVec3)) -> DVec3| sums.iter().map(of).sum::<DVec3>();
        // A channel without light has no share.
        let total_all = total(|sum| sum.1).max(DVec3::splat(f64::MIN_POSITIVE));
        let share = total(|sum| sum.0) / total_all;
        let squares: DVec3 = sums
            .iter()
            .map(|(part, all)| {
                let off = (*part - share * *all) / total_all;
                off * off
            })
            .sum();
        let freedom = f64::from(sequences.max(2) - 1) / f64::from(sequences);
        Self { mean: whole * share, variance: whole * whole * squares / freedom }
    }

    /// Square root of the variance.
    pub fn standard_error(&self) -> DVec3 {
        DVec3::from_array(self.variance.to_array().map(f64::sqrt))
    }
}

impl Add for Estimate {
    type Output = Self;

    /// The sum of independent estimates.
    fn add(self, other: Self) -> Self {
        Self { mean: self.mean + other.mean, variance: self.variance + other.variance }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_by_hand() {
        // Three kinds of sequences: with all of the whole, half of it, and none of it.
        let numbers = Numbers::new(1);
        let mut ix = 0;
        let estimate = Estimate::of_shares(8, numbers, DVec3::splat(6.0), |_| {
            ix += 1;
            let part = [2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 1.0, 1.0][ix - 1];
            (DVec3::splat(part), DVec3::splat(2.0))
        });
        // The share is a half, and four of eight sequences differ by 1: 8 / 7 of 4 / 16^2, times
        // the square of the whole.
        assert_eq!(estimate.mean, DVec3::splat(3.0));
        let expected = 36.0 * 4.0 / 256.0 * 8.0 / 7.0;
        assert!((estimate.variance.x - expected).abs() < 1e-12, "{estimate:?}");
        let seen = Estimate::of_shares(8, numbers, DVec3::splat(6.0), |_| (DVec3::X, DVec3::X));
        assert_eq!(seen, Estimate::exact(DVec3::new(6.0, 0.0, 0.0)));
    }

    #[test]
    fn four_samples_by_hand() {
        let mut values = [1.0, 3.0, 5.0, 7.0].into_iter();
        let estimate = Estimate::of_samples(4, || DVec3::splat(values.next().unwrap()));
        // Squared deviations 9, 1, 1, 9: 20 / (4 * 3).
        assert_eq!(estimate.mean.x, 4.0);
        assert!((estimate.variance.x - 5.0 / 3.0).abs() < 1e-12);
        let sum = estimate + estimate + Estimate::exact(DVec3::ONE);
        assert!((sum.mean.y - 9.0).abs() < 1e-12);
        assert!((sum.standard_error().y.powi(2) - 10.0 / 3.0).abs() < 1e-12);
    }
}
