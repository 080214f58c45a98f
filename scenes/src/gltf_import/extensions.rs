//! Which extensions are supported, which a file may require anyway, and the warnings about the
//! others.

use std::{collections::BTreeMap, path::Path};

use serde_json::Value;

use super::Warnings;
use crate::SceneError;

/// Extensions that are supported.
const READ: &[&str] = &[
    "EXT_lights_area",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that a file may require although they are not supported. Without them, geometry still
/// stands in its place; only appearance, sound or behaviour differ. The same holds for every
/// extension of materials.
const HARMLESS: &[&str] = &[
    "CESIUM_primitive_outline",
    "EXT_instance_features",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_texture_avif",
    "KHR_animation_pointer",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_texture_dds",
];

fn is_harmless(name: &str) -> bool {
    HARMLESS.contains(&name) || name.contains("_materials_")
}

/// Refuses files that require an extension that is neither supported nor harmless. Warns about
/// every other extension that is not supported, whether the file declares it or only uses it.
pub(super) fn check(path: &Path, json: &Value, warnings: &mut Warnings) -> Result<(), SceneError> {
    let names = |list: &str| {
        let list = json.get(list).and_then(Value::as_array);
        list.into_iter().flatten().filter_map(Value::as_str)
    };
    let is_read = |name: &str| READ.contains(&name);
    if let Some(name) = names("extensionsRequired").find(|n| !is_read(n) && !is_harmless(n)) {
        return Err(SceneError::Extension {
            file: path.into(),
            extension: name.into(),
            supported: READ.join(", "),
        });
    }
    let mut uses = BTreeMap::new();
    for name in names("extensionsUsed").chain(names("extensionsRequired")) {
        uses.insert(name, 0);
    }
    count(json, &mut uses);
    for (name, uses) in uses.iter().filter(|(name, _)| !is_read(name)) {
        let uses = match uses {
            0 => String::new(),
            1 => " (used once)".into(),
            _ => format!(" (used {uses} times)"),
        };
        warnings.add(format!("extension {name} is not supported: what it adds is left out{uses}"));
    }
    Ok(())
}

/// Removes unsupported extensions from the JSON, so that nothing inside them counts as a fault.
/// Those of textures stay, because a warning names them where a texture has no other image.
pub(super) fn strip(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(strip),
        Value::Object(map) => {
            for (key, value) in
                map.iter_mut().filter(|(key, _)| !["extras", "textures"].contains(&key.as_str()))
            {
                if key == "extensions"
                    && let Some(extensions) = value.as_object_mut()
                {
                    extensions.retain(|name, _| READ.contains(&name.as_str()));
                }
                strip(value);
            }
        }
        _ => {}
    }
}

/// Counts the objects that carry each extension.
fn count<'a>(value: &'a Value, uses: &mut BTreeMap<&'a str, u64>) {
    match value {
        Value::Array(list) => list.iter().for_each(|value| count(value, uses)),
        Value::Object(map) => {
            for (key, value) in map.iter().filter(|(key, _)| *key != "extras") {
                if key == "extensions"
                    && let Some(extensions) = value.as_object()
                {
                    for name in extensions.keys() {
                        *uses.entry(name).or_default() += 1;
                    }
                }
                count(value, uses);
            }
        }
        _ => {}
    }
}
