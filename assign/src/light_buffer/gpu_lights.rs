//! Lights that a renderer's own kernel writes: its buffers, and what they must be.

use glam::Vec3;

use super::given::MAX_LIGHTS;
use crate::{AssignError, LightKinds, MAX_RANGE_M, MIN_RANGE_M};

/// Lights that a renderer's own kernel writes, in its own buffers.
///
/// The records are those of [`LightSphere`](crate::LightSphere) and
/// [`LightEmission`](crate::LightEmission), with the shape vectors that
/// [`Light::emission`](crate::Light::emission) lists.
///
/// # Faulty records
///
/// The GPU checks every record in every frame, as [`Light::check`](crate::Light::check) checks a
/// light. Faulty records light nothing and are counted
/// ([`LightBuffer::read_counts`](crate::LightBuffer::read_counts)). Besides what `check` rejects, a
/// record is faulty
///
/// - outside the stated [`bounds`](Self::bounds), [`radius_max_m`](Self::radius_max_m) and
///   [`kinds`](Self::kinds);
/// - if its shape vectors end beyond [`shapes`](Self::shapes);
/// - if its numbers contradict each other by more than rounding: 2e-6 of their size, or 1e-5 of an
///   emitter's squared size for its area. So a direction or normal has the length 1. A spot's sine, cosine and squared chord belong to one angle. A
///   virtual point light has the constants of a half space. An area light's ball holds its range
///   around its vertices, its half axes hold its vertices, a rectangle's vertices are its corners,
///   and its normal and area are those of its vertices.
///
/// A record does not show everything. These lights have the record of a sound light:
///
/// - a virtual point light whose least distance is negative, because the record has its square;
/// - a spot or a virtual point light whose direction has another length, because the record has the
///   direction of length 1;
/// - a spot whose inner angle is negative, NaN, or larger than the outer one, because the record has
///   only the steepness of the ramp;
/// - a spot whose outer angle is larger than π by less than 1e-3, or larger than 2π, because the
///   record has its sine and cosine.
#[derive(Clone, Copy, Debug)]
pub struct GpuLights<'a> {
    /// `array<LightSphere>`, usage `STORAGE`.
    pub spheres: &'a wgpu::Buffer,
    /// `array<LightEmission>`, usage `STORAGE`.
    pub emissions: &'a wgpu::Buffer,
    /// `array<vec4f>`: the shapes that the emissions' indices point to, usage `STORAGE`.
    pub shapes: &'a wgpu::Buffer,
    /// The buffer that holds the number of lights, usage `COPY_SRC`. A number above `capacity`
    /// counts as `capacity`.
    pub count: &'a wgpu::Buffer,
    /// Where the number of lights is in `count`, bytes; a multiple of 4.
    pub count_offset: u64,
    /// The most lights.
    pub capacity: u32,
    /// The kinds of lights that may occur. Shaders are compiled for these; others are faulty.
    pub kinds: LightKinds,
    /// A box that holds all positions in every frame: lowest and highest corner, world space,
    /// metres. A light outside is faulty.
    pub bounds: (Vec3, Vec3),
    /// The largest radius of a light's ball, metres. A larger light is faulty.
    pub radius_max_m: f32,
}

impl GpuLights<'_> {
    /// Checks everything but the lights themselves.
    pub(super) fn check(&self) -> Result<(), AssignError> {
        let fail = |field: &str, value: String, accepted: String| {
            Err(AssignError::Parameter {
                field: format!("lights from the GPU: {field}"),
                value,
                accepted,
            })
        };
        if self.capacity as usize > MAX_LIGHTS {
            return fail("capacity", self.capacity.to_string(), format!("at most {MAX_LIGHTS}"));
        }
        let records = u64::from(self.capacity) * 16;
        for (name, buffer, least, usage) in [
            ("spheres", self.spheres, records, wgpu::BufferUsages::STORAGE),
            ("emissions", self.emissions, records, wgpu::BufferUsages::STORAGE),
            ("shapes", self.shapes, 16, wgpu::BufferUsages::STORAGE),
            (
                "count",
                self.count,
                self.count_offset.saturating_add(4),
                wgpu::BufferUsages::COPY_SRC,
            ),
        ] {
            if buffer.size() < least {
                return fail(
                    name,
                    format!("{} bytes", buffer.size()),
                    format!("at least {least} bytes"),
                );
            }
            if !buffer.usage().contains(usage) {
                return fail(name, format!("{:?}", buffer.usage()), format!("usage {usage:?}"));
            }
        }
        if !self.count_offset.is_multiple_of(4) {
            return fail("count_offset", self.count_offset.to_string(), "a multiple of 4".into());
        }
        let (low, high) = self.bounds;
        if !(low.is_finite() && high.is_finite() && low.cmple(high).all()) {
            return fail(
                "bounds",
                format!("{low} to {high}"),
                "finite corners, lowest first".into(),
            );
        }
        // An emitter may add to the range.
        if !(MIN_RANGE_M..=2.0 * MAX_RANGE_M).contains(&self.radius_max_m) {
            let accepted = format!("{MIN_RANGE_M} to {} metres", 2.0 * MAX_RANGE_M);
            return fail("radius_max_m", self.radius_max_m.to_string(), accepted);
        }
        Ok(())
    }
}
