//! Warnings about what the importer left out or changed. Their number and length are bounded,
//! whatever the file contains.

use std::{
    collections::{HashMap, HashSet},
    hash::{DefaultHasher, Hash, Hasher},
};

use crate::error::one_line;

/// The most lines kept of one kind. Further ones are counted.
const MOST_OF_A_KIND: usize = 20;

/// The most lines kept of all kinds.
const MOST_LINES: usize = 400;

/// The most characters shown of a quoted name.
const MOST_OF_A_NAME: usize = 60;

/// The most characters shown of a line.
const MOST_OF_A_LINE: usize = 400;

/// The most characters of a name that a scene keeps.
const MOST_KEPT: usize = 120;

/// One line for each thing left out or changed, without repeats. Two lines are of one kind if they
/// differ only in names and numbers.
#[derive(Default)]
pub(super) struct Warnings {
    lines: Vec<Line>,
    /// Hashes of all lines, including those not kept.
    seen: HashSet<u64>,
    kinds: HashMap<u64, Kind>,
    /// The number of lines of new kinds that came after [`MOST_LINES`].
    others: usize,
}

struct Line {
    text: String,
    kind: u64,
}

#[derive(Default)]
struct Kind {
    kept: usize,
    left_out: usize,
}

impl Warnings {
    /// Adds a line, unless it is there already.
    pub(super) fn add(&mut self, line: String) {
        self.add_short(shortened(&line));
    }

    fn add_short(&mut self, line: String) {
        if !self.seen.insert(hash(&line)) {
            return;
        }
        let kind = hash(&without_names_and_numbers(&line));
        let full = self.lines.len() >= MOST_LINES;
        if full && !self.kinds.contains_key(&kind) {
            self.others += 1;
            return;
        }
        let count = self.kinds.entry(kind).or_default();
        if full || count.kept == MOST_OF_A_KIND {
            count.left_out += 1;
        } else {
            count.kept += 1;
            self.lines.push(Line { text: line, kind });
        }
    }

    /// Adds another list's lines and counts.
    pub(super) fn append(&mut self, other: Self) {
        for line in other.lines {
            self.add_short(line.text);
        }
        self.others += other.others;
        for (kind, count) in other.kinds {
            match self.kinds.get_mut(&kind) {
                Some(known) => known.left_out += count.left_out,
                None => self.others += count.left_out,
            }
        }
    }

    /// The lines in the order in which they were added. The count of further lines of a kind
    /// follows its last line.
    pub(super) fn into_lines(self) -> Vec<String> {
        let mut last = HashMap::new();
        for (ix, line) in self.lines.iter().enumerate() {
            last.insert(line.kind, ix);
        }
        let mut lines = Vec::new();
        for (ix, line) in self.lines.into_iter().enumerate() {
            let more = self.kinds.get(&line.kind).map_or(0, |kind| kind.left_out);
            lines.push(line.text);
            if more > 0 && last.get(&line.kind) == Some(&ix) {
                lines.push(format!("and {} more like the last one", grouped(more)));
            }
        }
        if self.others > 0 {
            lines.push(format!("and {} more warnings of other kinds", grouped(self.others)));
        }
        lines
    }
}

/// A name as a scene keeps it: cut after [`MOST_KEPT`] characters, so that a long name shared by
/// many objects costs little memory.
pub(super) fn kept_name(name: &str) -> String {
    cut(name, MOST_KEPT)
}

fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}

fn hash(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

/// A line without control characters, with its quoted names cut.
fn shortened(line: &str) -> String {
    let mut short = String::new();
    // The number of characters since the open quote.
    let mut quoted: Option<usize> = None;
    let mut chars = line.chars();
    while let Some(c) = chars.next() {
        if c == '"' {
            quoted = if quoted.is_some() { None } else { Some(0) };
            short.push(c);
            continue;
        }
        if let Some(count) = &mut quoted {
            *count += 1;
            if *count == MOST_OF_A_NAME + 1 {
                short.push_str("...");
            }
        }
        let escaped = if c == '\\' { chars.next() } else { None };
        if quoted.is_none_or(|count| count <= MOST_OF_A_NAME) {
            short.push(c);
            short.extend(escaped);
        }
    }
    cut(&one_line(short), MOST_OF_A_LINE)
}

/// The text that all lines of one kind share.
fn without_names_and_numbers(line: &str) -> String {
    let mut kind = String::new();
    let mut in_name = false;
    let mut chars = line.chars();
    while let Some(c) = chars.next() {
        match c {
            '"' => in_name = !in_name,
            '\\' => drop(chars.next()),
            _ if in_name || c.is_ascii_digit() => {}
            _ => kind.push(c),
        }
    }
    kind
}

/// A count with commas between groups of three digits.
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (ix, digit) in digits.chars().enumerate() {
        if ix > 0 && (digits.len() - ix).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_are_counted_capped_and_short() {
        let mut warnings = Warnings::default();
        for ix in 0..80_000 {
            let mut job_warnings = Warnings::default();
            job_warnings.add(format!(
                "mesh {:?}: {ix} normals of length 0 were replaced",
                format!("m\"{ix}")
            ));
            job_warnings.add("vertex colours (COLOR_0) are ignored".into());
            warnings.append(job_warnings);
        }
        warnings.add(format!("node {:?}: not drawn", "n\u{1b}[31m\u{202e}".repeat(1_000_000)));
        warnings.add("x".repeat(1_000_000));
        let lines = warnings.into_lines();
        assert_eq!(lines.len(), 20 + 1 + 1 + 2, "{lines:#?}");
        assert_eq!(lines[0], "mesh \"m\\\"0\": 0 normals of length 0 were replaced");
        assert_eq!(lines[1], "vertex colours (COLOR_0) are ignored");
        assert_eq!(lines[21], "and 79,980 more like the last one");
        assert!(
            lines[22].starts_with("node \"n\\u{1b}[31m") && lines[22].ends_with("\": not drawn")
        );
        assert!(lines.iter().all(|line| line.chars().count() <= MOST_OF_A_LINE + 3), "{lines:#?}");
        assert!(!lines.iter().any(|line| line.contains(['\u{1b}', '\u{202e}'])), "{lines:#?}");
    }

    #[test]
    fn many_kinds_are_bounded_too() {
        let mut warnings = Warnings::default();
        let letters = |ix: usize| ix.to_string().bytes().map(|b| char::from(b + 49)).collect();
        for ix in 0..10_000 {
            let name: String = letters(ix);
            warnings.add(format!("EXT_{name} is ignored"));
        }
        let lines = warnings.into_lines();
        assert_eq!(lines.len(), MOST_LINES + 1);
        assert_eq!(lines[MOST_LINES], "and 9,600 more warnings of other kinds");
    }
}
