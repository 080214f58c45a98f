//! Transparent surfaces, particles and fog, as a run of all strategies sees them.

use std::path::{Path, PathBuf};

use base64::Engine;
use harness::{
    bench::Bench,
    cli::{Invocation, parse},
    compare::compare_on,
    error::HarnessError,
    report::render_table,
    results::{LayerSetting, PassKind, Record, Results, is_raster_pass},
};
use serde_json::{Value, json};

/// A rectangle: its lower left corner, and its edges.
type Quad = [[f32; 3]; 3];

/// A room of 6 x 6 x 4 metres that is open to the front, and three sheets of glass in it: the material of each quad,
/// and the quad.
const QUADS: [(usize, Quad); 5] = [
    (0, [[-3.0, 0.0, 3.0], [6.0, 0.0, 0.0], [0.0, 0.0, -6.0]]),
    (0, [[-3.0, 0.0, -3.0], [6.0, 0.0, 0.0], [0.0, 4.0, 0.0]]),
    (1, [[-2.2, 0.3, -1.0], [2.0, 0.0, 0.6], [0.0, 2.2, 0.0]]),
    (2, [[-0.4, 0.2, 0.0], [2.0, 0.0, -0.5], [0.0, 2.4, 0.0]]),
    (3, [[-1.4, 0.1, 1.2], [2.4, 0.0, 0.3], [0.0, 1.6, 0.0]]),
];

/// Writes the room as a glTF file, with a camera before it.
fn write_room(folder: &Path, has_glass: bool) -> PathBuf {
    let quads = &QUADS[..if has_glass { 5 } else { 2 }];
    let mut bytes: Vec<u8> = [0_u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut views = vec![json!({"buffer": 0, "byteLength": 12})];
    let mut accessors =
        vec![json!({"bufferView": 0, "count": 6, "componentType": 5123, "type": "SCALAR"})];
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    for (ix, (material, [corner, x, y])) in quads.iter().enumerate() {
        let at = |u: f32, v: f32| std::array::from_fn(|i| corner[i] + u * x[i] + v * y[i]);
        let corners: [[f32; 3]; 4] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        let ends = |end: fn(f32, f32) -> f32| {
            corners.into_iter().reduce(|a, b| std::array::from_fn(|i| end(a[i], b[i])))
        };
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 48}));
        bytes.extend(corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
        accessors
            .push(json!({"bufferView": ix + 1, "count": 4, "componentType": 5126, "type": "VEC3",
            "min": ends(f32::min), "max": ends(f32::max)}));
        meshes.push(json!({"primitives": [
            {"attributes": {"POSITION": ix + 1}, "indices": 0, "material": material}]}));
        nodes.push(json!({"mesh": ix}));
    }
    let mut children: Vec<usize> = (0..nodes.len()).collect();
    children.push(nodes.len());
    nodes.push(json!({"camera": 0, "translation": [0.3, 1.5, 5.5]}));
    let material = |color: [f32; 4], roughness: f32, more: Value| {
        let mut material = json!({"doubleSided": true, "pbrMetallicRoughness":
            {"baseColorFactor": color, "metallicFactor": 0.0, "roughnessFactor": roughness}});
        let fields = material.as_object_mut().expect("an object");
        fields.extend(more.as_object().expect("an object").clone());
        material
    };
    let blend = || json!({"alphaMode": "BLEND"});
    let clear = json!({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.85}}});
    let base64 = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let uri = format!("data:application/octet-stream;base64,{base64}");
    let file = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": bytes.len(), "uri": uri}],
        "bufferViews": views, "accessors": accessors, "meshes": meshes, "nodes": nodes,
        "materials": [
            material([0.7, 0.68, 0.65, 1.0], 0.8, json!({})),
            material([0.8, 0.15, 0.1, 0.45], 0.15, blend()),
            material([0.1, 0.35, 0.8, 0.55], 0.2, blend()),
            material([0.85, 0.95, 0.9, 1.0], 0.1, clear),
        ],
        "extensionsUsed": ["KHR_materials_transmission"],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
        "scenes": [{"nodes": children}], "scene": 0,
    });
    let path = folder.join("room.gltf");
    std::fs::write(&path, file.to_string()).expect("writes");
    path
}

/// Runs `compare` with the words of `line` on the room.
fn run(bench: &mut Bench, room: &Path, line: &str) -> Result<Results, HarnessError> {
    let out = room.parent().expect("a folder").join("out");
    let [room, out] = [room, &out].map(|path| path.to_str().expect("UTF-8"));
    let fixed = ["lightbench", "--scene", room, "--out", out, "--size", "64x36", "--frames", "1"];
    let words = fixed.into_iter().chain(["--warmup", "0"]).chain(line.split(' '));
    let Ok(Invocation::Compare(args)) = parse(words) else { panic!("{line} does not parse") };
    Ok(compare_on(bench, &args, vec![])?.0)
}

/// The families that serve look-ups at any depth.
const ANY_DEPTH: &str = "DC-I G HG None Sphere T-I W W1 ZB";

/// Those that also serve what lies in front of opaque surfaces.
const IN_FRONT: &str = "DA-E DA-I DC-E DC-I G HC HG HalfZ M ModifiedHalfZ None SC-E SC-I Sphere \
                        T-25D T-E T-E1 T-I W W1 ZB";

/// Runs all strategies with layers, checks all records, and returns the families that serve them and
/// those that refuse them, each once.
fn served_and_refused(layers: &str, setting: LayerSetting) -> [Vec<String>; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let room = write_room(folder.path(), true);
    let mut bench = Bench::open(None).expect("an adapter");
    let lights = "--lights 60 --radius-scale 1.5 --spots 0.3 --areas 0.1 --strategies all";
    let line = format!("{lights} --pictures none {layers}");
    let results = run(&mut bench, &room, &line).expect("runs");
    let mut served = Vec::new();
    for record in results.records.iter().filter(|record| record.strategy != "Clay") {
        served.push(record.strategy.family().to_owned());
        let what = format!("{} in {}", record.strategy, record.setting.mode.name());
        assert_eq!(record.setting.layers, Some(setting), "{what}");
        assert_eq!(record.image.differing_channels, Some(0), "{what}");
        assert_eq!(record.lists.missed_pairs, Some(0), "{what}");
        let froxels = if setting.fog_per_m.is_some() { 8 * 5 * 64 } else { 0 };
        assert!(record.lists.layer_samples > Some(froxels + 500), "{what}: {:?}", record.lists);
        check_passes(record, setting.fog_per_m.is_some());
    }
    let refused = results.warnings.iter().filter(|line| line.contains(" was left out: "));
    let refused = refused.inspect(|line| {
        assert!(line.contains("look-ups ") || line.contains("layers over"), "{line}");
    });
    let refused = refused.filter_map(|line| line.split(['/', ' ']).next()).map(str::to_owned);
    [served, refused.collect()].map(|mut families: Vec<String>| {
        families.sort();
        families.dedup();
        families.retain(|family| family != "RasterSphere");
        families
    })
}

/// Checks the passes of layers: their bill, and the mark of figures that rasterisation limits.
fn check_passes(record: &Record, has_fog: bool) {
    for (pass, kind, needs_fog, is_raster) in [
        ("fog-light", PassKind::Shade, true, false),
        ("fog-sum", PassKind::Scene, true, false),
        ("fog-apply", PassKind::Scene, true, true),
        ("blend", PassKind::Shade, false, true),
    ] {
        let what = format!("{pass} of {}", record.strategy);
        let times = record.times.passes.get(pass);
        assert_eq!(
            times.map(|times| times.kind),
            (has_fog || !needs_fog).then_some(kind),
            "{what}"
        );
        assert_eq!(
            is_raster_pass(pass, record.setting.mode, &record.strategy),
            is_raster,
            "{what}"
        );
    }
    assert!(record.raster_passes().contains(&"blend"), "{}", record.strategy);
}

#[test]
fn every_strategy_shows_all_layers_as_no_culling_does_or_refuses_them() {
    let setting = LayerSetting { transparent: true, particles: 40, fog_per_m: Some(0.1) };
    let [served, refused] =
        served_and_refused("--transparent --particles 40 --fog 0.1 --mode both", setting);
    assert_eq!(served.join(" "), ANY_DEPTH);
    let mut expected: Vec<&str> = IN_FRONT.split(' ').collect();
    expected.retain(|family| !served.iter().any(|other| other == family));
    assert_eq!(refused, expected);
}

#[test]
fn more_strategies_show_what_lies_in_front_of_surfaces() {
    let setting = LayerSetting { transparent: true, particles: 40, fog_per_m: None };
    let [served, refused] = served_and_refused("--transparent --particles 40", setting);
    assert_eq!(served.join(" "), IN_FRONT);
    assert!(refused.is_empty(), "{refused:?}");
}

#[test]
fn options_without_effect_and_named_strategies_that_refuse_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bench = Bench::open(None).expect("an adapter");
    let plain = write_room(folder.path(), false);
    let error = run(&mut bench, &plain, "--transparent --lights 5").expect_err("no glass");
    assert!(error.to_string().contains("no material of the scene is transparent"), "{error}");
    let error = run(&mut bench, &plain, "--fog 0.1 --lights 5 --strategies None,SC-E/32x32x16")
        .expect_err("serves only surfaces");
    assert!(error.to_string().contains("look-ups at any depth"), "{error}");
    // Layers do not stay when the next run asks for none.
    let fog = "--lights 5 --strategies None,DC-I/32x32x8 --pictures none";
    let with = run(&mut bench, &plain, &format!("{fog} --fog 0.1")).expect("runs");
    let page = render_table(&with);
    assert!(page.contains("fog-light") && !page.contains("blend"), "{page}");
    let without = run(&mut bench, &plain, fog).expect("runs");
    assert!(with.records[0].times.passes.get("fog-light").is_some());
    assert!(without.records[0].times.passes.get("fog-light").is_none());
    assert_eq!(without.records[0].setting.layers, None);
}
