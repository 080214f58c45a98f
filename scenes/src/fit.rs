//! Bounds and camera paths fitted to any scene.

use glam::Vec3;

use crate::{Aabb, CameraPath, Pose, Scene};

/// What a scene looks at before its path is fitted.
pub(crate) const ORIGIN: Pose = Pose {
    eye: Vec3::ZERO,
    target: Vec3::NEG_Z,
    up: Vec3::Y,
};

/// The box around all triangles drawn.
pub(crate) fn bounds(scene: &Scene) -> Aabb {
    scene.models.iter().fold(Aabb::EMPTY, |all, model| {
        all.union(model.bounds_object.transformed(&model.object_to_world))
    })
}

/// The box around the part that most triangles belong to.
pub(crate) fn core_bounds(scene: &Scene) -> Aabb {
    scene.bounds
}

/// A path through the core that shows a lot of the scene.
pub(crate) fn path(scene: &Scene) -> CameraPath {
    let core = scene.core_bounds;
    CameraPath::still(Pose::new(core.center() + core.size() * 0.7, core.center()))
}
