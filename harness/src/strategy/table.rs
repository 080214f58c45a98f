//! The rows of the registry as text: for the terminal, and for README.

use std::fmt::Write;

use super::{Row, flaws, rows};

/// The width of the column of ids, characters.
const ID_WIDTH: usize = 16;

/// What `lightbench list strategies` prints: all rows, and then the methods that fail on purpose.
pub fn list() -> String {
    let rows: String = rows().map(entry).collect();
    let heading = "Fail on purpose (`all` includes none of them, and no ranking picks one):";
    format!("{rows}\n{heading}\n{}", flaws::list())
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
    for axis in row.axes.iter().filter(|axis| !axis.is_flaw()) {
        line(&format!("/{}", axis.accepted()));
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
