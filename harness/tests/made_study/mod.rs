//! What tests of study pages share: an empty study, its jobs, its report, and the verdicts on it.
#![allow(dead_code, reason = "each test uses its share")]

use std::collections::BTreeMap;
use std::path::Path;

use harness::results::Results;
use harness::study::{Done, Job, Manifest, Settings, write_study};

/// A study without jobs.
pub(crate) fn study(name: &str) -> Done {
    let identity = ["lightbench", "study", name].map(str::to_owned).to_vec();
    let manifest = Manifest::new(identity, name, Vec::new());
    Done { manifest, results: BTreeMap::new(), folders: BTreeMap::new() }
}

/// Adds a job of the atrium that is done; returns its name.
pub(crate) fn add(done: &mut Done, section: &str, variant: &str, results: Results) -> String {
    add_with(done, section, variant, Settings::default(), results)
}

/// The same with settings.
pub(crate) fn add_with(
    done: &mut Done,
    section: &str,
    variant: &str,
    settings: Settings,
    results: Results,
) -> String {
    let name = format!("atrium-{section}-{variant}");
    done.manifest.jobs.push(Job {
        name: name.clone(),
        scene: "atrium".into(),
        section: section.into(),
        settings,
        command: vec!["lightbench".into(), "compare".into()],
    });
    done.results.insert(name.clone(), results);
    name
}

/// Says in which folder the images of a job lie.
pub(crate) fn place(done: &mut Done, job: String, folder: &Path) {
    done.folders.insert(job, folder.to_owned());
}

/// A report: what was printed on one line, the page, and the names of the files of charts.
pub(crate) struct Written {
    pub(crate) text: String,
    pub(crate) page: String,
    pub(crate) charts: Vec<String>,
}

/// Writes the report of a study; every chart is an SVG, and the data is JSON.
pub(crate) fn write(done: &Done) -> Written {
    let out = tempfile::tempdir().expect("a temporary folder");
    let text = write_study(done, out.path()).expect("writes");
    let read = |path: &Path| std::fs::read_to_string(path).expect("reads");
    let page = read(&out.path().join("index.html"));
    let data = read(&out.path().join("study-data.json"));
    serde_json::from_str::<serde_json::Value>(&data).expect("the data is JSON");
    let files = std::fs::read_dir(out.path().join("charts")).into_iter().flatten().flatten();
    let name = |file: std::fs::DirEntry| {
        assert!(read(&file.path()).contains("<svg"), "{:?} is no SVG", file.path());
        file.file_name().to_string_lossy().into_owned()
    };
    let charts = files.map(name).collect();
    Written { text: text.split_whitespace().collect::<Vec<_>>().join(" "), page, charts }
}

/// The verdict on a claim, by its id: `holds`, `fails`, `differs` or `unknown`.
pub(crate) fn verdict<'a>(page: &'a str, claim: &str) -> &'a str {
    let start = format!("data-claim=\"{claim}\" data-verdict=\"");
    let found = page.split_once(&start).unwrap_or_else(|| panic!("the page lacks {claim}"));
    found.1.split('"').next().expect("the attribute ends")
}
