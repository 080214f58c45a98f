//! The volume that stands for a light in tests: its extent along an axis, and its cone against a
//! sphere. It is `volume.wesl`, and `LightVolume` of `lights.wesl`.

use glam::Vec3;

use crate::{Light, LightShape};

/// The outline extended by a ball of `range_m`, cut by a cone around `axis` if `cos_outer > -1`. An
/// area light's outline is the rectangle of the half axes, extended by a ball of `thick_m`; any other light's is a
/// point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightVolume {
    /// Position of the light, world space, metres.
    pub center: Vec3,
    /// Radius of a ball around the whole volume, metres.
    pub radius_m: f32,
    /// Range of the light, metres.
    pub range_m: f32,
    /// Axis of the cone, of unit length; zero without a cone.
    pub axis: Vec3,
    /// Cosine of the cone's half angle; -1 without a cone.
    pub cos_outer: f32,
    /// Sine of the cone's half angle; 0 without a cone.
    pub sin_outer: f32,
    /// Half axes of the outline, metres; zero for a point.
    pub half_axes: [Vec3; 2],
    /// Radius of a sphere or a line, metres; 0 for other lights.
    pub thick_m: f32,
}

impl From<&Light> for LightVolume {
    fn from(light: &Light) -> Self {
        let ball = Self {
            center: light.position,
            radius_m: light.radius_m(),
            range_m: light.range_m,
            axis: Vec3::ZERO,
            cos_outer: -1.0,
            sin_outer: 0.0,
            half_axes: [Vec3::ZERO; 2],
            thick_m: 0.0,
        };
        match &light.shape {
            LightShape::Point => ball,
            LightShape::Spot { direction, outer_angle, .. } => Self {
                axis: direction.normalize(),
                cos_outer: outer_angle.cos(),
                sin_outer: outer_angle.sin().max(0.0),
                ..ball
            },
            LightShape::Vpl { normal, .. } => {
                Self { axis: normal.normalize(), cos_outer: 0.0, sin_outer: 1.0, ..ball }
            }
            LightShape::Area(emitter) => {
                let thick_m = if emitter.is_solid() { emitter.radius_m() } else { 0.0 };
                let half_axes = emitter.half_axes();
                let sheet = Self { axis: emitter.normal(), half_axes, thick_m, ..ball };
                // One-sided: the half ball in front.
                let half = Self { cos_outer: 0.0, sin_outer: 1.0, ..sheet };
                if emitter.shines_all_around() { sheet } else { half }
            }
        }
    }
}

/// Shading finds a cone's edge by comparing squared chords, `2 - 2 cos`, of unit vectors in f32.
/// Their error is that of cosines off by 4 units in the last place, 5e-7. So the edge moves
/// outwards by at most 5e-7 over its sine, radians, or twice that if the cone is almost a ball.
const CONE_ERROR: f32 = 1e-6;

/// Below this sine the edge's angle stops growing: `sqrt(2 * 5e-7)`, its value for the narrowest
/// and the widest cone.
const CONE_SINE_MIN: f32 = 1e-3;

/// How often the nearest points of a box and an outline are projected onto each other. Any axis
/// between them is a valid test; more rounds find a better one.
pub(super) const PROJECTIONS: usize = 3;

impl LightVolume {
    /// How far the volume extends from its centre along the unit vector `axis`, metres, `>= 0`.
    ///
    /// For a cone of half angle `a` and an axis at angle `t > a` from the cone's, the farthest
    /// point lies on the rim, at angle `t - a`; shading's rounding adds up to 1e-3. For half angles
    /// above π/2 the result is the extent of the volume's convex hull.
    ///
    /// The sine comes from the cross product. Computed from the cosine, it and the extent would be
    /// wrong by 3e-4 for almost parallel axes.
    pub fn extent_along(&self, axis: Vec3) -> f32 {
        let cos_t = self.axis.dot(axis);
        let sin_t = self.axis.cross(axis).length();
        let cos_rim = cos_t * self.cos_outer + sin_t * self.sin_outer;
        let cos_nearest = if cos_t >= self.cos_outer {
            1.0
        } else {
            (cos_rim + self.edge_angle()).clamp(0.0, 1.0)
        };
        self.outline_extent(axis) + self.range_m * cos_nearest
    }

    /// How far the outline extends from the volume's centre along a unit vector, metres.
    pub(super) fn outline_extent(&self, axis: Vec3) -> f32 {
        self.half_axes[0].dot(axis).abs() + self.half_axes[1].dot(axis).abs() + self.thick_m
    }

    /// Distance from the volume's centre to the outline's farthest points, metres.
    pub(super) fn outline_radius(&self) -> f32 {
        let [x, y] = self.half_axes;
        (x.length_squared() + y.length_squared()).sqrt() + self.thick_m
    }

    /// The point of the outline, without its thickness, closest to `point`, world space.
    pub(super) fn closest_on_outline(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        let along = |half: Vec3| {
            (half.dot(offset) / half.length_squared().max(1e-30)).clamp(-1.0, 1.0) * half
        };
        self.center + along(self.half_axes[0]) + along(self.half_axes[1])
    }

    /// Whether the light is an area light.
    pub(super) fn has_outline(&self) -> bool {
        self.half_axes != [Vec3::ZERO; 2]
    }

    /// Whether the light lights only what lies in front of the outline's plane.
    pub(super) fn is_half(&self) -> bool {
        self.cos_outer == 0.0
    }

    /// Whether an axis separates a box from the volume. The axes are the one between the nearest
    /// points of box and outline, found by projecting back and forth, and the outline's normal.
    /// `closest` returns the box's point closest to a given one; `highest` returns the box's
    /// greatest coordinate along an axis, relative to the volume's centre.
    pub(super) fn parts_from(
        &self,
        closest: impl Fn(Vec3) -> Vec3,
        highest: impl Fn(Vec3) -> f32,
        slack_m: f32,
    ) -> bool {
        let mut on_box = closest(self.center);
        let mut on_outline = self.center;
        for _ in 0..PROJECTIONS {
            on_outline = self.closest_on_outline(on_box);
            on_box = closest(on_outline);
        }
        let across = on_outline - on_box;
        let apart = |axis: Vec3| -highest(axis) > self.extent_along(-axis) + slack_m;
        (across.length() > 0.0 && apart(across / across.length()))
            || (self.is_half() && apart(self.axis))
    }

    /// Whether the cone misses a sphere; an outline's cone is its plane. It is loose behind the
    /// apex, where the ball's test decides.
    pub fn cone_misses_sphere(&self, center: Vec3, radius_m: f32) -> bool {
        let to_center = center - self.center;
        let along = to_center.dot(self.axis);
        let across = to_center.cross(self.axis).length();
        let outside = across * self.cos_outer - along * self.sin_outer;
        outside > radius_m + self.radius_m * self.edge_angle()
    }

    /// How far beyond the cone's edge shading may still see light, radians.
    fn edge_angle(&self) -> f32 {
        CONE_ERROR / self.sin_outer.max(CONE_SINE_MIN)
    }
}
