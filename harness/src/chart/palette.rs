//! The report's colours, for files that no page colours.

/// A class or variable with its colour on white and on black.
type Colour = (&'static str, &'static str, &'static str);

const VARIABLES: [Colour; 4] = [
    ("--paper", "#fdfdfb", "#141618"),
    ("--ink", "#17191b", "#eceae4"),
    ("--soft", "#5c6166", "#a2a8ad"),
    ("--line", "#dcdcd5", "#33383d"),
];

const CLASSES: [Colour; 26] = [
    ("strategy-none", "#8a8f93", "#8d9398"),
    ("strategy-0", "#0f8a77", "#45bda9"),
    ("strategy-1", "#8b3a8f", "#cf84d2"),
    ("strategy-2", "#8a8420", "#c7c05a"),
    ("strategy-3", "#882255", "#e07aa6"),
    ("strategy-4", "#332288", "#9a8bf0"),
    ("strategy-5", "#117733", "#63bd80"),
    ("strategy-6", "#c25a66", "#ee949e"),
    ("strategy-7", "#5b8fa8", "#9ccbe0"),
    ("strategy-8", "#6e4a26", "#c79b6b"),
    ("pass-scene-0", "#c3c5c4", "#5a5f63"),
    ("pass-scene-1", "#a2a6a7", "#777d81"),
    ("pass-scene-2", "#848a8c", "#949a9e"),
    ("pass-scene-3", "#6a7073", "#b0b6b9"),
    ("pass-assign-0", "#1f6fae", "#5aa7e0"),
    ("pass-assign-1", "#5a9bd0", "#347fb8"),
    ("pass-assign-2", "#124a7a", "#8cc4ee"),
    ("pass-assign-3", "#8fc0e6", "#245c88"),
    ("pass-shade-0", "#e08a1e", "#e9a04a"),
    ("pass-shade-1", "#b9650b", "#c67a22"),
    ("pass-shade-2", "#efb568", "#f3c184"),
    ("pass-shade-3", "#8f4a05", "#9c5b12"),
    ("pass-other-0", "#d8cfe0", "#4c4356"),
    ("pass-other-1", "#b9abc7", "#6b5f78"),
    ("pass-other-2", "#9786aa", "#8b7e99"),
    ("pass-other-3", "#77658c", "#ab9fb8"),
];

const FONT: &str = "system-ui, -apple-system, \"Segoe UI\", Roboto, \"Helvetica Neue\", \
                    \"Noto Sans\", \"Liberation Sans\", Arial, sans-serif";

/// A file's style: the page's rules without its variables, which many viewers of SVG lack.
pub(super) fn file_style(rules: &str) -> String {
    let light = scheme(rules, |(_, light, _)| light);
    let dark = scheme(rules, |(_, _, dark)| dark);
    format!(
        ".chart {{ font-family: {FONT}; }}\n{light}\
         @media (prefers-color-scheme: dark) {{\n{dark}}}\n\
         svg.chart {{ width: auto; max-width: 100%; }}\n"
    )
}

fn scheme(rules: &str, pick: impl Fn(Colour) -> &'static str) -> String {
    let colours = VARIABLES.iter().fold(rules.to_owned(), |rules, &colour| {
        rules.replace(&format!("var({})", colour.0), pick(colour))
    });
    let ink = VARIABLES.iter().find(|colour| colour.0 == "--ink").map_or("#000", |&ink| pick(ink));
    let mut style = colours.replace(&format!("var(--colour, {ink})"), ink);
    for colour in VARIABLES.iter().filter(|colour| colour.0 == "--paper") {
        style.push_str(&format!(".chart .paper {{ fill: {}; }}\n", pick(*colour)));
    }
    for &colour in &CLASSES {
        style.push_str(&format!(".chart .{} {{ color: {}; }}\n", colour.0, pick(colour)));
    }
    style
}
