//! Support of a light's volume along an axis, and its rejection by a bounding sphere:
//! `volume.wesl`, and `LightVolume` of `lights.wesl`.

use glam::Vec3;

use crate::{Light, LightShape};

/// Ball around `center`, cut by a cone around `axis` where `cos_outer > -1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightVolume {
    /// Position of the light, world space, metres.
    pub center: Vec3,
    /// Range of the light, metres.
    pub range_m: f32,
    /// Axis of the cone, of unit length; zero without a cone.
    pub axis: Vec3,
    /// Cosine of the cone's half angle; -1 without a cone.
    pub cos_outer: f32,
    /// Sine of the cone's half angle; 0 without a cone.
    pub sin_outer: f32,
}

impl From<&Light> for LightVolume {
    fn from(light: &Light) -> Self {
        let ball = Self {
            center: light.position,
            range_m: light.range_m,
            axis: Vec3::ZERO,
            cos_outer: -1.0,
            sin_outer: 0.0,
        };
        match light.shape {
            LightShape::Point => ball,
            LightShape::Spot { direction, outer_angle, .. } => Self {
                axis: direction.normalize(),
                cos_outer: outer_angle.cos(),
                sin_outer: outer_angle.sin().max(0.0),
                ..ball
            },
        }
    }
}

/// Shading finds a cone's edge by comparing two cosines in f32, each a dot product of normalised
/// vectors, good to 4 units in the last place: 5e-7. The edge moves outwards with them, by an
/// angle of 5e-7 over its sine, or twice that where the cone is almost a ball.
const CONE_ERROR: f32 = 1e-6;

/// Sine below which the angle stops growing: `sqrt(2 * 5e-7)`, the edge's angle for the narrowest
/// cone and for the widest.
const CONE_SINE_MIN: f32 = 1e-3;

impl LightVolume {
    /// How far the volume extends from its centre along the unit vector `axis`, metres, `>= 0`.
    ///
    /// For a cone of half angle `a` and an axis at angle `t > a` from the cone's, the farthest
    /// point lies on the rim at angle `t - a`, and up to 1e-3 beyond for shading's rounding. Beyond
    /// a half angle of π/2 it is the extent of the volume's convex hull.
    ///
    /// The sine comes from the cross product: taken from the cosine it would be wrong by 3e-4
    /// where the two axes are almost parallel, and the extent with it.
    pub fn extent_along(&self, axis: Vec3) -> f32 {
        let cos_t = self.axis.dot(axis);
        let sin_t = self.axis.cross(axis).length();
        let cos_rim = cos_t * self.cos_outer + sin_t * self.sin_outer;
        let cos_nearest = if cos_t >= self.cos_outer {
            1.0
        } else {
            (cos_rim + self.edge_angle()).clamp(0.0, 1.0)
        };
        self.range_m * cos_nearest
    }

    /// Whether the cone passes a sphere by. Loose behind the apex, where the ball's test decides.
    pub fn cone_misses_sphere(&self, center: Vec3, radius_m: f32) -> bool {
        let to_center = center - self.center;
        let along = to_center.dot(self.axis);
        let across = to_center.cross(self.axis).length();
        let outside = across * self.cos_outer - along * self.sin_outer;
        outside > radius_m + self.range_m * self.edge_angle()
    }

    /// How far beyond the cone's edge shading may still see light, radians.
    fn edge_angle(&self) -> f32 {
        CONE_ERROR / self.sin_outer.max(CONE_SINE_MIN)
    }
}
