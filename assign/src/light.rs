//! Lights with compact support, and their record on the GPU.
//!
//! Every light's contribution is multiplied by the window `(1 - (d / range)^4)^2`, clamped at 0,
//! so its *support*, the set of points it can reach, is exact: a ball, or a ball cut by a cone.
//! Culling and shading read the same `range`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use thiserror::Error;

/// What a light is, beside its position, range and intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// Emits alike in all directions.
    Point,
    /// Emits into a cone (KHR_lights_punctual). The fall-off between the two angles is
    /// `((cos θ - cos outer) / max(0.001, cos inner - cos outer))^2`, clamped to 0..1.
    Spot {
        /// The cone's axis, of unit length, world space.
        direction: Vec3,
        /// Half angle of full intensity, radians, `0 <= inner <= outer`.
        inner_angle: f32,
        /// Half angle at which the light ends, radians, `0 < outer <= π`.
        outer_angle: f32,
    },
}

/// One light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is, metres.
    pub position: Vec3,
    /// Distance at which its window reaches 0, metres, [`MIN_RANGE_M`] to [`MAX_RANGE_M`].
    pub range_m: f32,
    /// Radiant intensity, linear RGB, each 0 to [`MAX_INTENSITY`] and not all 0.
    pub intensity: Vec3,
    /// What kind of light it is.
    pub shape: LightShape,
}

/// Why a light cannot be used. Such a light is left out and counted, never uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LightFault {
    /// A field is NaN or infinite.
    #[error("{field} is {value}: it must be finite")]
    NotFinite {
        /// The field's name.
        field: &'static str,
        /// The offending value.
        value: f32,
    },
    /// A field lies outside its range.
    #[error("{field} is {value}: it must be {accepted}")]
    OutOfRange {
        /// The field's name.
        field: &'static str,
        /// The offending value.
        value: f32,
        /// What would be accepted.
        accepted: &'static str,
    },
}

/// The kinds of light, as stored in the top four bits of [`LightEmission::kind_and_shape`].
/// The numbers 2, 3 and 4 are kept for rectangles, polygons and hemispherical VPLs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum LightKind {
    /// [`LightShape::Point`].
    Point = 0,
    /// [`LightShape::Spot`].
    Spot = 1,
}

/// The part of a light that culling reads: its bounding sphere. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightSphere {
    /// World-space position, metres.
    pub position_world: [f32; 3],
    /// Range, metres.
    pub range_m: f32,
}

/// The part of a light that only shading reads. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightEmission {
    /// Radiant intensity, linear RGB.
    pub intensity: [f32; 3],
    /// [`LightKind`] in the top 4 bits; in the low 28 the index of the light's first vector in
    /// the shape buffer.
    pub kind_and_shape: u32,
}

impl Light {
    /// A point light.
    pub fn point(position: Vec3, range_m: f32, intensity: Vec3) -> Self {
        Self { position, range_m, intensity, shape: LightShape::Point }
    }

    /// The range at which an unbounded light's unoccluded intensity over squared distance falls
    /// to `threshold`: `sqrt(max(intensity) / threshold)` (Watrous 2024, "Light volumes").
    pub fn range_from_threshold(intensity: Vec3, threshold: f32) -> f32 {
        (intensity.max_element() / threshold).sqrt()
    }

    /// Its kind.
    pub fn kind(&self) -> LightKind {
        match self.shape {
            LightShape::Point => LightKind::Point,
            LightShape::Spot { .. } => LightKind::Spot,
        }
    }

    /// Checks every field. [`LightBuffer`](crate::LightBuffer) leaves a faulty light out.
    pub fn check(&self) -> Result<(), LightFault> {
        let finite = |field, v: Vec3| {
            v.to_array()
                .into_iter()
                .find(|x| !x.is_finite())
                .map_or(Ok(()), |value| Err(LightFault::NotFinite { field, value }))
        };
        let out = |field, value, accepted| Err(LightFault::OutOfRange { field, value, accepted });
        finite("position", self.position)?;
        finite("range", Vec3::splat(self.range_m))?;
        finite("intensity", self.intensity)?;
        if !(MIN_RANGE_M..=MAX_RANGE_M).contains(&self.range_m) {
            return out("range", self.range_m, "between 1e-6 and 1e9 metres");
        }
        if self.intensity.min_element() < 0.0 {
            return out("intensity", self.intensity.min_element(), "0 or more");
        }
        if self.intensity.max_element() > MAX_INTENSITY {
            return out("intensity", self.intensity.max_element(), "at most 1e18");
        }
        if self.intensity.max_element() == 0.0 {
            return out("intensity", 0.0, "above 0 in some channel");
        }
        if let LightShape::Spot { direction, inner_angle, outer_angle } = self.shape {
            finite("spot direction", direction)?;
            finite("spot angle", Vec3::new(inner_angle, outer_angle, 0.0))?;
            let length = direction.length();
            if (length - 1.0).abs() > 1e-3 {
                return out("spot direction", length, "of length 1");
            }
            if !(outer_angle > 0.0 && outer_angle <= std::f32::consts::PI) {
                return out("spot outer angle", outer_angle, "above 0 and at most pi radians");
            }
            if !(0.0..=outer_angle).contains(&inner_angle) {
                return out("spot inner angle", inner_angle, "between 0 and the outer angle");
            }
        }
        Ok(())
    }

    /// How far `point` lies inside the light's support, in f64, as a share of the range (and of
    /// the cone): positive inside, 0 on the edge, negative outside. This is the truth that lists
    /// are checked against.
    pub fn reach(&self, point: DVec3) -> f64 {
        let to_point = point - self.position.as_dvec3();
        let distance = to_point.length();
        let ball = 1.0 - distance / f64::from(self.range_m);
        match self.shape {
            LightShape::Point => ball,
            LightShape::Spot { direction, outer_angle, .. } => {
                if distance == 0.0 {
                    return ball;
                }
                let cos = direction.as_dvec3().normalize().dot(to_point) / distance;
                ball.min(cos - f64::from(outer_angle).cos())
            }
        }
    }

    /// The part of the light's record that culling reads.
    pub fn sphere(&self) -> LightSphere {
        LightSphere { position_world: self.position.to_array(), range_m: self.range_m }
    }

    /// The light's record for shading; appends what its kind needs to `shapes`.
    ///
    /// Shape vectors: a point light has none; a spot has `(direction, cos outer)` and
    /// `(1 / max(0.001, cos inner - cos outer), sin outer, 0, 0)`.
    pub(crate) fn emission(&self, shapes: &mut Vec<[f32; 4]>) -> LightEmission {
        let first_shape = shapes.len() as u32;
        if let LightShape::Spot { direction, inner_angle, outer_angle } = self.shape {
            let direction = direction.normalize();
            let cos_outer = outer_angle.cos();
            let scale = 1.0 / (inner_angle.cos() - cos_outer).max(1e-3);
            shapes.push([direction.x, direction.y, direction.z, cos_outer]);
            shapes.push([scale, outer_angle.sin().max(0.0), 0.0, 0.0]);
        }
        LightEmission {
            intensity: self.intensity.to_array(),
            kind_and_shape: (self.kind() as u32) << 28 | first_shape,
        }
    }
}

/// The shortest range accepted, metres: its square stays far above f32's smallest number.
pub const MIN_RANGE_M: f32 = 1e-6;

/// The longest range accepted, metres: its square stays far inside f32.
pub const MAX_RANGE_M: f32 = 1e9;

/// The greatest radiant intensity accepted in a channel. The fall-off multiplies it by up to 1e4,
/// GGX's peak by up to 8e4, and 2^20 such lights still sum to a finite f32.
pub const MAX_INTENSITY: f32 = 1e18;

#[cfg(test)]
mod tests {
    use super::*;

    fn lamp() -> Light {
        Light::point(Vec3::new(1.0, 2.0, 3.0), 2.0, Vec3::ONE)
    }

    #[test]
    fn faults_name_field_and_value() {
        let mut light = lamp();
        light.range_m = f32::NAN;
        assert!(matches!(light.check(), Err(LightFault::NotFinite { field: "range", .. })));
        light.range_m = -1.0;
        assert_eq!(
            light.check().unwrap_err().to_string(),
            "range is -1: it must be between 1e-6 and 1e9 metres"
        );
        let mut light = lamp();
        light.intensity = Vec3::ZERO;
        assert!(light.check().is_err());
        light.intensity = Vec3::new(1.0, f32::INFINITY, 0.0);
        assert!(light.check().is_err());
    }

    #[test]
    fn reach_is_signed_distance_to_the_edge() {
        let light = lamp();
        assert_eq!(light.reach(DVec3::new(1.0, 2.0, 3.0)), 1.0);
        assert_eq!(light.reach(DVec3::new(3.0, 2.0, 3.0)), 0.0);
        assert!(light.reach(DVec3::new(3.1, 2.0, 3.0)) < 0.0);
        let spot = Light {
            shape: LightShape::Spot { direction: Vec3::X, inner_angle: 0.1, outer_angle: 0.5 },
            ..light
        };
        assert!(spot.reach(DVec3::new(2.0, 2.0, 3.0)) > 0.0);
        assert!(spot.reach(DVec3::new(1.0, 3.0, 3.0)) < 0.0);
    }

    #[test]
    fn threshold_radius_is_the_surveys() {
        assert_eq!(Light::range_from_threshold(Vec3::splat(2.0), 0.02), 10.0);
    }
}
