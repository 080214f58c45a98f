//! Makes sure that a device has reached its full clock when it is timed: it warms up until times are steady,
//! and a rule rejects unsteady samples.
//!
//! A GPU lowers its clock while it waits. A quarter of a second of small passes does not always raise
//! it: one set of builds took 0.967 ms in all of 32 samples and 0.316 ms in another run. So the timed work
//! itself warms the device, without pauses, until its time no longer changes ([`WarmUp`]). Afterwards
//! [`unsteady`] checks the samples.

use std::time::{Duration, Instant};

use crate::results::median;

/// Times of one window of a warm-up.
const WINDOW: usize = 8;

/// Windows whose medians must agree before a device counts as warm.
const WINDOWS: usize = 3;

/// The largest difference between them, as a share of the smallest.
const STEADY: f64 = 0.02;

/// The shortest warm-up of a GPU: twice the time that was too short for 4 of 81 jobs on an H200.
const LEAST: Duration = Duration::from_millis(500);

/// A device that is not steady by then is timed anyway; [`unsteady`] decides.
const MOST: Duration = Duration::from_secs(4);

/// How much the medians of the first and the last third of a series may differ, as a share of the
/// smaller. Of 171 series of one study on an H200, 164 differ by less than 3.2 %.
pub const DRIFT: f64 = 0.05;

/// A sample this far below the median shows that the clock rose in between, because the same work is never
/// this much faster by chance. On a warm H200 the smallest sample lies within 4 % of the median.
pub const RISE: f64 = 0.1;

/// Differences below this come from the resolution of timestamps, ms.
const TICK_MS: f64 = 1e-3;

/// The fewest samples that can show drift.
const LEAST_SAMPLES: usize = 9;

/// Why samples of the same work, in the order in which they were taken, are unsteady. `None` if they are
/// steady or too few.
///
/// Samples are unsteady if one is not a finite number, if the medians of the first and the last third differ
/// by more than [`DRIFT`], or if the smallest sample lies more than [`RISE`] below the median. These rules
/// miss a clock that stayed low all the time; [`slower_than_again`] finds it if the same work was timed twice.
pub fn unsteady(samples_ms: &[f64]) -> Option<String> {
    let count = samples_ms.len();
    let unknown = samples_ms.iter().filter(|ms| !ms.is_finite()).count();
    if unknown > 0 {
        return Some(format!("{unknown} of its {count} samples are not a number"));
    }
    if count < LEAST_SAMPLES {
        return None;
    }
    let third = count / 3;
    let [first, last] = [&samples_ms[..third], &samples_ms[count - third..]].map(median);
    if apart(first, last) > DRIFT && (first - last).abs() > TICK_MS {
        return Some(format!(
            "the median of its first third is {first:.4} ms and that of its last {last:.4} ms"
        ));
    }
    let middle = median(samples_ms);
    let least = samples_ms.iter().copied().fold(f64::INFINITY, f64::min);
    if least < middle * (1.0 - RISE) && middle - least > TICK_MS {
        return Some(format!("its smallest sample is {least:.4} ms and its median {middle:.4} ms"));
    }
    None
}

/// How much slower than the fastest time of the same work a time may be: 10 %. A larger time comes from a
/// lower clock.
pub const AGAIN: f64 = 0.1;

/// Whether a time was taken at a lower clock than `least_ms`, the time of the same work in another job.
pub fn slower_than_again(ms: f64, least_ms: f64) -> bool {
    ms > least_ms * (1.0 + AGAIN) && ms - least_ms > TICK_MS
}

/// How far two times are apart, as a share of the smaller.
fn apart(a: f64, b: f64) -> f64 {
    let least = a.min(b);
    if least > 0.0 { (a - b).abs() / least } else { 0.0 }
}

/// Warms a device up with the work that will be timed. Feed it the time of each frame until the device is
/// warm.
///
/// ```
/// # use harness::drift::WarmUp;
/// let mut warm_up = WarmUp::new(true);
/// while !warm_up.is_warm() {
///     let frame_ms = 0.3; // Draws and times a frame.
///     warm_up.feed(frame_ms);
/// }
/// ```
#[derive(Clone, Debug)]
pub struct WarmUp {
    began: Instant,
    is_software: bool,
    times_ms: Vec<f64>,
}

impl WarmUp {
    /// Starts now. A software adapter has no clock to raise, so one frame warms it.
    pub fn new(is_software: bool) -> Self {
        Self { began: Instant::now(), is_software, times_ms: Vec::new() }
    }

    /// Adds the time of a frame, ms.
    pub fn feed(&mut self, ms: f64) {
        self.times_ms.push(ms);
    }

    /// Whether the device is warm: half a second has passed and the medians of the last three windows
    /// of eight frames lie within 2 %, or four seconds have passed.
    pub fn is_warm(&self) -> bool {
        let passed = self.began.elapsed();
        let has_frame = !self.times_ms.is_empty();
        match self.is_software {
            true => has_frame,
            false => has_frame && (passed >= MOST || (passed >= LEAST && is_level(&self.times_ms))),
        }
    }
}

/// Whether the medians of the last windows agree.
fn is_level(times_ms: &[f64]) -> bool {
    let Some(from) = times_ms.len().checked_sub(WINDOW * WINDOWS) else { return false };
    if times_ms[from..].iter().any(|ms| !ms.is_finite()) {
        return false;
    }
    let medians = || times_ms[from..].chunks_exact(WINDOW).map(median);
    let least = medians().fold(f64::INFINITY, f64::min);
    let most = medians().fold(0.0, f64::max);
    apart(least, most) <= STEADY || most - least <= TICK_MS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Made-up times: a level, and up to 1 % of noise.
    fn noisy(level: impl Fn(usize) -> f64, count: usize) -> Vec<f64> {
        (0..count).map(|ix| level(ix) * (1.0 + 0.01 * ((ix * 7 % 11) as f64 / 11.0))).collect()
    }

    #[test]
    fn samples_that_drift_are_unsteady() {
        assert_eq!(unsteady(&noisy(|_| 0.316, 32)), None);
        // The clock rises slowly, by 8 % over the samples.
        let rising = noisy(|ix| 0.34 - 0.027 * ix as f64 / 32.0, 32);
        assert!(unsteady(&rising).expect("drifts").contains("first third"), "{rising:?}");
        // At once, in the middle: from 5.08 to 1.82 ms, as one stored build did.
        assert!(unsteady(&noisy(|ix| if ix < 12 { 5.08 } else { 1.82 }, 32)).is_some());
        // At the very end: both thirds have the same median.
        let last = noisy(|ix| if ix < 30 { 1.82 } else { 0.61 }, 32);
        assert!(unsteady(&last).expect("rises").contains("smallest sample"), "{last:?}");
        // One slow frame is an outlier and no drift.
        assert_eq!(unsteady(&noisy(|ix| if ix == 5 { 3.0 } else { 0.22 }, 32)), None);
    }

    #[test]
    fn timestamp_ticks_and_few_samples_show_no_drift() {
        // 4.1 and 4.4 microseconds are one tick of the timestamp apart.
        assert_eq!(unsteady(&noisy(|ix| if ix < 16 { 0.0041 } else { 0.0045 }, 32)), None);
        assert_eq!(unsteady(&[3.0, 1.0, 1.0]), None);
        assert_eq!(unsteady(&[]), None);
    }

    #[test]
    fn a_series_with_a_sample_that_is_not_finite_is_unsteady() {
        let mut samples = noisy(|_| 0.316, 32);
        samples[5] = f64::NAN;
        assert!(unsteady(&samples).expect("refused").contains("1 of its 32 samples"));
        assert!(unsteady(&[f64::INFINITY]).is_some());
        assert!(!is_level(&samples[..24]), "a warm-up never ends on it");
    }

    #[test]
    fn timing_the_same_work_twice_reveals_a_low_clock() {
        // Steady, and three times as slow as the same build elsewhere.
        assert_eq!(unsteady(&noisy(|_| 0.967, 32)), None);
        assert!(slower_than_again(0.967, 0.316));
        assert!(!slower_than_again(0.33, 0.316) && !slower_than_again(0.0045, 0.0040));
    }

    #[test]
    fn a_device_is_warm_when_its_times_are_steady() {
        assert!(is_level(&noisy(|_| 0.3, 24)));
        assert!(!is_level(&noisy(|_| 0.3, 23)), "three windows of eight");
        assert!(!is_level(&noisy(|ix| 0.9 - 0.02 * ix as f64, 24)), "it still falls");
        // What came before the last three windows does not matter.
        assert!(is_level(&noisy(|ix| if ix < 40 { 0.9 } else { 0.3 }, 64)));
        let mut software = WarmUp::new(true);
        assert!(!software.is_warm());
        software.feed(100.0);
        assert!(software.is_warm());
        let mut gpu = WarmUp::new(false);
        for _ in 0..100 {
            gpu.feed(0.3);
        }
        assert!(!gpu.is_warm(), "level, but half a second has not passed");
    }
}
