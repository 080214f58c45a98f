//! How many digits of a number are shown, and in which groups.

/// Writes `1000` as `1,000`. Digits after a decimal point stay as they are.
pub(crate) fn grouped(digits: &str) -> String {
    let (whole, rest) = digits.split_at(digits.find('.').unwrap_or(digits.len()));
    let (sign, whole) = whole.split_at(usize::from(whole.starts_with('-')));
    let mut text = sign.to_owned();
    for (ix, digit) in whole.chars().enumerate() {
        if ix > 0 && (whole.len() - ix).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text + rest
}

/// A number with four significant digits, without zeros at its end: `6.71` for 6.709688.
pub(crate) fn rounded(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn four_digits_are_kept() {
        for (value, text) in [
            (6.709_688_313_802_084, "6.71"),
            (0.123_456, "0.1235"),
            (f64::from(0.1_f32), "0.1"),
            (12.0, "12"),
            (123_456.0, "123500"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(rounded(value), text);
        }
    }
}
