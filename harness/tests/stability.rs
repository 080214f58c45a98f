//! The study of stability on one scenario: what should not fail does not, what fails on purpose does, and the page
//! says so.

use std::path::Path;

use harness::cli::{Invocation, StudyArgs, parse};
use harness::results::Results;
use harness::study::{Done, study};

/// More than 32 lights reach some tiles.
const SCENARIO: &str = "stability:depth-discontinuity";

fn args(out: &Path, words: &[&str]) -> (StudyArgs, Vec<String>) {
    let out = out.display().to_string();
    let line = ["lightbench", "study", "stability", "--quick", "--scene", SCENARIO, "--out", &out];
    let line: Vec<String> = line.iter().chain(words).map(|word| (*word).to_owned()).collect();
    match parse(&line) {
        Ok(Invocation::Study(args)) => (args, line),
        other => panic!("{other:?}"),
    }
}

/// The results of the study's jobs in a section.
fn of_section<'a>(done: &'a Done, section: &'a str) -> impl Iterator<Item = &'a Results> {
    let jobs = done.manifest.jobs.iter().filter(move |job| job.section == section);
    jobs.map(|job| &done.results[&job.name])
}

#[test]
fn sound_methods_are_exact_and_flawed_ones_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let (args, command) = args(folder.path(), &["--size", "64x36"]);
    let words = study(&args, &command).expect("runs");
    let done = Done::read(&[folder.path().to_owned()]).expect("a study");
    assert!(done.missing().is_empty(), "{:?}", done.missing());
    let still: Vec<&Results> = of_section(&done, "still").collect();
    let records = || still.iter().flat_map(|results| &results.records);
    assert!(records().count() > 40, "every method in both modes");
    for record in records() {
        assert!(record.shows_no_loss(), "{}", record.strategy);
        assert!(record.lists.untested.is_none(), "{}", record.strategy);
    }
    let refused = &still[0].refused;
    assert!(
        refused.iter().any(|refused| refused.strategy == "RasterSphere" && refused.mode.is_some()),
        "{refused:?}"
    );
    let flawed = of_section(&done, "flawed").flat_map(|results| &results.records);
    let failed: Vec<&str> = flawed
        .filter(|record| !record.is_lossless())
        .map(|record| record.strategy.as_str())
        .collect();
    for id in ["T-E/32x32/unordered/cap32", "T-E/32x32", "T-I/32x32/first1024/cap8"] {
        assert!(failed.contains(&id), "{id} should fail: {failed:?}");
    }
    // The page says what the records show.
    let line = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(line.contains("and none is wrong"), "{words}");
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("a page");
    for part in [
        "<table class=\"matrix\">",
        "<td class=\"cell exact\">",
        "<td class=\"cell wrong\">",
        "depth-discontinuity-method-sc-e-48x48x40",
        "lightbench explain",
        "lightbench compare --scene stability:depth-discontinuity",
    ] {
        assert!(page.contains(part), "the page lacks {part}");
    }
    // Every cell leads to what was seen.
    for link in page.split("href=\"#depth-discontinuity-").skip(1) {
        let anchor = link.split('"').next().expect("an anchor");
        assert!(page.contains(&format!("id=\"depth-discontinuity-{anchor}\"")), "{anchor}");
    }
}

#[test]
fn soaks_belong_to_this_study() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut args, command) = args(folder.path(), &["--soak", "3"]);
    let error = study(&args, &command).expect_err("refused").to_string();
    assert!(error.contains("--soak is 3: it must be given without --out"), "{error}");
    args.study = "engines".into();
    let error = study(&args, &command).expect_err("refused").to_string();
    assert!(error.starts_with("--soak is 3: it must be left out of studies"), "{error}");
}
