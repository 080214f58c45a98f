//! The scenes that can be opened by name.

use std::path::Path;

use glam::DVec3;

use crate::{
    Scene, SceneError, TownSize, atrium, gltf_import::load_gltf_lights, load_gltf, stability, town,
};

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

/// Opens the procedural scene with that id, the stability scenario with that id
/// ([`stability`](crate::stability)), or the glTF file at that path.
///
/// # Errors
///
/// [`SceneError::Unknown`] if the name is not an id and does not end in `.gltf` or `.glb`,
/// [`SceneError::Move`] if a scenario does not move as its id asks. For a file, the errors of
/// [`load_gltf`].
pub fn open(name_or_path: &str) -> Result<Scene, SceneError> {
    open_seeded(name_or_path, SEED)
}

/// As [`open`], with a seed for stability scenarios. [`open`] takes the seed 1. Other scenes are the same with every seed.
///
/// # Errors
///
/// As for [`open`].
pub fn open_seeded(name_or_path: &str, seed: u64) -> Result<Scene, SceneError> {
    if let Some(entry) = ENTRIES.iter().find(|entry| entry.id == name_or_path) {
        return Ok((entry.make)());
    }
    if name_or_path.starts_with(stability::PREFIX) {
        return stability::open(name_or_path, seed)?.ok_or_else(|| unknown(name_or_path));
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

/// The error for a name that no scene has. It offers scenarios as well, with or without their prefix.
fn unknown(name: &str) -> SceneError {
    let wanted = name.to_lowercase();
    let scenes =
        ENTRIES.iter().map(|entry| (strsim::jaro_winkler(entry.id, &wanted), entry.id.to_owned()));
    let scenarios = stability::list().iter().map(|scenario| {
        let id = scenario.id();
        // Every id starts alike, so that only the rest tells them apart.
        let rest = wanted.strip_prefix(stability::PREFIX).unwrap_or(&wanted);
        (strsim::jaro_winkler(scenario.name, rest), id)
    });
    let mut near: Vec<_> =
        scenes.chain(scenarios).filter(|(likeness, _)| *likeness >= NEAR).collect();
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    let near: Vec<_> = near.into_iter().take(3).map(|(_, id)| id).collect();
    let ids: Vec<_> = ENTRIES.iter().map(|entry| entry.id).collect();
    SceneError::Unknown {
        name: name.into(),
        known: format!("{}, {}NAME", ids.join(", "), stability::PREFIX),
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
    fn a_seed_changes_scenarios_and_no_other_scene() {
        let hash = |name: &str, seed: u64| open_seeded(name, seed).expect("a scene").hash();
        for (name, is_seeded) in [("stability:sub-pixel-moves", true), ("atrium", false)] {
            let default = open(name).expect("a scene").hash();
            assert_eq!(hash(name, 1), default, "{name}");
            assert_eq!(hash(name, 2) != default, is_seeded, "{name}");
        }
    }

    #[test]
    fn unknown_names_list_similar_ids() {
        let error = open("Atrum").expect_err("no such scene").to_string();
        assert!(error.contains("nearest: atrium"), "{error}");
        for name in ["stability:depth-discontinuty", "depth-discontinuity"] {
            let error = open(name).expect_err("no such scene").to_string();
            assert!(error.contains("nearest: stability:depth-discontinuity"), "{error}");
        }
        let error = open("stability:depth-discontinuity:dolly").expect_err("still").to_string();
        assert!(error.contains("dolly") && error.contains("does not move"), "{error}");
        let error = open("xyz").expect_err("no such scene").to_string();
        assert!(error.contains("one of atrium") && !error.contains("nearest"), "{error}");
        let error = open("a\nb\t\u{1b}[1m").expect_err("no such scene").to_string();
        assert!(error.starts_with("scene is \"a\\nb\\t\\u{1b}[1m\""), "{error}");
        assert!(matches!(open("no/such.gltf"), Err(SceneError::Read { .. })));
    }
}
