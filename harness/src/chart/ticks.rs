//! Where an axis has ticks.

/// A tick's value, and whether its label goes before others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) major: bool,
}

const MOST: u32 = 60;
/// Axes of fewer decades have ticks between the powers of ten.
const FEW_DECADES: f64 = 2.6;

/// At most about `count` round steps.
pub(super) fn linear(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let raw = (high - low) / count.max(1) as f64;
    if !(raw.is_finite() && raw > 0.0) {
        return vec![Tick { value: low, major: true }];
    }
    let power = 10_f64.powf(raw.log10().floor());
    let factors = [1.0, 2.0, 2.5, 5.0, 10.0];
    let step = factors.iter().map(|f| f * power).find(|&step| step >= raw * 0.999).unwrap_or(raw);
    let first = (low / step - 1e-9).ceil();
    (0..MOST)
        .map(|ix| (first + f64::from(ix)) * step)
        .take_while(|&value| value <= high + step * 1e-9)
        .map(|value| Tick { value, major: true })
        .collect()
}

/// Powers of ten; with their double and fivefold where there are few of them.
pub(super) fn log(low: f64, high: f64, count: usize) -> Vec<Tick> {
    let (from, to) = (low.log10(), high.log10());
    if !(from.is_finite() && to.is_finite()) {
        return Vec::new();
    }
    let (first, last) = ((from - 1e-9).ceil() as i32, (to + 1e-9).floor() as i32);
    if to - from >= FEW_DECADES {
        let decades = last - first + 1;
        let stride = (decades + count.max(1) as i32 - 1) / count.max(1) as i32;
        return (first..=last)
            .filter(|power| power.rem_euclid(stride.max(1)) == 0)
            .map(|power| Tick { value: 10_f64.powi(power), major: true })
            .collect();
    }
    let ticks: Vec<Tick> = (first - 1..=last)
        .flat_map(|power| [1.0, 2.0, 5.0].map(|factor| (factor, factor * 10_f64.powi(power))))
        .filter(|&(_, value)| value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9))
        .map(|(factor, value)| Tick { value, major: factor == 1.0 })
        .collect();
    if ticks.len() < 3 { linear(low, high, count.min(4)) } else { ticks }
}

/// The whole multiples of powers of ten, unless there are many decades.
pub(super) fn between_powers(low: f64, high: f64) -> Vec<f64> {
    const MOST_DECADES: i32 = 8;
    let (first, last) = (low.log10().floor() as i32, high.log10().floor() as i32);
    if last.saturating_sub(first) > MOST_DECADES {
        return Vec::new();
    }
    (first..=last)
        .flat_map(|power| (2..10).map(move |factor| f64::from(factor) * 10_f64.powi(power)))
        .filter(|value| (low..=high).contains(value))
        .collect()
}
