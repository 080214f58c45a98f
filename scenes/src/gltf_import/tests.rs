mod area_lights;
mod cameras;
mod compressed;
mod light_animation;
mod materials;
mod placing;
mod valid;

use std::path::PathBuf;

use assign::LightShape;
use base64::Engine;
use glam::Vec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};

mod lights;

use super::load_gltf;
use crate::{Encoding, Scene, SceneError};

/// A quad of two triangles, indexed, with normals and uv; one textured material with a normal
/// map; a mirrored and a plain instance; a spot light; an animated camera.
#[derive(Clone)]
struct Sample {
    json: Value,
    binary: Vec<u8>,
}

const POSITIONS: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn sample() -> Sample {
    let mut binary = Vec::new();
    let mut views = Vec::new();
    let mut push = |bytes: &[u8]| {
        views.push(json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len()}));
        binary.extend_from_slice(bytes);
        binary.resize(binary.len().next_multiple_of(4), 0);
    };
    let floats =
        |values: &[f32]| -> Vec<u8> { values.iter().flat_map(|v| v.to_le_bytes()).collect() };
    push(&floats(POSITIONS.as_flattened()));
    push(&floats([[0.0, 0.0, 1.0]; 4].as_flattened()));
    push(&floats(&[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
    push(&[0_u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes).concat());
    push(&floats(&[0.0, 2.0]));
    push(&floats(&[0.0, 0.0, 5.0, 4.0, 0.0, 5.0]));
    push(&png());
    let length = binary.len();
    let accessor = |view: u32, count: u32, component: u32, kind: &str| {
        json!({"bufferView": view, "count": count, "componentType": component, "type": kind,
            "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0]})
    };
    let json = json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensionsRequired": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 8.0, "color": [1.0, 0.5, 0.25], "spot": {"outerConeAngle": 0.5}}]}},
        "buffers": [{"byteLength": length}],
        "bufferViews": views,
        "accessors": [accessor(0, 4, 5126, "VEC3"), accessor(1, 4, 5126, "VEC3"),
            accessor(2, 4, 5126, "VEC2"), accessor(3, 6, 5123, "SCALAR"),
            accessor(4, 2, 5126, "SCALAR"), accessor(5, 2, 5126, "VEC3")],
        "images": [{"bufferView": 6, "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0},
            "emissiveFactor": [1.0, 1.0, 1.0],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3.0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2},
            "indices": 3, "material": 0}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}],
        "nodes": [{"mesh": 0, "children": [1, 2]}, {"mesh": 0, "scale": [-1.0, 2.0, 1.0]},
            {"translation": [0.0, 0.0, 3.0], "scale": [5.0, 5.0, 5.0],
             "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"camera": 0}],
        "scenes": [{"nodes": [0, 3]}],
        "animations": [{"samplers": [{"input": 4, "output": 5}],
            "channels": [{"sampler": 0, "target": {"node": 3, "path": "translation"}}]}],
    });
    Sample { json, binary }
}

fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([255, 128, 0, 255]));
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("encodes");
    bytes.into_inner()
}

fn glb(sample: &Sample) -> Vec<u8> {
    let mut json = sample.json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    let length = 28 + json.len() + sample.binary.len();
    bytes.extend((length as u32).to_le_bytes());
    for (kind, data) in [(b"JSON", &json), (b"BIN\0", &sample.binary)] {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    }
    bytes
}

fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("writes");
    load_gltf(&path)
}

fn load(sample: &Sample) -> Result<Scene, SceneError> {
    load_bytes("sample.glb", &glb(sample))
}

/// Loads after setting a JSON field, and returns the error.
fn error_with(pointer: &str, value: Value) -> String {
    let mut sample = sample();
    *sample.json.pointer_mut(pointer).expect("a field of the sample") = value;
    load(&sample).expect_err(pointer).to_string()
}

#[test]
fn the_sample_loads_whole() {
    let scene = load(&sample()).expect("valid");
    assert_eq!((scene.meshes.len(), scene.models.len(), scene.triangle_count()), (1, 2, 4));
    assert!(!scene.models[0].is_mirrored() && scene.models[1].is_mirrored());
    assert!(scene.world_triangles().all(|[a, b, c]| (b - a).cross(c - a).z > 0.0));
    assert_eq!(scene.bounds.min, Vec3::new(-1.0, 0.0, 0.0));
    assert_eq!(scene.bounds.max, Vec3::new(1.0, 2.0, 0.0));
    let encodings: Vec<_> = scene.images.iter().map(|i| i.encoding).collect();
    assert_eq!(encodings, [Encoding::Srgb, Encoding::Linear]);
    assert_eq!(scene.images[0].rgba[..4], [255, 128, 0, 255]);
    assert_eq!(scene.materials[0].emissive, Vec3::splat(3.0));
    // u grows along +x and v down, so the bitangent cross(n, t) w is +y.
    for vertex in &scene.meshes[0].vertices {
        assert_eq!(vertex.tangent, [1.0, 0.0, 0.0, 1.0]);
    }
    let light = scene.lights[0];
    assert_eq!(light.position, Vec3::Z * 3.0);
    assert_eq!((light.range_m, light.intensity.x), (20.0, 8.0));
    assert!(matches!(light.shape, LightShape::Spot { direction, .. } if direction == Vec3::NEG_Z));
}

#[test]
fn animated_cameras_become_the_path() {
    let scene = load(&sample()).expect("valid");
    assert!(scene.path.is_animation());
    assert_eq!(scene.path.pose(0, 3).eye, Vec3::new(0.0, 0.0, 5.0));
    assert_eq!(scene.path.pose(1, 3).eye, Vec3::new(2.0, 0.0, 5.0));
    assert_eq!(scene.path.pose(2, 3).eye, Vec3::new(4.0, 0.0, 5.0));
    let scaled = scene.scaled(2.0).expect("in range");
    assert_eq!(scaled.path.pose(2, 3).eye, Vec3::new(8.0, 0.0, 10.0));
    assert_eq!((scaled.lights[0].range_m, scaled.lights[0].intensity.x), (40.0, 32.0));
    assert_eq!(scaled.bounds.max, Vec3::new(2.0, 4.0, 0.0));
    assert!(scaled.scaled(f64::NAN).is_err());
}

#[test]
fn external_and_embedded_files_load_alike() {
    let mut sample = sample();
    let hash = load(&sample).expect("valid").hash();
    let base64 = base64::engine::general_purpose::STANDARD.encode(&sample.binary);
    sample.json["buffers"][0]["uri"] =
        format!("data:application/octet-stream;base64,{base64}").into();
    let embedded = load_bytes("s.gltf", sample.json.to_string().as_bytes()).expect("valid");
    assert_eq!(embedded.hash(), hash);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path: PathBuf = folder.path().join("scene.gltf");
    sample.json["buffers"][0]["uri"] = "the%20data.bin".into();
    std::fs::write(folder.path().join("the data.bin"), &sample.binary).expect("writes");
    std::fs::write(&path, sample.json.to_string()).expect("writes");
    let external = load_gltf(&path).expect("valid");
    assert_eq!(external.hash(), hash);
    assert_eq!(Some(external.name.as_str()), folder.path().file_name().and_then(|n| n.to_str()));
}

#[test]
fn missing_normals_indices_and_materials_are_filled_in() {
    let mut sample = sample();
    let attributes = json!({"POSITION": 0});
    sample.json["meshes"][0]["primitives"] = json!([
        {"attributes": attributes, "mode": 5}, {"attributes": attributes, "mode": 6},
        {"attributes": attributes, "mode": 1}]);
    let scene = load(&sample).expect("valid");
    assert_eq!((scene.meshes.len(), scene.meshes[0].triangle_count()), (2, 2));
    let normals = scene.meshes[1].vertices.iter().map(|v| v.normal);
    assert!(normals.into_iter().all(|n| n == [0.0, 0.0, 1.0]));
    let material = &scene.materials[scene.meshes[0].material as usize];
    assert_eq!((material.metallic, material.roughness), (1.0, 1.0));
    assert!(scene.warnings.iter().any(|w| w.contains("primitives of type Lines are not drawn")));
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut sample = sample();
    let (at, with) = (sample.binary.len(), sample.binary.len() + 4);
    sample.binary.extend([2, 0, 0, 0]);
    sample.binary.extend([5.0_f32, 6.0, 0.0].iter().flat_map(|v| v.to_le_bytes()));
    let views = sample.json["bufferViews"].as_array_mut().expect("views");
    views.push(json!({"buffer": 0, "byteOffset": at, "byteLength": 4}));
    views.push(json!({"buffer": 0, "byteOffset": with, "byteLength": 12}));
    sample.json["buffers"][0]["byteLength"] = sample.binary.len().into();
    sample.json["accessors"][0]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": 7, "componentType": 5121}, "values": {"bufferView": 8}});
    let scene = load(&sample).expect("valid");
    assert_eq!(scene.meshes[0].bounds.max, Vec3::new(5.0, 6.0, 0.0));
    sample.binary[at] = 9;
    assert!(load(&sample).expect_err("index 9 of 4").to_string().contains("below 4"));
}

#[test]
fn errors_name_field_value_and_what_is_accepted() {
    let cases = [
        ("/extensionsRequired", json!(["EXT_unheard_of"]), "EXT_unheard_of"),
        ("/accessors/0/count", json!(400), "400 elements of 12 bytes"),
        ("/accessors/0/count", json!(0), "1 to 4294967295"),
        ("/accessors/0/count", json!(u64::MAX), "1 to 4294967295"),
        ("/accessors/0/type", json!("VEC2"), "accessors[0].type is VEC2: it must be VEC3"),
        ("/accessors/3/componentType", json!(5126), "5121, 5123 or 5125"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "inside its buffer"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "inside its buffer"),
        ("/bufferViews/0/buffer", json!(7), "bufferViews[0].buffer"),
        ("/buffers/0/byteLength", json!(99_999), "buffers[0].byteLength is 99999"),
        ("/images/0/bufferView", json!(0), "does not decode"),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(77),
            "POSITION is 77: it must be below 6",
        ),
        ("/nodes/1", json!({"mesh": 0, "children": [0]}), "reached twice"),
        ("/nodes/1/mesh", json!(9), "nodes[1].mesh"),
        ("/scenes/0/nodes", json!([3]), "0 triangles"),
        ("/asset", json!({"version": 3}), "asset.version is 3: it must be a string"),
        ("/asset", json!({}), "malformed"),
        ("/asset/version", json!("1.0"), "asset.version is \"1.0\": it must be \"2.0\" or"),
        ("/asset/version", json!("3.0"), "asset.version is \"3.0\": it must be"),
        ("/asset/version", json!("2"), "asset.version is \"2\": it must be"),
        ("/asset/version", json!("2.0\n"), "asset.version is \"2.0\\n\": it must be"),
        ("/asset", json!({"version": "2.1", "minVersion": "2.1"}), "asset.minVersion is \"2.1\""),
        ("/asset", json!({"version": "2.0", "minVersion": "x"}), "asset.minVersion is \"x\""),
        (
            "/extensionsRequired",
            json!(["EXT\nodd"]),
            "extensionsRequired is EXT\\nodd: it must be one of",
        ),
        ("/buffers/0", json!({"byteLength": 4, "uri": ""}), "buffers[0].uri is \"\": it must"),
        ("/buffers/0", json!({"byteLength": 4, "uri": "gone%0A.bin"}), "buffers[0].uri names"),
        ("/images/0", json!({"uri": ""}), "images[0].uri is \"\": it must be a data URI"),
        ("/images/0", json!({"uri": "gone.png"}), "images[0].uri names"),
        ("/images/0", json!({"uri": "data:\n,x"}), "images[0] (data:\\n,x) does not decode"),
    ];
    for (pointer, value, expected) in cases {
        let error = error_with(pointer, value);
        assert!(error.contains(expected), "{pointer}: {error}");
        assert!(!error.contains('\n') && error.contains("sample.glb: "), "{error}");
    }
}

#[test]
fn bad_indices_and_positions_are_named() {
    let mut bad = sample();
    let at = bad.json["bufferViews"][3]["byteOffset"].as_u64().expect("an offset") as usize;
    bad.binary[at] = 200;
    let error = load(&bad).expect_err("index 200 of 4").to_string();
    assert!(error.contains("indices is 200: it must be below 4"), "{error}");
    let mut bad = sample();
    bad.binary[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = load(&bad).expect_err("NaN").to_string();
    assert!(error.contains("POSITION (accessors[0]) element 0 is NaN"), "{error}");
    assert!(matches!(load_bytes("empty.glb", b""), Err(SceneError::Invalid { .. })));
}

#[test]
fn errors_name_the_version_of_other_versions() {
    let old = json!({"asset": {"version": "1.0"}, "meshes": {"mesh": {"primitives": []}}});
    let error = load_bytes("old.gltf", old.to_string().as_bytes()).expect_err("glTF 1.0");
    assert!(error.to_string().contains("asset.version is \"1.0\""), "{error}");
    let mut newer = sample();
    newer.json["asset"] = json!({"version": "2.7", "minVersion": "2.0"});
    load(&newer).expect("any glTF 2 that 2.0 is enough for");
}

#[test]
fn missing_parts_name_the_scene_the_field_and_the_part() {
    let mut sample = sample();
    sample.json["buffers"][0]["uri"] = "gone.bin".into();
    let error = load(&sample).expect_err("no such buffer").to_string();
    for part in ["sample.glb: buffers[0].uri names ", "gone.bin, which cannot be read: No such"] {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn faults_in_extensions_are_named_as_in_the_file() {
    let mut sample = sample();
    sample.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "laser".into();
    let error = load(&sample).expect_err("no such light").to_string();
    assert!(error.contains("extensions.KHR_lights_punctual.lights[0].type"), "{error}");
}

/// A mesh of 100,000 triangles that as many nodes place.
fn heavy(nodes: usize) -> Sample {
    let mut sample = sample();
    let offset = sample.binary.len();
    // All triangles differ, because repeats are left out.
    let corners = (0..300_000).flat_map(|ix| [ix as f32, (ix % 3) as f32, (ix % 2) as f32]);
    sample.binary.extend(corners.flat_map(f32::to_le_bytes));
    sample.json["buffers"][0]["byteLength"] = sample.binary.len().into();
    let views = sample.json["bufferViews"].as_array_mut().expect("views");
    views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": 3_600_000}));
    let accessors = sample.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"bufferView": 7, "count": 300_000, "componentType": 5126,
        "type": "VEC3", "min": [0.0, 0.0, 0.0], "max": [3e5, 2.0, 1.0]}));
    sample.json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 6}});
    sample.json["materials"][0]["normalTexture"] = json!(null);
    sample.json["nodes"] = (0..nodes).map(|_| json!({"mesh": 0})).collect();
    sample.json["scenes"][0]["nodes"] = (0..nodes).collect();
    sample.json["animations"] = json!([]);
    sample
}

#[test]
fn too_many_triangles_are_refused() {
    let error = load(&heavy(20_000)).expect_err("too many").to_string();
    let expected = "is 2000000000: it must be at most 200000000";
    assert!(error.contains("sample.glb: scene triangles") && error.ends_with(expected), "{error}");
    let mut shared = heavy(1);
    let primitive = shared.json["meshes"][0]["primitives"][0].clone();
    shared.json["meshes"][0]["primitives"] = (0..1000).map(|_| primitive.clone()).collect();
    let error = load(&shared).expect_err("too many").to_string();
    assert!(error.ends_with("is 300000000: it must be at most 134217728"), "{error}");
}

/// Truncations, flipped bytes and replaced JSON values give an error or a scene, never a panic.
#[test]
fn damaged_files_never_panic() {
    let whole = sample();
    let bytes = glb(&whole);
    // Damage reaches past the header, but is light enough that some of it is noticed late.
    let (mut loaded, mut refused) = (0, 0);
    let mut count = |result: Result<Scene, SceneError>| match result {
        Ok(_) => loaded += 1,
        Err(_) => refused += 1,
    };
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    for _ in 0..150 {
        count(load_bytes("cut.glb", &bytes[..rng.random_range(0..bytes.len())]));
    }
    for _ in 0..1500 {
        let mut bytes = bytes.clone();
        for _ in 0..rng.random_range(1..4) {
            let at = rng.random_range(0..bytes.len());
            bytes[at] = rng.random();
        }
        count(load_bytes("flipped.glb", &bytes));
    }
    let mut pointers = Vec::new();
    leaves(&whole.json, String::new(), &mut pointers);
    for pointer in &pointers {
        for value in odd_values() {
            let mut json = whole.json.clone();
            *json.pointer_mut(pointer).expect("a leaf") = value;
            let damaged = Sample { json, binary: whole.binary.clone() };
            count(load(&damaged));
        }
    }
    assert!(loaded > 20 && refused > 20, "{loaded} loaded, {refused} refused");
}

fn odd_values() -> impl Iterator<Item = Value> {
    let numbers = [json!(0), json!(1), json!(-1), json!(7), json!(4_000_000_000_u32)];
    let large = [json!(u64::MAX), json!(1e30), json!(1e300), json!(5125), json!(5120)];
    numbers.into_iter().chain(large).chain([json!("x"), json!(null), json!([]), json!({})])
}

fn leaves(value: &Value, at: String, out: &mut Vec<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(k, v)| leaves(v, format!("{at}/{k}"), out)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(k, v)| leaves(v, format!("{at}/{k}"), out));
        }
        _ => out.push(at),
    }
}
