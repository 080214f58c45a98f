//! The scenes that can be opened by name.

use std::path::Path;

use glam::DVec3;

use crate::{Scene, SceneError, TownSize, atrium, gltf_import::load_gltf_lights, load_gltf, town};

/// A procedural scene.
#[derive(Clone, Copy, Debug)]
pub struct SceneEntry {
    /// Its id, for [`open`].
    pub id: &'static str,
    /// A short description.
    pub summary: &'static str,
    make: fn() -> Scene,
}

/// The seed of procedural scenes opened by name.
const SEED: u64 = 1;

static ENTRIES: &[SceneEntry] = &[
    SceneEntry {
        id: "atrium",
        summary: "two storeys of arcades around a court: marble, stone, cloth, bronze",
        make: || atrium(SEED),
    },
    SceneEntry {
        id: "town",
        summary: "streets of gabled houses, gardens, a square with a church: 7 million triangles",
        make: || town(SEED, TownSize::Full),
    },
    SceneEntry {
        id: "town-small",
        summary: "a corner of the town in coarse detail, for software adapters",
        make: || town(SEED, TownSize::Small),
    },
];

/// All procedural scenes.
pub fn list() -> &'static [SceneEntry] {
    ENTRIES
}

/// Opens the procedural scene with that id, or the glTF file at that path.
///
/// # Errors
///
/// [`SceneError::Unknown`] if the name is not an id and does not end in `.gltf` or `.glb`. For a
/// file, the errors of [`load_gltf`].
pub fn open(name_or_path: &str) -> Result<Scene, SceneError> {
    if let Some(entry) = ENTRIES.iter().find(|entry| entry.id == name_or_path) {
        return Ok((entry.make)());
    }
    match gltf_path(name_or_path) {
        Some(path) => load_gltf(path),
        None => Err(unknown(name_or_path)),
    }
}

/// Opens only the lights of a procedural scene or of a glTF file, as a scene. The file need not
/// hold anything else. World space begins at `origin` of the file. Lights without a range keep an
/// infinite one; [`close_ranges`](crate::close_ranges) chooses it later.
///
/// # Errors
///
/// As for [`open`], except that a scene without triangles is accepted.
pub fn open_lights(name_or_path: &str, origin: DVec3) -> Result<Scene, SceneError> {
    if let Some(path) = gltf_path(name_or_path) {
        return load_gltf_lights(path, origin);
    }
    let mut scene = open(name_or_path)?;
    for light in &mut scene.lights {
        light.position = (light.position.as_dvec3() - origin).as_vec3();
    }
    Ok(scene)
}

/// The path, if the name is that of a glTF file.
fn gltf_path(name_or_path: &str) -> Option<&Path> {
    let path = Path::new(name_or_path);
    let is_one =
        |e: &std::ffi::OsStr| e.eq_ignore_ascii_case("gltf") || e.eq_ignore_ascii_case("glb");
    path.extension().is_some_and(is_one).then_some(path)
}

/// How similar an id must be to be suggested, by Jaro-Winkler.
const NEAR: f64 = 0.7;

fn unknown(name: &str) -> SceneError {
    let ids: Vec<_> = ENTRIES.iter().map(|entry| entry.id).collect();
    let mut near: Vec<_> = ids
        .iter()
        .map(|id| (strsim::jaro_winkler(id, &name.to_lowercase()), *id))
        .filter(|(likeness, _)| *likeness >= NEAR)
        .collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let near: Vec<_> = near.iter().take(3).map(|(_, id)| *id).collect();
    SceneError::Unknown {
        name: name.into(),
        known: ids.join(", "),
        nearest: if near.is_empty() {
            String::new()
        } else {
            format!("; nearest: {}", near.join(", "))
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_names_list_similar_ids() {
        let error = open("Atrum").expect_err("no such scene").to_string();
        assert!(error.contains("nearest: atrium"), "{error}");
        let error = open("xyz").expect_err("no such scene").to_string();
        assert!(error.contains("one of atrium") && !error.contains("nearest"), "{error}");
        let error = open("a\nb\t\u{1b}[1m").expect_err("no such scene").to_string();
        assert!(error.starts_with("scene is \"a\\nb\\t\\u{1b}[1m\""), "{error}");
        assert!(matches!(open("no/such.gltf"), Err(SceneError::Read { .. })));
    }
}
