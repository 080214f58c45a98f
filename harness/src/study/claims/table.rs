//! Draws all claims of a paper as a table.

use super::claim::{Claim, Paper};
use super::verdict::Answer;
use crate::report::column::Column;
use crate::report::markup::{Html, html};
use crate::report::table::{Look, Row, Table};

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
    // A narrow table has no heads, so a word precedes the figures.
    let paper_says = |claim: &&Claim<'_>| {
        html!("<b class=\"of\">paper: </b>{}{}", claim.check.paper, departure(claim))
    };
    let columns = [
        Column::markup("the paper", "", paper_says),
        Column::markup("measured here", "", |claim: &&Claim<'_>| {
            let is_one_of_several = claim.answers.len() > 1;
            claim.answers.iter().map(|answer| measured(answer, is_one_of_several)).collect()
        }),
        Column::markup("verdict", "", |claim: &&Claim<'_>| verdict(claim)),
    ];
    let rows = claims.iter().map(|claim| Row::new(claim.check.words, claim)).collect();
    let table = Table::new("claim", columns, rows)
        .noted(|claim| html!(" <small>{}</small>", claim.check.place))
        .html(&format!("Claims of {}", paper.name), Look::Plain);
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
        table
    )
}

/// How our measurement departs from the paper's.
fn departure(claim: &Claim<'_>) -> Html {
    match claim.check.departure {
        "" => Html::default(),
        departure => html!("<br><small>Here: {}</small>", departure),
    }
}

fn verdict(claim: &Claim<'_>) -> Html {
    html!(
        "<span class=\"verdict {0}\" data-claim=\"{1}\" data-verdict=\"{0}\">{2}</span>",
        claim.verdict().id(),
        claim.check.id,
        claim.verdict_text()
    )
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
    let badge = html!("<span class=\"verdict {}\">{}</span>", answer.verdict.id(), verdict);
    match (is_one_of_several, figure.is_empty()) {
        (false, true) => html!("<p>{}</p>", verdict),
        (false, false) => html!("<p>{}</p>", figure),
        (true, true) => html!("<p><b>{}</b> {}</p>", scene, badge),
        (true, false) => html!("<p><b>{}</b> {}<br>{}</p>", scene, badge, figure),
    }
}
