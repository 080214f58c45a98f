//! Intersection tests on the CPU.

mod aabb;
mod frustum;
mod oriented_box;
mod volume;

use glam::Vec3;

pub use aabb::Aabb;
pub use frustum::Frustum;
pub use oriented_box::OrientedBox;
pub use volume::LightVolume;

use crate::ViewUniform;

/// View depth from which on a frustum has no far plane, metres: `UNBOUNDED` of
/// `bounds_frustum.wesl`.
pub const UNBOUNDED: f32 = 3.4e38;

/// World-space position of the camera.
fn eye_world(uniform: &ViewUniform) -> Vec3 {
    Vec3::from_slice(&uniform.view_to_world[3])
}
