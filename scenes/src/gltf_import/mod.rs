//! Import of glTF 2.0: `.gltf` and `.glb`, buffers and images embedded or beside the file.
//!
//! The file is parsed and validated by gltf-json; everything read after that is range-checked
//! here, so that no file makes the importer panic.

mod accessor;
mod adapt;
mod animation;
mod area_lights;
mod cameras;
mod compressed_views;
mod draco;
mod extensions;
mod file;
mod images;
mod influence;
mod invalid;
mod json_path;
mod limits;
mod materials;
mod mesh_limits;
mod meshes;
mod meshopt;
mod models;
mod nodes;
mod origin;
mod parts;
mod placed;
mod punctual;
mod repeats;
mod skins;
mod tangents;
#[cfg(test)]
mod tests;
mod walk;
mod warnings;

use std::path::Path;

use assign::{MAX_SUNS, Sun};
use glam::DVec3;

use file::File;
use warnings::Warnings;

use crate::{CameraPath, Scene, SceneError, close_ranges, extent, fit};

/// Loads a glTF 2.0 file.
///
/// Meshes used by several nodes are shared, each node becoming a model, and each instance of
/// EXT_mesh_gpu_instancing. Skinned meshes are posed where their joints rest. Missing normals are
/// computed flat, missing tangents by MikkTSpace where the material has a normal map. Morph
/// targets, lines, points and animations of anything but cameras are left
/// out, and blended materials become masks; [`Scene::warnings`] says so, and names every
/// extension that is not read. [`close_ranges`] gives lights without a range their end. Those that
/// [`Light::check`](assign::Light::check) refuses stay in [`Scene::lights`], for
/// [`LightBuffer`](assign::LightBuffer) to quarantine and report.
///
/// At most 200 million triangles are accepted, every node counting its mesh's, and at most 2^27
/// vertices and indices, every primitive counting its own. Images in use have at most 2^31 pixels
/// together, and 16,384 per side. Buffers, meshes and decoded images may take a quarter of the
/// machine's memory each. The boxes and the path of scenes of more than 2 million triangles are
/// found from a sample of them.
///
/// Parts are read from regular files beside the scene, never by absolute paths. A part outside the
/// scene's folder is read with a warning that names it.
///
/// The path is the animation of the first animated camera; else it is fitted to the scene and
/// starts at the first camera where there is one. A scene that stands far from its file's origin is
/// moved to its own ([`Scene::origin`]).
///
/// # Errors
///
/// [`SceneError`] for a file that cannot be read, that is malformed or cut short, that is not of
/// glTF 2, whose images do not decode, that requires an unknown extension, or that has no
/// triangles or too many.
pub fn load_gltf(path: &Path) -> Result<Scene, SceneError> {
    let file = open(path)?;
    let mut warnings = file.take_notes();
    let materials = materials::load(&file, &mut warnings)?;
    warnings.append(file.take_notes());
    let mut meshes = meshes::load(&file, &materials, &mut warnings)?;
    let (walk, placed, origin) = origin::place(&file, &mut meshes, &mut warnings)?;
    check_suns(&file, &placed.suns)?;
    if placed.instances.is_empty() {
        return Err(SceneError::Empty { name: path.display().to_string() });
    }
    animation::note_unplayed(&file, &walk, &mut warnings);
    let mut animated = None;
    let targets = animation::targets(&file);
    let mut view_camera = 0;
    for (ix, chain) in placed.camera_chains.iter().enumerate() {
        if !chain.iter().any(|node| targets.contains(node)) {
            continue;
        }
        if animated.is_some() {
            let name = &placed.cameras[ix].name;
            warnings
                .add(format!("camera {name:?}: its animation is not played, only the first is"));
            continue;
        }
        animated = animation::load(&file, chain, origin, &mut warnings)?;
        view_camera = if animated.is_some() { ix } else { 0 };
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
        view_camera,
        origin,
        path: CameraPath::still(fit::ORIGIN),
        bounds: crate::Aabb::EMPTY,
        core_bounds: crate::Aabb::EMPTY,
        warnings: warnings.into_lines(),
    };
    drop_unused_default(&mut scene);
    scene.bounds = extent::bounds(&scene);
    let bounds = &scene.bounds;
    if bounds.is_empty() || !(bounds.size().is_finite() && bounds.diagonal() < 1e12) {
        let size = scene.bounds.size();
        return Err(file.invalid("scene bounds", size, "at most 1e12 across"));
    }
    scene.core_bounds = extent::core_bounds(&scene);
    scene.open_lights = close_ranges(&mut scene.lights, scene.core_bounds.diagonal());
    scene.path = match animated {
        Some(animated) => CameraPath::animated(animated),
        None => fit::path(&scene),
    };
    Ok(scene)
}

/// Loads the lights of a glTF 2.0 file and nothing else, so that it may hold nothing else.
///
/// They come as a [`Scene`] without triangles, to be scaled and to carry their warnings. World space
/// begins at `origin` of the file. Lights without a range reach infinitely far: the scene that they light
/// decides where they end.
///
/// # Errors
///
/// [`SceneError`] as [`load_gltf`] has them of the file's JSON, buffers, nodes and lights.
pub(crate) fn load_gltf_lights(path: &Path, origin: DVec3) -> Result<Scene, SceneError> {
    let file = open(path)?;
    let mut warnings = file.take_notes();
    let walk = walk::walk(&file, origin)?;
    let (lights, suns) = nodes::lights(&file, &walk, &mut warnings)?;
    check_suns(&file, &suns)?;
    animation::note_unplayed(&file, &walk, &mut warnings);
    Ok(Scene {
        name: name(path),
        meshes: Vec::new(),
        materials: vec![crate::Material::default()],
        images: Vec::new(),
        instances: Vec::new(),
        models: Vec::new(),
        lights,
        suns,
        open_lights: Vec::new(),
        cameras: Vec::new(),
        view_camera: 0,
        origin,
        path: CameraPath::still(fit::ORIGIN),
        bounds: crate::Aabb::EMPTY,
        core_bounds: crate::Aabb::EMPTY,
        warnings: warnings.into_lines(),
    })
}

/// Opens a file with its buffers, and decodes its compressed buffer views.
fn open(path: &Path) -> Result<File, SceneError> {
    let mut file = File::open(path)?;
    let decoded = compressed_views::decode(&file)?;
    file.set_decoded(decoded);
    Ok(file)
}

fn check_suns(file: &File, suns: &[Sun]) -> Result<(), SceneError> {
    if suns.len() <= MAX_SUNS {
        return Ok(());
    }
    let field = "number of directional lights (KHR_lights_punctual)";
    Err(file.invalid(field, suns.len(), format!("at most {MAX_SUNS}")))
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
