//! Indirect light as a user asks for it: deep images, virtual point lights, and their study.

use std::{
    path::Path,
    process::{Command, Output},
};

use harness::{
    results::{DeepImageRun, Record, Results},
    study::Done,
};
use shading::{HdrImage, luminance};

fn lightbench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lightbench")).args(arguments).output().expect("starts")
}

/// Runs it into `out`; returns what it printed, and its results.
fn run(out: &Path, arguments: &[&str]) -> (String, Results) {
    let output = lightbench(&[arguments, &["--out", out.to_str().expect("UTF-8")]].concat());
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    let results = Results::read(&out.join("results.json")).expect("results");
    (String::from_utf8_lossy(&output.stdout).into_owned(), results)
}

/// Deep images of the small town.
fn deep(out: &Path, more: &[&str]) -> (String, DeepImageRun) {
    let small = ["cdi", "--scene", "town-small", "--directions", "4x4", "--deep-size", "32"];
    let (printed, results) = run(out, &[&small[..], &["--frames", "1"], more].concat());
    (printed, results.deep_images.expect("deep images"))
}

#[test]
fn deep_images_are_built_cast_through_and_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let (printed, all) = deep(folder.path(), &["--casts", "32", "--compared", "3000"]);
    for words in ["16 directions of 32x32 pixels", "cdi-sort", "casts    ", "corrected rays"] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let names: Vec<&str> = all.passes.iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["cdi-samples", "cdi-count", "cdi-scan", "cdi-fill", "cdi-sort"]);
    assert!(all.deep.fragments == 16 * all.deep.samples && all.deep.samples > 500, "{all:?}");
    let [whole, middle] = &all.casts[..] else { panic!("two maps: {:?}", all.casts) };
    // About every texel of a map of the middle shows a surface.
    assert!(middle.is_middle && (900..=1024).contains(&middle.lights), "{middle:?}");
    assert!(!whole.is_middle && (100..middle.lights).contains(&whole.lights), "{whole:?}");
    let errors = all.range_errors.expect("errors");
    let compared: u64 = errors.histogram.iter().sum();
    assert_eq!(errors.rays, errors.agree + errors.lost + errors.invented, "{errors:?}");
    assert!(compared <= errors.agree && compared > errors.rays / 4, "{errors:?}");
    assert!(errors.median() < 1.5, "{errors:?}");
    let corrected = all.corrected_errors.expect("errors");
    assert!(corrected.median() < errors.median(), "{corrected:?}");

    // Visiting the triangles for each direction finds what each direction sees, and nothing twice.
    let each = ["--build", "per-direction", "--casts", "none", "--compared", "0"];
    let (_, each) = deep(folder.path(), &each);
    let share = each.deep.fragments as f64 / all.deep.fragments as f64;
    assert!((0.3..1.0).contains(&share), "{share}");
    assert!(each.range_errors.is_none() && each.casts.is_empty());
}

#[test]
fn every_strategy_shows_the_same_indirect_light() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = ["compare", "--scene", "town-small", "--size", "96x54", "--vpls", "24"];
    let all = ["--strategies", "None,T-I,T-E,DC-I,DC-E,SC-I,SC-E,SC-E/48x48x40/n6,G,M/4,HG"];
    let timed = ["--source", "both", "--mode", "both", "--frames", "1", "--warmup", "0"];
    let (_, results) = run(folder.path(), &[&drawn[..], &all, &timed].concat());
    assert!(results.records.len() >= 36, "{}", results.records.len());
    for record in &results.records {
        let what = format!("{} {}", record.strategy, record.mode.name());
        assert_eq!(record.missed_pairs, Some(0), "{what}");
        assert_eq!(record.differing_channels, Some(0), "{what}");
        let vpls = record.vpls.as_ref().expect("virtual point lights");
        assert_eq!(
            (vpls.kept, record.light_kinds.get("vpl").copied()),
            (record.lights, Some(record.lights))
        );
        assert_eq!(vpls.candidates, vpls.kept + vpls.too_small + vpls.too_large, "{what}");
        assert!(vpls.kept > 100 && vpls.mean_range_m > 1.0, "{vpls:?}");
    }
}

/// The mean luminance of a linear image.
fn mean(image: &HdrImage) -> f64 {
    image.pixels.iter().map(luminance).sum::<f64>() / image.pixels.len() as f64
}

#[test]
fn indirect_light_is_as_bright_as_one_bounce() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = ["--scene", "atrium", "--size", "64x36"];
    let truth = folder.path().join("truth");
    let bounced = ["--primary", "--shadows", "--bounces", "1", "--indirect", "--samples", "256"];
    let (printed, results) = run(&truth, &[&["truth"], &drawn[..], &bounced].concat());
    assert!(printed.contains("indirect light alone"), "{printed}");
    let raw = results.truth_image.expect("a truth image").raw;
    let truth = mean(&HdrImage::read_exr(&truth.join(raw)).expect("an image"));
    let lit = |name: &str, rule: &[&str]| -> f64 {
        let out = folder.path().join(name);
        let timed = ["--strategies", "HG", "--truth", "none", "--frames", "1", "--warmup", "0"];
        let words = [&["compare"], &drawn[..], &["--vpls", "64"], &timed, rule].concat();
        let (_, results) = run(&out, &words);
        let record: &Record = results.records.last().expect("a record");
        let raw = record.images.raw.as_ref().expect("a linear image");
        mean(&HdrImage::read_exr(&out.join(raw)).expect("an image")) / truth
    };
    let cast = lit("cast", &["--ranges", "average"]);
    let infinite = lit("infinite", &["--ranges", "infinite"]);
    let short = lit("short", &["--ranges", "random", "--random-ranges", "0,2"]);
    assert!((0.7..1.4).contains(&cast), "{cast}");
    let compensated = lit("compensated", &["--ranges", "average", "--compensate", "10"]);
    assert!((compensated - cast).abs() > 0.05, "{compensated}, {cast}");
    // Light without a range leaks; light of short range lacks.
    assert!(infinite > 1.1 * cast && short < 0.7 * cast, "{infinite}, {cast}, {short}");
}

#[test]
fn what_does_not_go_together_is_refused() {
    for (line, wanted) in [
        ("--vpls 64 --primary", "--primary"),
        ("--vpls 64 --lights 10", "--lights"),
        ("--primary --spots 0.5", "--spots"),
        ("--vpls 8", "--vpls is 8: it must be 0, or a whole number from 16 to 2,048"),
        ("--vpls 64 --ranges nearest", "--ranges is nearest: it must be one of average"),
        ("--vpls 64 --random-ranges 5,1", "--random-ranges is 5,1: it must be LOW,HIGH in metres"),
        ("--vpls 64 --directions 0x4", "--directions is 0x4: it must be STACKSxSLICES"),
        ("--ranges random", "--vpls"),
        ("--vpls 64 --ranges infinite --keep-ranges 1,2", "--keep-ranges: it must be given with"),
        ("--vpls 64 --random-ranges 1,2", "--random-ranges: it must be given with --ranges random"),
        ("--vpls 64 --ranges random --correct-rays", "--correct-rays: it must be given with"),
        ("cdi --build per-direction --oversampling 2", "--oversampling is 2: it must be 1 where"),
        ("truth --primary --indirect", "--indirect: it must be given with --bounces 1"),
        ("cdi --casts 12", "--casts is 12: it must be none, or sizes from 16 to 2,048"),
        ("cdi --directions 64x64", "stacks x slices is 64 x 64: it must be 1 to 1024 together"),
    ] {
        let output = lightbench(&line.split_whitespace().collect::<Vec<_>>());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "{line}");
        assert!(stderr.contains(wanted), "{line}: {stderr}");
    }
}

#[test]
fn a_quick_study_has_all_parts() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let words =
        ["study", "cdi", "--quick", "--scene", "town-small", "--size", "32x18", "--out", out];
    let output = lightbench(&words);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let printed = String::from_utf8_lossy(&output.stdout);
    for words in
        ["one pass over the triangles builds", "median error of a ray", "million rays take"]
    {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    assert!(!printed.contains("it states no loss"), "{printed}");
    let done = Done::read(&[folder.path().to_owned()]).expect("a study");
    assert!(done.missing().is_empty(), "{:?}", done.missing());
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("a page");
    for part in ["indirect", "pictures", "steps", "builds", "casts", "ranges", "vpl-strategies"] {
        assert!(page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    assert!(!page.contains("NaN") && !page.contains("not finite"));
}
