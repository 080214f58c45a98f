//! Indirect light as a user asks for it: deep images, virtual point lights, and their study.

mod frame;
mod stored;

use std::{
    f64::consts::FRAC_1_SQRT_2,
    path::Path,
    process::{Command, Output},
};

use harness::{
    results::{DeepImageRun, Record, Results},
    study::Done,
};
use serde_json::json;
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
    let each = ["--build", "per-direction", "--casts", "none", "--compared", "3000"];
    let (_, each) = deep(folder.path(), &each);
    let share = each.deep.fragments as f64 / all.deep.fragments as f64;
    assert!((0.3..1.0).contains(&share), "{share}");
    let found = each.range_errors.expect("errors");
    assert!(each.casts.is_empty() && found.median() < 1.5, "{found:?}");
    // One dispatch for all directions makes the same images: every ray has the same length.
    let batched = ["--build", "per-direction-batched", "--casts", "none", "--compared", "3000"];
    let (_, batched) = deep(folder.path(), &batched);
    assert_eq!((batched.deep.fragments, batched.range_errors), (each.deep.fragments, Some(found)));
    let (_, none) = deep(folder.path(), &["--casts", "none", "--compared", "0"]);
    assert!(none.range_errors.is_none());
}

/// The CPU orders the lights, so that they are made once and not in every frame.
const ONCE: [&str; 2] = ["--light-order", "bvh"];

#[test]
fn ranges_that_rays_do_not_measure_keep_the_lights_that_rays_keep() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = ["compare", "--scene", "town-small", "--size", "32x18", "--vpls", "32"];
    let drawn = [&drawn[..], &ONCE].concat();
    let timed = ["--strategies", "HG", "--truth", "none", "--frames", "1", "--warmup", "0"];
    let made = |name: &str, rule: &[&str]| {
        let out = folder.path().join(name);
        let (printed, results) = run(&out, &[&drawn[..], &timed, rule].concat());
        for passes in ["Lights, made once, ms: rsm-depth ", "HG/48x48x40, ms: depth "] {
            assert!(printed.contains(passes), "{passes}: {printed}");
        }
        results.records[0].indirect.clone().expect("virtual point lights")
    };
    let cast = made("cast", &["--ranges", "average"]);
    let all = made("all", &["--ranges", "random", "--random-ranges", "4,20"]);
    let random = made("random", &["--ranges", "random-discard", "--random-ranges", "4,20"]);
    let constant = made("constant", &["--ranges", "constant-discard", "--constant-range", "7"]);
    assert!(cast.kept < all.kept && all.kept == all.candidates, "{cast:?}, {all:?}");
    for other in [&random, &constant] {
        assert_eq!((other.kept, other.too_large), (cast.kept, cast.too_large), "{other:?}");
        assert!(
            other.rays == 6 && other.deep.is_some() && other.passes.get("cdi-ranges").is_some()
        );
    }
    // Uniform from 4 to 20 metres: the mean of n is within four standard errors, 4.62 / sqrt(n).
    let within = 4.0 * 4.62 / (random.kept as f64).sqrt();
    assert!((random.mean_range_m - 12.0).abs() < within, "{random:?}");
    assert!((constant.mean_range_m - 7.0).abs() < 1e-3, "{constant:?}");
    assert_eq!(
        (random.given_ranges_m, constant.given_ranges_m),
        (Some([4.0, 20.0]), Some([7.0, 7.0]))
    );
}

#[test]
fn every_strategy_shows_the_same_indirect_light() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = ["compare", "--scene", "town-small", "--size", "96x54", "--vpls", "24"];
    let drawn = [&drawn[..], &ONCE].concat();
    let all = ["--strategies", "None,T-I,T-E,DC-I,DC-E,SC-I,SC-E,SC-E/48x48x40/n6,G,M/4,HG"];
    let timed = ["--source", "both", "--mode", "both", "--frames", "1", "--warmup", "0"];
    let (_, results) = run(folder.path(), &[&drawn[..], &all, &timed].concat());
    assert!(results.records.len() >= 36, "{}", results.records.len());
    for record in &results.records {
        let what = format!("{} {}", record.strategy, record.setting.mode.name());
        assert_eq!(record.lists.missed_pairs, Some(0), "{what}");
        assert_eq!(record.image.differing_channels, Some(0), "{what}");
        let vpls = record.indirect.as_ref().expect("virtual point lights");
        assert_eq!(
            (vpls.kept, record.setting.light_kinds.get("vpl").copied()),
            (record.setting.lights, Some(record.setting.lights))
        );
        assert_eq!(vpls.candidates, vpls.kept + vpls.too_small + vpls.too_large, "{what}");
        assert!(vpls.kept > 100 && vpls.mean_range_m > 1.0, "{vpls:?}");
    }
}

/// The mean luminance of a linear image.
fn mean(image: &HdrImage) -> f64 {
    image.pixels.iter().map(luminance).sum::<f64>() / image.pixels.len() as f64
}

/// Writes a room of a floor and three walls, lit by a spot that hits the floor only: of every point of
/// the walls the whole lit floor is seen.
fn room(folder: &Path, floor: f64) -> String {
    let up = [0.0_f32, 1.0, 0.0];
    // Corners around each rectangle, and its normal.
    let rectangles: [([[f32; 3]; 4], [f32; 3]); 4] = [
        ([[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]], up),
        (
            [[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 3.0, -2.0], [-2.0, 3.0, -2.0]],
            [0.0, 0.0, 1.0],
        ),
        (
            [[-2.0, 0.0, 2.0], [-2.0, 0.0, -2.0], [-2.0, 3.0, -2.0], [-2.0, 3.0, 2.0]],
            [1.0, 0.0, 0.0],
        ),
        ([[2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [2.0, 3.0, 2.0], [2.0, 3.0, -2.0]], [-1.0, 0.0, 0.0]),
    ];
    let mut bytes = Vec::new();
    let vectors = |of: &dyn Fn(usize, usize) -> [f32; 3], bytes: &mut Vec<u8>| {
        for (rectangle, corner) in (0..4).flat_map(|r| (0..4).map(move |c| (r, c))) {
            for value in of(rectangle, corner) {
                bytes.extend(value.to_le_bytes());
            }
        }
    };
    vectors(&|r, c| rectangles[r].0[c], &mut bytes);
    vectors(&|r, _| rectangles[r].1, &mut bytes);
    for first in (0..4_u16).map(|r| 4 * r) {
        for corner in [0, 1, 2, 0, 2, 3] {
            bytes.extend((first + corner).to_le_bytes());
        }
    }
    std::fs::write(folder.join("room.bin"), &bytes).expect("written");
    let gltf = json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{
            "type": "spot", "intensity": 100.0, "range": 1000.0,
            "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}
        }]}},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"mesh": 0},
            {"translation": [0.0, 2.8, 0.0], "rotation": [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2],
             "extensions": {"KHR_lights_punctual": {"light": 0}}}
        ],
        "materials": [
            {"doubleSided": true, "pbrMetallicRoughness":
                {"baseColorFactor": [floor, floor, floor, 1.0], "metallicFactor": 0.0}},
            {"doubleSided": true, "pbrMetallicRoughness":
                {"baseColorFactor": [0.6, 0.6, 0.6, 1.0], "metallicFactor": 0.0}}
        ],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0},
            {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 3, "material": 1}
        ]}],
        "buffers": [{"byteLength": bytes.len(), "uri": "room.bin"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 192},
            {"buffer": 0, "byteOffset": 192, "byteLength": 192},
            {"buffer": 0, "byteOffset": 384, "byteLength": 48}
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 16, "type": "VEC3",
             "min": [-2.0, 0.0, -2.0], "max": [2.0, 3.0, 2.0]},
            {"bufferView": 1, "componentType": 5126, "count": 16, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "byteOffset": 12, "componentType": 5123, "count": 18, "type": "SCALAR"}
        ]
    });
    let path = folder.join(format!("room-{floor}.gltf"));
    std::fs::write(&path, gltf.to_string()).expect("written");
    path.to_str().expect("UTF-8").to_owned()
}

/// The image of a wall above the lit floor.
const ROOM_VIEW: [&str; 4] = ["--size", "64x36", "--camera", "0,1.5,-0.8:0,1.5,-2"];

/// Virtual point lights are as bright, on average over a wall that sees them all, as a path-traced bounce
/// off surfaces that reflect as the lights emit: one model on both sides.
#[test]
fn virtual_point_lights_are_as_bright_as_a_matte_bounce() {
    const WITHIN: f64 = 0.01;
    let folder = tempfile::tempdir().expect("a folder");
    let truth = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let bounced =
            ["--primary", "--shadows", "--bounces", "1", "--indirect", "--samples", "512"];
        let scene = room(folder.path(), 1.0);
        let words = [&["truth", "--scene", &scene], &ROOM_VIEW[..], &bounced, more].concat();
        let (_, results) = run(&out, &words);
        let raw = results.truth_image.expect("a truth image").raw;
        mean(&HdrImage::read_exr(&out.join(raw)).expect("an image"))
    };
    let lit = |floor: f64| {
        let out = folder.path().join(format!("lights-{floor}"));
        let timed = ["--strategies", "HG", "--truth", "none", "--frames", "1", "--warmup", "0"];
        let scene = room(folder.path(), floor);
        let lights = ["--vpls", "64", "--ranges", "infinite"];
        let words = [&["compare", "--scene", &scene], &ROOM_VIEW[..], &lights, &timed].concat();
        let (printed, results) = run(&out, &words);
        // By default, each frame makes its lights.
        assert!(printed.contains("HG/48x48x40, ms: rsm-depth "), "{printed}");
        let raw = results.records[0].image.files.raw.clone().expect("a linear image");
        mean(&HdrImage::read_exr(&out.join(raw)).expect("an image"))
    };
    let matte = truth("matte", &["--matte-bounces"]);
    let off = |lit: f64| (lit / matte - 1.0).abs();
    // White has no rounding in the map's eight bits.
    let own = lit(1.0);
    println!("lights are {} of a matte bounce", own / matte);
    assert!(off(own) < WITHIN, "{} of what the floor reflects", own / matte);
    // A floor that reflects a twentieth less is told from it, and so is the floor's specular term.
    let darker = lit(0.95);
    assert!(off(darker) > WITHIN, "{}", darker / matte);
    let whole = truth("whole", &[]);
    assert!(off(whole) > WITHIN, "{}", whole / matte);
}

#[test]
fn light_of_long_range_leaks_and_light_of_short_range_lacks() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = ["--scene", "atrium", "--size", "64x36", ONCE[0], ONCE[1]];
    let lit = |name: &str, rule: &[&str]| -> f64 {
        let out = folder.path().join(name);
        let timed = ["--strategies", "HG", "--truth", "none", "--frames", "1", "--warmup", "0"];
        let words = [&["compare"], &drawn[..], &["--vpls", "64"], &timed, rule].concat();
        let (_, results) = run(&out, &words);
        let record: &Record = results.records.last().expect("a record");
        let raw = record.image.files.raw.as_ref().expect("a linear image");
        mean(&HdrImage::read_exr(&out.join(raw)).expect("an image"))
    };
    let cast = lit("cast", &["--ranges", "average"]);
    let infinite = lit("infinite", &["--ranges", "infinite"]);
    let short = lit("short", &["--ranges", "random", "--random-ranges", "0,2"]);
    assert!(infinite > 1.1 * cast && short < 0.7 * cast, "{infinite}, {cast}, {short}");
    let compensated = lit("compensated", &["--ranges", "average", "--compensate", "10"]);
    assert!((compensated / cast - 1.0).abs() > 0.05, "{compensated}, {cast}");
}

#[test]
fn contradicting_options_are_refused() {
    for (line, wanted) in [
        ("--vpls 64 --primary", "--primary"),
        ("--vpls 64 --lights 10", "--lights"),
        ("--primary --spots 0.5", "--spots"),
        ("--vpls 8", "--vpls is 8: it must be 0, or a whole number from 16 to 2,048"),
        ("--vpls 64 --ranges nearest", "--ranges is nearest: it must be one of average"),
        ("--vpls 64 --random-ranges 5,1", "--random-ranges is 5,1: it must be LOW,HIGH in metres"),
        ("--vpls 64 --directions 0x4", "--directions is 0x4: it must be STACKSxSLICES"),
        ("--ranges random", "--vpls"),
        ("--vpls 64 --ranges infinite --keep-ranges 1,2", "--keep-ranges has no effect here"),
        (
            "--vpls 64 --random-ranges 1,2",
            "--random-ranges has no effect here: it needs --vpls N above 0 and --ranges random",
        ),
        (
            "--vpls 64 --ranges random --correct-rays",
            "--correct-rays has no effect here: it needs --vpls N above 0 and --ranges average",
        ),
        (
            "--vpls 64 --constant-range 3",
            "--constant-range has no effect here: it needs --vpls N above 0 and --ranges constant",
        ),
        (
            "study cdi --quick --only no-such-job",
            "--only is no-such-job: it must be words from job names",
        ),
        (
            "cdi --build per-direction --oversampling 2",
            "--oversampling is 2: it must be 1 for --build per-direction",
        ),
        ("truth --primary --indirect", "--indirect has no effect here: it needs --bounces 1"),
        ("cdi --casts 12", "--casts is 12: it must be none, or sizes from 16 to 2,048"),
        (
            "cdi --directions 64x64",
            "directions (stacks x slices) is 64 x 64: it must be 1 to 1024 in all",
        ),
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
    assert!(!printed.contains("claims to lose nothing"), "{printed}");
    let done = Done::read(&[folder.path().to_owned()]).expect("a study");
    assert!(done.missing().is_empty(), "{:?}", done.missing());
    let page = std::fs::read_to_string(folder.path().join("index.html")).expect("a page");
    // Brute force was compared with the single pass, image by image.
    let brute = &done.results["town-small-models-per-direction"].records[0];
    let errors = &brute.indirect.as_ref().expect("virtual point lights").build_errors;
    assert!(errors["mean_error"].is_some_and(|error| error > 0.0 && error < 0.5), "{errors:?}");
    for claim in ["one-pass", "same-image", "fewer-lights"] {
        assert!(page.contains(&format!("data-claim=\"{claim}\"")), "{claim}");
    }
    for part in ["indirect", "pictures", "steps", "builds", "casts", "ranges", "vpl-strategies"] {
        assert!(page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    assert!(!page.contains("NaN") && !page.contains("not finite"));
}

#[test]
fn a_study_runs_the_jobs_that_are_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let small = ["study", "cdi", "--quick", "--scene", "town-small", "--size", "32x18"];
    let only = ["--only", "builds-compute,builds-size", "--out", out];
    let output = lightbench(&[&small[..], &only].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let done = Done::read(&[folder.path().to_owned()]).expect("a study");
    let names: Vec<&str> = done.results.keys().map(String::as_str).collect();
    let wanted = ["compute-2x4", "compute-4x8", "size-16"];
    assert_eq!(names, wanted.map(|name| format!("town-small-builds-{name}")));
    assert!(done.missing().len() > 20);
}
