//! Verdicts and sentences of stored studies.

use std::path::PathBuf;

use crate::lightbench;

/// The folder of stored results.
fn stored(name: &str) -> String {
    format!("{}/../results/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The page and the words of a report of stored results.
fn report(name: &str) -> (String, String) {
    report_of(&stored(name))
}

/// The same of a folder.
fn report_of(study: &str) -> (String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let output = lightbench(&["report", study, "--out", out]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("a page");
    // The terminal wraps its lines.
    let words = String::from_utf8_lossy(&output.stdout);
    (page, words.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn has_verdict(page: &str, claim: &str, verdict: &str) -> bool {
    page.contains(&format!("data-claim=\"{claim}\" data-verdict=\"{verdict}\""))
}

#[test]
fn stored_builds_of_a_low_clock_are_left_out() {
    let (page, words) = report("h200-cdi-builds");
    // Steady at a low clock; rising at once; rising at the end; with one late rise.
    for job in ["casts", "builds-size-256", "builds-size-128", "builds-oversampled"] {
        let notice = format!("town-{job}: times of its build are left out");
        assert!(words.contains(&notice), "{notice}: {words}");
    }
    assert_eq!(words.matches("times of its build are left out").count(), 4, "{words}");
    assert!(words.contains("town-casts: 2 of 5 times of rays are left out"), "{words}");
    // Nothing is said of brute force in one dispatch, which was not measured.
    assert!(has_verdict(&page, "one-pass", "differs"), "{words}");
    assert!(has_verdict(&page, "overhead", "holds"), "{words}");
    assert!(has_verdict(&page, "redundant", "fails"), "{words}");
    assert!(has_verdict(&page, "same-image", "unknown"), "{words}");
}

#[test]
fn stored_images_by_rays_are_nearer_or_tie() {
    let (page, words) = report("h200-cdi");
    for claim in ["fewer-lights", "quality"] {
        assert!(has_verdict(&page, claim, "differs"), "{claim}: {words}");
    }
    // The best spans in two scenes are the last that were tried.
    assert!(words.contains("The best value is the first or last one that was tried"), "{words}");
    assert!(words.contains("rays are nearer to the truth") && words.contains("a tie"), "{words}");
    assert!(!words.contains("too bright"), "{words}");
}

/// The stored study with lights as older programs had them.
#[test]
fn lights_without_fresnel_decide_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = PathBuf::from(stored("h200-cdi"));
    std::fs::copy(source.join("study.json"), folder.path().join("study.json")).expect("copies");
    for job in std::fs::read_dir(source.join("jobs")).expect("jobs") {
        let job = job.expect("a job");
        let results = std::fs::read_to_string(job.path().join("results.json")).expect("results");
        let old = results.replace("\"has_fresnel\":true", "\"has_fresnel\":false");
        let copy = folder.path().join("jobs").join(job.file_name());
        std::fs::create_dir_all(&copy).expect("a folder");
        std::fs::write(copy.join("results.json"), old).expect("writes");
    }
    let (page, words) = report_of(folder.path().to_str().expect("UTF-8"));
    assert!(words.contains("their lights are 4 to 7 % too bright"), "{words}");
    for claim in ["fewer-lights", "quality", "similar"] {
        assert!(has_verdict(&page, claim, "unknown"), "{claim}: {words}");
    }
    // Sentences refuse what the claims refuse.
    assert!(words.contains("In atrium, the mean error with ranges from rays"), "{words}");
    assert!(words.contains("these lights are 4 to 7 % too bright: measure again"), "{words}");
    assert!(!words.contains("rays are nearer") && !words.contains("a tie"), "{words}");
}
