//! Groups that a pixel rectangle and a depth range cut from the view frustum:
//! `bounds_frustum.wesl`.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::{LightVolume, UNBOUNDED, box_magnitude, eye_world};
use crate::{FrustumTests, View, ViewUniform};

/// A piece of the view frustum, perspective or orthographic.
///
/// Tests (Enhuber 2019, section 3.5.2): see [`FrustumTests`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// World-space corners: bit 0 of the index is x, bit 1 y, bit 2 depth. Without a far plane
    /// the last four repeat the first.
    pub corners: [Vec3; 8],
    /// World-space planes that face outwards: `dot(xyz, p) + w <= 0` inside. Order: left, right,
    /// bottom, top, near, far.
    pub planes: [Vec4; 6],
    /// Unit vectors along the edges, zero if an edge has no length: x, y, four along depth.
    pub edges: [Vec3; 6],
    /// Centre of a sphere around the corners.
    pub center: Vec3,
    /// Radius of that sphere, metres.
    pub radius_m: f32,
    /// Bound of the rounding of a sample's position, metres.
    pub slack_m: f32,
    /// Additional slack per metre of the light's distance from the origin and of its range.
    pub slack_per_m: f32,
    /// Whether the frustum has a far plane, and so far corners.
    pub bounded: bool,
}

impl Frustum {
    /// The part of the view between two corners in normalised device coordinates and two view
    /// depths, metres. With a `depth_max` of [`UNBOUNDED`] or more it has no far plane.
    pub fn new(view: &View, ndc_min: Vec2, ndc_max: Vec2, depth_min: f32, depth_max: f32) -> Self {
        let lens = Lens::new(&view.uniform());
        let bounded = depth_max < UNBOUNDED;
        let corners: [Vec3; 8] = std::array::from_fn(|i| {
            let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
            let ndc = Vec2::new(pick(1, ndc_min.x, ndc_max.x), pick(2, ndc_min.y, ndc_max.y));
            let far = if bounded { depth_max } else { depth_min };
            lens.world_at(ndc, pick(4, depth_min, far))
        });
        // In a flipped window, the least coordinate of the image is the greatest of the window.
        let [at_min, at_max] = [ndc_min, ndc_max].map(|ndc| lens.ray_scale * ndc + lens.ray_offset);
        let (low, high) = (at_min.min(at_max), at_min.max(at_max));
        let planes = [
            lens.side_plane(Vec3::X, low.x, -1.0),
            lens.side_plane(Vec3::X, high.x, 1.0),
            lens.side_plane(Vec3::Y, low.y, -1.0),
            lens.side_plane(Vec3::Y, high.y, 1.0),
            lens.world_plane(Vec3::Z, depth_min),
            lens.world_plane(Vec3::NEG_Z, -depth_max),
        ];
        let ends = [[0, 1], [0, 2], [0, 4], [1, 5], [2, 6], [3, 7]];
        let edges = ends.map(|[from, to]: [usize; 2]| {
            let edge: Vec3 = corners[to] - corners[from];
            if edge.length() > 0.0 { edge / edge.length() } else { Vec3::ZERO }
        });
        let center = corners.iter().fold(Vec3::ZERO, |sum, corner| sum + 0.125 * corner);
        let radius =
            corners.iter().fold(0.0, |radius: f32, corner| radius.max(center.distance(*corner)));
        let slack_m = lens.position_error * (2.0 * lens.eye.length() + center.length() + radius);
        Self {
            corners,
            planes,
            edges,
            center,
            radius_m: radius,
            slack_m,
            slack_per_m: lens.position_error,
            bounded,
        }
    }

    /// Whether the light's volume may reach the frustum: no test separates them.
    pub fn reaches(&self, volume: &LightVolume, tests: FrustumTests) -> bool {
        let magnitude = volume.center.abs();
        let slack_m = self.slack_m
            + self.slack_per_m * (magnitude.x + magnitude.y + magnitude.z + volume.radius_m);
        if tests.hs && self.half_spaces_miss(volume, slack_m) {
            return false;
        }
        // Without a far plane there are no far corners for the other tests.
        if !self.bounded {
            return true;
        }
        let gap = |axes: &[Vec3]| {
            axes.iter().fold(f32::NEG_INFINITY, |gap, axis| gap.max(self.gap_along(*axis, volume)))
        };
        let nearest = self.nearest_corner(volume.closest_on_outline(self.center));
        if tests.sat_n && self.gap_towards(nearest, volume) > slack_m {
            return false;
        }
        if tests.sat_e && gap(&self.edges) > slack_m {
            return false;
        }
        // The far plane has the near plane's normal, reversed.
        if tests.sat_p && gap(&self.planes.map(Vec4::truncate)[..5]) > slack_m {
            return false;
        }
        let misses = |corner: &Vec3| self.gap_towards(*corner, volume) > slack_m;
        if tests.sat_v && self.corners.iter().any(misses) {
            return false;
        }
        let behind = |volume: &LightVolume| {
            let (_, highest) = self.corner_range(volume.axis, volume.center);
            highest < -slack_m - volume.extent_along(-volume.axis)
        };
        if volume.has_outline() && volume.is_half() && behind(volume) {
            return false;
        }
        !volume.cone_misses_sphere(self.center, self.radius_m + slack_m)
    }

    /// HS: whether the whole volume lies outside one of the planes.
    fn half_spaces_miss(&self, volume: &LightVolume, slack_m: f32) -> bool {
        let count = if self.bounded { 6 } else { 5 };
        self.planes[..count].iter().any(|plane| {
            let normal = plane.truncate();
            let outside = normal.dot(volume.center) + plane.w;
            outside > volume.extent_along(-normal) + slack_m
        })
    }

    /// How far an axis separates volume and frustum, metres, in whichever order they lie.
    fn gap_along(&self, axis: Vec3, volume: &LightVolume) -> f32 {
        let (low, high) = self.corner_range(axis, volume.center);
        (low - volume.extent_along(axis)).max(-high - volume.extent_along(-axis))
    }

    /// How far the axis from the light to a corner separates volume and frustum, metres.
    fn gap_towards(&self, corner: Vec3, volume: &LightVolume) -> f32 {
        let to_corner = corner - volume.closest_on_outline(corner);
        let distance_m = to_corner.length();
        if distance_m == 0.0 {
            return -1.0;
        }
        let axis = to_corner / distance_m;
        self.corner_range(axis, volume.center).0 - volume.extent_along(axis)
    }

    /// Least and greatest coordinate of the corners along an axis, seen from `origin`.
    fn corner_range(&self, axis: Vec3, origin: Vec3) -> (f32, f32) {
        let along = self.corners.map(|corner| axis.dot(corner - origin));
        let low = along.into_iter().fold(f32::INFINITY, f32::min);
        (low, along.into_iter().fold(f32::NEG_INFINITY, f32::max))
    }

    fn nearest_corner(&self, center: Vec3) -> Vec3 {
        self.corners.into_iter().fold(self.corners[0], |nearest, corner| {
            let nearer = (corner - center).length_squared() < (nearest - center).length_squared();
            if nearer { corner } else { nearest }
        })
    }

    /// Whether a light whose support lies in a world-space box may reach the frustum.
    pub fn reaches_box(&self, min_world: Vec3, max_world: Vec3) -> bool {
        let slack_m = self.slack_m + self.slack_per_m * box_magnitude(min_world, max_world);
        let center = 0.5 * (min_world + max_world);
        let half_size = 0.5 * (max_world - min_world);
        let outside = |plane: &Vec4| {
            let normal = plane.truncate();
            normal.dot(center) + plane.w - normal.abs().dot(half_size) > slack_m
        };
        let nearest = self.center.max(min_world).min(max_world);
        let beside = self.bounded && self.center.distance(nearest) - self.radius_m > slack_m;
        let count = if self.bounded { 6 } else { 5 };
        !(beside || self.planes[..count].iter().any(outside))
    }
}

/// The part of a [`ViewUniform`] that defines bounds.
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

    /// The world-space plane of a view-space plane, facing outwards.
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
