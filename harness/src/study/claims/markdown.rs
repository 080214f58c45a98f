//! All claims of a paper as a Markdown table, for the documents: verdicts without the figures, which
//! `lightbench report` prints.

use crate::study::claims::{Claim, Paper, claims, paper};
use crate::study::Done;

/// The verdict on each claim of the paper that a study is held against; empty where there is no paper.
pub fn claims_markdown(done: &Done) -> String {
    paper(&done.manifest.study).map_or_else(String::new, |paper| table(paper, &claims(done, paper)))
}

fn table(paper: &Paper, claims: &[Claim<'_>]) -> String {
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

/// Text that ends no cell and no line.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
