//! Groups that are boxes along their own axes: `bounds_oriented_box.wesl`.

use glam::Vec3;

use super::{LightVolume, box_magnitude};
use crate::View;

/// A box along its own axes.
///
/// The test is NPT, the nearest point after the light was turned into the box's frame (Enhuber
/// 2019, section 3.5.1), which is exact for a ball. Other lights are tested as in
/// [`Aabb`](super::Aabb).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Centre, world space, metres.
    pub center_world: Vec3,
    /// Orthonormal axes, of either handedness, world space.
    pub axes: [Vec3; 3],
    /// Half the size along each axis, metres, `>= 0`.
    pub half_extents_m: Vec3,
    /// Bound of the rounding of a sample's position, metres.
    pub slack_m: f32,
    /// Additional slack per metre of the light's range.
    pub slack_per_m: f32,
}

impl OrientedBox {
    /// The box around `center_world`, with the slack of `view`.
    pub fn new(view: &View, center_world: Vec3, axes: [Vec3; 3], half_extents_m: Vec3) -> Self {
        let uniform = view.uniform();
        let extreme = center_world.length() + half_extents_m.length();
        Self {
            center_world,
            axes,
            half_extents_m,
            slack_m: uniform.position_error * (super::eye_world(&uniform).length() + 2.0 * extreme),
            slack_per_m: uniform.position_error,
        }
    }

    /// Whether a light whose support lies in a world-space box may reach this one.
    pub fn reaches_box(&self, min_world: Vec3, max_world: Vec3) -> bool {
        let slack_m = self.slack_m + self.slack_per_m * box_magnitude(min_world, max_world);
        let offset = 0.5 * (min_world + max_world) - self.center_world;
        let half_size = 0.5 * (max_world - min_world);
        let [x, y, z] = self.axes;
        let reach = x.abs() * self.half_extents_m.x
            + y.abs() * self.half_extents_m.y
            + z.abs() * self.half_extents_m.z;
        let along_world = offset.abs() - half_size - reach;
        let local = Vec3::from_array(self.axes.map(|axis| offset.dot(axis).abs()));
        let reach = Vec3::from_array(self.axes.map(|axis| axis.abs().dot(half_size)));
        let along_own = local - self.half_extents_m - reach;
        along_world.max(along_own).max_element() <= slack_m
    }

    /// Whether the light's volume may reach the box.
    pub fn reaches(&self, volume: &LightVolume) -> bool {
        let slack_m = self.slack_m + self.slack_per_m * volume.radius_m;
        let offset = volume.center - self.center_world;
        let local = Vec3::from_array(self.axes.map(|axis| offset.dot(axis)));
        let to_light = local - local.max(-self.half_extents_m).min(self.half_extents_m);
        let reach = volume.radius_m + slack_m;
        if to_light.dot(to_light) > reach * reach {
            return false;
        }
        let closest = |point: Vec3| {
            let offset = point - self.center_world;
            let local = Vec3::from_array(self.axes.map(|axis| offset.dot(axis)));
            let near = local.max(-self.half_extents_m).min(self.half_extents_m);
            let [x, y, z] = self.axes;
            self.center_world + x * near.x + y * near.y + z * near.z
        };
        let extent = |axis: Vec3| {
            let along = Vec3::from_array(self.axes.map(|box_axis| box_axis.dot(axis).abs()));
            along.dot(self.half_extents_m)
        };
        let highest = |axis: Vec3| extent(axis) - axis.dot(offset);
        if volume.has_outline() && volume.parts_from(closest, highest, slack_m) {
            return false;
        }
        let distance_m = to_light.length();
        let [axis_x, axis_y, axis_z] = self.axes;
        let away = axis_x * to_light.x + axis_y * to_light.y + axis_z * to_light.z;
        if distance_m > 0.0 && distance_m > volume.extent_along(-away / distance_m) + slack_m {
            return false;
        }
        let radius_m = self.half_extents_m.length() + slack_m;
        !volume.cone_misses_sphere(self.center_world, radius_m)
    }
}
