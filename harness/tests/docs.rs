//! The documents tell the truth about the registry and the results.

use std::path::{Path, PathBuf};

use harness::{
    advise::answer,
    registry::STRATEGIES,
    report::{render_markdown, write_study},
    results::{Record, Results},
    study::Done,
};

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

/// The root of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Whether stale documents are to be written anew instead of failing.
fn refreshes() -> bool {
    std::env::var_os("LIGHTBENCH_REFRESH").is_some()
}

/// Fails where a document is not what the results make of it.
fn check_fresh(path: &Path, fresh: &str) {
    let known = std::fs::read_to_string(path).unwrap_or_default();
    if refreshes() {
        std::fs::write(path, fresh).expect("writes");
    } else {
        assert!(
            known == fresh,
            "{} is stale: `LIGHTBENCH_REFRESH=1 cargo test --workspace --test docs` renews it",
            path.display()
        );
    }
}

#[test]
fn the_tables_of_the_readme_are_those_of_the_results() {
    let path = root().join("README.md");
    let readme = std::fs::read_to_string(&path).expect("README.md");
    assert!(readme.matches(TABLE).count() >= 2, "README.md has its tables");
    check_fresh(&path, &refreshed(&readme, &root()));
}

/// Charts of the H200 studies that documents show.
const CHARTS: [(&str, &[&str]); 5] = [
    (
        "h200-study",
        &[
            "sponza-caps-rel-mse.svg",
            "sponza-reuse-rel-mse.svg",
            "sponza-scaling-linear.svg",
            "sponza-path-10000.svg",
        ],
    ),
    ("h200-area", &["atrium-models-flip.svg"]),
    ("h200-endless", &["sponza-a-2016-times.svg"]),
    ("h200-cdi", &["sponza-indirect-mean-error.svg"]),
    ("h200-cdi-builds", &["sponza-range-errors.svg", "town-builds.svg"]),
];

#[test]
fn the_charts_of_the_documents_are_those_of_the_studies() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("README.md");
    let verdicts = std::fs::read_to_string(root().join("results/README.md")).expect("README");
    for (study, charts) in CHARTS {
        let folder = tempfile::tempdir().expect("a folder");
        let done = Done::read(&[root().join("results").join(study)]).expect("the study");
        assert!(done.missing().is_empty(), "missing: {:?}", done.missing());
        write_study(&done, folder.path()).expect("writes");
        for chart in charts {
            let fresh = std::fs::read_to_string(folder.path().join("charts").join(chart));
            check_fresh(&root().join("docs").join(chart), &fresh.expect("the chart"));
            assert!(readme.contains(chart) || verdicts.contains(chart), "{chart} is shown nowhere");
        }
    }
}

/// What advice measured in all its rounds.
fn measured(folder: &Path) -> (Results, Vec<Record>) {
    let read = |round: &str| Results::read(&folder.join(round)).expect("results");
    let last = read("final.json");
    let all = ["families.json", "parameters.json"].map(|round| read(round).records).concat();
    let all = all.into_iter().chain(last.records.clone()).collect();
    (last, all)
}

#[test]
fn advice_lies_on_the_frontier_of_all_that_was_measured() {
    let folder = root().join("results/h200-advise");
    let error = |record: &Record| match record.is_lossless() {
        true => 0.0,
        false => record.errors.get("rel_mse").copied().flatten().unwrap_or(f64::INFINITY),
    };
    let mut answers = Vec::new();
    for (name, budget) in [("sponza", 0.0), ("sponza-budget", 0.001), ("atrium-30", 0.0)] {
        let (last, all) = measured(&folder.join(name));
        let text = answer(&last, budget);
        let id = text.split(' ').nth(1).expect("a name").trim_end_matches(':').to_owned();
        let best = last.records.iter().find(|record| record.strategy == id).expect("its record");
        // Nothing within the budget was faster by more than what two rounds differ by.
        for other in all.iter().filter(|other| error(other) <= budget) {
            let gain = best.assign_and_shade_ms() / other.assign_and_shade_ms() - 1.0;
            assert!(gain < 0.02, "{name}: {} beats {id} by {gain}", other.strategy);
        }
        answers.push(id);
    }
    assert_ne!(answers[0], answers[2], "two scenes, two answers");
}
