//! The colours of strategies, passes and plain series: for pages, and for files that no page colours.
//!
//! A strategy's colour stands in its row of the [registry](crate::strategy); the class of its family,
//! such as `strategy-sc-e`, gives it in every table and chart.

use crate::strategy::{Colour, GREY, rows};

/// A class or variable with its colour on white and on black.
type Named = (&'static str, Colour);

const fn colour(light: &'static str, dark: &'static str) -> Colour {
    Colour { light, dark }
}

const VARIABLES: [Named; 4] = [
    ("--paper", colour("#fdfdfb", "#141618")),
    ("--ink", colour("#17191b", "#eceae4")),
    ("--soft", colour("#5c6166", "#a2a8ad")),
    ("--line", colour("#dcdcd5", "#33383d")),
];

/// Strategies that compete with none, and those of unknown families.
const NO_FAMILY: Named = ("strategy-none", GREY);

/// Series of a chart that are no strategies, such as models of area lights.
const SERIES: [Named; 9] = [
    ("series-0", colour("#0f8a77", "#45bda9")),
    ("series-1", colour("#8b3a8f", "#cf84d2")),
    ("series-2", colour("#8a8420", "#c7c05a")),
    ("series-3", colour("#882255", "#e07aa6")),
    ("series-4", colour("#332288", "#9a8bf0")),
    ("series-5", colour("#117733", "#63bd80")),
    ("series-6", colour("#c25a66", "#ee949e")),
    ("series-7", colour("#5b8fa8", "#9ccbe0")),
    ("series-8", colour("#6e4a26", "#c79b6b")),
];

/// Passes of a frame. The hue tells the kind (grey scene, green lights that move, blue assign, orange shade),
/// the lightness the pass.
const PASSES: [Named; 19] = [
    ("pass-scene-0", colour("#c3c5c4", "#5a5f63")),
    ("pass-scene-1", colour("#a2a6a7", "#777d81")),
    ("pass-scene-2", colour("#848a8c", "#949a9e")),
    ("pass-scene-3", colour("#6a7073", "#b0b6b9")),
    ("pass-living-0", colour("#0b6b52", "#63c9a5")),
    ("pass-living-1", colour("#3fa886", "#1f8263")),
    ("pass-living-2", colour("#93d3ba", "#135a45")),
    ("pass-assign-0", colour("#1f6fae", "#5aa7e0")),
    ("pass-assign-1", colour("#5a9bd0", "#347fb8")),
    ("pass-assign-2", colour("#124a7a", "#8cc4ee")),
    ("pass-assign-3", colour("#8fc0e6", "#245c88")),
    ("pass-shade-0", colour("#e08a1e", "#e9a04a")),
    ("pass-shade-1", colour("#b9650b", "#c67a22")),
    ("pass-shade-2", colour("#efb568", "#f3c184")),
    ("pass-shade-3", colour("#8f4a05", "#9c5b12")),
    ("pass-other-0", colour("#d8cfe0", "#4c4356")),
    ("pass-other-1", colour("#b9abc7", "#6b5f78")),
    ("pass-other-2", colour("#9786aa", "#8b7e99")),
    ("pass-other-3", colour("#77658c", "#ab9fb8")),
];

const FONT: &str = "system-ui, -apple-system, \"Segoe UI\", Roboto, \"Helvetica Neue\", \
                    \"Noto Sans\", \"Liberation Sans\", Arial, sans-serif";

/// All classes that give a colour.
fn classes() -> impl Iterator<Item = (String, Colour)> {
    let named = |(class, colour): &Named| ((*class).to_owned(), *colour);
    let families = rows().map(|row| (row.class(), row.colour));
    [NO_FAMILY]
        .iter()
        .chain(&SERIES)
        .chain(&PASSES)
        .map(named)
        .collect::<Vec<_>>()
        .into_iter()
        .chain(families.filter(|(class, _)| class != NO_FAMILY.0))
}

/// The rules by which a page colours strategies, passes and series: each class sets `--colour`.
pub fn page_colours() -> String {
    let rule = |(class, Colour { light, dark }): (String, Colour)| {
        format!(".{class} {{ --colour: light-dark({light}, {dark}); }}\n")
    };
    classes().map(rule).collect()
}

/// The style of a file with some content: the page's rules without its variables, which many viewers of
/// SVG lack. Only the classes of the content have a rule, so that other files do not change when a
/// family joins.
pub(super) fn file_style(rules: &str, content: &str) -> String {
    let light = scheme(rules, content, |colour| colour.light);
    let dark = scheme(rules, content, |colour| colour.dark);
    format!(
        ".chart {{ font-family: {FONT}; }}\n{light}\
         @media (prefers-color-scheme: dark) {{\n{dark}}}\n\
         svg.chart {{ width: auto; max-width: 100%; }}\n"
    )
}

fn scheme(rules: &str, content: &str, pick: impl Fn(Colour) -> &'static str) -> String {
    let coloured = VARIABLES.iter().fold(rules.to_owned(), |rules, (name, colour)| {
        rules.replace(&format!("var({name})"), pick(*colour))
    });
    let [(_, paper), (_, ink), ..] = VARIABLES;
    let ink = pick(ink);
    let mut style = coloured.replace(&format!("var(--colour, {ink})"), ink);
    style.push_str(&format!(".chart .paper {{ fill: {}; }}\n", pick(paper)));
    for (class, colour) in classes().filter(|(class, _)| has_class(content, class)) {
        style.push_str(&format!(".chart .{class} {{ color: {}; }}\n", pick(colour)));
    }
    style
}

/// Whether some element has a class.
fn has_class(content: &str, class: &str) -> bool {
    content.match_indices(class).any(|(at, _)| {
        let next = content.as_bytes().get(at + class.len());
        matches!(next, Some(b'"' | b' '))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_colour_what_they_show_and_pages_everything() {
        let content = "<g class=\"line strategy-sc-e\"/><g class=\"series-1\"/>";
        let style = file_style(".line { stroke: var(--colour, var(--ink)); }", content);
        assert!(style.contains(".strategy-sc-e { color: #117733; }"), "{style}");
        assert!(style.contains(".series-1 ") && !style.contains(".strategy-t-e"), "{style}");
        assert!(!has_class("strategy-sc-e2", "strategy-sc-e"));
        let page = page_colours();
        for row in rows() {
            let class = format!(".{} {{", row.class());
            assert_eq!(page.matches(&class).count(), 1, "{class}");
        }
    }
}
