//! Lights from their records on the GPU, for checks on the CPU.

use glam::Vec3;

use crate::{
    Emitter, Light, LightEmission, LightKind, LightShape, LightSphere, MAX_VERTICES, MIN_RANGE_M,
    Outline,
};

/// More vertices than any emitter has: an emitter of so many is refused.
const MAX_SHAPES: f32 = MAX_VERTICES as f32 + 1.0;

/// The light of an empty slot.
pub(super) const EMPTY: Light = Light {
    position: Vec3::ZERO,
    range_m: MIN_RANGE_M,
    intensity: Vec3::ZERO,
    shape: LightShape::Point,
};

impl Light {
    /// The light of a record on the GPU; `shapes` are the shape vectors that its index points into. A
    /// spot's inner angle is 0, because the record has only the outer one. A record with shapes that
    /// make no light gives a light of intensity 0.
    pub fn from_record(
        sphere: &LightSphere,
        emission: &LightEmission,
        shapes: &[[f32; 4]],
    ) -> Self {
        let vector = |ix: u32| {
            let place = (emission.kind_and_shape & 0x0fff_ffff) as usize + ix as usize;
            shapes.get(place).copied().unwrap_or_default()
        };
        let direction = |v: [f32; 4]| Vec3::from_slice(&v[..3]);
        let light = |range_m, shape| Light {
            position: sphere.position_world.into(),
            range_m,
            intensity: emission.intensity.into(),
            shape,
        };
        let kinds = [
            LightKind::Point,
            LightKind::Spot,
            LightKind::Rectangle,
            LightKind::Polygon,
            LightKind::Vpl,
            LightKind::Disc,
            LightKind::Sphere,
            LightKind::Line,
        ];
        let kind = kinds.into_iter().find(|&kind| kind as u32 == emission.kind_and_shape >> 28);
        match kind {
            Some(LightKind::Point) => light(sphere.radius_m, LightShape::Point),
            Some(LightKind::Spot) => {
                let axis = vector(0);
                let outer_angle = vector(1)[1].atan2(axis[3]);
                let shape =
                    LightShape::Spot { direction: direction(axis), inner_angle: 0.0, outer_angle };
                light(sphere.radius_m, shape)
            }
            Some(LightKind::Vpl) => {
                let min_distance_m = vector(1)[2].max(0.0).sqrt();
                let shape = LightShape::Vpl { normal: direction(vector(0)), min_distance_m };
                light(sphere.radius_m, shape)
            }
            Some(kind) => {
                let (normal_range, x_diffuse, y_count) = (vector(0), vector(1), vector(2));
                let range_m = normal_range[3];
                let outline = match kind {
                    LightKind::Rectangle => Outline::Rectangle,
                    LightKind::Disc => Outline::Disc,
                    LightKind::Sphere => Outline::Sphere,
                    LightKind::Line => Outline::Line,
                    _ => Outline::Polygon,
                };
                let count = if outline.is_curved() { 0.0 } else { y_count[3].abs() };
                let corners: Vec<Vec3> = (4..)
                    .take(count.min(MAX_SHAPES) as usize)
                    .map(|ix| direction(vector(ix)))
                    .collect();
                let half_axes = [direction(x_diffuse), direction(y_count)];
                let parts = Emitter::from_parts(outline, half_axes, vector(3)[1], &corners);
                let Some(mut emitter) = parts else { return EMPTY };
                emitter.two_sided = y_count[3] < 0.0 && !emitter.is_solid();
                emitter.diffuse_share = x_diffuse[3] / range_m;
                light(range_m, LightShape::Area(emitter))
            }
            None => EMPTY,
        }
    }
}
