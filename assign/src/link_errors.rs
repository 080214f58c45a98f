//! What the WESL linker says of a fault, as plain text.

use wesl::{Error, ValidateError};

/// The message, without the codes that colour it in a terminal. If the module may be WGSL that the linker does not
/// know, it says what to do.
pub(crate) fn words(error: &Error) -> String {
    let mut words = without_colours(&error.to_string());
    if is_unknown_to_linker(error) {
        words.push_str(
            "\nIf this is WGSL that the linker does not know, leave it out of linking: add the text of Lookup::wgsl to it",
        );
    }
    words
}

/// Whether the linker cannot read a module, or misses a declaration that may be built in.
fn is_unknown_to_linker(error: &Error) -> bool {
    match error {
        Error::Error(diagnostic) => is_unknown_to_linker(&diagnostic.error),
        Error::ParseError(_) | Error::ValidateError(ValidateError::UndefinedSymbol(_)) => true,
        _ => false,
    }
}

/// Whether one name is declared twice.
pub(crate) fn is_clash(error: &Error) -> bool {
    match error {
        Error::Error(diagnostic) => is_clash(&diagnostic.error),
        error => matches!(error, Error::ValidateError(ValidateError::Duplicate(_))),
    }
}

/// Leaves out the sequences from an escape character to the letter `m`.
fn without_colours(text: &str) -> String {
    let mut parts = text.split('\u{1b}');
    let plain = parts.next().unwrap_or_default().to_owned();
    let after = |part: &str| part.split_once('m').map_or("", |(_, rest)| rest).to_owned();
    parts.map(after).fold(plain, |all, part| all + &part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_left_out_and_text_stays() {
        let coloured = "\u{1b}[1m\u{1b}[91merror\u{1b}[0m: mine";
        assert_eq!(without_colours(coloured), "error: mine");
        assert_eq!(without_colours("plain text, mine"), "plain text, mine");
    }
}
