//! All claims of a paper as a Markdown table, for the documents: verdicts without the figures, which
//! `lightbench report` prints.

use super::claim::{Claim, Paper};

/// The verdict on each claim of a paper.
pub(crate) fn markdown(paper: &Paper, claims: &[Claim<'_>]) -> String {
    let mut text = format!(
        "| what {} says | where | its figures | verdict |\n|---|---|---|---|\n",
        paper.name
    );
    for claim in claims {
        let check = claim.check;
        let cells = [check.words, check.place, check.paper, &claim.verdict_text()].map(cell);
        text += &format!("| {} |\n", cells.join(" | "));
    }
    text
}

/// Escapes what would end a cell or a line.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
