//! Rewrites JSON that glTF allows and gltf-json refuses, before gltf-json reads it.

use gltf::json::validation::Error as Fault;
use serde_json::{Value, json};

use super::Warnings;

/// Extensions that give a texture an image of another format, and whose format is decoded.
const TEXTURE_SOURCES: &[&str] = &["EXT_texture_webp"];

/// The properties of nodes that an animation channel may move.
const PATHS: &[&str] = &["translation", "rotation", "scale", "weights"];

/// Rewrites the JSON so that gltf-json reads every valid file.
pub(super) fn adapt(json: &mut Value, warnings: &mut Warnings) {
    add_scene_nodes(json);
    drop_channels_without_node(json, warnings);
    add_texture_sources(json);
}

/// Whether a fault that gltf-json finds is none, because glTF allows the field to be missing.
pub(super) fn is_tolerated(field: &str, fault: Fault) -> bool {
    let inside = |list: &str, end: &str| field.starts_with(list) && field.ends_with(end);
    // Accessors without a bufferView are zeros, textures without a source get one from an
    // extension, and primitives without POSITION show nothing. The importer does not read the
    // bounds of POSITION.
    fault == Fault::Missing
        && (inside("accessors[", ".bufferView")
            || inside("textures[", ".source")
            || inside("meshes[", ".attributes[\"POSITION\"]")
            || inside("meshes[", ".attributes[\"POSITION\"].min")
            || inside("meshes[", ".attributes[\"POSITION\"].max"))
}

/// The objects of a list at the root of the file.
fn objects<'a>(
    json: &'a mut Value,
    list: &str,
) -> impl Iterator<Item = &'a mut serde_json::Map<String, Value>> {
    let list = json.get_mut(list).and_then(Value::as_array_mut);
    list.into_iter().flatten().filter_map(Value::as_object_mut)
}

/// Adds empty node lists: a scene may be empty, and Blender writes such scenes.
fn add_scene_nodes(json: &mut Value) {
    for scene in objects(json, "scenes") {
        scene.entry("nodes").or_insert(json!([]));
    }
}

/// Drops channels without a node. They move what an extension names (KHR_animation_pointer), or
/// nothing.
fn drop_channels_without_node(json: &mut Value, warnings: &mut Warnings) {
    let mut dropped = 0;
    for animation in objects(json, "animations") {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else {
            continue;
        };
        let before = channels.len();
        channels.retain(|channel| {
            // gltf-json refuses channels that are malformed.
            let Some(target) = channel.get("target").and_then(Value::as_object) else {
                return true;
            };
            let path = target.get("path").and_then(Value::as_str).unwrap_or_default();
            target.contains_key("node") && PATHS.contains(&path)
        });
        dropped += before - channels.len();
    }
    if dropped > 0 {
        warnings.add(format!(
            "animations: {dropped} channels that move no node are not played \
             (KHR_animation_pointer is not supported)"
        ));
    }
}

/// Gives textures without a `source` the image of an extension that is read.
fn add_texture_sources(json: &mut Value) {
    for texture in objects(json, "textures").filter(|texture| !texture.contains_key("source")) {
        let extension = |name: &&str| texture.get("extensions")?.get(name)?.get("source").cloned();
        if let Some(source) = TEXTURE_SOURCES.iter().find_map(extension) {
            texture.insert("source".into(), source);
        }
    }
}
