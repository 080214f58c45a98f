//! Studies as a user runs them: interrupted, split, and put together again.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use harness::{
    results::{Record, Results},
    study::{Done, Manifest},
};

fn start(arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_lightbench"))
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts")
}

/// Runs the program to its end; returns what it printed.
fn run(arguments: &[&str]) -> String {
    let output = start(arguments).wait_with_output().expect("ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The arguments of a small study into a folder. The scene is the smallest there is: a software adapter
/// spends almost all of a frame on the triangles.
fn study<'a>(out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let out = out.to_str().expect("UTF-8");
    let scene = ["--scene", "town-small"];
    let small = ["study", "culling", "--quick", "--size", "32x18", "--out", out];
    [&small[..], &scene, more].concat()
}

/// What of a record does not depend on the clock.
fn timeless(record: &Record) -> Record {
    let nothing = harness::results::Passes::default();
    let names =
        record.times.passes.iter().map(|(name, times)| (name.to_owned(), times.samples.len()));
    let mut record =
        Record { note: Some(format!("{:?}", names.collect::<Vec<_>>())), ..record.clone() };
    record.times.light_build_ms = None;
    record.times.passes = nothing;
    record.set_times();
    (record.times.assign_ms, record.times.shade_ms, record.times.frame_ms) = (0.0, 0.0, 0.0);
    record
}

/// All records of a study by job, without their times.
fn records(folders: &[PathBuf]) -> BTreeMap<String, Vec<Record>> {
    let done = Done::read(folders).expect("a study");
    assert!(done.missing().is_empty(), "missing: {:?}", done.missing());
    let of = |results: &Results| results.records.iter().map(timeless).collect();
    done.results.iter().map(|(job, results)| (job.clone(), of(results))).collect()
}

fn results_in(out: &Path) -> usize {
    let jobs = std::fs::read_dir(out.join("jobs")).into_iter().flatten().flatten();
    jobs.filter(|job| job.path().join("results.json").is_file()).count()
}

#[test]
fn an_interrupted_study_and_two_shards_equal_one_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let whole = at("whole");
    let printed = run(&study(&whole, &[]));
    assert!(printed.contains("index.html"), "{printed}");
    assert!(!printed.contains("claims to lose nothing"), "{printed}");
    let expected = records(std::slice::from_ref(&whole));
    assert_eq!(expected.len(), 6);
    assert!(expected.values().all(|records| records.len() >= 5));

    // Killed once two jobs are done, in the midst of a third.
    let cut = at("cut");
    let child = start(&study(&cut, &[]));
    let began = Instant::now();
    while results_in(&cut) < 2 {
        assert!(began.elapsed() < Duration::from_secs(300), "no job ends");
        std::thread::sleep(Duration::from_millis(20));
    }
    // Another process that wants the folder is told who has it.
    let second = start(&study(&cut, &[])).wait_with_output().expect("ends");
    let stderr = String::from_utf8_lossy(&second.stderr);
    assert_eq!(second.status.code(), Some(2), "{stderr}");
    let pid = child.id().to_string();
    assert!(stderr.contains(&format!("process {pid} ")) && stderr.contains("--out"), "{stderr}");
    // Interrupted, it says how to go on, and lets go.
    let sent = Command::new("kill").args(["-INT", &pid]).status().expect("kill");
    assert!(sent.success());
    let ended = child.wait_with_output().expect("ends");
    let stderr = String::from_utf8_lossy(&ended.stderr);
    assert!(!ended.status.success(), "{stderr}");
    assert!(
        stderr.contains("interrupted: ") && stderr.contains("keeps the finished jobs"),
        "{stderr}"
    );
    assert!(!cut.join("lightbench.lock").exists());
    let before = results_in(&cut);
    assert!((2..6).contains(&before), "{before} jobs before it was interrupted");
    // What a killed run leaves half written goes.
    let half = cut.join("jobs/results.json.123.tmp");
    std::fs::write(&half, "{").expect("writes");
    run(&study(&cut, &[]));
    assert_eq!(records(std::slice::from_ref(&cut)), expected);
    assert!(!half.exists());

    // Damaged and incomplete results are no results: `report` says so, and the study runs them again.
    let jobs = Manifest::find(&cut).expect("reads").expect("is there").jobs;
    let files: Vec<PathBuf> =
        jobs.iter().map(|job| job.folder(&cut).join("results.json")).collect();
    let texts: Vec<String> =
        files.iter().map(|file| std::fs::read_to_string(file).expect("reads")).collect();
    std::fs::write(&files[0], &texts[0][..texts[0].len() / 2]).expect("writes");
    std::fs::write(&files[1], texts[1].replacen("\"seed\": 1", "\"seed\": 2", 1)).expect("writes");
    let mut short = Results::read(&files[2]).expect("results");
    short.records.pop();
    short.write(&files[2]).expect("writes");
    let left = Done::read(std::slice::from_ref(&cut)).expect("a study");
    assert_eq!(left.missing(), jobs[..3].iter().map(|job| job.name.as_str()).collect::<Vec<_>>());
    let output = start(&study(&cut, &[])).wait_with_output().expect("ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    for (job, why) in jobs.iter().zip(["cut short", "checksum", "is missing"]) {
        let warning = format!("warning  job {} runs again: ", job.name);
        let line = stderr.lines().find(|line| line.starts_with(&warning));
        assert!(line.is_some_and(|line| line.contains(why)), "{}: {stderr}", job.name);
    }
    assert_eq!(records(std::slice::from_ref(&cut)), expected);
    // What was sound is not written again, by the study or by its report.
    run(&["report", cut.to_str().expect("UTF-8")]);
    for (file, text) in files.iter().zip(&texts).skip(3) {
        assert_eq!(&std::fs::read_to_string(file).expect("reads"), text);
    }

    // Another study does not go into its folder, nor the same under another seed.
    let output = start(&study(&cut, &["--seed", "2"])).wait_with_output().expect("ends");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--out"), "{output:?}");

    let (one, two) = (at("one"), at("two"));
    run(&study(&one, &["--shard", "1/2"]));
    assert_eq!(results_in(&one), 3);
    run(&study(&two, &["--shard", "2/2"]));
    let merged = at("merged");
    let [a, b, out] = [&one, &two, &merged].map(|path| path.to_str().expect("UTF-8"));
    run(&["report", a, b, "--out", out]);
    assert!(merged.join("index.html").is_file());
    assert_eq!(records(&[one.clone(), two]), expected);
    // Half of it is half of it.
    assert_eq!(Done::read(std::slice::from_ref(&one)).expect("a study").missing().len(), 3);

    // Results of another machine or another command are no part of it.
    let job = Manifest::find(&one).expect("reads").expect("is there").jobs.swap_remove(0);
    let path = job.folder(&one).join("results.json");
    let sound = Results::read(&path).expect("results");
    let refused = |results: &Results| {
        results.write(&path).expect("writes");
        Done::read(std::slice::from_ref(&one)).expect_err("refused").to_string()
    };
    let mut other = sound.clone();
    other.machine.adapter = "another".into();
    assert!(refused(&other).contains("machine.adapter"));
    // One scene, one commit: its times stand side by side.
    let mut other = sound.clone();
    other.machine.commit = "another".into();
    assert!(refused(&other).contains("machine.commit"));
    let mut other = sound.clone();
    other.command.push("--spots".into());
    assert!(refused(&other).contains("--spots"));
    let mut other = sound.clone();
    other.records[0].setting.scene_hash = "0".into();
    assert!(refused(&other).contains("scene_hash"));
}

#[test]
fn a_damaged_study_is_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("study.json"), "{").expect("writes");
    let error = Manifest::find(folder.path()).expect_err("damaged").to_string();
    assert!(error.contains("study.json"), "{error}");
    let out = folder.path().to_str().expect("UTF-8");
    let output = start(&["report", out]).wait_with_output().expect("ends");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("study.json"));
    // A later version of the file is refused, not guessed at.
    let job = r#"{"name":"a","scene":"a","section":"b","command":[]}"#;
    let text = format!(r#"{{"version":99,"identity":[],"study":"culling","jobs":[{job}]}}"#);
    std::fs::write(folder.path().join("study.json"), text).expect("writes");
    let error = Manifest::find(folder.path()).expect_err("refused").to_string();
    assert!(error.contains("version is 99") && error.contains("1 to 2"), "{error}");
    assert!(error.contains("newer") && !error.contains("remove"), "{error}");
    for (name, value, accepted) in [
        ("version", "\"two\"", "1 to 2"),
        ("version", "0", "1 to 2"),
        ("identity", "7", "a list of texts"),
        ("study", "7", "the name of a study"),
        ("jobs", "[]", "at least one job"),
    ] {
        let mut file: serde_json::Value = serde_json::from_str(&format!(
            r#"{{"version":1,"identity":[],"study":"culling","jobs":[{job}]}}"#
        ))
        .expect("JSON");
        file[name] = serde_json::from_str(value).expect("JSON");
        std::fs::write(folder.path().join("study.json"), file.to_string()).expect("writes");
        let error = Manifest::find(folder.path()).expect_err("refused").to_string();
        let names_field = error
            .contains(&format!("study.json: not the list of a study's jobs: {name} is {value}"));
        assert!(names_field && error.contains(accepted), "{error}");
    }
    let text = format!(r#"{{"version":1,"identity":[],"study":"cullin","jobs":[{job}]}}"#);
    std::fs::write(folder.path().join("study.json"), text).expect("writes");
    let output = start(&["report", out]).wait_with_output().expect("ends");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.contains("study.json") && error.contains("culling, living, area"), "{error}");
    // Jobs of version 2 have settings, even if there are none: without them a view has no name.
    for (settings, is_whole) in [("", false), (r#","settings":{}"#, true)] {
        let job = format!(r#"{{"name":"a","scene":"a","section":"b","command":[]{settings}}}"#);
        let text = format!(r#"{{"version":2,"identity":[],"study":"culling","jobs":[{job}]}}"#);
        std::fs::write(folder.path().join("study.json"), text).expect("writes");
        let found = Manifest::find(folder.path()).map_err(|error| error.to_string());
        let names = |error: &String| error.contains("jobs[0].settings is missing");
        assert!(found.as_ref().map_or_else(names, |_| is_whole), "{found:?}");
    }
    // A job's name is the name of a folder that may be deleted.
    for name in ["../victim", "..", "", "/tmp/x", "a/b"] {
        let job = format!(r#"{{"name":"{name}","scene":"a","section":"b","command":[]}}"#);
        let text = format!(r#"{{"identity":[],"study":"culling","jobs":[{job}]}}"#);
        std::fs::write(folder.path().join("study.json"), text).expect("writes");
        let error = Manifest::find(folder.path()).expect_err("refused").to_string();
        assert!(error.contains("jobs[0].name"), "{error}");
    }
}

#[test]
fn metrics_are_computed_again_from_the_stored_images() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    run(&[
        "compare",
        "--size",
        "96x54",
        "--frames",
        "1",
        "--warmup",
        "0",
        "--lights",
        "400",
        "--radius-scale",
        "2",
        "--strategies",
        "None,SC-E/cap4",
        "--truth",
        "none",
        "--out",
        out,
    ]);
    let path = folder.path().join("results.json");
    let mut results = Results::read(&path).expect("results");
    let record = &results.records[1];
    assert!(record.is_lossy && !record.is_lossless());
    let errors = record.image.errors.clone();
    assert!(errors["rel_mse"] > Some(1e-4), "{errors:?}");
    assert!(errors["missing_energy"] > Some(0.0));
    // As if they had never been computed.
    results.records[1].image.errors.clear();
    results.write(&path).expect("writes");
    let raw = std::fs::read(&path).expect("reads");
    run(&["report", out]);
    assert_eq!(Results::read(&path).expect("results").records[1].image.errors, errors);
    // They lie beside the raw results, which no report writes, into whatever folder it goes.
    let other = folder.path().join("other");
    std::fs::create_dir(&other).expect("a folder");
    std::fs::write(other.join("results.json"), "raw").expect("writes");
    run(&["report", out, "--out", other.to_str().expect("UTF-8")]);
    assert_eq!(std::fs::read(&path).expect("reads"), raw);
    assert_eq!(std::fs::read(other.join("results.json")).expect("reads"), b"raw");
    assert!(other.join("index.html").is_file());
    // An image of another size is named.
    let small = shading::HdrImage { width: 2, height: 1, pixels: vec![[1.0; 3]; 2] };
    small.write_exr(&folder.path().join("deferred-None.exr")).expect("writes");
    let output = start(&["report", out]).wait_with_output().expect("ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("deferred-None.exr") && stderr.contains("2x1"), "{stderr}");
}
