//! Lights with compact support.
//!
//! Every light's contribution is multiplied by the window `(1 - (d / range)^4)^2`, clamped at 0,
//! where `d` is the distance to the closest point of the emitter. So a light reaches exactly one
//! set of points, its *support*: a ball, a ball cut by a cone, half a ball, a rounded line, or a rounded
//! rectangle, polygon or disc that its plane cuts if it is one-sided. Culling and shading read the same `range`.

use glam::{DVec3, Vec3};

use crate::{emitter::Emitter, light_fault::LightFault};

/// The kind of a light, with the parameters of that kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// Emits equally in all directions.
    Point,
    /// Emits into a cone (KHR_lights_punctual) with full intensity up to the inner angle. Between
    /// the two angles the intensity falls off as `((cos θ - cos outer) / (cos inner - cos
    /// outer))^2`.
    Spot {
        /// The cone's axis, of unit length, world space.
        direction: Vec3,
        /// Half angle of full intensity, radians, `0 <= inner <= outer`.
        inner_angle: f32,
        /// Half angle at which the light ends, radians, [`MIN_SPOT_ANGLE`] to π.
        outer_angle: f32,
    },
    /// Emits the same radiance from every point of an emitter, in every direction in front of its
    /// surface.
    Area(Emitter),
    /// A virtual point light: emits from a point into the half space in front of it, by the cosine
    /// to its normal, as a matte surface does.
    Vpl {
        /// The surface's unit normal, world space. The light's intensity is the intensity along it.
        normal: Vec3,
        /// Distance below which inverse-square fall-off stops growing, metres, 0 to
        /// [`MAX_RANGE_M`]. A point close by would send more light than the surface that it stands
        /// for.
        min_distance_m: f32,
    },
}

/// One light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position, metres. An area light's position is the centre of its rectangle, or of the
    /// smallest rectangle around its polygon, and the middle of every other emitter.
    pub position: Vec3,
    /// Distance at which the light's window reaches 0, metres, [`MIN_RANGE_M`] to [`MAX_RANGE_M`].
    pub range_m: f32,
    /// Radiant intensity, linear RGB, each channel 0 to [`MAX_INTENSITY`] and not all 0. For an
    /// area light it is the intensity along the normal: radiance times area. A sphere has the same intensity in
    /// all directions, and a line that across its axis: radiance times [`Emitter::area`].
    pub intensity: Vec3,
    /// What kind of light it is.
    pub shape: LightShape,
}

impl Light {
    /// A point light.
    pub fn point(position: Vec3, range_m: f32, intensity: Vec3) -> Self {
        Self { position, range_m, intensity, shape: LightShape::Point }
    }

    /// An area light. A polygon's `position` is the one that [`Emitter::polygon`] returned; a
    /// rectangle's is free.
    pub fn area(emitter: Emitter, position: Vec3, range_m: f32, intensity: Vec3) -> Self {
        Self { position, range_m, intensity, shape: LightShape::Area(emitter) }
    }

    /// A virtual point light.
    pub fn vpl(position: Vec3, normal: Vec3, range_m: f32, intensity: Vec3) -> Self {
        let shape = LightShape::Vpl { normal, min_distance_m: 0.0 };
        Self { position, range_m, intensity, shape }
    }

    /// The range at which an unbounded light's intensity over squared distance falls to
    /// `threshold`: `sqrt(max(intensity) / threshold)` (Watrous 2024, "Light volumes").
    pub fn range_from_threshold(intensity: Vec3, threshold: f32) -> f32 {
        (intensity.max_element() / threshold).sqrt()
    }

    /// The range of an area light's diffuse term by the rule of Swarbrick 2025 (listing 4.1),
    /// metres. At this distance the light's flux, times a factor tuned by eye, spread over a
    /// hemisphere falls to the irradiance `least`. The rule's flux is the sum over channels of
    /// radiance times area.
    pub fn influence_radius(intensity: Vec3, least: f32) -> f32 {
        const TUNED: f32 = 4.4;
        (TUNED * intensity.element_sum() / (std::f32::consts::TAU * least)).sqrt()
    }

    /// Radius of a ball around the light's position that contains its support, metres.
    pub fn radius_m(&self) -> f32 {
        match &self.shape {
            LightShape::Area(emitter) => (self.range_m + emitter.radius()).next_up(),
            LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => self.range_m,
        }
    }

    /// Distance at which the window of the diffuse term reaches 0, metres.
    pub fn diffuse_range_m(&self) -> f32 {
        match &self.shape {
            LightShape::Area(emitter) => self.range_m * emitter.diffuse_share,
            LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => self.range_m,
        }
    }

    /// Checks every field. [`LightBuffer`](crate::LightBuffer) omits faulty lights. For lights that
    /// a renderer's own kernel writes, the GPU checks their records in the same way
    /// ([`GpuLights`](crate::GpuLights)).
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
            return Err(LightFault::DARK);
        }
        if let LightShape::Spot { direction, inner_angle, outer_angle } = self.shape {
            finite("spot direction", direction)?;
            finite("spot angle", Vec3::new(inner_angle, outer_angle, 0.0))?;
            let length = direction.length();
            if (length - 1.0).abs() > 1e-3 {
                return out("spot direction", length, "of length 1");
            }
            if !(MIN_SPOT_ANGLE..=std::f32::consts::PI).contains(&outer_angle) {
                return out("spot outer angle", outer_angle, "between 1e-5 and pi radians");
            }
            if !(0.0..=outer_angle).contains(&inner_angle) {
                return out("spot inner angle", inner_angle, "between 0 and the outer angle");
            }
        }
        if let LightShape::Area(emitter) = &self.shape {
            emitter.check()?;
            if self.diffuse_range_m() < MIN_RANGE_M {
                return out("diffuse range", self.diffuse_range_m(), "at least 1e-6 metres");
            }
        }
        if let LightShape::Vpl { normal, min_distance_m } = self.shape {
            finite("VPL normal", normal)?;
            finite("VPL minimum distance", Vec3::splat(min_distance_m))?;
            let length = normal.length();
            if (length - 1.0).abs() > 1e-3 {
                return out("VPL normal", length, "of length 1");
            }
            if !(0.0..=MAX_RANGE_M).contains(&min_distance_m) {
                return out("VPL minimum distance", min_distance_m, "between 0 and 1e9 metres");
            }
        }
        Ok(())
    }

    /// How far `point` lies inside the light's support, in f64, as a share of the range (and of the
    /// cone). It is positive inside, 0 on the edge and negative outside. Lists are checked against
    /// it.
    pub fn reach(&self, point: DVec3) -> f64 {
        let to_point = point - self.position.as_dvec3();
        let distance = to_point.length();
        let ball = 1.0 - distance / f64::from(self.range_m);
        // Relative to the value on the axis, so that even the narrowest cone has an inside.
        let cone = |axis: Vec3, cos_outer: f64| {
            let inside = axis.as_dvec3().normalize().dot(to_point) / distance - cos_outer;
            if distance == 0.0 { ball } else { ball.min(inside / (1.0 - cos_outer).min(1.0)) }
        };
        match self.shape {
            LightShape::Point => ball,
            LightShape::Spot { direction, outer_angle, .. } => {
                cone(direction, f64::from(outer_angle).cos())
            }
            LightShape::Vpl { normal, .. } => cone(normal, 0.0),
            LightShape::Area(emitter) => {
                let range = f64::from(self.range_m);
                let window = 1.0 - to_point.distance(emitter.closest(to_point)) / range;
                if emitter.two_sided && !emitter.is_solid() {
                    window
                } else {
                    window.min(emitter.in_front(to_point) / range)
                }
            }
        }
    }

    /// As [`reach`](Self::reach), for the support of the light's diffuse term.
    pub fn diffuse_reach(&self, point: DVec3) -> f64 {
        Self { range_m: self.diffuse_range_m(), ..*self }.reach(point)
    }

    /// How far the light rises above the horizon of a surface at `point`, in f64, as a share of its
    /// range. A light at or below the horizon does not light the surface.
    pub fn above_horizon(&self, point: DVec3, normal: DVec3) -> f64 {
        let height = normal.dot(self.position.as_dvec3() - point);
        let rise = match &self.shape {
            LightShape::Area(emitter) => emitter.extent_along(normal),
            LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => 0.0,
        };
        (height + rise) / f64::from(self.range_m)
    }
}

/// The shortest accepted range, metres. Its square stays far above f32's smallest number.
pub const MIN_RANGE_M: f32 = 1e-6;

/// The longest accepted range, metres. Its square stays far below f32's largest number.
pub const MAX_RANGE_M: f32 = 1e9;

/// The smallest accepted half angle of a spot, radians. A unit vector in f32 is accurate to 1e-7.
pub const MIN_SPOT_ANGLE: f32 = 1e-5;

/// The greatest accepted radiant intensity of a channel. Fall-off multiplies it by up to 1e4 and
/// GGX's peak by up to 8e4; 2^20 such lights still sum to a finite f32.
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
