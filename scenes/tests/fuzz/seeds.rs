//! The files from which inputs are made.

use std::{fs, path::Path};

use serde_json::{Value, json};

use crate::made_up::{MadeUp, floats, png};

/// Larger files are not used as seeds, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// The files made here, and those of a folder and its subfolders.
pub(crate) fn all(folder: Option<&Path>) -> Vec<MadeUp> {
    let mut seeds = vec![MadeUp::triangle(), lit(), textured(), shaped(), moving(), extended()];
    if let Some(folder) = folder {
        let made_here = seeds.len();
        read(folder, 3, &mut seeds);
        println!("{} seeds from {}", seeds.len() - made_here, folder.display());
    }
    seeds
}

fn read(folder: &Path, depth: usize, seeds: &mut Vec<MadeUp>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() && depth > 0 {
            read(&path, depth - 1, seeds);
            continue;
        }
        let kind = path.extension().and_then(|e| e.to_str());
        let small = fs::metadata(&path).is_ok_and(|about| about.len() <= MOST_BYTES);
        if matches!(kind, Some("gltf" | "glb")) && small {
            seeds.extend(fs::read(&path).ok().and_then(|bytes| open(&bytes)));
        }
    }
}

/// A file's JSON and its first buffer.
fn open(bytes: &[u8]) -> Option<MadeUp> {
    if bytes.starts_with(b"glTF") {
        let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
        let json = serde_json::from_slice(bytes.get(20..20 + length)?).ok()?;
        let binary = bytes.get(28 + length..).unwrap_or_default().to_vec();
        return Some(MadeUp { json, binary });
    }
    let json: Value = serde_json::from_slice(bytes).ok()?;
    let uri = json.pointer("/buffers/0/uri").and_then(Value::as_str).unwrap_or_default();
    let data = uri.split_once("base64,").map_or("", |(_, data)| data);
    let binary = base64::Engine::decode(&base64::prelude::BASE64_STANDARD, data).ok()?;
    Some(MadeUp { json, binary })
}

/// Every kind of light and camera.
fn lit() -> MadeUp {
    let mut file = MadeUp::triangle();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "name": "p", "intensity": 8.0, "range": 3.0, "color": [1.0, 0.5, 0.2]},
        {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}},
        {"type": "directional", "intensity": 2.0}]}});
    file.json["cameras"] = json!([
        {"type": "perspective", "name": "c", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 90.0, "aspectRatio": 1.5}},
        {"type": "orthographic", "orthographic": {"xmag": 2.0, "ymag": 1.0, "znear": 0.1, "zfar": 50.0}}]);
    for light in 0..3 {
        file.push(
            "nodes",
            json!({"translation": [0.0, 1.0, light],
            "extensions": {"KHR_lights_punctual": {"light": light}}}),
        );
    }
    file.push("nodes", json!({"camera": 0, "rotation": [0.0, 0.0, 0.0, 1.0], "children": [5]}));
    file.push("nodes", json!({"camera": 1, "scale": [1.0, 2.0, -1.0]}));
    file.push(
        "nodes",
        json!({"extras": {"lightbench_area_light":
        {"shape": "rectangle", "width": 1.0, "height": 2.0, "intensity": 8.0, "two_sided": true}}}),
    );
    file.push(
        "nodes",
        json!({"extras": {"lightbench_area_light":
        {"shape": "polygon", "vertices": [[0, 0, 1], [1, 0, 1], [0, 1, 1]], "range": 4.0}}}),
    );
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4, 6, 7]);
    file
}

fn encoded(image: &image::DynamicImage, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).expect("encodes");
    bytes.into_inner()
}

/// Images of every depth, in views and beside the file, with samplers and transforms.
fn textured() -> MadeUp {
    use image::{
        DynamicImage,
        ImageFormat::{Jpeg, Png},
    };
    let mut file = MadeUp::triangle();
    let images = [
        (encoded(&DynamicImage::new_rgb8(4, 4), Jpeg), "image/jpeg"),
        (encoded(&DynamicImage::new_rgba16(3, 5), Png), "image/png"),
        (encoded(&DynamicImage::new_luma8(8, 2), Png), "image/png"),
        (encoded(&DynamicImage::new_luma_a16(2, 2), Png), "image/png"),
        (png(), "image/png"),
    ];
    for (bytes, kind) in &images {
        let view = file.view(bytes);
        file.textured(json!({"bufferView": view, "mimeType": kind}));
    }
    file.textured(json!({"uri": "part.png", "name": "beside"}));
    file.json["samplers"] =
        json!([{"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648}]);
    file.json["textures"][0]["sampler"] = 0.into();
    file.json["materials"][1] = json!({"name": "m", "alphaMode": "MASK", "alphaCutoff": 0.3, "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.5, 0.5, 1.0], "metallicFactor": 0.5,
            "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
                {"offset": [0.1, 0.2], "rotation": 0.5, "scale": [2.0, 2.0], "texCoord": 0}}},
            "metallicRoughnessTexture": {"index": 1}},
        "normalTexture": {"index": 2, "scale": 0.5}, "emissiveTexture": {"index": 3},
        "emissiveFactor": [1.0, 1.0, 1.0], "occlusionTexture": {"index": 4},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3.0},
            "KHR_materials_ior": {"ior": 1.4}, "KHR_materials_unlit": {}}});
    file.json["materials"][2]["alphaMode"] = "BLEND".into();
    file
}

/// Primitives of every mode, component type and layout, sparse accessors, several scenes.
fn shaped() -> MadeUp {
    let mut file = MadeUp::triangle();
    let square = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let positions = file.accessor(&square, 4, 5126, "VEC3");
    let bytes = file.accessor(&[0, 1, 2, 3], 4, 5121, "SCALAR");
    let words: Vec<u8> = [0_u32, 1, 2, 2, 1, 3].iter().flat_map(|ix| ix.to_le_bytes()).collect();
    let words = file.accessor(&words, 6, 5125, "SCALAR");
    let colors = file.accessor(&[255; 16], 4, 5121, "VEC4");
    file.json["accessors"][colors]["normalized"] = true.into();
    let small =
        file.accessor(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0, 127, 127, 0, 0], 4, 5120, "VEC3");
    file.json["bufferViews"][7 + 1]["byteStride"] = 4.into();
    let (at, with) = (file.view(&[1, 3]), file.view(&floats(&[2.0, 0.0, 0.0, 2.0, 2.0, 0.0])));
    let sparse = file.push(
        "accessors",
        json!({"count": 4, "componentType": 5126, "type": "VEC3",
        "bufferView": 4, "min": [0, 0, 0], "max": [2, 2, 0], "sparse": {"count": 2,
        "indices": {"bufferView": at, "componentType": 5121}, "values": {"bufferView": with}}}),
    );
    let primitives: Vec<Value> = (0..7)
        .map(|mode| json!({"attributes": {"POSITION": positions, "COLOR_0": colors}, "mode": mode, "indices": bytes}))
        .chain([
            json!({"attributes": {"POSITION": sparse}, "indices": words}),
            json!({"attributes": {"POSITION": small}, "indices": words, "targets": [{"POSITION": positions}]}),
        ])
        .collect();
    file.push("meshes", json!({"name": "all modes", "primitives": primitives, "weights": [0.5]}));
    file.push("nodes", json!({"mesh": 1, "name": "n",
        "matrix": [2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 1.0]}));
    file.json["scenes"] = json!([{"nodes": [0, 1]}, {"name": "second", "nodes": [1]}]);
    file
}

/// Animated cameras of every interpolation, and a skin.
fn moving() -> MadeUp {
    let mut file = lit();
    let keys = file.accessor(&floats(&[0.0, 2.0]), 2, 5126, "SCALAR");
    let places = file.accessor(&floats(&[0.0, 0.0, 5.0, 4.0, 0.0, 5.0]), 2, 5126, "VEC3");
    let turns = file.accessor(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]), 2, 5126, "VEC4");
    let splines = file.accessor(&floats(&[1.0; 18]), 6, 5126, "VEC3");
    let bound = file.accessor(
        &floats(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
        1,
        5126,
        "MAT4",
    );
    file.json["skins"] = json!([{"joints": [0], "inverseBindMatrices": bound}]);
    file.json["nodes"][0]["skin"] = 0.into();
    file.json["animations"] = json!([{
        "samplers": [{"input": keys, "output": places, "interpolation": "LINEAR"},
            {"input": keys, "output": turns, "interpolation": "STEP"},
            {"input": keys, "output": splines, "interpolation": "CUBICSPLINE"}],
        "channels": [{"sampler": 0, "target": {"node": 4, "path": "translation"}},
            {"sampler": 1, "target": {"node": 4, "path": "rotation"}},
            {"sampler": 2, "target": {"node": 4, "path": "scale"}}]}]);
    file
}

/// Extensions of nodes, textures, accessors and materials.
fn extended() -> MadeUp {
    let mut file = textured();
    let places =
        file.accessor(&floats(&[-3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0]), 3, 5126, "VEC3");
    file.json["extensionsUsed"] = json!([
        "EXT_mesh_gpu_instancing",
        "KHR_node_visibility",
        "EXT_lights_area",
        "EXT_texture_webp",
        "KHR_texture_basisu",
        "KHR_materials_specular",
        "KHR_materials_variants",
        "KHR_xmp"
    ]);
    file.json["extensions"] = json!({"EXT_lights_area": {"lights": [
        {"type": "rect", "size": 2.0, "rect": {"aspect": 0.5}, "intensity": 5.0}]}});
    file.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}},
        "KHR_node_visibility": {"visible": true}});
    file.push("nodes", json!({"extensions": {"EXT_lights_area": {"light": 0}}}));
    let last = file.list("nodes").len() - 1;
    file.json["scenes"][0]["nodes"].as_array_mut().expect("nodes").push(last.into());
    file.json["textures"][1] =
        json!({"source": 1, "extensions": {"EXT_texture_webp": {"source": 0}}});
    file.json["materials"][3]["extensions"] = json!({"KHR_materials_specular": {"specularFactor": 0.5},
        "KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_clearcoat": {}});
    file
}
