//! Numbers as the charts write them.

pub(super) use crate::digits::grouped;

/// A tick's number with no more digits than it needs: `0.01`, `1,000`, `1e-7`.
pub(super) fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if !size.is_finite() {
        "not finite".to_owned()
    } else if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e7).contains(&size) {
        grouped(&format!("{rounded}"))
    } else {
        format!("{rounded:e}")
    }
}

/// Three significant digits: `0.0361`, `14.0`, `1,230`.
pub(super) fn significant(value: f64) -> String {
    let size = value.abs();
    if !size.is_finite() {
        "not finite".to_owned()
    } else if size == 0.0 {
        "0".to_owned()
    } else if !(1e-4..1e15).contains(&size) {
        format!("{value:.1e}")
    } else {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        let before = rounded.abs().log10().floor() as i32 + 1;
        let decimals = usize::try_from(3 - before).unwrap_or(0);
        grouped(&format!("{rounded:.decimals$}"))
    }
}

/// A length in the drawing, to a tenth: `12`, `12.3`.
pub(super) fn length(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(whole) => whole.to_owned(),
        None => text,
    }
}
