//! The rows of the registry as text: for the terminal, and for README.

use std::fmt::Write;

use super::{Axis, Row, flaws, rows};

/// The width of the column of ids, characters.
const ID_WIDTH: usize = 16;

/// What `lightbench list strategies` prints: all rows, the segments of their ids, and then the methods that lose light.
pub fn list() -> String {
    let rows: String = rows().map(entry).collect();
    let segments: String = Axis::ALL.iter().filter(|axis| !axis.is_flaw()).map(axis).collect();
    format!(
        "{rows}\nSegments that an id may have, in any order, where its strategy lists them: \
         SC-E/48x48x40/bvh\n\n{segments}\n{}",
        flaws::list()
    )
}

/// A segment, and what it may be.
fn axis(axis: &Axis) -> String {
    format!("{:<ID_WIDTH$} {}\n", axis.name(), axis.accepted())
}

fn entry(row: &Row) -> String {
    let mut text = format!("{:<ID_WIDTH$} {}\n", row.default_id(), row.description());
    let mut line = |what: &str| {
        let _ = writeln!(text, "{:<ID_WIDTH$} {what}", "");
    };
    line(&format!("{}; {}", row.role.name(), row.source));
    for refusal in row.refuses {
        let modes: Vec<&str> = refusal.modes.iter().map(|mode| mode.name()).collect();
        line(&format!("refuses {}: {}", modes.join(" and "), refusal.why));
    }
    if !row.parameters.is_empty() {
        line(&format!("parameters: {}", row.parameters.join(" x ")));
    }
    let segments = row.axes.iter().filter(|axis| !axis.is_flaw());
    let segments: Vec<&str> = segments.map(|axis| axis.name()).collect();
    if !segments.is_empty() {
        line(&format!("segments: {}", segments.join(", ")));
    }
    text
}

/// The table of strategies in README, Markdown.
pub fn markdown() -> String {
    let mut table = "| id | what it is | from | crate |\n|---|---|---|---|\n".to_owned();
    for row in rows() {
        let (id, what) = (row.default_id(), row.description());
        let _ = writeln!(table, "| `{id}` | {what} | {} | `{}` |", row.source, row.krate);
    }
    table
}
