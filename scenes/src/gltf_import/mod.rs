//! Imports glTF 2.0: `.gltf` and `.glb` files, with buffers and images embedded or in files beside
//! them.
//!
//! gltf-json parses and validates the file. The importer checks the range of everything that it
//! reads afterwards, so no file makes it panic.

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
mod light_animation;
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
mod triangle_list;
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
/// # What is read
///
/// Each node with a mesh becomes a model, and so does each instance of EXT_mesh_gpu_instancing.
/// Nodes that use the same mesh share it. Skinned meshes are posed by the resting place of their
/// joints. Missing normals are computed flat. Missing tangents are computed by MikkTSpace where the
/// material has a normal map.
///
/// The importer leaves out morph targets, lines and points. It turns blended materials into masks.
/// It plays animations of cameras and of the points and spots of KHR_lights_punctual
/// ([`Scene::light_animation`]), but not those of meshes, area lights and suns. [`Scene::warnings`]
/// lists all of this, and every extension that is not supported.
///
/// [`close_ranges`] chooses a range for lights without one. Lights that
/// [`Light::check`](assign::Light::check) refuses stay in [`Scene::lights`]:
/// [`LightBuffer`](assign::LightBuffer) quarantines and reports them.
///
/// The path is the animation of the first animated camera. Without one, it is fitted to the scene
/// and starts at the first camera if there is any. A scene that stands far from its file's origin
/// gets an origin of its own ([`Scene::origin`]).
///
/// # Limits
///
/// A scene has at most 200 million triangles (each node counts the triangles of its mesh) and 2^27
/// vertices and indices (each primitive counts its own). The images in use have at most 2^31 pixels
/// together, and 16,384 per side. Buffers, meshes and decoded images may each take a quarter of the
/// machine's memory. In scenes of more than 2 million triangles, the boxes and the path are
/// computed from a sample of the triangles.
///
/// Parts are read only from regular files, and only by relative paths. A part outside the scene's
/// folder is read, and a warning names it.
///
/// # Errors
///
/// [`SceneError`] for a file that cannot be read, is malformed or truncated, is not glTF 2, has
/// images that do not decode, requires an unknown extension, or has no triangles or too many.
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
    let light_animation =
        light_animation::load(&file, &walk, &placed.light_nodes, origin, &mut warnings)?;
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
            warnings.add(format!(
                "camera {name:?}: its animation is not played; only the first animated camera moves"
            ));
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
        light_animation,
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

/// Loads only the lights of a glTF 2.0 file, so the file need not hold anything else.
///
/// The lights come in a [`Scene`] without triangles, so that they can be scaled and keep their
/// warnings. World space begins at `origin` of the file. Lights without a range keep an infinite
/// one, because the scene that they light decides where they end.
///
/// # Errors
///
/// The [`SceneError`]s of [`load_gltf`] that concern the file's JSON, buffers, nodes and lights.
pub(crate) fn load_gltf_lights(path: &Path, origin: DVec3) -> Result<Scene, SceneError> {
    let file = open(path)?;
    let mut warnings = file.take_notes();
    let walk = walk::walk(&file, origin)?;
    let placed = nodes::lights(&file, &walk, &mut warnings)?;
    check_suns(&file, &placed.suns)?;
    let light_animation =
        light_animation::load(&file, &walk, &placed.light_nodes, origin, &mut warnings)?;
    animation::note_unplayed(&file, &walk, &mut warnings);
    Ok(Scene {
        name: name(path),
        meshes: Vec::new(),
        materials: vec![crate::Material::default()],
        images: Vec::new(),
        instances: Vec::new(),
        models: Vec::new(),
        lights: placed.lights,
        light_animation,
        suns: placed.suns,
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

/// The file's stem, or its folder's name where the stem is just "scene".
fn name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    let folder = path.parent().and_then(Path::file_name);
    let name = folder.filter(|_| stem == "scene").unwrap_or(stem);
    name.to_string_lossy().into_owned()
}

/// Removes the default material, which is the last one, unless a mesh uses it or it is the only
/// one.
fn drop_unused_default(scene: &mut Scene) {
    let default = scene.materials.len() - 1;
    let used = scene.meshes.iter().any(|mesh| mesh.material as usize == default);
    if default > 0 && !used {
        scene.materials.pop();
    }
}
