//! The pages of all stored results show the figures and names that they showed before.
//!
//! `lines.txt` holds these lines for each page:
//!
//! - the headline and each finding, whole;
//! - of each table, a digest of the figures, and one of the row names. A figure is a number in a cell;
//! - of all charts, a digest of the figures in the titles of their marks;
//! - a digest of the verdicts on claims.
//!
//! Tables and verdicts of studies were compared with the pages of commit 0f3b1ca, which is older than the
//! first version of this file: all figures are the same.
//! `LIGHTBENCH_REFRESH=1 cargo test -p harness --test stored_pages` writes the file anew, where a change is
//! meant.

mod lines;

use std::path::{Path, PathBuf};

use harness::{
    report::render_html,
    results::Results,
    study::{Done, Manifest, write_study},
};
use lines::lines;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The stored results in a folder: studies, and files of results.
fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![root().join("results")];
    while let Some(folder) = open.pop() {
        let is_study = Manifest::find(&folder).expect("reads").is_some();
        if is_study {
            found.push(folder.clone());
        }
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            let is_data = path.extension().is_some_and(|extension| extension == "json");
            match path.is_dir() {
                true if !is_study => open.push(path),
                false if is_data && !path.ends_with("study.json") => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// The page of stored results.
fn page(source: &Path) -> String {
    if source.is_file() {
        // Answers of `advise` are no results.
        return match Results::read(source) {
            Ok(results) => render_html(&results, &[]),
            Err(_) => String::new(),
        };
    }
    let done = Done::read(&[source.to_owned()]).expect("a study");
    let out = tempfile::tempdir().expect("a folder");
    write_study(&done, out.path()).expect("writes");
    std::fs::read_to_string(out.path().join("index.html")).expect("a page")
}

#[test]
fn stored_results_give_the_same_figures() {
    let file = root().join("harness/tests/stored_pages/lines.txt");
    let mut fresh = String::new();
    for source in sources() {
        let name =
            source.strip_prefix(root().join("results")).expect("inside").display().to_string();
        for line in lines(&name, &page(&source)) {
            fresh += &format!("{line}\n");
        }
    }
    for kind in [" table ", " rows of table ", " marks: ", " verdicts, ", " says "] {
        let count = fresh.lines().filter(|line| line.contains(kind)).count();
        assert!(count >= 7, "{count} lines with{kind}were found:\n{fresh}");
    }
    if std::env::var_os("LIGHTBENCH_REFRESH").is_some() {
        std::fs::write(&file, &fresh).expect("writes");
        return;
    }
    let known = std::fs::read_to_string(&file).expect("reads");
    let lines_only_in = |one: &str, other: &str| -> Vec<String> {
        let others: Vec<&str> = other.lines().collect();
        one.lines().filter(|line| !others.contains(line)).map(str::to_owned).collect()
    };
    let (gone, new) = (lines_only_in(&known, &fresh), lines_only_in(&fresh, &known));
    assert!(
        gone.is_empty() && new.is_empty(),
        "figures changed; gone:\n{}\nnew:\n{}",
        gone.join("\n"),
        new.join("\n")
    );
}
