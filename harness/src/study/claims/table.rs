//! Draws all claims of a paper as a table.

use super::claim::{Claim, Paper};
use super::verdict::Answer;
use crate::report::markup::{Html, html};
use crate::study::page::figure::table;

const HEADS: [&str; 4] = ["claim", "the paper", "measured here", "verdict"];

/// What a verdict means.
const SCALE: &str = "A claim \u{201c}holds\u{201d} if the figures of all scenes confirm it, and \
                     \u{201c}does not hold\u{201d} if all contradict it. Otherwise it \
                     \u{201c}differs\u{201d}, and the text says where or why. A scene that decides nothing does \
                     not count.";

/// All claims as a table.
pub(crate) fn claims_html(paper: &Paper, claims: &[Claim<'_>], is_software: bool) -> Html {
    if claims.is_empty() {
        return Html::default();
    }
    let rows: Vec<Vec<Html>> = claims.iter().map(row).collect();
    let caveat = if is_software {
        " This study ran on a software adapter, so the verdicts do not apply to a GPU."
    } else {
        ""
    };
    html!(
        "<section class=\"claims\" aria-labelledby=\"claims\"><h2 id=\"claims\">What {} says, and what was \
         measured</h2>\n<p class=\"note\">{}{}</p>\n<p class=\"note\">{}</p>\n{}</section>\n",
        paper.name,
        paper.about,
        caveat,
        SCALE,
        table(&format!("Claims of {}", paper.name), &HEADS, &rows)
    )
}

/// One row: the claim, the paper's figures and our departure, the answer of each scene, and the verdict.
fn row(claim: &Claim<'_>) -> Vec<Html> {
    let check = claim.check;
    let departure = match check.departure {
        "" => Html::default(),
        departure => html!("<br><small>Here: {}</small>", departure),
    };
    let several = claim.answers.len() > 1;
    vec![
        html!("{} <small>{}</small>", check.words, check.place),
        // A narrow table has no heads, so a word precedes the figures.
        html!("<b class=\"of\">paper: </b>{}{}", check.paper, departure),
        claim.answers.iter().map(|answer| measured(answer, several)).collect(),
        html!(
            "<span class=\"verdict {0}\" data-claim=\"{1}\" data-verdict=\"{0}\">{2}</span>",
            claim.verdict().id(),
            check.id,
            claim.verdict_text()
        ),
    ]
}

/// A figure with each of its parts, which semicolons separate, on a line of its own.
fn line_by_line(figure: &str) -> Html {
    let line = |(ix, part): (usize, &str)| {
        let end = if ix == 0 { Html::default() } else { html!("<br>") };
        end + Html::from(part)
    };
    figure.split("; ").enumerate().map(line).collect()
}

/// The answer of one scene, with its own verdict if there are several.
fn measured((scene, answer): &(&str, Answer), is_one_of_several: bool) -> Html {
    let (verdict, figure) = (answer.verdict.text(), line_by_line(&answer.figure));
    let own = html!("<span class=\"verdict {}\">{}</span>", answer.verdict.id(), verdict);
    match (is_one_of_several, figure.is_empty()) {
        (false, true) => html!("<p>{}</p>", verdict),
        (false, false) => html!("<p>{}</p>", figure),
        (true, true) => html!("<p><b>{}</b> {}</p>", scene, own),
        (true, false) => html!("<p><b>{}</b> {}<br>{}</p>", scene, own, figure),
    }
}
