//! Cameras of files and of the command line, as a run sees them: one device, small files made here.

use std::path::{Path, PathBuf};

use base64::Engine;
use harness::{
    bench::Bench,
    cli::{CompareArgs, Invocation, parse},
    compare::compare_on,
    report::{finding, render_table},
    results::{Results, Untested},
};
use serde_json::{Value, json};
use shading::HdrImage;

/// A floor of `half` metres around the origin, a wall at `z`, their front to +Y and +Z; every node
/// stands on one at `place`.
struct Room {
    half: f32,
    wall: Option<f32>,
    place: [f64; 3],
    lights: Vec<Value>,
    cameras: Vec<(Value, Value)>,
}

impl Room {
    fn write(&self, folder: &Path, name: &str) -> PathBuf {
        let Self { half, wall, .. } = *self;
        let quad = |corners: [[f32; 3]; 4]| corners.as_flattened().to_vec();
        let mut quads = vec![quad([
            [-half, 0.0, -half],
            [-half, 0.0, half],
            [half, 0.0, half],
            [half, 0.0, -half],
        ])];
        if let Some(z) = wall {
            quads.push(quad([
                [-half, -half, z],
                [half, -half, z],
                [half, half, z],
                [-half, half, z],
            ]));
        }
        let mut bytes: Vec<u8> =
            [0_u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()).collect();
        let mut views = vec![json!({"buffer": 0, "byteLength": 12})];
        let mut accessors =
            vec![json!({"bufferView": 0, "count": 6, "componentType": 5123, "type": "SCALAR"})];
        let mut meshes = Vec::new();
        for (ix, quad) in quads.iter().enumerate() {
            views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 48}));
            bytes.extend(quad.iter().flat_map(|v| v.to_le_bytes()));
            accessors.push(
                json!({"bufferView": ix + 1, "count": 4, "componentType": 5126, "type": "VEC3",
                "min": [-half, -half, -half], "max": [half, half, half]}),
            );
            meshes.push(json!({"primitives": [{"attributes": {"POSITION": ix + 1}, "indices": 0, "material": 0}]}));
        }
        let mut nodes: Vec<Value> = (0..meshes.len()).map(|mesh| json!({"mesh": mesh})).collect();
        let mut punctual = Vec::new();
        for light in &self.lights {
            let extension = json!({"KHR_lights_punctual": {"light": punctual.len()}});
            nodes.push(json!({"translation": light["at"], "extensions": extension}));
            let mut light = light.clone();
            light.as_object_mut().expect("a light").remove("at");
            punctual.push(light);
        }
        for (ix, (_, node)) in self.cameras.iter().enumerate() {
            let mut node = node.clone();
            node["camera"] = ix.into();
            nodes.push(node);
        }
        let children: Vec<usize> = (0..nodes.len()).collect();
        nodes.push(json!({"translation": self.place, "children": children}));
        let base64 = base64::engine::general_purpose::STANDARD.encode(&bytes);
        let mut file = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{base64}")}],
            "bufferViews": views, "accessors": accessors, "meshes": meshes,
            "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.8}}],
            "scenes": [{"nodes": [nodes.len() - 1]}], "nodes": nodes,
        });
        if !self.cameras.is_empty() {
            file["cameras"] = self.cameras.iter().map(|(camera, _)| camera.clone()).collect();
        }
        if !punctual.is_empty() {
            file["extensionsUsed"] = json!(["KHR_lights_punctual"]);
            file["extensions"] = json!({"KHR_lights_punctual": {"lights": punctual}});
        }
        let path = folder.join(name);
        std::fs::write(&path, file.to_string()).expect("writes");
        path
    }
}

fn lamp(at: [f32; 3], range: f32) -> Value {
    json!({"type": "point", "intensity": 60.0, "range": range, "at": at})
}

fn perspective(near_m: f32) -> Value {
    json!({"type": "perspective", "name": "wide", "perspective": {"yfov": 0.9, "znear": near_m}})
}

fn orthographic(half_height: f32) -> Value {
    json!({"type": "orthographic", "name": "flat",
        "orthographic": {"xmag": 5.0, "ymag": half_height, "znear": 0.0, "zfar": 60.0}})
}

/// At a place, turned about x by a tenth of a radian downwards for each step.
fn node(at: [f32; 3], tenths: i16) -> Value {
    let half = -0.05 * f32::from(tenths);
    json!({"translation": at, "rotation": [half.sin(), 0.0, 0.0, half.cos()]})
}

fn args(scene: &Path, out: &Path, more: &str) -> CompareArgs {
    let mut words = vec!["lightbench", "compare", "--scene", scene.to_str().expect("UTF-8")];
    words.extend(["--out", out.to_str().expect("UTF-8"), "--size", "64x36"]);
    words.extend(["--frames", "1", "--warmup", "0"]);
    if !more.contains("--lights") {
        words.extend(["--lights", "0"]);
    }
    words.extend(more.split_whitespace());
    match parse(&words) {
        Ok(Invocation::Compare(args)) => args,
        other => panic!("{words:?}: {other:?}"),
    }
}

/// A device, and a folder for what it reads and writes.
struct Runs {
    bench: Bench,
    folder: tempfile::TempDir,
}

impl Runs {
    fn run(&mut self, room: &Room, more: &str) -> Results {
        let path = room.write(self.folder.path(), "room.gltf");
        // A new file under an old name: another folder makes it another scene.
        let kept = tempfile::tempdir_in(self.folder.path()).expect("a folder").keep();
        let moved = kept.join("room.gltf");
        std::fs::rename(path, &moved).expect("moves");
        let args = args(&moved, &self.folder.path().join("out"), more);
        compare_on(&mut self.bench, &args, Vec::new()).expect("runs").0
    }

    /// The picture of no culling.
    fn image(&self) -> HdrImage {
        HdrImage::read_exr(&self.folder.path().join("out/deferred-None.exr")).expect("an image")
    }
}

fn lit_pixels(image: &HdrImage) -> usize {
    image.pixels.iter().filter(|pixel| pixel.iter().any(|channel| *channel > 0.0)).count()
}

fn largest_difference(a: &HdrImage, b: &HdrImage) -> f32 {
    let pairs = a.pixels.as_flattened().iter().zip(b.pixels.as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn cameras_follow_their_file_and_empty_views_count_as_untested() {
    let bench = Bench::open(None).expect("an adapter");
    let mut runs = Runs { bench, folder: tempfile::tempdir().expect("a folder") };
    let pixels = 64 * 36;
    let two = "--strategies None,SC-E/16x16x8 --pictures";

    // A lens 17 cm above a floor of 120 m, with the file's near plane and with none.
    let close = Room {
        half: 60.0,
        wall: None,
        place: [0.0; 3],
        lights: vec![lamp([0.0, 0.5, 0.0], 4.0)],
        cameras: vec![(perspective(0.01), node([0.0, 0.12, 0.12], 8))],
    };
    for more in ["", "--camera 0,0.12,0.12:0,0.02,0"] {
        let results = runs.run(&close, &format!("{two} all {more}"));
        assert_eq!(results.records[1].lists.samples, pixels, "{more}");
        assert_eq!(lit_pixels(&runs.image()), pixels as usize, "{more}");
        assert!(results.records[1].is_exact(), "{more}: {:?}", results.warnings);
    }

    // The file's near plane cuts a wall away: the picture is that without the wall, and a note says so.
    let mut cut = Room {
        half: 8.0,
        wall: Some(6.0),
        place: [0.0; 3],
        lights: vec![lamp([0.0, 3.0, 0.0], 20.0)],
        cameras: vec![(perspective(4.0), node([0.0, 2.0, 9.0], 1))],
    };
    let results = runs.run(&cut, &format!("{two} all"));
    assert!(
        results.warnings.iter().any(|note| note.contains("near plane, 4.00 m")),
        "{:?}",
        results.warnings
    );
    let with_wall = runs.image();
    cut.wall = None;
    runs.run(&cut, &format!("{two} all"));
    // The far plane follows the bounds, which lack the wall: positions round otherwise.
    assert!(largest_difference(&with_wall, &runs.image()) < 1e-4);
    assert!(lit_pixels(&with_wall) > 200);

    // The same room 1,400 km away, seen by its camera and by a pose in the file's coordinates.
    let here = runs.image();
    cut.place = [1e6, 0.0, 1e6];
    let results = runs.run(&cut, &format!("{two} all"));
    assert!(
        largest_difference(&here, &runs.image()) < 1e-3,
        "{}",
        largest_difference(&here, &runs.image())
    );
    assert!(
        (results.records[0].setting.eye[0] - 1e6).abs() < 1e-3,
        "{:?}",
        results.records[0].setting.eye
    );
    let sin = 0.1_f64.sin() / 0.1_f64.cos();
    let pose = format!("1000000,2,1000009:1000000,{},1000008", 2.0 - sin);
    let results = runs.run(&cut, &format!("{two} all --camera {pose}"));
    assert!(results.records[1].lists.samples > 500 && results.records[1].is_exact(), "{results:?}");

    // A view of nothing, and lights that reach nothing that it shows: nothing is exact or ranked.
    cut.place = [0.0; 3];
    for (camera, lights, why) in [
        ("0,2,9:0,9,9.1", "--lights 0", Untested::NoSurface),
        ("0,2,9:0,2,0", "--lights 0 --no-own-lights", Untested::NoLight),
        ("-7,0.3,-7:-8,0,-7", "--lights 0 --threshold 100", Untested::NoLight),
    ] {
        let results =
            runs.run(&cut, &format!("{two} none --camera={camera} {lights} --truth none"));
        for record in &results.records {
            assert_eq!(record.lists.untested, Some(why), "{camera}");
            assert!(!record.is_exact() && record.shows_no_loss(), "{camera}");
        }
        let texts = [finding(&results)[0].clone(), render_table(&results)];
        assert!(results.warnings[0].starts_with("NOTHING WAS TESTED: "), "{:?}", results.warnings);
        assert!(texts.iter().all(|text| !text.contains("same image")), "{texts:?}");
        assert!(texts[1].contains("NOTHING WAS TESTED"), "{texts:?}");
        assert!(harness::advise::verdict(&results, 0.0).is_none(), "{camera}");
        let advice = harness::advise::answer(&results, 0.0);
        assert!(advice.starts_with("No advice: "), "{advice}");
    }
}

/// Every method through an orthographic camera that only its number names: no light is missed, and every
/// lossless image is that of no culling.
#[test]
fn all_methods_serve_an_orthographic_camera_of_a_file() {
    let bench = Bench::open(None).expect("an adapter");
    let mut runs = Runs { bench, folder: tempfile::tempdir().expect("a folder") };
    let room = Room {
        half: 8.0,
        wall: Some(-8.0),
        place: [0.0; 3],
        lights: vec![lamp([0.0, 1.0, 0.0], 3.0), lamp([3.0, 0.4, 2.0], 2.0)],
        cameras: vec![
            (perspective(0.1), node([0.0, 2.0, 9.0], 1)),
            (orthographic(4.0), node([0.0, 5.0, 9.0], 4)),
        ],
    };
    let more =
        "--camera #1 --lights 300 --spots 0.3 --strategies all,M/2 --source bvh --pictures none";
    let results = runs.run(&room, more);
    assert!(results.records.len() > 10, "{} records", results.records.len());
    let far = results.records[0].setting.planes.expect("planes").far_m;
    assert_eq!(far, Some(60.0));
    for record in results.records.iter().filter(|record| record.strategy != "Clay") {
        let what = format!("{} {}", record.strategy, record.setting.mode.name());
        assert!(
            record.is_lossless() && record.lists.untested.is_none(),
            "{what}: {:?}",
            record.image.max_rel_diff
        );
        assert_eq!(record.lists.missed_pairs.unwrap_or(0), 0, "{what}");
    }
    let none = results.records.iter().find(|record| record.is_baseline()).expect("no culling");
    let (samples, pairs) = (none.lists.samples, none.lists.checked_pairs);
    assert!(samples > 1_000 && pairs > Some(1_000), "{samples} samples, {pairs:?} pairs");
}

#[test]
fn advise_refuses_a_view_without_surfaces() {
    let folder = tempfile::tempdir().expect("a folder");
    let words = ["advise", "--size", "64x36", "--lights", "9", "--camera=0,500,0:0,501,0"];
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lightbench"))
        .args(words)
        .args(["--out".as_ref(), folder.path().as_os_str()])
        .output()
        .expect("starts");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("advise: no advice for this view: the view shows no surface"),
        "{stderr}"
    );
}
