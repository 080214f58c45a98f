//! The documents tell the truth about the registry and the results.

use std::path::Path;

use harness::{registry::STRATEGIES, report::render_markdown, results::Results};

#[test]
fn the_readme_lists_every_strategy_as_the_registry_does() {
    let readme = include_str!("../../README.md");
    for entry in STRATEGIES {
        let row = format!("| `{}` | {} |", entry.default_id(), entry.summary);
        assert!(readme.contains(&row), "README.md lacks the row\n{row}");
    }
}

/// Stands before a table that is made from a file of results.
const TABLE: &str = "<!-- table of ";
/// Stands behind it.
const END: &str = "<!-- end of table -->";

/// A document with its tables made anew from the results that they name.
fn refreshed(document: &str, root: &Path) -> String {
    let mut parts = document.split(TABLE);
    let mut fresh = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (file, rest) = part.split_once(" -->").expect("the comment ends");
        let (_, behind) = rest.split_once(END).expect("the table ends");
        let results = Results::read(&root.join(file)).expect("results");
        fresh += &format!("{TABLE}{file} -->\n{}{END}{behind}", render_markdown(&results));
    }
    fresh
}

/// With `LIGHTBENCH_REFRESH=1` set it writes the tables instead.
#[test]
fn the_tables_of_the_readme_are_those_of_the_results() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let path = root.join("README.md");
    let readme = std::fs::read_to_string(&path).expect("README.md");
    let fresh = refreshed(&readme, &root);
    assert!(readme.matches(TABLE).count() >= 2, "README.md has its tables");
    if std::env::var_os("LIGHTBENCH_REFRESH").is_some() {
        std::fs::write(&path, &fresh).expect("writes");
    } else {
        assert!(
            fresh == readme,
            "a table is stale: `LIGHTBENCH_REFRESH=1 cargo test -p harness --test docs` renews it"
        );
    }
}
