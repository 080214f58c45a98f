//! All claims of a paper as a table.

use super::super::super::format::escape;
use super::super::figure::table;
use super::{Claim, Paper};

/// All claims as a table.
pub(in crate::report::study) fn claims_html(
    paper: &Paper,
    claims: &[Claim<'_>],
    is_software: bool,
) -> String {
    let Some(first) = claims.first() else { return String::new() };
    let mut heads = vec!["claim".to_owned(), "the paper".to_owned()];
    heads.extend(first.answers.iter().map(|(scene, _)| escape(scene)));
    heads.push("verdict".to_owned());
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> = claims
        .iter()
        .map(|claim| {
            let verdict = claim.verdict();
            let check = claim.check;
            let mut row = vec![format!("{} <small>{}</small>", check.words, escape(check.place))];
            let departure = match check.departure {
                "" => String::new(),
                departure => format!("<br><small>Here: {}</small>", escape(departure)),
            };
            row.push(format!("<b class=\"of\">paper: </b>{}{departure}", escape(check.paper)));
            row.extend(claim.answers.iter().map(|(scene, answer)| {
                let figure = match answer.figure.as_str() {
                    "" => answer.verdict.text(),
                    figure => figure.to_owned(),
                };
                // Where the table is too narrow for heads, the scene stands before its figure.
                let of = format!("<b class=\"of\">{}: </b>", escape(scene));
                let own = match claim.answers.len() {
                    1 => String::new(),
                    _ => format!(
                        "<span class=\"verdict {}\">{}</span><br>",
                        answer.verdict.id(),
                        escape(&answer.verdict.text())
                    ),
                };
                let figure = escape(&figure).replace("; ", ";<br>");
                if answer.figure.is_empty() && !own.is_empty() {
                    return of + &own;
                }
                of + &own + &figure
            }));
            row.push(format!(
                "<span class=\"verdict {0}\" data-claim=\"{1}\" data-verdict=\"{0}\">{2}</span>",
                verdict.id(),
                check.id,
                escape(&claim.verdict_text())
            ));
            row
        })
        .collect();
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
        table(&format!("Claims of {}", paper.name), &heads, &rows)
    )
}
