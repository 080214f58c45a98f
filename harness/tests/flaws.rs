//! Methods that fail on purpose: each one fails in a scene that is made for it, and its sound twin does not.

use std::path::Path;

use base64::Engine;
use harness::{
    bench::Bench,
    cli::{Invocation, parse},
    compare::compare_on,
    results::{Record, Results},
    strategy::{StrategyId, engines},
};
use serde_json::{Value, json};

/// A floor around the origin, with lights above it and a camera.
struct Floor {
    /// Half its side, metres.
    half: f32,
    roughness: f32,
    metallic: f32,
    /// Place and range of each light, metres.
    lights: Vec<([f32; 3], f32)>,
    /// Place of the camera, and its angle downwards, radians.
    eye: ([f32; 3], f32),
    /// Vertical field of view, radians.
    fov: f32,
}

impl Default for Floor {
    fn default() -> Self {
        let lights = Vec::new();
        let eye = ([0.0, 2.0, 5.0], 0.4);
        Self { half: 20.0, roughness: 0.8, metallic: 0.0, lights, eye, fov: 0.9 }
    }
}

impl Floor {
    fn write(&self, path: &Path) {
        let half = self.half;
        let corners =
            [[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]];
        let mut bytes: Vec<u8> =
            [0_u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()).collect();
        bytes.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
        let base64 = base64::engine::general_purpose::STANDARD.encode(&bytes);
        let (eye, down) = self.eye;
        let mut nodes = vec![
            json!({"mesh": 0}),
            json!({"camera": 0, "translation": eye,
                "rotation": [-(down / 2.0).sin(), 0.0, 0.0, (down / 2.0).cos()]}),
        ];
        let mut lights = Vec::new();
        for (ix, (at, range)) in self.lights.iter().enumerate() {
            nodes.push(
                json!({"translation": at, "extensions": {"KHR_lights_punctual": {"light": ix}}}),
            );
            lights.push(json!({"type": "point", "intensity": 60.0, "range": range}));
        }
        let all: Vec<usize> = (0..nodes.len()).collect();
        let file: Value = json!({
            "asset": {"version": "2.0"},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": lights}},
            "buffers": [{"byteLength": bytes.len(),
                "uri": format!("data:application/octet-stream;base64,{base64}")}],
            "bufferViews": [{"buffer": 0, "byteLength": 12},
                {"buffer": 0, "byteOffset": 12, "byteLength": 48}],
            "accessors": [
                {"bufferView": 0, "count": 6, "componentType": 5123, "type": "SCALAR"},
                {"bufferView": 1, "count": 4, "componentType": 5126, "type": "VEC3",
                    "min": [-half, 0.0, -half], "max": [half, 0.0, half]},
            ],
            "meshes": [{"primitives": [
                {"attributes": {"POSITION": 1}, "indices": 0, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness":
                {"metallicFactor": self.metallic, "roughnessFactor": self.roughness}}],
            "cameras": [{"type": "perspective",
                "perspective": {"yfov": self.fov, "znear": 0.1, "zfar": 2.0 * half}}],
            "scenes": [{"nodes": all}], "nodes": nodes,
        });
        std::fs::write(path, file.to_string()).expect("writes");
    }
}

/// Where runs write. With `LIGHTBENCH_KEEP`, pictures are kept there.
struct Runs {
    bench: Bench,
    folder: tempfile::TempDir,
}

impl Runs {
    fn new() -> Self {
        let bench = Bench::open(None).expect("an adapter: scripts/test installs the software one");
        Self { bench, folder: tempfile::tempdir().expect("a folder") }
    }

    /// Compares strategies on a floor of 64 x 36 pixels.
    fn run(&mut self, name: &str, floor: &Floor, more: &str) -> Results {
        let file = self.folder.path().join(format!("{name}.gltf"));
        floor.write(&file);
        let kept = std::env::var_os("LIGHTBENCH_KEEP").map(|kept| Path::new(&kept).join(name));
        let is_kept = kept.is_some();
        let out = kept.unwrap_or_else(|| self.folder.path().join(name));
        let mut words = vec!["lightbench", "compare", "--lights", "0", "--size", "64x36"];
        words.extend(["--frames", "2", "--warmup", "0"]);
        words.extend(["--scene", file.to_str().expect("UTF-8")]);
        words.extend(["--out", out.to_str().expect("UTF-8")]);
        if !is_kept {
            words.extend(["--pictures", "none"]);
        }
        words.extend(more.split_whitespace());
        let Ok(Invocation::Compare(args)) = parse(&words) else { panic!("{words:?}") };
        compare_on(&mut self.bench, &args, Vec::new()).unwrap_or_else(|e| panic!("{name}: {e}")).0
    }
}

fn record<'a>(results: &'a Results, strategy: &str) -> &'a Record {
    let found = results.records.iter().find(|record| record.strategy == *strategy);
    found.unwrap_or_else(|| panic!("{strategy} is missing"))
}

/// The largest temporal error of a strategy, which was measured.
fn flicker(results: &Results, strategy: &str) -> f64 {
    let found = record(results, strategy).image.temporal.as_ref().expect("a temporal error");
    found.worst.expect("finite")
}

fn error(record: &Record, metric: &str) -> f64 {
    record.image.errors[metric].expect("finite")
}

fn assert_exact(results: &Results, strategy: &str) {
    let record = record(results, strategy);
    assert!(record.is_exact(), "{strategy}: {:?}, {:?}", record.lists, record.image);
}

/// A strategy that states a loss, shows it, has no rank, and is named in a warning.
fn assert_fails_as_stated(results: &Results, strategy: &str) {
    let record = record(results, strategy);
    assert!(record.is_lossy && !record.is_lossless(), "{strategy}: {:?}", record.image);
    let words = format!("{strategy} fails on purpose: ");
    assert!(results.warnings.iter().any(|note| note.starts_with(&words)), "{:?}", results.warnings);
}

#[test]
fn lists_without_an_order_flicker_and_with_a_limit_they_pop() {
    let mut runs = Runs::new();
    let place = |ix: u8| {
        let [x, z] = [f32::from(ix % 8), f32::from(ix / 8)];
        ([x - 3.5, 0.3 + 0.1 * f32::from(ix % 3), 2.0 - 1.3 * z], 3.0)
    };
    let floor = Floor { lights: (0..40).map(place).collect(), ..Floor::default() };
    let methods = "T-E/16x16,T-E/16x16/cap4,T-E/16x16/unordered,T-E/16x16/unordered/cap4";
    let more = format!("--strategies {methods} --temporal --checks 4");
    let results = runs.run("order", &floor, &more);
    assert_exact(&results, "T-E/16x16");
    assert_eq!(flicker(&results, "T-E/16x16"), 0.0);
    // No light is missing: only sums round in another way.
    let unordered = record(&results, "T-E/16x16/unordered");
    assert_eq!(unordered.lists.missed_pairs, Some(0));
    assert!(unordered.image.max_rel_diff.is_some_and(|off| off > 0.0 && off < 1e-4));
    let last_bits = flicker(&results, "T-E/16x16/unordered");
    assert!(last_bits > 0.0 && last_bits < 1e-3, "{last_bits}");
    assert_fails_as_stated(&results, "T-E/16x16/unordered");
    // A limit loses lights, always the same ones while lists are in order.
    let capped = record(&results, "T-E/16x16/cap4");
    assert!(capped.is_lossy && error(capped, "rel_mse") > 0.01, "{:?}", capped.image);
    assert_eq!(flicker(&results, "T-E/16x16/cap4"), 0.0);
    let popping = flicker(&results, "T-E/16x16/unordered/cap4");
    assert!(popping > 100.0 * last_bits && popping > 0.1, "{popping}");
    assert_fails_as_stated(&results, "T-E/16x16/unordered/cap4");
    // Frames differ, and runs do not.
    let again = runs.run("order-again", &floor, &more);
    for id in methods.split(',') {
        assert_eq!(record(&again, id).image.temporal, record(&results, id).image.temporal, "{id}");
    }
}

#[test]
fn the_rectangle_of_a_ball_loses_lights_near_the_border_of_a_wide_view() {
    let mut runs = Runs::new();
    let lights = vec![([-4.5, 0.5, 2.0], 1.6), ([4.5, 0.5, 2.0], 1.6), ([0.0, 0.5, 2.0], 1.6)];
    let wide = Floor { lights, eye: ([0.0, 1.2, 5.0], 0.3), fov: 2.0, ..Floor::default() };
    let both = "--strategies T-I/8x8,T-I/8x8/rect";
    let results = runs.run("rect", &wide, both);
    assert_exact(&results, "T-I/8x8");
    assert_fails_as_stated(&results, "T-I/8x8/rect");
    let flawed = record(&results, "T-I/8x8/rect");
    assert!(flawed.lists.missed_pairs > Some(20), "{:?}", flawed.lists.missed_pairs);
    assert!(error(flawed, "tile") > 0.05, "{}", error(flawed, "tile"));
    // On the axis of a narrow view the rectangle is almost right.
    let middle = vec![wide.lights[2]];
    let narrow = Floor { lights: middle, fov: 0.5, ..wide };
    let results = runs.run("rect-narrow", &narrow, both);
    assert!(record(&results, "T-I/8x8/rect").lists.missed_pairs < Some(5));
    assert!(record(&results, "T-I/8x8/rect").lists.checked_pairs > Some(300));
}

#[test]
fn culling_in_half_precision_loses_lights_far_from_the_origin() {
    let mut runs = Runs::new();
    let both = "--strategies T-E/8x8,T-E/8x8/half";
    // Half floats are 4 m apart at 5 km: the light moves by 1.7 m.
    for (x, name) in [(0.0, "half-near"), (5_001.7, "half-far")] {
        let eye = ([x, 2.0, 5.0], 0.4);
        let floor =
            Floor { half: 8_000.0, lights: vec![([x, 0.8, 0.5], 2.1)], eye, ..Floor::default() };
        let results = runs.run(name, &floor, both);
        assert_exact(&results, "T-E/8x8");
        let flawed = record(&results, "T-E/8x8/half");
        assert!(flawed.is_lossy && flawed.lists.checked_pairs > Some(300), "{:?}", flawed.lists);
        if x == 0.0 {
            // Only the rim of a ball is lost, if anything.
            assert!(error(flawed, "rel_mse") < 1e-6, "{:?}", flawed.image);
        } else {
            assert_fails_as_stated(&results, "T-E/8x8/half");
            assert!(flawed.lists.missed_pairs > Some(50), "{:?}", flawed.lists);
            assert!(error(flawed, "tile") > 0.2, "{}", error(flawed, "tile"));
        }
    }
}

#[test]
fn lights_that_go_on_beyond_their_range_end_at_the_edges_of_tiles() {
    let mut runs = Runs::new();
    let lights = vec![([-1.5, 0.6, 1.0], 1.2), ([1.5, 0.6, 0.0], 1.2)];
    let floor = Floor { lights, ..Floor::default() };
    for cut in ["windowed", "hard", "never"] {
        let more = format!("--strategies None,Sphere,T-E/8x8,RasterSphere --cut {cut}");
        let results = runs.run(&format!("cut-{cut}"), &floor, &more);
        // The early exit skips what adds nothing, and a light without an end adds something everywhere.
        assert_eq!(record(&results, "Sphere").image.differing_channels, Some(0), "{cut}");
        assert!(!record(&results, "Sphere").is_lossy, "{cut}");
        let tiles = record(&results, "T-E/8x8");
        assert_eq!(tiles.setting.cut.as_deref(), Some(cut));
        if cut != "never" {
            assert_exact(&results, "T-E/8x8");
            continue;
        }
        assert!(tiles.is_lossy && record(&results, "RasterSphere").is_lossy);
        assert!(error(tiles, "missing_energy") > 0.1, "{:?}", tiles.image.errors);
        let note = "with --cut never lights go on beyond the ranges";
        assert!(results.warnings.iter().any(|known| known.starts_with(note)));
    }
}

#[test]
fn thresholds_of_diffuse_light_lose_highlights_on_a_mirror() {
    let mut runs = Runs::new();
    let lights = (0..5).map(|ix| ([1.6 * ix as f32 - 3.2, 1.2, -6.0], 100.0)).collect();
    let floor = Floor { lights, roughness: 0.08, metallic: 1.0, ..Floor::default() };
    let lost = |results: &Results| {
        let culled = record(results, "SC-E/16x16x16");
        assert!(culled.is_lossy, "the range is stated to lose light");
        (error(culled, "highlights"), error(culled, "missing_energy"))
    };
    // Lights of 60 cd end after 3.2 m, or after 775 m. The floor mirrors them from 4.3 m away.
    let one = "--strategies None,SC-E/16x16x16 --cut never --threshold";
    let (highlights, energy) = lost(&runs.run("gloss", &floor, &format!("{one} 6")));
    assert!(highlights > 2.0 && energy > 0.9, "{highlights}, {energy}");
    let long = lost(&runs.run("gloss-long", &floor, &format!("{one} 1e-4")));
    assert_eq!(long, (0.0, 0.0));
}

#[test]
fn defaults_of_all_engines_run_in_one_list_and_in_every_mode() {
    let mut runs = Runs::new();
    let lights = (0..12).map(|ix| ([0.5 * ix as f32 - 3.0, 0.5, 1.0], 2.0)).collect();
    let floor = Floor { lights, ..Floor::default() };
    let results = runs.run("engines", &floor, "--strategies engine:all --mode all --truth none");
    assert_eq!(results.records.len(), 4 * engines::ENGINES.len());
    for record in &results.records {
        // Few lights: only the limit of eight in a list loses some.
        let is_capped = StrategyId::from(record.strategy.as_str()).options().cap == Some(8);
        assert_eq!(record.is_lossy, is_capped, "{}", record.strategy);
        assert_eq!(record.shows_no_loss(), !is_capped, "{}", record.strategy);
    }
}
