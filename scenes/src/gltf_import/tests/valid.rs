//! Tests of files that glTF allows and that other readers refuse or draw wrongly.

use super::*;

/// Asserts that a warning contains a text.
pub(super) fn assert_warns(scene: &Scene, text: &str) {
    assert!(scene.warnings.iter().any(|w| w.contains(text)), "{text}: {:?}", scene.warnings);
}

/// Adds bytes as a buffer view and returns its index.
pub(super) fn add_view(sample: &mut Sample, bytes: &[u8]) -> usize {
    let offset = sample.binary.len();
    sample.binary.extend(bytes);
    sample.binary.resize(sample.binary.len().next_multiple_of(4), 0);
    sample.json["buffers"][0]["byteLength"] = sample.binary.len().into();
    let views = sample.json["bufferViews"].as_array_mut().expect("views");
    views.push(json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}));
    views.len() - 1
}

/// Adds an accessor over bytes of its own and returns its index.
pub(super) fn add_accessor(sample: &mut Sample, bytes: &[u8], mut accessor: Value) -> usize {
    accessor["bufferView"] = add_view(sample, bytes).into();
    let accessors = sample.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(accessor);
    accessors.len() - 1
}

/// Adds an accessor of floats.
pub(super) fn add_floats(sample: &mut Sample, values: &[f32], kind: &str) -> usize {
    let width = match kind {
        "SCALAR" => 1,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 16,
    };
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let count = values.len() / width;
    add_accessor(sample, &bytes, json!({"componentType": 5126, "type": kind, "count": count}))
}

#[test]
fn optional_fields_may_be_missing() {
    let pointer = json!({"sampler": 0, "target": {"path": "pointer", "extensions":
        {"KHR_animation_pointer": {"pointer": "/nodes/2/scale"}}}});
    let cases = [
        ("/animations/0/channels/0", pointer, "1 channels that move no node"),
        (
            "/animations/0/channels/0",
            json!({"sampler": 0, "target": {"path": "translation"}}),
            "1 channels that move no node",
        ),
        ("/scenes", json!([{"nodes": [0, 3]}, {"name": "empty"}]), ""),
        ("/textures/0", json!({}), "texture 0 has no image of a supported format (none)"),
        (
            "/textures/0",
            json!({"extensions": {"EXT_texture_odd": {"source": 0}}}),
            "texture 0 has no image of a supported format (EXT_texture_odd)",
        ),
        ("/accessors/2", json!({"count": 4, "componentType": 5126, "type": "VEC2"}), ""),
        ("/accessors/0/min", json!(null), ""),
        (
            "/meshes/0/primitives",
            json!([{"attributes": {"NORMAL": 1}},
                {"attributes": {"POSITION": 0}, "indices": 3, "material": 0}]),
            "mesh \"mesh 0.0\" has no POSITION",
        ),
        (
            "/extensionsRequired",
            json!(["KHR_materials_sheen"]),
            "KHR_materials_sheen is not supported",
        ),
        ("/extensionsUsed", json!(["EXT_lights_image_based"]), "EXT_lights_image_based"),
        (
            "/nodes/3",
            json!({"camera": 0, "extensions": {"EXT_undeclared": {"x": 1}}}),
            "EXT_undeclared is not supported: what it adds is left out (used once)",
        ),
    ];
    for (pointer, value, warning) in cases {
        let mut sample = sample();
        *sample.json.pointer_mut(pointer).expect(pointer) = value;
        let scene = load(&sample).expect(pointer);
        assert_eq!(scene.triangle_count(), 4, "{pointer}");
        if warning.is_empty() {
            assert!(scene.warnings.is_empty(), "{pointer}: {:?}", scene.warnings);
        } else {
            assert_warns(&scene, warning);
        }
    }
    let mut without = sample();
    without.json["accessors"][2].as_object_mut().expect("an accessor").remove("bufferView");
    let scene = load(&without).expect("zeros");
    assert!(scene.meshes[0].vertices.iter().all(|v| v.uv == [0.0; 2]));
}

#[test]
fn extensions_that_move_geometry_are_refused_where_required() {
    for name in ["EXT_unheard_of", "KHR_gaussian_splatting"] {
        let error = error_with("/extensionsRequired", json!([name]));
        assert!(error.contains(name), "{error}");
    }
}

#[test]
fn glb_chunks_of_other_types_are_passed_over() {
    let whole = sample();
    let bytes = glb(&whole);
    let hash = load_bytes("a.glb", &bytes).expect("valid").hash();
    let json = u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize;
    let chunk = [4_u32.to_le_bytes(), *b"ODD\0", [1, 2, 3, 4]].concat();
    for at in [20 + json, bytes.len()] {
        let mut longer = bytes.clone();
        longer.splice(at..at, chunk.iter().copied());
        let length = longer.len() as u32;
        longer[8..12].copy_from_slice(&length.to_le_bytes());
        assert_eq!(load_bytes("odd.glb", &longer).expect("valid").hash(), hash);
    }
}

#[test]
fn base64_needs_no_padding() {
    let mut sample = sample();
    // One byte more than needed, so that padding would be required.
    sample.binary.resize(sample.binary.len().next_multiple_of(3) + 1, 0);
    let hash = load(&sample).expect("valid").hash();
    let base64 = base64::engine::general_purpose::STANDARD.encode(&sample.binary);
    let bare = base64.trim_end_matches('=');
    assert_ne!(base64, bare);
    for body in [bare.to_owned(), base64.replace('=', "%3D")] {
        sample.json["buffers"][0]["uri"] =
            format!("data:application/octet-stream;base64,{body}").into();
        let scene = load_bytes("s.gltf", sample.json.to_string().as_bytes()).expect("valid");
        assert_eq!(scene.hash(), hash);
    }
}

/// In the sample, node 1 mirrors its mesh and node 2 holds the spot.
#[test]
fn scales_of_zero_flatten_and_keep_directions() {
    for (scale, triangles) in [([1.0, 1.0, 0.0], 4), ([0.0, 0.0, 1.0], 2), ([0.0; 3], 2)] {
        let mut flat = sample();
        flat.json["nodes"][1]["scale"] = json!(scale);
        let scene = load(&flat).expect("valid");
        assert_eq!(scene.triangle_count(), triangles, "{scale:?}");
        if triangles == 2 {
            assert_warns(&scene, "is scaled to a line or a point");
        }
    }
    let turn = |sample: &mut Sample, node: Value| {
        sample.json["nodes"][2] = node;
        sample.json["nodes"][2]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    };
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // A quarter turn about X, so that -Z looks down: as parts, and as a matrix of scale 0.
    let rotation = json!([-half, 0.0, 0.0, half]);
    for scale in [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 2.0]] {
        let mut spot = sample();
        turn(&mut spot, json!({"rotation": rotation, "scale": scale}));
        let LightShape::Spot { direction, .. } = load(&spot).expect("valid").lights[0].shape else {
            panic!("no spot");
        };
        assert!((direction - Vec3::NEG_Y).length() < 1e-6, "{scale:?}: {direction}");
    }
    let flat_z: [f32; 16] =
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut spot = sample();
    turn(&mut spot, json!({"matrix": flat_z}));
    let LightShape::Spot { direction, .. } = load(&spot).expect("valid").lights[0].shape else {
        panic!("no spot");
    };
    assert_eq!(direction, Vec3::NEG_Y);
}

#[test]
fn files_with_only_lights_give_their_lights() {
    let lights = json!({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"translation": [0, 3, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 60}]}},
        "extensionsUsed": ["KHR_lights_punctual", "EXT_odd"]});
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("lights.gltf");
    std::fs::write(&path, lights.to_string()).expect("writes");
    let name = path.to_string_lossy();
    let scene = crate::open_lights(&name, glam::DVec3::ZERO)
        .expect("lights")
        .scaled(2.0)
        .expect("in range");
    assert_eq!(scene.lights.len(), 1);
    assert_eq!(scene.lights[0].position, Vec3::Y * 6.0);
    assert_warns(&scene, "EXT_odd");
    assert!(matches!(crate::open(&name), Err(SceneError::Empty { .. })));
    assert_eq!(
        crate::open_lights("atrium", glam::DVec3::ZERO).expect("known").lights,
        crate::atrium(1).lights
    );
}

#[test]
fn animations_of_drawn_nodes_are_named() {
    let moved = |node: usize| {
        let mut sample = sample();
        sample.json["animations"][0]["channels"][0]["target"]["node"] = node.into();
        load(&sample).expect("valid")
    };
    assert!(moved(3).warnings.is_empty());
    assert!(moved(2).warnings.is_empty() && moved(2).light_animation.is_some());
    assert_warns(&moved(1), "1 animated nodes stay at rest; the first is \"node 1\"");
    assert_warns(&moved(0), "the first is \"node 0\"");
}

/// An unsupported extension may contain anything without being a fault.
#[test]
fn unsupported_extensions_cannot_be_faulty() {
    let mut sample = sample();
    sample.json["materials"][0]["extensions"] =
        json!({"KHR_materials_volume": {"thicknessFactor": "inf"}, "KHR_materials_clearcoat": 7});
    sample.json["extensionsUsed"] = json!(["KHR_materials_volume", "KHR_materials_clearcoat"]);
    let scene = load(&sample).expect("valid");
    for name in ["KHR_materials_volume", "KHR_materials_clearcoat"] {
        assert!(scene.warnings.iter().any(|line| line.contains(name)), "{:?}", scene.warnings);
    }
}
