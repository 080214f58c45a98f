//! Sampled values with their error.

use std::ops::Add;

use glam::DVec3;

/// A value, each channel alone, and how far off it may be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The mean of the samples.
    pub mean: DVec3,
    /// Variance of that mean: 0 where it is exact.
    pub variance: DVec3,
}

impl Estimate {
    /// A value without error.
    pub fn exact(value: DVec3) -> Self {
        Self { mean: value, variance: DVec3::ZERO }
    }

    /// The mean of `count` independent samples, and the variance that their spread gives it (Welford
    /// 1962). One sample knows no spread: its variance is the square of its value, the larger where
    /// samples are mostly 0.
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

    /// Square root of the variance.
    pub fn standard_error(&self) -> DVec3 {
        DVec3::from_array(self.variance.to_array().map(f64::sqrt))
    }
}

impl Add for Estimate {
    type Output = Self;

    /// Of independent estimates.
    fn add(self, other: Self) -> Self {
        Self { mean: self.mean + other.mean, variance: self.variance + other.variance }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
