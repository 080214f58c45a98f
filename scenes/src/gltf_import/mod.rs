//! Import of glTF 2.0: `.gltf` and `.glb`, buffers and images embedded or beside the file.
//!
//! The file is parsed and validated by gltf-json; everything read after that is range-checked
//! here, so that no file makes the importer panic.

mod accessor;
mod animation;
mod area_lights;
mod file;
mod images;
mod materials;
mod meshes;
mod nodes;
mod punctual;
mod tangents;
#[cfg(test)]
mod tests;

use std::path::Path;

pub(crate) use animation::AnimatedNode;
use file::File;

use assign::MAX_SUNS;

use crate::{CameraPath, Scene, SceneError, close_ranges, error::one_line, fit};

/// One line for each thing left out or changed, without repeats.
#[derive(Default)]
struct Warnings(Vec<String>);

impl Warnings {
    fn add(&mut self, line: String) {
        let line = one_line(line);
        if !self.0.contains(&line) {
            self.0.push(line);
        }
    }

    fn append(&mut self, other: Self) {
        for line in other.0 {
            self.add(line);
        }
    }
}

/// Loads a glTF 2.0 file.
///
/// Meshes used by several nodes are shared, each node becoming a model. Missing normals are
/// computed flat, missing tangents by MikkTSpace where the material has a normal map. Skins, morph
/// targets, vertex colours, lines and points are left out, and blended
/// materials become masks; [`Scene::warnings`] says so. [`close_ranges`] gives lights without a range
/// their end. Those that
/// [`Light::check`](assign::Light::check) refuses stay in [`Scene::lights`], for
/// [`LightBuffer`](assign::LightBuffer) to quarantine and report.
///
/// At most 200 million triangles are accepted, every node counting its mesh's, and at most 2^27
/// vertices and indices, every primitive counting its own. The boxes and the path of scenes of
/// more than 2 million triangles are found from a sample of them.
///
/// The path is the animation of the first animated camera; else it is fitted to the scene and
/// starts at the first camera where there is one.
///
/// # Errors
///
/// [`SceneError`] for a file that cannot be read, that is malformed or cut short, that is not of
/// glTF 2, whose images do not decode, that requires an unknown extension, or that has no
/// triangles or too many.
pub fn load_gltf(path: &Path) -> Result<Scene, SceneError> {
    let file = File::open(path)?;
    let mut warnings = Warnings::default();
    let materials = materials::load(&file, &mut warnings)?;
    let meshes = meshes::load(&file, &materials, &mut warnings)?;
    let placed = nodes::load(&file, &meshes, &mut warnings)?;
    if placed.suns.len() > MAX_SUNS {
        let field = "number of directional lights (KHR_lights_punctual)";
        return Err(file.invalid(field, placed.suns.len(), format!("at most {MAX_SUNS}")));
    }
    if placed.instances.is_empty() {
        return Err(SceneError::Empty { name: path.display().to_string() });
    }
    let mut animated = None;
    for chain in &placed.camera_chains {
        if animated.is_none() {
            animated = animation::load(&file, chain, &mut warnings)?;
        }
    }
    let mut scene = Scene {
        name: name(path),
        meshes: meshes.meshes,
        materials: materials.materials,
        images: materials.images,
        instances: placed.instances,
        models: placed.models,
        lights: placed.lights,
        suns: placed.suns,
        open_lights: Vec::new(),
        cameras: placed.cameras,
        path: CameraPath::still(fit::ORIGIN),
        bounds: crate::Aabb::EMPTY,
        core_bounds: crate::Aabb::EMPTY,
        warnings: warnings.0,
    };
    drop_unused_default(&mut scene);
    scene.bounds = fit::bounds(&scene);
    if !(scene.bounds.size().is_finite() && scene.bounds.diagonal() < 1e12) {
        let size = scene.bounds.size();
        return Err(file.invalid("scene bounds", size, "at most 1e12 across"));
    }
    scene.core_bounds = fit::core_bounds(&scene);
    scene.open_lights = close_ranges(&mut scene.lights, scene.core_bounds.diagonal());
    scene.path = match animated {
        Some(animated) => CameraPath::animated(animated),
        None => fit::path(&scene),
    };
    Ok(scene)
}

/// The file's stem, or its folder's name where that is just "scene".
fn name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    let folder = path.parent().and_then(Path::file_name);
    let name = folder.filter(|_| stem == "scene").unwrap_or(stem);
    name.to_string_lossy().into_owned()
}

/// The default material comes last; it stays only where a mesh uses it or there is no other.
fn drop_unused_default(scene: &mut Scene) {
    let default = scene.materials.len() - 1;
    let used = scene.meshes.iter().any(|mesh| mesh.material as usize == default);
    if default > 0 && !used {
        scene.materials.pop();
    }
}
