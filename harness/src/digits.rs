//! Groups digits by thousands.

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
