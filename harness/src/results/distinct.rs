//! Whether the times of two methods differ by more than chance.

use super::{Interval, Record, median, median_interval};

/// Ratios nearer to 1 than this are the same to whoever chooses: less than a shader gains or loses
/// by where the compiler puts it.
const SAME: f64 = 0.005;

/// The interval of `b`'s time over `a`'s, from their medians round by round: whatever drifted
/// between rounds hit both alike. `None` where they were not timed in the same two rounds or more.
pub fn ratio_interval(a: &Record, b: &Record) -> Option<Interval> {
    let (a, b) = (a.round_medians(), b.round_medians());
    let ratios: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b / a).collect();
    if a.len() != b.len() || ratios.iter().any(|ratio| !ratio.is_finite()) {
        return None;
    }
    median_interval(&ratios)
}

/// Whether two methods cannot be told apart: the interval of the ratio of their times holds 1, or
/// its median is within half a per cent of it. `None` where that is not known.
pub fn indistinguishable(a: &Record, b: &Record) -> Option<bool> {
    let interval = ratio_interval(a, b)?;
    let (a, b) = (a.round_medians(), b.round_medians());
    let ratios: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b / a).collect();
    let holds_one = interval.low <= 1.0 && 1.0 <= interval.high;
    Some(holds_one || (median(&ratios) - 1.0).abs() <= SAME)
}
