//! Escapes control characters in text from files and drivers.
//!
//! Names of scenes, adapters and strategies may come from any source. A control character in a name could move
//! the terminal's cursor, change its title or forge a line of output. A direction mark could reorder the
//! visible text. This module turns both into escapes.

use std::borrow::Cow;

/// Whether a character is invisible but changes the display of others.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{061c}' // Arabic letter mark
            | '\u{200b}'..='\u{200f}' // zero widths and direction marks
            | '\u{2028}'..='\u{202e}' // line and paragraph separators, embeddings and overrides
            | '\u{2060}'..='\u{206f}' // joiners, isolates, deprecated format characters
            | '\u{feff}' // byte order mark
            | '\u{fff9}'..='\u{fffb}' // interlinear annotations
            | '\u{e0000}'..='\u{e007f}' // tags
        )
}

/// The text on one line, with control characters and line breaks escaped.
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, is_hidden)
}

/// The text with control characters escaped, except line breaks.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c != '\n' && is_hidden(c))
}

fn escaped(text: &str, is_hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_hidden(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_control_characters_are_escaped() {
        for odd in [
            "\u{1b}[31m",
            "\u{1b}]0;title\u{7}",
            "\r",
            "\u{9b}2J",
            "\u{202e}",
            "\u{2066}",
            "\u{7f}",
        ] {
            let shown = visible(odd);
            assert!(shown.starts_with('\\') && !shown.contains(is_hidden), "{odd:?}: {shown}");
            assert_eq!(visible_lines(odd), shown);
        }
        assert_eq!(visible("a\nb"), "a\\nb");
        assert_eq!(visible_lines("a\nb"), "a\nb");
        assert_eq!(
            visible("caf\u{e9} \u{1f4a1} 1\u{a0}\u{d7}\u{a0}2"),
            "caf\u{e9} \u{1f4a1} 1\u{a0}\u{d7}\u{a0}2"
        );
    }
}
