//! All claims of a paper as a table.

use super::super::super::format::escape;
use super::super::figure::table;
use super::{Answer, Claim, Paper};

const HEADS: [&str; 4] = ["claim", "the paper", "measured here", "verdict"];

/// All claims as a table.
pub(in crate::report::study) fn claims_html(
    paper: &Paper,
    claims: &[Claim<'_>],
    is_software: bool,
) -> String {
    if claims.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = claims.iter().map(row).collect();
    let caveat = if is_software {
        " This study ran on a software adapter: the verdicts are not a GPU\u{2019}s."
    } else {
        ""
    };
    format!(
        "<section class=\"claims\" aria-labelledby=\"claims\"><h2 id=\"claims\">What {} says, and what was \
         measured</h2>\n<p class=\"note\">{}{caveat}</p>\n{}</section>\n",
        paper.name,
        paper.about,
        table(&format!("Claims of {}", paper.name), &HEADS, &rows)
    )
}

/// The claim, the paper's figures and our departure, what each scene says, and the verdict.
fn row(claim: &Claim<'_>) -> Vec<String> {
    let check = claim.check;
    let departure = match check.departure {
        "" => String::new(),
        departure => format!("<br><small>Here: {}</small>", escape(departure)),
    };
    let verdict = claim.verdict();
    vec![
        format!("{} <small>{}</small>", check.words, escape(check.place)),
        // Where the table is too narrow for heads, words stand before the figures.
        format!("<b class=\"of\">paper: </b>{}{departure}", escape(check.paper)),
        claim.answers.iter().map(|answer| measured(answer, claim.answers.len() > 1)).collect(),
        format!(
            "<span class=\"verdict {0}\" data-claim=\"{1}\" data-verdict=\"{0}\">{2}</span>",
            verdict.id(),
            check.id,
            escape(&claim.verdict_text())
        ),
    ]
}

/// What one scene says; of several, each with its own verdict.
fn measured((scene, answer): &(&str, Answer), is_one_of_several: bool) -> String {
    let verdict = escape(&answer.verdict.text());
    let figure = escape(&answer.figure);
    let own = format!("<span class=\"verdict {}\">{verdict}</span>", answer.verdict.id());
    match (is_one_of_several, figure.is_empty()) {
        (false, true) => format!("<p>{verdict}</p>"),
        (false, false) => format!("<p>{figure}</p>"),
        (true, true) => format!("<p><b>{}</b> {own}</p>", escape(scene)),
        (true, false) => format!("<p><b>{}</b> {own}<br>{figure}</p>", escape(scene)),
    }
}
