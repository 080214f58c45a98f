//! Text in a drawing: its markup, and the room it takes.

/// The size of all text, in the drawing's units.
pub(super) const SIZE: f64 = 15.0;
/// Its greatest size: `CHART_CSS` enlarges it on narrow pages.
const LARGEST: f64 = 16.0;
const BOLD: f64 = 1.12;

/// Text for SVG, between tags or in a quoted attribute.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' => escaped.push_str("&#10;"),
            '\t' => escaped.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c < ' ' => {}
            c => escaped.push(c),
        }
    }
    escaped
}

/// About how wide a character is, as a share of the text's size: that of DejaVu Sans, one of the
/// widest that pages fall back to.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | '\'' => 0.29,
        ' ' | '.' | ',' | ':' | ';' | '|' | '!' => 0.34,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '/' | '"' | '\u{b7}' => 0.4,
        'm' | 'w' | 'M' | 'W' | '\u{2026}' | '@' | '%' | '\u{2014}' => 1.0,
        'A'..='Z' | '&' => 0.7,
        '<' | '>' | '=' | '+' | '~' | '^' => 0.84,
        'c' | 'k' | 's' | 'v' | 'x' | 'y' | 'z' => 0.57,
        ' '..='\u{2ff}' => 0.63,
        '\u{300}'..='\u{36f}' => 0.0,
        '\u{1100}'..='\u{11ff}' | '\u{2e80}'.. => 1.05,
        _ => 0.7,
    }
}

/// About how wide a text is drawn, rather too much than too little.
pub(super) fn width(text: &str) -> f64 {
    text.chars().map(advance).sum::<f64>() * LARGEST
}

/// About how wide a text is drawn in bold.
pub(super) fn bold_width(text: &str) -> f64 {
    width(text) * BOLD
}

/// A text cut to fit the room, with an ellipsis where something was cut.
pub(super) fn shorten(text: &str, room: f64) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let room = room - width("\u{2026}");
    let mut used = 0.0;
    let kept: String = text
        .chars()
        .take_while(|&c| {
            used += advance(c) * LARGEST;
            used <= room
        })
        .collect();
    format!("{}\u{2026}", kept.trim_end())
}

/// A bold text cut to fit the room.
pub(super) fn shorten_bold(text: &str, room: f64) -> String {
    shorten(text, room / BOLD)
}

/// A text in lines that fit the room.
pub(super) fn wrap(text: &str, room: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let word = shorten(word, room);
        if !line.is_empty() && width(&line) + width(" ") + width(&word) > room {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(&word);
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// `one point is` or `7 points are`, to begin a sentence with.
pub(super) fn count_of(count: usize, singular: &str) -> String {
    match count {
        1 => format!("1 {singular} is"),
        _ => format!("{count} {singular}s are"),
    }
}
