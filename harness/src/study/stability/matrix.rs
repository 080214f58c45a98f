//! The matrix: a row per scenario, a column per method, and in each cell the worst that was seen.

use scenes::stability::{Group, Scenario};

use super::cells::{Cell, Method, cell, flawed_methods, methods};
use super::jobs::scenario_of;
use super::outcome::Outcome;
use crate::report::format::slug;
use crate::report::markup::{Html, html};
use crate::results::Mode;
use crate::study::manifest::Done;

/// How to read the matrix of methods that should not fail.
const SOUND: &str = "A row is a scenario, a column a method. A cell shows the worst that any of its runs showed: in the \
                     modes that the method does not refuse, still and over time. Choose a cell to see what was measured there.";

/// How to read the matrix of methods that fail on purpose.
const BROKEN: &str = "These methods are wrong in ways that renderers have shipped. They are the negative control: a \
                      scenario in which none of them fails tests little.";

/// Both matrices, with what their signs mean.
pub(crate) fn matrices(done: &Done) -> Html {
    if done.results.is_empty() {
        return Html::default();
    }
    let signs: Html = Outcome::ALL
        .iter()
        .rev()
        .map(|outcome| {
            let (name, sign) = (outcome.name(), outcome.sign());
            html!(
                "<dt><i class=\"cell {0}\">{1}</i> {0}</dt><dd>{2}.</dd>\n",
                name,
                sign,
                outcome.meaning()
            )
        })
        .collect();
    html!(
        "<section aria-labelledby=\"matrix\"><h2 id=\"matrix\">Scenarios and methods</h2>\n\
         <dl class=\"columns\">\n{}</dl>\n{}{}</section>\n",
        signs,
        matrix(done, "Methods", SOUND, &methods(done)),
        matrix(done, "Methods that fail on purpose", BROKEN, &flawed_methods(done))
    )
}

fn matrix(done: &Done, title: &str, note: &str, methods: &[Method]) -> Html {
    if methods.is_empty() {
        return Html::default();
    }
    let head = |method: &Method| {
        html!("<th scope=\"col\" title=\"{}\"><span>{}</span></th>", method.name(), method.head())
    };
    let heads: Html = methods.iter().map(head).collect();
    let scenarios: Vec<&Scenario> = done.scenes().into_iter().filter_map(scenario_of).collect();
    let mut body = Html::default();
    for group in Group::LIST {
        let of_group: Vec<&&Scenario> =
            scenarios.iter().filter(|scenario| scenario.group == group).collect();
        if of_group.is_empty() {
            continue;
        }
        body += html!(
            "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n",
            methods.len() + 1,
            group.name()
        );
        body += of_group.into_iter().map(|scenario| row(done, scenario, methods)).collect();
    }
    html!(
        "<h3>{0}</h3>\n<p class=\"note\">{1}</p>\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" \
         aria-label=\"{0}\"><table class=\"matrix\"><thead><tr><td></td>{2}</tr></thead>\n<tbody>\n{3}</tbody>\
         </table></div>\n",
        title,
        note,
        heads,
        body
    )
}

fn row(done: &Done, scenario: &Scenario, methods: &[Method]) -> Html {
    let number = scenario.number.map_or_else(String::new, |number| format!("{number}. "));
    let cells: Html = methods
        .iter()
        .map(|method| shown(scenario.name, &cell(done, scenario.name, method)))
        .collect();
    html!(
        "<tr><th scope=\"row\"><a href=\"#scene-{0}\" title=\"{1}\">{2}{0}</a></th>{3}</tr>\n",
        scenario.name,
        scenario.breaks,
        number,
        cells
    )
}

fn shown(scenario: &str, cell: &Cell<'_>) -> Html {
    let (Some(outcome), Some(worst)) = (cell.outcome(), cell.worst()) else {
        return html!("<td></td>");
    };
    let name = cell.method.name();
    let refused = cell.refuses_some().map_or_else(String::new, |case| {
        let mode = case.mode.map_or("some runs", Mode::name);
        format!("; refuses {mode}: {}", case.words)
    });
    let words = format!("{scenario}, {name}: {}: {}{refused}", outcome.name(), worst.words);
    html!(
        "<td class=\"cell {}\"><a href=\"#{}\" title=\"{}\" aria-label=\"{}\">{}</a></td>",
        outcome.name(),
        anchor(scenario, &cell.method),
        words,
        words,
        outcome.sign()
    )
}

/// Where the page shows what was seen of a method in a scenario.
pub(crate) fn anchor(scenario: &str, method: &Method) -> String {
    let kind = match method {
        Method::Sound(_) => "method",
        Method::Flawed(_) => "flaw",
    };
    format!("{scenario}-{kind}-{}", slug(&method.name()))
}
