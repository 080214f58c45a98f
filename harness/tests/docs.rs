//! The documents tell the truth about the registry.

use harness::registry::STRATEGIES;

#[test]
fn the_readme_lists_every_strategy_as_the_registry_does() {
    let readme = include_str!("../../README.md");
    for entry in STRATEGIES {
        let row = format!("| `{}` | {} |", entry.default_id(), entry.summary);
        assert!(readme.contains(&row), "README.md lacks the row\n{row}");
    }
}
