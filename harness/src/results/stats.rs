//! Statistics over the samples of a pass. There is no best-of, because it reports a lucky sample.

/// The median: the middle sample, or the mean of the two middle samples. NaN without samples.
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

/// The `share` quantile by nearest rank: the smallest sample x so that at least this share of all samples is
/// at most x. NaN without samples. `share` is clamped to 0..=1.
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

/// The mean. NaN without samples.
pub fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}

/// The standard deviation of the samples. NaN without samples.
pub fn standard_deviation(samples: &[f64]) -> f64 {
    let mean = mean(samples);
    (samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / samples.len() as f64)
        .sqrt()
}

/// A confidence interval of a median.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
    /// The probability that the interval contains the median, for any distribution of the samples: at least
    /// 0.95 with enough samples, else less.
    pub coverage: f64,
}

/// The wanted probability that an interval contains the median.
const COVERAGE: f64 = 0.95;

/// A confidence interval of the median of independent samples, from order statistics. The k-th smallest and
/// k-th largest sample enclose the median unless fewer than k of n fair coins fall on one side, so the coverage
/// is `1 - 2 P(B(n, 1/2) < k)`. The function takes the largest k with a coverage of at least 0.95. Below six
/// samples there is no such k, and the interval is the range of all samples. `None` for fewer than two.
///
/// ```
/// let times_ms: Vec<f64> = (1..=16).map(f64::from).collect();
/// let interval = harness::results::median_interval(&times_ms).unwrap();
/// assert_eq!((interval.low, interval.high), (4.0, 13.0));
/// assert!((interval.coverage - 0.979).abs() < 1e-3);
/// ```
pub fn median_interval(samples: &[f64]) -> Option<Interval> {
    let sorted = sorted(samples);
    let count = sorted.len();
    if count < 2 {
        return None;
    }
    if count > 200 {
        // The normal approximation of the binomial; the sum below would underflow.
        let k = ((count as f64 - 1.96 * (count as f64).sqrt()) / 2.0) as usize;
        let (low, high) = (sorted[k.max(1) - 1], sorted[count - k.max(1)]);
        return Some(Interval { low, high, coverage: COVERAGE });
    }
    let mut interval = None;
    // P(B(n, 1/2) = 0), then the sum up to k - 1.
    let mut term = 0.5_f64.powi(count as i32);
    let mut below = 0.0;
    for k in 1..=count / 2 {
        below += term;
        term *= (count - k + 1) as f64 / k as f64;
        let coverage = 1.0 - 2.0 * below;
        if k > 1 && coverage < COVERAGE {
            break;
        }
        interval = Some(Interval { low: sorted[k - 1], high: sorted[count - k], coverage });
    }
    interval
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
    fn the_median_does_not_depend_on_the_order() {
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
    fn intervals_contain_the_median_as_often_as_their_coverage() {
        // Known ranks (any table of order-statistic intervals).
        let ranks = |n: i32| {
            let samples: Vec<f64> = (1..=n).map(f64::from).collect();
            median_interval(&samples).map(|i| (i.low, i.high))
        };
        assert_eq!(ranks(6), Some((1.0, 6.0)));
        assert_eq!(ranks(9), Some((2.0, 8.0)));
        assert_eq!(ranks(20), Some((6.0, 15.0)));
        assert_eq!(ranks(1), None);
        let few = median_interval(&[3.0, 1.0, 2.0]).unwrap();
        assert_eq!((few.low, few.high, few.coverage), (1.0, 3.0, 0.75));
        // 2,000 draws of 16 uniform numbers: the share that holds 0.5 is the coverage.
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let held = (0..2_000).filter(|_| {
            let samples: Vec<f64> = (0..16).map(|_| uniform()).collect();
            median_interval(&samples).is_some_and(|i| i.low <= 0.5 && 0.5 <= i.high)
        });
        let share = held.count() as f64 / 2_000.0;
        assert!((share - 0.979).abs() < 0.013, "{share}");
    }

    #[test]
    fn an_outlier_moves_the_mean_but_not_the_median_or_percentile() {
        let mut samples = vec![1.0; 99];
        samples.push(1_000.0);
        assert_eq!(median(&samples), 1.0);
        assert_eq!(percentile(&samples, 0.95), 1.0);
    }
}
