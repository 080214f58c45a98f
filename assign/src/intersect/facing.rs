//! The directions in which a group's surfaces face, and the lights below all their horizons:
//! `facing.wesl`.

use glam::Vec3;

use super::{Aabb, LightVolume};

/// Unit normals within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalCone {
    /// Its axis, of unit length.
    pub axis: Vec3,
    /// Cosine of the half angle.
    pub cos_half: f32,
    /// Sine of the half angle, which is at most pi.
    pub sin_half: f32,
}

/// Half floats may change the length of a unit vector by this share.
const LENGTH_SLACK: f32 = 1.2e-3;
/// Bound of a vertex's distance from its emitter's plane, as a share of the emitter's size. It is
/// twice what emitters accept; rounding leaves vertices far closer.
pub(super) const OFF_PLANE: f32 = 2e-4;
/// Factor for an emitter's radius, because half axes may be 1e-3 off a right angle.
pub(super) const OFF_SQUARE: f32 = 1.001;

impl NormalCone {
    /// All directions.
    pub const ALL: Self = Self { axis: Vec3::Z, cos_half: -1.0, sin_half: 0.0 };

    /// A cone around the unit normals in a box, whose centre is c and whose corners are at distance r
    /// from c. The normals lie in the tangent cone of the ball around the box: its sine is r / |c|.
    /// They also lie beyond the plane through the box's nearest corner along c. The narrower cone
    /// counts.
    pub fn of_box(low: Vec3, high: Vec3) -> Self {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let distance = middle.length();
        if distance < 1e-3 {
            return Self::ALL;
        }
        let axis = middle / distance;
        let nearest = distance - axis.abs().dot(half);
        let cos_plane = (nearest - LENGTH_SLACK * nearest.abs()).clamp(-1.0, 1.0);
        let sin_ball = half.length() / distance;
        let cos_ball = if sin_ball < 1.0 { (1.0 - sin_ball * sin_ball).sqrt() } else { -1.0 };
        if cos_ball > cos_plane {
            return Self { axis, cos_half: cos_ball, sin_half: sin_ball };
        }
        Self { axis, cos_half: cos_plane, sin_half: (1.0 - cos_plane * cos_plane).sqrt() }
    }

    /// The cone made wider by a small angle, radians.
    #[must_use]
    pub fn widened(self, angle: f32) -> Self {
        let cos_half = self.cos_half * angle.cos() - self.sin_half * angle.sin();
        let sin_half = self.sin_half * angle.cos() + self.cos_half * angle.sin();
        if sin_half < 0.0 {
            return Self { axis: self.axis, ..Self::ALL };
        }
        Self { cos_half, sin_half, ..self }
    }

    /// Whether a light lies below the horizon of every surface in a box whose normal lies in the
    /// cone.
    pub fn faces_away(&self, bounds: &Aabb, volume: &LightVolume) -> bool {
        let half = 0.5 * (bounds.max_world - bounds.min_world);
        let across = volume.center - 0.5 * (bounds.min_world + bounds.max_world);
        let outline = OFF_SQUARE * volume.outline_radius();
        let radius = half.length() + outline;
        let extent =
            self.axis.abs().dot(half) + volume.outline_extent(self.axis) + OFF_PLANE * outline;
        let rise = self.cos_half * self.axis.dot(across)
            + self.sin_half * self.axis.cross(across).length()
            + radius.min(self.cos_half * extent + self.sin_half * radius);
        let slack_m = bounds.slack_m + bounds.slack_per_m * volume.radius_m;
        self.cos_half > 0.0 && rise < -slack_m
    }
}
