//! Statistics over the samples of a pass. No best-of: a lucky sample is no result.

/// The middle sample, or the mean of the two in the middle. NaN without samples.
///
/// ```
/// assert_eq!(harness::results::median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
/// ```
pub fn median(samples: &[f64]) -> f64 {
    let sorted = sorted(samples);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[middle],
        _ => f64::midpoint(sorted[middle - 1], sorted[middle]),
    }
}

/// The `share` quantile by nearest rank: the smallest sample that at least that share of all
/// samples does not exceed. NaN without samples. `share` is clamped to 0..=1.
///
/// ```
/// let times_ms: Vec<f64> = (1..=20).map(f64::from).collect();
/// assert_eq!(harness::results::percentile(&times_ms, 0.95), 19.0);
/// ```
pub fn percentile(samples: &[f64], share: f64) -> f64 {
    let sorted = sorted(samples);
    let rank = (share.clamp(0.0, 1.0) * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}

fn sorted(samples: &[f64]) -> Vec<f64> {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_is_the_middle_whatever_the_order() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[3.0, 1.0, 2.0, 100.0]), 2.5);
        assert_eq!(median(&[7.0]), 7.0);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn percentile_takes_the_nearest_rank() {
        let samples: Vec<f64> = (1..=100).rev().map(f64::from).collect();
        assert_eq!(percentile(&samples, 0.95), 95.0);
        assert_eq!(percentile(&samples, 0.951), 96.0);
        assert_eq!(percentile(&samples, 1.0), 100.0);
        assert_eq!(percentile(&samples, 0.0), 1.0);
        // Of eight samples the 95th percentile is the largest.
        assert_eq!(percentile(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 9.0], 0.95), 9.0);
        assert_eq!(percentile(&[5.0], 0.95), 5.0);
        assert!(percentile(&[], 0.95).is_nan());
    }

    #[test]
    fn one_outlier_moves_neither_like_the_mean() {
        let mut samples = vec![1.0; 99];
        samples.push(1_000.0);
        assert_eq!(median(&samples), 1.0);
        assert_eq!(percentile(&samples, 0.95), 1.0);
    }
}
