//! Numbers and text as the views show them.

use crate::digits::grouped;

/// Shown where a metric was not measured.
pub(crate) const ABSENT: &str = "\u{2013}";

/// The text as part of a file's name or an anchor: letters and digits in lower case, all else `-`.
pub(crate) fn slug(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    text.chars().map(plain).collect()
}

const MIB: f64 = 1_048_576.0;

/// Three significant digits: `0.0361`, `14.0`, `1,230`.
pub fn significant(value: f64) -> String {
    let size = value.abs();
    if !size.is_finite() {
        "not finite".to_owned()
    } else if size == 0.0 {
        "0".to_owned()
    } else if size < 1e-5 {
        format!("{value:.1e}")
    } else {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        let digits_before = rounded.abs().log10().floor() as i32 + 1;
        let decimals = usize::try_from(3 - digits_before).unwrap_or(0);
        grouped(&format!("{rounded:.decimals$}"))
    }
}

/// Whole numbers with thousands separated; others as [`significant`].
pub(crate) fn number(value: f64) -> String {
    if value.is_finite() && (value.abs() >= 1e3 || value.fract() == 0.0) {
        grouped(&format!("{value:.0}"))
    } else {
        significant(value)
    }
}

/// A difference of radiance: `0`, `1.2e-7`, `0.0312`.
pub(crate) fn difference(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:.1e}") } else { significant(value) }
}

/// Bytes in MiB.
pub(crate) fn mebibytes(bytes: f64) -> String {
    significant(bytes / MIB)
}

/// A factor, without its sign: `14.2`.
pub(crate) fn factor(value: f64) -> String {
    significant(value)
}

/// A share in per cent, without its sign: `27.9`.
pub(crate) fn percent(share: f64) -> String {
    significant(share * 100.0)
}

/// An adapter's name without the part in brackets after it.
pub(crate) fn short_adapter(adapter: &str) -> &str {
    let short = adapter.split(" (").next().unwrap_or(adapter).trim();
    if short.is_empty() { "an unnamed adapter" } else { short }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_significant_digits() {
        for (value, text) in [
            (0.0, "0"),
            (0.036_14, "0.0361"),
            (0.18, "0.180"),
            (1.659, "1.66"),
            (9.999, "10.0"),
            (14.0, "14.0"),
            (999.6, "1,000"),
            (1_234.0, "1,230"),
            (1_234_567.0, "1,230,000"),
            (-12.34, "-12.3"),
            (0.000_042, "0.0000420"),
            (1.23e-7, "1.2e-7"),
            (f64::NAN, "not finite"),
        ] {
            assert_eq!(significant(value), text);
        }
    }

    #[test]
    fn counts_keep_every_digit() {
        assert_eq!(number(1_024.0), "1,024");
        assert_eq!(number(16_777_216.0), "16,777,216");
        assert_eq!(number(7.0), "7");
        assert_eq!(number(18.42), "18.4");
    }

    #[test]
    fn differences_keep_their_size() {
        assert_eq!(difference(0.0), "0");
        assert_eq!(difference(1.19e-7), "1.2e-7");
        assert_eq!(difference(0.031_26), "0.0313");
        assert_eq!(difference(f64::INFINITY), "not finite");
    }
}
