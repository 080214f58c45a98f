//! Chooses where world space begins. A scene far from its file's origin gets an origin of its own.
//!
//! Positions on the GPU are f32. At 1,000 km from the origin they are 6 cm apart, so a room there
//! would have no straight wall. Transforms are therefore multiplied in f64. If the scene stands far
//! off, the middle of its models is subtracted before anything becomes f32.
//! [`Scene::origin`](crate::Scene::origin) holds what was subtracted, so the command line can use
//! the file's coordinates.

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

/// Beyond this distance from the origin, f32 positions are 2 mm apart or more.
const FAR_M: f32 = 16_384.0;

/// A scene is also far off at this many times its own size. f32 then leaves 19 of its 24 bits for
/// positions.
const FAR_SIZES: f32 = 32.0;

/// Walks the nodes, places what they hold, and returns the origin of world space in the file's
/// coordinates.
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
    // Skins pose new copies. The warnings would be the same as before.
    meshes.meshes.truncate(count);
    let walk = walk::walk(file, origin)?;
    let placed = nodes::place(file, &walk, meshes, &mut Warnings::default())?;
    Ok((walk, placed, origin))
}

/// The middle of the models, if it is far from the origin.
fn far_off(placed: &Placed, meshes: &Meshes) -> Option<DVec3> {
    let boxes = placed.instances.iter().map(|instance| {
        let mesh = &meshes.meshes[instance.mesh as usize];
        mesh.bounds.transformed(&placed.models[instance.model as usize].object_to_world)
    });
    let boxes: Vec<Aabb> = boxes.filter(|place| place.size().is_finite()).collect();
    let whole = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    // The median is where most models are, wherever the others lie.
    let median = |axis: usize| {
        let mut along: Vec<f32> = boxes.iter().map(|place| place.center()[axis]).collect();
        let middle = along.len() / 2;
        (!along.is_empty()).then(|| *along.select_nth_unstable_by(middle, f32::total_cmp).1)
    };
    let middle = Vec3::new(median(0)?, median(1)?, median(2)?);
    let far_m = FAR_M.min(FAR_SIZES * whole.diagonal());
    (middle.is_finite() && middle.abs().max_element() > far_m).then(|| middle.as_dvec3())
}
