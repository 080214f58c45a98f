//! Runs the program as a user does, on the adapter of this machine.

use std::{
    path::Path,
    process::{Command, Output},
};

use harness::{
    advise::verdict,
    report::is_surely_faster,
    results::{Record, Results},
};

/// The scene with the fewest triangles: a software adapter spends most of a frame on triangles. The default
/// scene has seven times as many, so only two tests draw it.
const SMALL: &str = "town-small";

fn lightbench(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_lightbench"));
    // A server lacks this variable, and the Vulkan loader would print a warning.
    program.env_remove("XDG_RUNTIME_DIR").args(arguments).output().expect("starts")
}

/// Runs `compare` at a small size into `out`; returns what it wrote.
fn compare(out: &Path, arguments: &[&str]) -> Results {
    let one: &[&str] = if arguments.contains(&"--frames") { &[] } else { &["--frames", "1"] };
    let small = ["compare", "--size", "160x90", "--warmup", "0", "--out"];
    let all = [&small[..], &[out.to_str().expect("UTF-8")], one, arguments].concat();
    let output = lightbench(&all);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Results::read(&out.join("results.json")).expect("results.json")
}

fn assert_lossless(results: &Results, records: usize) {
    assert_eq!(results.records.len(), records);
    for record in &results.records {
        let what =
            format!("{} {} {}", record.setting.scene, record.strategy, record.setting.mode.name());
        assert_eq!(record.lists.missed_pairs, Some(0), "{what}");
        assert_eq!(record.image.max_abs_diff, Some(0.0), "{what}");
        assert_eq!(record.image.differing_channels, Some(0), "{what}");
        assert!(record.lists.samples > 1_000, "{what}: {} samples", record.lists.samples);
        assert!(record.lists.listed_per_sample >= record.lists.contributing_per_sample, "{what}");
        assert!(record.times.passes.get("shade").is_some(), "{what}");
    }
}

#[test]
fn bad_input_leaves_an_earlier_report_untouched() {
    let folder = tempfile::tempdir().expect("a folder");
    let one = ["--scene", SMALL, "--lights", "1", "--strategies", "None", "--truth", "none"];
    compare(folder.path(), &one);
    let out = folder.path().to_str().expect("UTF-8");
    for (option, value, wanted) in [
        ("--scene", "gone.gltf", "gone.gltf"),
        ("--strategies", "M/-1", "--strategies M/-1: "),
        ("--strategies", "T-I/hs+foo", "--strategies T-I/hs+foo: "),
    ] {
        assert_refused(&[option, value, "--out", out], &[wanted]);
        for name in ["index.html", "results.json"] {
            assert!(folder.path().join(name).is_file(), "{option} {value} removed {name}");
        }
    }
}

/// The heat map of the default run's last strategy.
const HEAT_MAP: &str = "forward-SC-E-48x48x40-bvh-heat.png";

#[test]
fn the_default_scene_is_lossless_in_both_modes() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("new/run");
    let results = compare(&out, &["--lights", "300", "--spots", "0.3", "--mode", "both"]);
    assert_lossless(&results, 8);
    let culled = &results.records[2];
    assert!(culled.lists.checked_pairs > Some(1_000), "{:?} pairs", culled.lists.checked_pairs);
    assert!(
        culled.lists.listed_per_sample < Some(150.0),
        "{:?} listed",
        culled.lists.listed_per_sample
    );
    assert_eq!(culled.setting.light_kinds.values().sum::<u64>(), 300);
    assert!(culled.setting.light_kinds["spot"] > 50);
    assert!(culled.times.passes.get("cull").is_some());
    let sparse = &results.records[3];
    assert!(sparse.times.passes.get("bounds").is_some());
    assert!(sparse.lists.lengths_read.iter().sum::<u64>() > 20, "{:?}", sparse.lists.lengths_read);
    assert!(sparse.lists.listed_per_sample < culled.lists.listed_per_sample);
    for name in ["index.html", "deferred-None.png", "forward-None.exr", HEAT_MAP] {
        assert!(out.join(name).is_file(), "{name}");
    }
}

#[test]
fn all_methods_are_lossless_or_within_their_tolerance() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["--strategies", "all,M/2", "--source", "both", "--mode", "both"];
    let lights = ["--scene", SMALL, "--lights", "200", "--spots", "0.3"];
    let results = compare(folder.path(), &[&arguments[..], &lights].concat());
    assert!(results.records.len() > 40, "{} records", results.records.len());
    for record in results.records.iter().filter(|record| record.strategy != "Clay") {
        let what = format!("{} {}", record.strategy, record.setting.mode.name());
        assert!(record.is_lossless(), "{what}: {:?}", record.image.max_rel_diff);
        let is_raster = record.strategy == "RasterSphere";
        assert_eq!(record.image.tolerance.is_some(), is_raster, "{what}");
        assert_eq!(record.lists.missed_pairs, (!is_raster).then_some(0), "{what}");
    }
}

#[test]
fn laps_repeat_the_path() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["--strategies", "None,G/4x4x4/reuse4", "--lights", "20", "--truth", "none"];
    let path = ["--scene", SMALL, "--path", "--frames", "3", "--laps", "2", "--pictures", "none"];
    let results = compare(folder.path(), &[&arguments[..], &path].concat());
    for record in &results.records {
        assert_eq!((record.times.frames, record.setting.poses, record.laps()), (6, Some(3), 2));
        assert!(record.setting.along_path && record.times.rounds == 2);
        assert_eq!(record.times.passes.get("shade").expect("shade").samples.len(), 6);
        assert_eq!((record.round_times_ms().len(), record.pose_times_ms().len()), (2, 3));
        assert_eq!(record.image.differing_channels, Some(0), "{}", record.strategy);
    }
    let cull = &results.records[1].times.passes.get("cull").expect("cull").samples;
    let made: Vec<bool> = cull.iter().map(|ms| *ms > 0.0).collect();
    assert_eq!(made, [true, false, false, true, false, false]);
}

/// Diffuse light ends too close to every area light.
#[test]
fn faulty_lights_are_named_if_the_gpu_moves_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let lights = ["--lights", "30", "--areas", "0.5", "--diffuse-share", "1e-9"];
    let moved = ["--scene", SMALL, "--motion", "drift", "--moved-by", "gpu", "--checks", "1"];
    let results =
        compare(folder.path(), &[&lights[..], &moved, &["--strategies", "None"]].concat());
    let rejected = &results.rejected_lights;
    assert!((5..25).contains(&rejected.len()), "{} rejected lights", rejected.len());
    assert!(rejected.iter().all(|light| light.reason.starts_with("diffuse range is ")));
}

#[test]
fn clay_and_zero_lights_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["--lights", "0", "--strategies", "Clay,DC-I/32x32x8", "--truth", "none"];
    let results = compare(folder.path(), &[&["--scene", SMALL], &arguments[..]].concat());
    assert_eq!(results.records.len(), 2);
    assert_eq!(results.records[0].image.max_abs_diff, None);
    assert_eq!(results.records[1].image.max_abs_diff, Some(0.0));
    assert_eq!(results.records[1].lists.entries, 0);
}

#[test]
fn real_scenes_with_their_own_lights_are_lossless() {
    let folder = std::env::var_os("LIGHTBENCH_SCENES").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes"),
        Into::into,
    );
    let scenes = [
        ("crytek-sponza/Sponza.gltf", "200"),
        ("stk-candela-city/scene.gltf", "0"),
        ("city-munich/scene.gltf", "200"),
        ("boombox/BoomBox.glb", "50"),
    ];
    for (file, lights) in scenes {
        let path = folder.join(file);
        if !path.is_file() {
            println!("skipped: {} does not exist", path.display());
            continue;
        }
        let out = tempfile::tempdir().expect("a folder");
        let scene = path.to_str().expect("UTF-8");
        let results = compare(out.path(), &["--scene", scene, "--lights", lights]);
        assert_lossless(&results, 4);
    }
}

#[test]
fn advice_starts_with_the_best_method_and_prefers_lossy_ones_only_for_speed() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let small = ["advise", "--error-budget", "0.001", "--size", "64x36", "--lights", "60"];
    let output = lightbench(&[&small[..], &["--out", out]].concat());
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let results = Results::read(&folder.path().join("results.json")).expect("results.json");
    let best = verdict(&results, 0.001).expect("a verdict").best;
    assert!(
        text.starts_with(&format!("Use {} (", best.strategy)),
        "the first line must name the best method: {text}"
    );
    // It measured several poses, several times each.
    assert!(
        best.setting.along_path && best.setting.poses == Some(3) && best.times.frames == 24,
        "{best:?}"
    );
    let gains = |exact: &&Record| is_surely_faster(best, exact) == Some(true);
    let mut exact = results.records.iter().filter(|record| record.is_exact() && record.culls());
    assert!(best.is_exact() || exact.all(|exact| gains(&exact)), "{text}");
    // --camera gives one view, so --poses is refused; --lights-from works as in `compare`.
    let refused = lightbench(&["advise", "--poses", "3", "--camera", "0,1,0:1,1,0"]);
    assert_eq!(refused.status.code(), Some(2));
    assert_refused(&["advise", "--lights-from", "gone.glb", "--out", out], &["gone.glb"]);
}

/// Runs the program on bad input: one line on stderr, exit code 2, and the line holds `wanted`.
fn assert_refused(arguments: &[&str], wanted: &[&str]) {
    let output = lightbench(arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    // These lines may stand beside the error.
    let known = ["adapter  ", "scene    ", "lights   ", "warning  "];
    let is_known = |line: &&str| known.iter().any(|prefix| line.starts_with(prefix));
    let errors: Vec<&str> = stderr.lines().filter(|line| !is_known(line)).collect();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    assert_eq!(errors.len(), 1, "{arguments:?}: {stderr}");
    assert!(errors[0].starts_with("lightbench: "), "{arguments:?}: {stderr}");
    for part in wanted {
        assert!(
            errors[0].contains(part),
            "{arguments:?}: {:?} does not contain {part:?}",
            errors[0]
        );
    }
}

#[test]
fn bad_input_gets_one_line_and_exit_code_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let broken = path("broken.gltf");
    std::fs::write(&broken, "{ not json").expect("writes");
    let no_buffer = path("no-buffer.gltf");
    std::fs::write(
        &no_buffer,
        r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"gone.bin","byteLength":12}],
            "bufferViews":[{"buffer":0,"byteLength":12}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":1,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0}"#,
    )
    .expect("writes");
    let file = path("a-file");
    std::fs::write(&file, "").expect("writes");
    let below_file = format!("{file}/out");
    let out = path("new/out");
    for (arguments, wanted) in [
        (vec!["--scene", "atrum", "--out", &out], vec!["atrum", "atrium"]),
        (vec!["--scene", "gone.gltf", "--out", &out], vec!["gone.gltf"]),
        (vec!["--scene", &broken, "--out", &out], vec!["broken.gltf"]),
        (vec!["--scene", &no_buffer, "--out", &out], vec!["gone.bin"]),
        (vec!["--strategies", "DC-J", "--out", &out], vec!["DC-J", "DC-I"]),
        (vec!["--strategies", "SC-E/linear/bvh", "--out", &out], vec!["linear", "bvh"]),
        (vec!["advise", "--mode", "all", "--out", &out], vec!["all", "forward-no-prepass"]),
        (vec!["--strategies", "DC-I/0x64x24", "--out", &out], vec!["0", "tile"]),
        (vec!["--strategies", "DC-I/1x1x1024", "--out", &out], vec!["froxels"]),
        (vec!["--lights", "-1", "--out", &out], vec!["--lights", "-1"]),
        (vec!["--lights", "99999999", "--out", &out], vec!["--lights", "16,777,216"]),
        (vec!["--size", "0x10", "--out", &out], vec!["--size", "0x10"]),
        (vec!["--frames", "0", "--out", &out], vec!["--frames", "0"]),
        (vec!["--checks", "3", "--out", &out], vec!["--checks is 3", "--path"]),
        (vec!["--laps", "3", "--out", &out], vec!["--laps is 3", "--path"]),
        (
            vec!["--path", "--laps", "101", "--frames", "1000", "--out", &out],
            vec!["--laps is 101", "at most 100"],
        ),
        (
            vec!["--mode", "forward", "--strategies", "RasterSphere", "--out", &out],
            vec!["--mode", "forward", "RasterSphere"],
        ),
        (vec!["--mode", "sideways", "--out", &out], vec!["--mode", "sideways", "forward"]),
        (vec!["--out", &below_file], vec!["a-file"]),
        (vec!["--adapter", "no such adapter", "--out", &out], vec!["no such adapter"]),
        (vec!["list", "stratgies"], vec!["stratgies"]),
        (vec!["--scene", "two\nlines.gltf", "--out", &out], vec!["lines.gltf"]),
        (vec!["--strategies", "DC-I/a\nb", "--out", &out], vec!["a\\nb"]),
        (vec!["--strategies", "DC-E,dc-e/64x64x40", "--out", &out], vec!["DC-E/64x64x40", "once"]),
        (
            vec!["--strategies", "DC-E/reuse4", "--out", &out],
            vec!["DC-E/64x64x40/reuse4", "--path"],
        ),
        (vec!["--strategies", "DC-E/hs", "--out", &out], vec!["hs", "linear or bvh"]),
        (vec!["--test", "sat", "--out", &out], vec!["--test", "hs+sat-n"]),
        (vec!["--light-order", "zigzag", "--out", &out], vec!["--light-order", "morton"]),
        (vec!["--size", "16384x16384", "--lights", "1", "--out", &out], vec!["16384x16384"]),
        (
            vec!["--area-model", "mrp", "--lights", "1", "--out", &out],
            vec!["--area-model", "--areas"],
        ),
        (
            vec!["--influence", "0.1", "--lights", "1", "--out", &out],
            vec!["--influence", "--areas"],
        ),
        (vec!["study", "culling", "--only", "nonsense", "--out", &out], vec!["--only", "nonsense"]),
        (vec!["study", "culling", "--scene", "gone.gltf", "--out", &out], vec!["gone.gltf"]),
    ] {
        assert_refused(&arguments, &wanted);
    }
    // No error left a folder or a file.
    assert!(!folder.path().join("new").exists());
}

#[test]
fn list_and_help_print_their_text() {
    let text = |arguments: &[&str]| {
        let output = lightbench(arguments);
        assert!(output.status.success(), "{arguments:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert!(text(&["list", "strategies"]).contains("DC-I/128x128x64"));
    assert!(text(&["list", "scenes"]).contains("atrium"));
    assert!(!text(&["list", "adapters"]).is_empty());
    assert!(text(&["--help"]).contains("How to read the result"));
}

/// A floor of 10 m under a camera, one lamp of 0.05 cd without a range, and a sun if `has_sun`.
fn floor_file(folder: &Path, has_sun: bool) -> String {
    let corners: [[f32; 3]; 4] = [[-5., 0., -5.], [-5., 0., 5.], [5., 0., 5.], [5., 0., -5.]];
    let mut bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|ix| ix.to_le_bytes()));
    std::fs::write(folder.join("floor.bin"), &bytes).expect("writes");
    let down = [-0.5_f32.sqrt(), 0.0, 0.0, 0.5_f32.sqrt()];
    let light = |ix: u32, height: f32| {
        let extensions = serde_json::json!({"KHR_lights_punctual": {"light": ix}});
        serde_json::json!({"translation": [0.0, height, 0.0], "rotation": down, "extensions": extensions})
    };
    let nodes = if has_sun { vec![0, 1, 2, 3] } else { vec![0, 1, 3] };
    let json = serde_json::json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 0.05}, {"type": "directional", "intensity": 0.5}]}},
        "buffers": [{"byteLength": bytes.len(), "uri": "floor.bin"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "count": 4, "componentType": 5126, "type": "VEC3",
             "min": [-5.0, 0.0, -5.0], "max": [5.0, 0.0, 5.0]},
            {"bufferView": 1, "count": 6, "componentType": 5123, "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "nodes": [{"mesh": 0}, light(0, 3.0), light(1, 4.0),
            {"camera": 0, "translation": [0.0, 6.0, 0.0], "rotation": down}],
        "scenes": [{"nodes": nodes}],
    });
    let file = folder.join(if has_sun { "sun.gltf" } else { "lamp.gltf" });
    std::fs::write(&file, json.to_string()).expect("writes");
    file.to_str().expect("UTF-8").to_owned()
}

/// The image of `None` of a run.
fn image_of_none(out: &Path) -> shading::HdrImage {
    shading::HdrImage::read_exr(&out.join("deferred-None.exr")).expect("an image")
}

/// A dim lamp without a range lights its floor almost as if it had no end, and a note says where it ends. A
/// sun lights the floor once with every method.
#[test]
fn lights_without_a_range_are_visible_and_noted() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let few = ["--lights", "0", "--strategies", "None,SC-E/16x16x4,RasterSphere"];
    let run = |file: &str, more: &[&str]| {
        let size = ["--size", "32x18", "--frames", "1", "--warmup", "0", "--unbounded"];
        let out = ["--out", out.to_str().expect("UTF-8"), "--scene", file];
        let output = lightbench(&[&["compare"][..], &few[..], &size, &out, more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        let results = Results::read(&folder.path().join("run/results.json")).expect("results");
        (results, image_of_none(&folder.path().join("run")), words)
    };
    let lamp = floor_file(folder.path(), false);
    let (results, dim, words) = run(&lamp, &[]);
    let record = &results.records[0];
    assert_eq!((record.setting.lights, record.setting.open_lights), (1, Some(1)));
    assert!(
        record.image.unbounded_errors["rel_mse"] < Some(1e-4),
        "{:?}",
        record.image.unbounded_errors
    );
    assert!(dim.pixels.iter().all(|pixel| pixel[0] > 1e-5), "a black pixel");
    for place in [words, results.warnings.concat()] {
        assert!(place.contains("1 light has no range in its file, and ends at 70.71 m"), "{place}");
    }
    let (results, _, words) = run(&lamp, &["--threshold", "0.02"]);
    assert!(words.contains("ends at 1.581 m"), "{words}");
    assert!(results.records[0].image.unbounded_errors["rel_mse"] > Some(0.9), "{results:?}");
    let (results, sunny, words) = run(&floor_file(folder.path(), true), &[]);
    assert!(words.contains("1 lights, 1 sun"), "{words}");
    assert_eq!(results.records[0].setting.light_kinds["sun"], 1);
    assert!(results.records.iter().all(Record::is_lossless), "{:?}", results.records);
    assert!(sunny.pixels.iter().zip(&dim.pixels).all(|(sun, dim)| sun[0] > dim[0] + 0.01));
}
