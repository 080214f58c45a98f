//! Shadow maps as a user runs them: what records keep, and how far images are from the truth.

use std::{path::Path, process::Command};

use harness::results::{Record, Results, ShadowSetting};

fn run(arguments: &[&str]) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_lightbench")).args(arguments).output().expect("starts");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Three rectangles that shine into the court of the atrium.
const VIEW: [&str; 14] = [
    "--scene",
    "atrium",
    "--size",
    "48x27",
    "--lights",
    "3",
    "--areas",
    "1",
    "--outlines",
    "rectangles",
    "--radii",
    "equal",
    "--radius-scale",
    "14.4",
];

fn truth(out: &Path, more: &[&str]) -> Results {
    let out_text = out.to_str().expect("UTF-8");
    run(&[&["truth", "--shadows", "--out", out_text], &VIEW[..], more].concat());
    Results::read(&out.join("results.json")).expect("results")
}

/// The records of a comparison with a truth image.
fn compared(out: &Path, truth: &str, shadows: &str) -> (Vec<Record>, String) {
    let out_text = out.to_str().expect("UTF-8");
    let options = ["compare", "--strategies", "None,T-E,SC-E", "--mode", "both", "--frames", "1"];
    let checks = ["--warmup", "0", "--truth", "none", "--against", truth, "--shadows", shadows];
    let printed = run(&[&options[..], &VIEW[..], &checks[..], &["--out", out_text]].concat());
    (Results::read(&out.join("results.json")).expect("results").records, printed)
}

#[test]
fn records_keep_the_model_and_maps_come_close_to_the_truth() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let exact = truth(&folder.join("truth"), &["--samples", "256"]);
    let path = folder.join("truth").join("truth.exr");
    let path = path.to_str().expect("UTF-8");
    let separated = truth(&folder.join("separated"), &["--separated", "--against", path]);
    let [exact, separated] = [exact, separated].map(|file| file.truth_image.expect("an image"));
    assert!(!exact.is_separated && separated.is_separated && separated.shadows);
    assert!(exact.against_errors.is_empty());
    let separation = separated.against_errors["rel_mse"].expect("finite");

    let (plain, _) = compared(&folder.join("plain"), path, "none");
    let (shadowed, printed) = compared(&folder.join("shadowed"), path, "maps:9,128");
    let line = format!("against  {path}: None in deferred: flip ");
    assert!(printed.contains(&line), "{printed}");
    let expected = ShadowSetting {
        model: "maps:9,128".into(),
        maps_per_area_light: 9,
        maps: 27,
        faces: 27 * 5,
        atlas_px: [9 * 128, 9 * 128],
        occluder_bytes: None,
        draw_ms: None,
        adaptive: None,
        deep: None,
    };
    assert_eq!((plain.len(), shadowed.len()), (6, 6));
    for (plain, shadowed) in plain.iter().zip(&shadowed) {
        assert_eq!(plain.setting.shadows, None);
        let found = shadowed.setting.shadows.clone().expect("shadows");
        assert!(found.draw_ms.is_some_and(|ms| ms > 0.0), "{found:?}");
        assert_eq!(ShadowSetting { draw_ms: None, ..found }, expected);
        // No strategy shows other shadows than no culling.
        let mode = shadowed.setting.mode;
        assert_eq!(shadowed.image.differing_channels, Some(0), "{} {mode:?}", shadowed.strategy);
    }
    let error = |records: &[Record]| records[0].image.truth_errors["rel_mse"].expect("finite");
    let (without, with) = (error(&plain), error(&shadowed));
    println!("relMSE without shadows {without}, with maps {with}, separation {separation}");
    assert!(with < 0.2 * without, "{with} with maps, {without} without");
    assert!(separation < with, "{separation} with exact shares, {with} with maps");
}

#[test]
fn adaptive_maps_settle_before_methods_are_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let options = ["compare", "--strategies", "None,T-E,SC-E", "--mode", "both", "--frames", "1"];
    let checks = ["--warmup", "0", "--truth", "none", "--shadows", "adaptive:64,2,20"];
    run(&[&options[..], &VIEW[..], &checks[..], &["--out", out]].concat());
    let records = Results::read(&folder.path().join("results.json")).expect("results").records;
    assert_eq!(records.len(), 6);
    let first = records[0].setting.shadows.clone().expect("shadows");
    for record in &records {
        assert_eq!(record.image.differing_channels, Some(0), "{}", record.strategy);
        assert_eq!(record.setting.shadows.as_ref(), Some(&first));
    }
    let found = first.adaptive.expect("subdivided");
    assert_eq!((first.maps_per_area_light, found.maps_of_rectangles.len()), (20, 3));
    assert!(found.maps_of_rectangles.iter().all(|maps| (4..=20).contains(maps)), "{found:?}");
    assert!(found.maps_of_rectangles.iter().any(|maps| *maps > 4), "{found:?}");
    assert_eq!(found.maps_of_rectangles.iter().sum::<u32>(), first.maps);
    assert_eq!(first.faces, 5 * first.maps);
    assert!(found.frames > 0 && found.banding_ms > Some(0.0) && first.draw_ms > Some(0.0));
}

#[test]
fn rays_keep_their_images_and_all_strategies_show_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let options = ["compare", "--strategies", "None,SC-E", "--frames", "1", "--warmup", "0"];
    let images = ["--shadows", "cdi:4", "--directions", "2x4", "--deep-size", "32"];
    let checks = ["--truth", "none", "--out", out];
    run(&[&options[..], &VIEW[..], &images[..], &checks[..]].concat());
    let records = Results::read(&folder.path().join("results.json")).expect("results").records;
    assert_eq!(records.len(), 2);
    for record in &records {
        let found = record.setting.shadows.clone().expect("shadows");
        let deep = found.deep.as_ref().expect("deep images");
        assert_eq!((&found.model[..], found.maps_per_area_light, found.maps), ("cdi:4", 4, 12));
        assert_eq!((found.faces, found.atlas_px), (0, [0, 0]));
        assert_eq!((deep.directions(), deep.size_px), (8, 32));
        assert_eq!((&deep.build[..], &deep.spread[..]), ("per-direction-batched", "squares"));
        assert!(deep.fragments > 1000 && deep.bytes > 4 * deep.fragments, "{deep:?}");
        assert!(found.draw_ms > Some(0.0));
        assert_eq!(record.image.differing_channels, Some(0), "{}", record.strategy);
    }
}

#[test]
fn options_that_rays_do_not_take_are_refused() {
    for (line, expected) in [
        ("--shadows cdi:5", "it must be none, maps:N,PX"),
        ("--shadows cdi:4 --strategies SC-E/occ", "combined with --shadows maps:N,PX"),
        ("--shadows cdi:4 --build linked-lists", "--build is linked-lists: it must be another"),
        ("--shadows cdi:4 --oversampling 2", "1 for --build per-direction-batched"),
        ("--shadows cdi:4 --light-order gpu", "none with --light-order gpu"),
        ("--shadows cdi:4 --motion drift", "none with --motion"),
        ("--shadows cdi:4 --vpls 16", "none with --vpls"),
        ("--shadows cdi:4 --fog 0.1", "none with --transparent, --particles and --fog"),
        (
            "--shadows maps:4,64 --deep-size 64",
            "--deep-size has no effect here: it needs --shadows",
        ),
    ] {
        let words = ["compare"].into_iter().chain(line.split_whitespace());
        let output = Command::new(env!("CARGO_BIN_EXE_lightbench")).args(words).output();
        let output = output.expect("starts");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(expected), "{line}: {error}");
    }
}

/// Maps that follow lights: all methods show the same image in all frames, and the maps are on the bill of each frame.
#[test]
fn maps_follow_lights_that_move_on_the_clock() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let options = ["compare", "--strategies", "None,T-E,SC-E/occ", "--frames", "3"];
    let stage = ["--scene", "atrium", "--size", "48x27", "--lights", "12", "--areas", "0.3"];
    let moves = ["--spots", "0.3", "--radius-scale", "8", "--motion", "all", "--speed", "20"];
    let order = ["--light-order", "given", "--warmup", "0", "--truth", "full", "--checks", "3"];
    let drawn = ["--shadows", "maps:4,64", "--out", out];
    run(&[&options[..], &stage, &moves, &order, &drawn].concat());
    let records = Results::read(&folder.path().join("results.json")).expect("results").records;
    assert_eq!(records.len(), 3);
    for record in &records {
        let id = &record.strategy;
        assert_eq!(record.image.differing_channels, Some(0), "{id}");
        assert_eq!(record.lists.missed_pairs.unwrap_or_default(), 0, "{id}");
        let ms_of = |pass: &str| record.time_of(|name, _| name == pass);
        assert!(ms_of("shadow-maps") > 0.0 && ms_of("shadow-plan") > 0.0, "{id}");
        assert_eq!(ms_of("occluders") > 0.0, id.as_str().ends_with("/occ"), "{id}");
    }
}

/// Strategies of all families that have the segment show the image of no culling with shorter lists, in the atrium with lights
/// of all kinds.
#[test]
fn lists_without_hidden_lights_are_shorter_and_images_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let plain = ["SC-E/12x12x24/bvh", "T-I/16x16"];
    let tiles = ["T-E/16x16/occ", "ModifiedHalfZ/16x16/mask/occ", "T-25D/16x16/occ"];
    let cells = ["DC-I/12x12x24/occ", "DA-E/12x12x24/tree/occ", "G/16x16x16/occ", "HC/16/occ"];
    let more = ["SC-E/12x12x24/bvh/occ", "SC-E/12x12x24/n6/occ", "M/1/occ"];
    let ids = [&plain[..], &tiles, &cells, &more].concat().join(",");
    let options =
        ["compare", "--size", "96x54", "--lights", "60", "--spots", "0.2", "--areas", "0.2"];
    let shown = ["--radius-scale", "6", "--frames", "1", "--warmup", "0", "--truth", "full"];
    let drawn = ["--shadows", "maps:4,64", "--strategies", &ids, "--out", out];
    run(&[&options[..], &shown, &drawn].concat());
    let results = Results::read(&folder.path().join("results.json")).expect("results");
    let entries_of = |id: &str| {
        let record = results.records.iter().find(|record| record.strategy == *id);
        record.expect("measured").lists.entries
    };
    assert!(entries_of("SC-E/12x12x24/bvh/occ") < entries_of("SC-E/12x12x24/bvh"));
    for record in &results.records {
        let id = &record.strategy;
        assert!(record.setting.shadows.as_ref().is_some_and(|s| s.occluder_bytes > Some(0)));
        assert_eq!(record.image.differing_channels, Some(0), "{id}");
        assert_eq!(record.lists.missed_pairs, Some(0), "{id}");
        println!("{id}: {} entries, {:?}", record.lists.entries, record.lists.hidden);
        if id.as_str().ends_with("/occ") {
            assert!(record.lists.hidden.is_some_and(|h| h.removed_pairs > 100), "{id}");
        } else {
            assert_eq!(record.lists.hidden, None, "{id}");
        }
    }
}

#[test]
fn lists_without_hidden_lights_need_maps() {
    let output = |arguments: &[&str]| {
        let program = Command::new(env!("CARGO_BIN_EXE_lightbench")).args(arguments).output();
        String::from_utf8_lossy(&program.expect("starts").stderr).into_owned()
    };
    let error = output(&["compare", "--strategies", "SC-E/48x48x40/occ"]);
    let expected =
        "--strategies is SC-E/48x48x40/occ: it must be combined with --shadows maps:N,PX";
    assert!(error.contains(expected), "{error}");
    let error =
        output(&["explain", "--pixel", "1,1", "--strategies", "T-E/occ", "--shadows", "maps:1,64"]);
    assert!(error.contains("without /occ: explain shows"), "{error}");
    let error = output(&["compare", "--strategies", "SC-E/occ/keep4", "--shadows", "maps:1,64"]);
    assert!(error.contains("\"occ\" and \"keep4\" contradict each other"), "{error}");
    let error = output(&["compare", "--strategies", "W/occ", "--shadows", "maps:1,64"]);
    assert!(error.contains("\"occ\" is unknown: W takes"), "{error}");
}
