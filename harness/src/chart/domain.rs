//! The values that an axis spans, and where they lie on it.

use super::model::Scale;
use super::ticks::{self, Tick};

/// Greater values count as infinite, because their differences could be.
const MOST: f64 = 1e200;
/// The default width of the lane for exact zeros.
const LANE: f64 = 30.0;

/// Why an axis cannot show a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Misfit {
    NotFinite,
    BelowZero,
}

/// The span of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    scale: Scale,
    low: f64,
    high: f64,
    zeros: bool,
    /// Whether there is anything to span: on a logarithmic axis, anything but zeros.
    spans: bool,
}

/// Whether a value can be shown on a scale.
pub(super) fn check(scale: Scale, value: f64) -> Result<(), Misfit> {
    if !value.is_finite() || value.abs() > MOST {
        Err(Misfit::NotFinite)
    } else if scale == Scale::Log && value < 0.0 {
        Err(Misfit::BelowZero)
    } else {
        Ok(())
    }
}

impl Domain {
    /// Spans the values, and their ranges as far as the values keep enough room.
    pub(super) fn spanning(
        scale: Scale,
        values: impl Iterator<Item = f64>,
        ranges: impl Iterator<Item = f64>,
    ) -> Self {
        let log = scale == Scale::Log;
        let (mut low, mut high, mut zeros) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values.filter(|&value| check(scale, value).is_ok()) {
            if log && value == 0.0 {
                zeros = true;
            } else {
                let value = if log { value.max(1.0 / MOST) } else { value };
                (low, high) = (low.min(value), high.max(value));
            }
        }
        if low > high {
            let (low, high) = if log { (1.0, 10.0) } else { (0.0, 1.0) };
            return Self { scale, low, high, zeros, spans: false };
        }
        let (least, most) = if log {
            (low / 10.0, high * 10.0)
        } else {
            let span = if high > low { high - low } else { high.abs() };
            (low - span, high + span)
        };
        for end in ranges.filter(|end| end.is_finite()) {
            let end = end.clamp(least, most);
            (low, high) = (low.min(end), high.max(end));
        }
        let (low, high) = match scale {
            Scale::Log => log_margin(low, high),
            Scale::Linear => linear_margin(low, high),
            Scale::LinearFromZero => from_zero(low, high),
        };
        Self { scale, low, high, zeros, spans: true }
    }

    /// From zero to the greatest of the values, without a margin.
    pub(super) fn from_zero(values: impl Iterator<Item = f64>) -> Self {
        let most =
            values.filter(|&value| check(Scale::LinearFromZero, value).is_ok()).fold(0.0, f64::max);
        let high = if most > 0.0 { most } else { 1.0 };
        Self { scale: Scale::LinearFromZero, low: 0.0, high, zeros: false, spans: true }
    }

    /// The ticks without that of the zero lane, about `count` at most.
    pub(super) fn ticks(&self, count: usize) -> Vec<Tick> {
        match self.scale {
            _ if !self.spans => Vec::new(),
            Scale::Log => ticks::log(self.low, self.high, count),
            _ => ticks::linear(self.low, self.high, count),
        }
    }

    /// The values between the powers of ten, where a logarithmic axis has few of these.
    pub(super) fn subdivisions(&self) -> Vec<f64> {
        if self.scale == Scale::Log && self.spans {
            ticks::between_powers(self.low, self.high)
        } else {
            Vec::new()
        }
    }

    /// How far along the axis a value lies, from 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        let share = if self.scale == Scale::Log {
            let low = self.low.log10();
            (value.log10() - low) / (self.high.log10() - low)
        } else {
            (value - self.low) / (self.high - self.low)
        };
        if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    }

    /// Whether exact zeros have a lane of their own.
    pub(super) fn has_lane(&self) -> bool {
        self.zeros
    }
}

fn log_margin(low: f64, high: f64) -> (f64, f64) {
    let ratio = high / low;
    let factor = if ratio > 1.0 + 1e-9 { ratio.powf(0.035).max(1.0 + 1e-9) } else { 2.0 };
    (low / factor, high * factor)
}

fn linear_margin(low: f64, high: f64) -> (f64, f64) {
    let span = high - low;
    let margin = if span > high.abs().max(low.abs()) * 1e-12 {
        span * 0.03
    } else if high == 0.0 {
        1.0
    } else {
        high.abs() * 0.5
    };
    (low - margin, high + margin)
}

fn from_zero(low: f64, high: f64) -> (f64, f64) {
    let (low, high) = (low.min(0.0), high.max(0.0));
    let span = if high > low { high - low } else { 1.0 };
    (if low < 0.0 { low - span * 0.05 } else { 0.0 }, low.max(high) + span * 0.05)
}

/// A domain laid along a line of the drawing, from the place of its low end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    domain: Domain,
    start: f64,
    end: f64,
    lane: f64,
}

impl Track {
    pub(super) fn new(domain: Domain, start: f64, end: f64) -> Self {
        Self { domain, start, end, lane: LANE }
    }

    /// With a wider or narrower lane for exact zeros.
    pub(super) fn with_lane(self, lane: f64) -> Self {
        Self { lane, ..self }
    }

    fn lane(&self) -> f64 {
        if self.domain.zeros { self.lane * (self.end - self.start).signum() } else { 0.0 }
    }

    /// Where the values other than exact zeros begin.
    pub(super) fn floor(&self) -> f64 {
        self.start + self.lane()
    }

    /// The middle of the lane of exact zeros, where there is one.
    pub(super) fn zero(&self) -> Option<f64> {
        self.domain.zeros.then(|| self.start + self.lane() * 0.5)
    }

    /// Where a value is drawn, if it can be.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        check(self.domain.scale, value).ok()?;
        match self.zero() {
            Some(zero) if value == 0.0 => Some(zero),
            _ => Some(self.within(value)),
        }
    }

    /// Where the end of a range is drawn: at the nearest place the axis has.
    pub(super) fn within(&self, value: f64) -> f64 {
        let floor = self.floor();
        floor + (self.end - floor) * self.domain.share(value)
    }
}
