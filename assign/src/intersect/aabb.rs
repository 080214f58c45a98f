//! Groups that are boxes along the world's axes: `bounds_box.wesl`.

use glam::Vec3;

use super::{LightVolume, box_magnitude};
use crate::View;

/// A box along the world's axes.
///
/// The test is NP, the nearest point of the box (Enhuber 2019, section 3.5.1), which is exact for a
/// ball. For a spot it also tries the same axis against the cone's extent, and the cone against the
/// sphere around the box. For an area light it tries the axis between the nearest points of box and
/// outline, and the farthest corner against the outline's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lowest corner, world space, metres.
    pub min_world: Vec3,
    /// Highest corner, world space, metres.
    pub max_world: Vec3,
    /// Bound of the rounding of a sample's position, metres.
    pub slack_m: f32,
    /// Additional slack per metre of the light's range.
    pub slack_per_m: f32,
}

impl Aabb {
    /// The box from `min_world` to `max_world`, with the slack of `view`.
    pub fn new(view: &View, min_world: Vec3, max_world: Vec3) -> Self {
        let uniform = view.uniform();
        let extreme = min_world.abs().max(max_world.abs());
        Self {
            min_world,
            max_world,
            slack_m: uniform.position_error
                * (super::eye_world(&uniform).length() + 2.0 * extreme.length()),
            slack_per_m: uniform.position_error,
        }
    }

    /// Whether a light whose support lies in a world-space box may reach this one.
    pub fn reaches_box(&self, min_world: Vec3, max_world: Vec3) -> bool {
        let slack_m = self.slack_m + self.slack_per_m * box_magnitude(min_world, max_world);
        (min_world - self.max_world).max(self.min_world - max_world).max_element() <= slack_m
    }

    /// Whether the light's volume may reach the box.
    pub fn reaches(&self, volume: &LightVolume) -> bool {
        let slack_m = self.slack_m + self.slack_per_m * volume.radius_m;
        let nearest = volume.center.max(self.min_world).min(self.max_world);
        let to_light = volume.center - nearest;
        let reach = volume.radius_m + slack_m;
        if to_light.dot(to_light) > reach * reach {
            return false;
        }
        let closest = |point: Vec3| point.max(self.min_world).min(self.max_world);
        let highest = |axis: Vec3| {
            let farthest = Vec3::select(axis.cmpgt(Vec3::ZERO), self.max_world, self.min_world);
            axis.dot(farthest - volume.center)
        };
        if volume.has_outline() && volume.parts_from(closest, highest, slack_m) {
            return false;
        }
        let distance_m = to_light.length();
        if distance_m > 0.0 && distance_m > volume.extent_along(-to_light / distance_m) + slack_m {
            return false;
        }
        let center = 0.5 * (self.min_world + self.max_world);
        let radius_m = center.distance(self.max_world) + slack_m;
        !volume.cone_misses_sphere(center, radius_m)
    }
}
