//! Truth images and the studies that need them, as a user runs them.

use std::{
    path::Path,
    process::{Command, Output},
};

use harness::{
    image_errors::{ImagePair, errors, stored},
    results::{Errors, Results, TruthImage},
    study::Manifest,
};
use shading::HdrImage;

fn lightbench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lightbench")).args(arguments).output().expect("starts")
}

fn run(arguments: &[&str]) -> String {
    let output = lightbench(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Renders a small truth image; returns what its results say, and the image.
fn truth(out: &Path, more: &[&str]) -> (TruthImage, HdrImage) {
    let text = out.to_str().expect("UTF-8");
    let small =
        ["truth", "--lights", "30", "--radius-scale", "8", "--size", "32x18", "--out", text];
    let printed = run(&[&small[..], more].concat());
    assert!(printed.starts_with("truth    atrium, 30 lights, 32x18"), "{printed}");
    let truth = Results::read(&out.join("results.json")).expect("results").truth_image;
    let truth = truth.expect("a truth image");
    for name in [&truth.image, &truth.error_image] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let errors = truth.raw_error.as_ref().expect("an image of errors");
    let errors = HdrImage::read_exr(&out.join(errors)).expect("an image");
    let is_exact = errors.pixels.iter().flatten().all(|error| *error == 0.0);
    assert_eq!(is_exact, truth.standard_error == 0.0, "{}", truth.standard_error);
    let image = HdrImage::read_exr(&out.join(&truth.raw)).expect("an image");
    (truth, image)
}

#[test]
fn points_are_as_shading_has_them_and_shadows_take_light_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let (exact, image) = truth(&folder.path().join("plain"), &[]);
    assert_eq!((exact.standard_error, exact.shadows, exact.bounces), (0.0, false, 0));
    // What no culling shows of the same view: models of area lights apart, shading is right.
    let compared = folder.path().join("compared");
    let out = compared.to_str().expect("UTF-8");
    let view = ["compare", "--lights", "30", "--radius-scale", "8", "--size", "32x18"];
    let timed = ["--strategies", "None", "--frames", "1", "--warmup", "0", "--truth", "none"];
    run(&[&view[..], &timed, &["--out", out]].concat());
    let shaded = HdrImage::read_exr(&compared.join("deferred-None.exr")).expect("an image");
    let pair = ImagePair { image: &shaded, reference: &image, exposure: 1.0 };
    let shading: Errors = stored(errors(&pair));
    let error = |errors: &Errors, id: &str| errors[id].expect("finite");
    assert!(error(&shading, "log_error") < 0.03, "{shading:?}");
    // Shading reads the G-buffer: its rounding is about all that the image is off.
    let rounding = &exact.gbuffer_errors;
    let share = error(rounding, "log_error") / error(&shading, "log_error");
    assert!((0.5..1.5).contains(&share), "{rounding:?} of {shading:?}");

    let sum = |image: &HdrImage| image.pixels.iter().flatten().map(|v| f64::from(*v)).sum::<f64>();
    let (_, dark) = truth(&folder.path().join("shadows"), &["--shadows"]);
    assert!(sum(&dark) < 0.99 * sum(&image), "{} of {}", sum(&dark), sum(&image));
    let bounce = ["--shadows", "--bounces", "1", "--samples", "4"];
    let (noisy, lit) = truth(&folder.path().join("bounce"), &bounce);
    assert!(sum(&lit) > 1.01 * sum(&dark), "{} of {}", sum(&lit), sum(&dark));
    assert!(noisy.standard_error > 0.0 && noisy.bounces == 1);
    assert!(noisy.gbuffer_errors.is_empty(), "shading has no shadows to compare");
    // Two bounces are brighter, and other samples give other noise.
    let bounces = ["--shadows", "--bounces", "2", "--samples", "4", "--sample-seed", "9"];
    let (other, brighter) = truth(&folder.path().join("bounces"), &bounces);
    assert!(sum(&brighter) > sum(&lit) && other.sample_seed == Some(9));
}

#[test]
fn options_that_give_no_truth_image_are_refused() {
    let refused = |arguments: &[&str], wanted: &str| {
        let output = lightbench(&[&["truth"], arguments].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(wanted) && stderr.lines().count() == 1, "{stderr}");
    };
    refused(&["--bounces", "1"], "--bounces is 1: it must be 0 without --shadows");
    refused(
        &["--bounces", "17", "--shadows"],
        "--bounces is 17: it must be a whole number from 0 to 16",
    );
    refused(
        &["--bounces", "1", "--shadows", "--matte-bounces"],
        "--matte-bounces has no effect here: it needs --primary and --bounces 1",
    );
    refused(&["--samples", "0"], "--samples is 0: it must be a whole number from 1 to 65,536");
    refused(&["--strategies", "None"], "--strategies");
}

#[test]
fn a_note_says_that_emitted_light_is_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("lamp.gltf");
    // A triangle that emits.
    let data = "AACAvwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAwD8AAAAA";
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}}],
        "materials": [{{"emissiveFactor": [1, 1, 1], "doubleSided": true}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [-1, 0, 0], "max": [1, 1.5, 0]}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,{data}"}}]}}"#
    );
    std::fs::write(&file, text).expect("writes");
    let file = file.to_str().expect("UTF-8");
    let out = folder.path().join("out");
    let out = out.to_str().expect("UTF-8");
    let lamp = ["truth", "--scene", file, "--lights", "0", "--size", "8x8", "--out", out];
    let printed = |more: &[&str]| run(&[&lamp[..], more].concat());
    let note = "surfaces that emit light no others";
    assert!(printed(&[]).contains(note));
    assert!(!printed(&["--shadows", "--bounces", "1", "--samples", "1"]).contains(note));
}

/// The folders of a study's jobs that are done, by the names of the jobs.
fn done(out: &Path) -> Vec<String> {
    let jobs = Manifest::find(out).expect("reads").expect("is there").jobs;
    let is_done = |name: &String| out.join("jobs").join(name).join("results.json").is_file();
    jobs.into_iter().map(|job| job.name).filter(is_done).collect()
}

#[test]
fn a_study_runs_truths_and_comparisons_and_computes_their_errors_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    // The truth, one model and a few costs.
    let study = ["study", "area", "--quick", "--size", "32x18", "--shard", "1/6", "--out", out];
    run(&study);
    let names = done(folder.path());
    assert_eq!(names.first().map(String::as_str), Some("atrium-truth"));
    let model = names.iter().find(|name| name.starts_with("atrium-models-")).expect("a model");
    let path = folder.path().join("jobs").join(model).join("results.json");
    let read = || Results::read(&path).expect("results");
    let errors = read().records[0].image.truth_errors.clone();
    assert!(errors["flip"] > Some(0.0) && errors["bias"].is_some(), "{errors:?}");
    assert!(names.iter().any(|name| name.starts_with("atrium-cost-")), "{names:?}");
    // Once more, from what is stored.
    let mut results = read();
    results.records[0].image.truth_errors.clear();
    results.write(&path).expect("writes");
    run(&["report", out]);
    assert_eq!(read().records[0].image.truth_errors, errors);
    // Nothing is rendered again where all is done.
    let image = folder.path().join("jobs/atrium-truth/truth.exr");
    let written = || std::fs::metadata(&image).and_then(|data| data.modified()).expect("a file");
    let before = written();
    run(&study);
    assert_eq!(written(), before);
}

#[test]
fn cones_are_counted_from_every_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let study = ["study", "endless", "--quick", "--size", "32x18", "--shard", "1/6", "--out", out];
    let printed = run(&study);
    assert!(printed.contains("1 of 6 jobs are done"), "{printed}");
    let jobs = Manifest::find(folder.path()).expect("reads").expect("is there").jobs;
    let names: Vec<&str> = jobs.iter().map(|job| job.name.as_str()).collect();
    let expected = ["a-126", "b-126", "a-1134", "b-1134", "c-1134", "influence-1134"]
        .map(|job| format!("atrium-{job}"));
    assert_eq!(names, expected);
    let path = folder.path().join("jobs/atrium-a-126/results.json");
    for record in Results::read(&path).expect("results").records {
        let counted = record.lists.operations.expect("counted");
        let is_diffuse_only = record.strategy.as_str().contains("/dif");
        let is_order_kept = counted.specular >= counted.diffuse || record.is_lossy;
        assert!(is_order_kept && counted.diffuse > 0, "{counted:?}");
        assert!(!is_diffuse_only || counted.specular == counted.diffuse, "{counted:?}");
        let evaluated = counted.evaluated.expect("counted");
        let exits = !record.strategy.as_str().contains("no-exit");
        assert_eq!(
            exits,
            evaluated.specular < counted.specular,
            "{}: {counted:?}",
            record.strategy
        );
        let seen = counted.perceptible_listed.expect("counted");
        assert!(record.is_lossy || seen == counted.perceptible, "{}: {counted:?}", record.strategy);
        assert_eq!(record.setting.lights, 126);
        assert!(record.is_lossy || record.is_lossless(), "{}", record.strategy);
    }
}
