//! Where a camera is and where it looks.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec3};

/// Where a camera is and where it looks. It holds a direction instead of a point to look at,
/// because such a point would lose its digits far from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The camera's position, world space, metres.
    pub eye: Vec3,
    /// The unit view direction.
    forward: Vec3,
    /// The up direction of the image; not along the view direction.
    pub up: Vec3,
}

impl Pose {
    /// At `eye`, looking at `target`, with +Y up, or +Z up where it looks straight up or down.
    pub fn new(eye: Vec3, target: Vec3) -> Self {
        Self::level(eye, (target - eye).normalize_or(Vec3::NEG_Z))
    }

    /// At `eye`, looking along the unit vector `forward`, with +Y up, or +Z up where it looks straight
    /// up or down.
    pub fn level(eye: Vec3, forward: Vec3) -> Self {
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        Self { eye, forward, up }
    }

    /// At `eye`, looking along the unit vector `forward`, with `up` pointing up in the image.
    pub const fn looking(eye: Vec3, forward: Vec3, up: Vec3) -> Self {
        Self { eye, forward, up }
    }

    /// The unit view direction.
    pub fn forward(&self) -> Vec3 {
        self.forward
    }

    /// World to view space: +X right, +Y up, looking down -Z.
    pub fn world_to_view(&self) -> Mat4 {
        glam::camera::rh::view::look_to_mat4(self.eye, self.forward, self.up)
    }

    /// Scaled about the origin.
    pub fn scaled(self, factor: f32) -> Self {
        Self { eye: self.eye * factor, ..self }
    }

    /// The pose of a camera or spot that a glTF node holds: it looks along the node's -Z axis. The
    /// node's scale does not matter, and one axis may have length 0.
    pub(crate) fn of_node(to_world: &DMat4) -> Self {
        let [x, y, z] = [to_world.x_axis, to_world.y_axis, to_world.z_axis].map(DVec4::truncate);
        let back = z.try_normalize().or_else(|| x.cross(y).try_normalize()).unwrap_or(DVec3::Z);
        let up = if y == DVec3::ZERO { back.cross(x) } else { y };
        let up = (up - back * back.dot(up)).normalize_or(back.any_orthonormal_vector());
        let eye = to_world.w_axis.truncate();
        Self::looking(eye.as_vec3(), -back.as_vec3(), up.as_vec3())
    }
}
