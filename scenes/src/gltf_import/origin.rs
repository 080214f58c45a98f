//! Where world space begins: a scene far from its file's origin gets one of its own.
//!
//! Positions on the GPU are f32. At 1,000 km they are 6 cm apart, so a room there would have no straight
//! wall. Transforms are therefore multiplied in f64, and where the scene stands far off, the middle of
//! its models is taken off before anything becomes f32. [`Scene::origin`](crate::Scene::origin) holds
//! what was taken off, so that the file's coordinates still hold on the command line.

use glam::{DVec3, Vec3};

use super::{
    Warnings,
    file::File,
    meshes::Meshes,
    nodes,
    placed::Placed,
    walk::{self, Walk},
};
use crate::{Aabb, SceneError};

/// Farther from the origin than this, f32 positions are 2 mm apart or more.
const FAR_M: f32 = 16_384.0;

/// A scene is also far off at this many times its own size, where f32 leaves it 19 bits of 24.
const FAR_SIZES: f32 = 32.0;

/// Walks the nodes and places what they hold, and tells where world space begins in the file's.
pub(super) fn place(
    file: &File,
    meshes: &mut Meshes,
    warnings: &mut Warnings,
) -> Result<(Walk, Placed, DVec3), SceneError> {
    let count = meshes.meshes.len();
    let walk = walk::walk(file, DVec3::ZERO)?;
    let placed = nodes::place(file, &walk, meshes, warnings)?;
    let Some(origin) = far_off(&placed, meshes) else {
        return Ok((walk, placed, DVec3::ZERO));
    };
    // Skins pose copies anew. The warnings are the same again.
    meshes.meshes.truncate(count);
    let walk = walk::walk(file, origin)?;
    let placed = nodes::place(file, &walk, meshes, &mut Warnings::default())?;
    Ok((walk, placed, origin))
}

/// The middle of the models, where that is far from the origin.
fn far_off(placed: &Placed, meshes: &Meshes) -> Option<DVec3> {
    let boxes = placed.instances.iter().map(|instance| {
        let mesh = &meshes.meshes[instance.mesh as usize];
        mesh.bounds.transformed(&placed.models[instance.model as usize].object_to_world)
    });
    let boxes: Vec<Aabb> = boxes.filter(|place| place.size().is_finite()).collect();
    let whole = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    // The median is where most of them are, whatever else lies about.
    let median = |axis: usize| {
        let mut along: Vec<f32> = boxes.iter().map(|place| place.center()[axis]).collect();
        let middle = along.len() / 2;
        (!along.is_empty()).then(|| *along.select_nth_unstable_by(middle, f32::total_cmp).1)
    };
    let middle = Vec3::new(median(0)?, median(1)?, median(2)?);
    let far_m = FAR_M.min(FAR_SIZES * whole.diagonal());
    (middle.is_finite() && middle.abs().max_element() > far_m).then(|| middle.as_dvec3())
}
