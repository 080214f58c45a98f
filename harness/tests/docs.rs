//! The documents tell the truth about the registry and the results.

use std::path::{Path, PathBuf};

use harness::{
    advise::{answer, error_of, verdict},
    report::{
        best_sizes_markdown, chosen_sizes_markdown, is_surely_faster, memory_chart, render_markdown,
    },
    results::{Record, Results},
    strategy,
    study::{Done, claims_markdown, write_study},
};

/// Stands before the table of strategies.
const STRATEGIES: &str = "<!-- strategies -->\n";

/// Stands before the table of what a renderer provides for each.
const PLUG_IN: &str = "<!-- plug-in -->\n";

#[test]
fn the_readme_lists_every_strategy_as_the_registry_does() {
    let path = root().join("README.md");
    let readme = std::fs::read_to_string(&path).expect("README.md");
    let gpu = assign::Gpu::noop().expect("a device");
    let plug_in = strategy::plug_in_markdown(&gpu).expect("a table");
    let fresh = [(STRATEGIES, strategy::markdown()), (PLUG_IN, plug_in)];
    let fresh = fresh.into_iter().fold(readme, |readme, (mark, table)| {
        let (before, rest) = readme.split_once(mark).expect("README.md has the table");
        let (_, behind) = rest.split_once(END).expect("the table ends");
        format!("{before}{mark}{table}{END}{behind}")
    });
    check_fresh(&path, &fresh);
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

/// Stands before a table of verdicts that is made from a folder of a study.
const CLAIMS: &str = "<!-- claims of ";

/// A document with its verdicts made anew from the studies that they name.
fn judged_anew(document: &str, root: &Path) -> String {
    let mut parts = document.split(CLAIMS);
    let mut fresh = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (folder, rest) = part.split_once(" -->").expect("the comment ends");
        let (_, behind) = rest.split_once(END).expect("the table ends");
        let done = Done::read(&[root.join(folder)]).expect("a study");
        fresh += &format!("{CLAIMS}{folder} -->\n{}{END}{behind}", claims_markdown(&done));
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
fn the_full_tables_hold_the_figures_of_the_results() {
    let path = root().join("docs/sponza.md");
    let document = std::fs::read_to_string(&path).expect("docs/sponza.md");
    assert!(document.matches(TABLE).count() >= 5, "docs/sponza.md has its five tables");
    check_fresh(&path, &refreshed(&document, &root()));
}

/// Stands before a table of methods against the number of lights. The stem of the files follows, a colon, and
/// `best` or the ids of the rows.
const METHODS: &str = "<!-- methods of ";

/// The light counts of these tables, in the order of their columns.
const LIGHT_COUNTS: [u32; 4] = [100, 1_000, 10_000, 100_000];

/// A document with its tables of methods made anew from the results that they name.
fn with_methods(document: &str, root: &Path) -> String {
    let mut parts = document.split(METHODS);
    let mut fresh = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (words, rest) = part.split_once(" -->").expect("the comment ends");
        let (_, behind) = rest.split_once(END).expect("the table ends");
        let (stem, chosen) = words.split_once(": ").expect("a stem and what to show");
        let read = |count: u32| Results::read(&root.join(format!("{stem}-{count}.json")));
        let columns = LIGHT_COUNTS.map(|count| read(count).expect("results"));
        let table = match chosen {
            "best" => best_sizes_markdown(&columns),
            ids => {
                let ids: Vec<&str> = ids.split(',').collect();
                chosen_sizes_markdown(&columns, &ids).expect("measured ids")
            }
        };
        fresh += &format!("{METHODS}{words} -->\n{table}{END}{behind}");
    }
    fresh
}

#[test]
fn the_tables_of_methods_hold_the_figures_of_the_results() {
    for (name, least) in [("README.md", 1), ("docs/methods.md", 4)] {
        let path = root().join(name);
        let document = std::fs::read_to_string(&path).expect("the document");
        assert!(document.matches(METHODS).count() >= least, "{name} has its tables");
        check_fresh(&path, &with_methods(&document, &root()));
    }
}

#[test]
fn the_verdicts_of_the_results_are_those_of_the_reports() {
    let path = root().join("results/README.md");
    let document = std::fs::read_to_string(&path).expect("results/README.md");
    assert!(document.matches(CLAIMS).count() >= 5, "every paper has its verdicts");
    check_fresh(&path, &judged_anew(&document, &root()));
}

/// The study that was run with `--only`, so some of its jobs are missing.
const PARTIAL: &str = "h200-comparison";

/// Charts of the H200 studies that documents show.
const CHARTS: [(&str, &[&str]); 7] = [
    ("h200-comparison", &["sponza-scaling-linear.svg"]),
    (
        "h200-study",
        &["sponza-caps-rel-mse.svg", "sponza-reuse-rel-mse.svg", "sponza-path-10000.svg"],
    ),
    ("h200-area", &["atrium-models-flip.svg"]),
    ("h200-endless", &["sponza-a-2016-times.svg"]),
    ("h200-cdi", &["sponza-indirect-mean-error.svg"]),
    ("h200-engines", &["sponza-errors-10000-flip.svg"]),
    ("h200-cdi-builds", &["sponza-range-errors.svg", "town-builds.svg"]),
];

#[test]
fn the_charts_of_the_documents_are_those_of_the_studies() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("README.md");
    let verdicts = std::fs::read_to_string(root().join("results/README.md")).expect("README");
    for (study, charts) in CHARTS {
        let folder = tempfile::tempdir().expect("a folder");
        let done = Done::read(&[root().join("results").join(study)]).expect("the study");
        let is_whole = done.missing().is_empty() || study == PARTIAL;
        assert!(is_whole, "{study} lacks {:?}", done.missing());
        write_study(&done, folder.path()).expect("writes");
        for chart in charts {
            let fresh = std::fs::read_to_string(folder.path().join("charts").join(chart));
            check_fresh(&root().join("docs").join(chart), &fresh.expect("the chart"));
            assert!(readme.contains(chart) || verdicts.contains(chart), "{chart} is shown nowhere");
        }
    }
}

/// Charts of time against memory that documents show, and the results that they are made from.
const MEMORY_CHARTS: [(&str, &str); 2] = [
    ("sponza-memory-10000.svg", "results/h200-families/sponza-10000.json"),
    ("sponza-memory-1000.svg", "results/h200-families/sponza-1000.json"),
];

#[test]
fn the_charts_of_memory_are_those_of_the_results() {
    let document = std::fs::read_to_string(root().join("docs/methods.md")).expect("methods.md");
    for (chart, file) in MEMORY_CHARTS {
        let results = Results::read(&root().join(file)).expect("results");
        let fresh = memory_chart(&results).expect("a chart");
        check_fresh(&root().join("docs").join(chart), &fresh);
        assert!(document.contains(chart), "{chart} is shown nowhere");
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
    let error = |record: &Record| error_of(record).unwrap_or(f64::INFINITY);
    let time = Record::assign_and_shade_ms;
    let mut answers = Vec::new();
    for (name, budget) in [("sponza", 0.0), ("sponza-budget", 0.001), ("atrium-30", 0.0)] {
        let (last, all) = measured(&folder.join(name));
        let verdict = verdict(&last, budget).expect("a verdict");
        let (best, id) = (verdict.best, &verdict.best.strategy);
        let text = answer(&last, budget);
        assert!(text.starts_with(&format!("Use {id} (")), "{name}: {text}");
        println!("{name}: {text}");
        // Nothing within the budget was surely faster in the same round.
        let within = last.records.iter().filter(|other| error(other) <= budget);
        for other in within.filter(|other| !other.is_control()) {
            assert_eq!(is_surely_faster(other, best), Some(false), "{name}: {}", other.strategy);
        }
        // Nor, in another, by more than what two rounds differ by.
        for other in all.iter().filter(|other| error(other) <= budget) {
            let gain = time(best) / time(other) - 1.0;
            assert!(gain < 0.03, "{name}: {} beats {id} by {gain}", other.strategy);
        }
        // A lossy setting is named only where no exact one ties with it.
        let exact = last.records.iter().filter(|other| other.is_exact() && other.culls());
        let gains = |other: &Record| is_surely_faster(best, other) == Some(true);
        assert!(best.is_exact() || exact.clone().all(gains), "{name}: {id} gains nothing");
        let says_still = text.lines().next().is_some_and(|line| line.contains("Still lights only"));
        assert_eq!(says_still, id.is_bvh(), "{name}: {text}");
        answers.push(id.clone());
    }
    assert_ne!(answers[0], answers[2], "two scenes, two answers");
}

/// The stored budget run once named what a cap of 64 gained: nothing. Whatever the caps took, their
/// least time must not lead.
#[test]
fn stored_caps_that_tie_are_not_advised() {
    let (last, _) = measured(&root().join("results/h200-advise/sponza-budget"));
    let mut caps = 0;
    for ix in 0..last.records.len() {
        let mut turned = last.clone();
        let record = &mut turned.records[ix];
        if !record.is_lossy {
            continue;
        }
        // As if this cap erred by less than the budget, and its median were the least by luck.
        caps += 1;
        record.image.errors.insert("rel_mse".into(), Some(0.0005));
        record.image.differing_channels = Some(9);
        let exact = turned.records.iter().filter(|r| r.is_exact() && r.culls());
        let best = exact.min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
        let best = best.expect("an exact one").clone();
        let record = &mut turned.records[ix];
        (record.times.passes, record.times.rounds, record.times.frames) =
            (best.times.passes, best.times.rounds, best.times.frames);
        record.set_times();
        record.times.shade_ms -= 1e-6;
        let named = &verdict(&turned, 0.001).expect("a verdict").best;
        assert!(named.is_exact(), "{} is named", named.strategy);
    }
    assert!(caps > 0);
}
