//! A group cut from the view frustum by a pixel rectangle and a depth range:
//! `bounds_frustum.wesl`.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::{LightVolume, UNBOUNDED, eye_world};
use crate::{FrustumTests, View, ViewUniform};

/// A piece of the view frustum, perspective or orthographic.
///
/// Tests (Enhuber 2019, section 3.5.2): HS, the half spaces of the six planes; SAT-N, the axis
/// from the nearest corner to the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// World-space corners: bit 0 of the index is x, bit 1 y, bit 2 depth. Without a far plane
    /// the last four repeat the first.
    pub corners: [Vec3; 8],
    /// World-space planes, outward: `dot(xyz, p) + w <= 0` inside. Left, right, bottom, top,
    /// near, far.
    pub planes: [Vec4; 6],
    /// Centre of a sphere around the corners.
    pub center: Vec3,
    /// Radius of that sphere, metres.
    pub radius_m: f32,
    /// Rounding of a sample's position, metres.
    pub slack_m: f32,
    /// Further slack per metre of the light's distance from the origin and of its range.
    pub slack_per_m: f32,
    /// Whether the far plane exists, and with it far corners.
    pub bounded: bool,
}

impl Frustum {
    /// The piece of the view between two corners in normalised device coordinates and two view
    /// depths, metres; a `depth_max` of [`UNBOUNDED`] or more has no far plane.
    pub fn new(view: &View, ndc_min: Vec2, ndc_max: Vec2, depth_min: f32, depth_max: f32) -> Self {
        let lens = Lens::new(&view.uniform());
        let bounded = depth_max < UNBOUNDED;
        let corners = std::array::from_fn(|i| {
            let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
            let ndc = Vec2::new(pick(1, ndc_min.x, ndc_max.x), pick(2, ndc_min.y, ndc_max.y));
            let far = if bounded { depth_max } else { depth_min };
            lens.world_at(ndc, pick(4, depth_min, far))
        });
        let low = lens.ray_scale * ndc_min + lens.ray_offset;
        let high = lens.ray_scale * ndc_max + lens.ray_offset;
        let planes = [
            lens.side_plane(Vec3::X, low.x, -1.0),
            lens.side_plane(Vec3::X, high.x, 1.0),
            lens.side_plane(Vec3::Y, low.y, -1.0),
            lens.side_plane(Vec3::Y, high.y, 1.0),
            lens.world_plane(Vec3::Z, depth_min),
            lens.world_plane(Vec3::NEG_Z, -depth_max),
        ];
        let center = corners.iter().fold(Vec3::ZERO, |sum, corner| sum + 0.125 * corner);
        let radius =
            corners.iter().fold(0.0, |radius: f32, corner| radius.max(center.distance(*corner)));
        let slack_m = lens.position_error * (2.0 * lens.eye.length() + center.length() + radius);
        Self {
            corners,
            planes,
            center,
            radius_m: radius,
            slack_m,
            slack_per_m: lens.position_error,
            bounded,
        }
    }

    /// Whether the light's volume may reach the frustum: whether none of the tests separates it.
    pub fn reaches(&self, volume: &LightVolume, tests: FrustumTests) -> bool {
        let magnitude = volume.center.abs();
        let slack_m = self.slack_m
            + self.slack_per_m * (magnitude.x + magnitude.y + magnitude.z + volume.range_m);
        if self.half_spaces_miss(volume, slack_m) {
            return false;
        }
        if !self.bounded {
            return true;
        }
        if tests.sat_n && self.nearest_corner_axis_misses(volume, slack_m) {
            return false;
        }
        !volume.cone_misses_sphere(self.center, self.radius_m + slack_m)
    }

    /// HS: whether one of the planes has the whole volume outside.
    fn half_spaces_miss(&self, volume: &LightVolume, slack_m: f32) -> bool {
        let count = if self.bounded { 6 } else { 5 };
        self.planes[..count].iter().any(|plane| {
            let normal = plane.truncate();
            let outside = normal.dot(volume.center) + plane.w;
            outside > volume.extent_along(-normal) + slack_m
        })
    }

    /// SAT-N: whether the axis from the nearest corner to the light separates the volume.
    fn nearest_corner_axis_misses(&self, volume: &LightVolume, slack_m: f32) -> bool {
        let mut to_light = volume.center - self.corners[0];
        for corner in &self.corners[1..] {
            let candidate = volume.center - corner;
            if candidate.dot(candidate) < to_light.dot(to_light) {
                to_light = candidate;
            }
        }
        let distance_m = to_light.length();
        if distance_m == 0.0 {
            return false;
        }
        let axis = to_light / distance_m;
        let gap = self
            .corners
            .iter()
            .fold(distance_m, |gap, corner| gap.min(axis.dot(volume.center - corner)));
        gap > volume.extent_along(-axis) + slack_m
    }
}

/// The part of a [`ViewUniform`] that bounds are made from.
struct Lens {
    view_to_world: Mat4,
    ray_scale: Vec2,
    ray_offset: Vec2,
    perspective: f32,
    position_error: f32,
    eye: Vec3,
}

impl Lens {
    fn new(uniform: &ViewUniform) -> Self {
        Self {
            view_to_world: Mat4::from_cols_array_2d(&uniform.view_to_world),
            ray_scale: Vec2::from_array(uniform.ray_scale),
            ray_offset: Vec2::from_array(uniform.ray_offset),
            perspective: uniform.perspective,
            position_error: uniform.position_error,
            eye: eye_world(uniform),
        }
    }

    /// World-space position seen at `ndc` at a view depth: `position_view_at`, `world_of_view`.
    fn world_at(&self, ndc: Vec2, depth_view: f32) -> Vec3 {
        let footprint = if self.perspective > 0.5 { depth_view } else { 1.0 };
        let window = (self.ray_scale * ndc + self.ray_offset) * footprint;
        (self.view_to_world * window.extend(-depth_view).extend(1.0)).truncate()
    }

    /// Outward plane in world space of a plane in view space.
    fn world_plane(&self, normal_view: Vec3, offset: f32) -> Vec4 {
        let normal = (self.view_to_world * normal_view.extend(0.0)).truncate();
        normal.extend(offset - normal.dot(self.eye))
    }

    /// Side plane whose window coordinate is `edge` along `axis`; `side` is -1 at the low edge.
    fn side_plane(&self, axis: Vec3, edge: f32, side: f32) -> Vec4 {
        let scale = side / (1.0 + self.perspective * edge * edge).sqrt();
        let normal = scale * (axis + Vec3::new(0.0, 0.0, self.perspective * edge));
        self.world_plane(normal, -scale * edge * (1.0 - self.perspective))
    }
}
