//! Lights in the renderer's own buffers.

use glam::Vec3;

use super::given::MAX_LIGHTS;
use crate::{AssignError, LightKinds, MAX_RANGE_M, MIN_RANGE_M};

/// Lights that a renderer's own kernel writes, in its own buffers.
///
/// The records are those of [`LightSphere`], [`LightEmission`] and the shape vectors that
/// [`LightKind`](crate::LightKind) lists. Faulty records light nothing and are counted
/// ([`LightBuffer::read_counts`](crate::LightBuffer::read_counts)).
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
    /// How far a light's ball may reach beyond its ball of the frame before, metres; `None` if there is
    /// no bound. [`Keep`](crate::Keep) relies on it. A light that goes further is faulty until the next
    /// sort, and so is one that is new or becomes bright.
    pub step_max_m: Option<f32>,
}

impl GpuLights<'_> {
    /// [`step_max_m`](Self::step_max_m) with the rounding that the GPU's check allows.
    pub(super) fn step_m(&self) -> Option<f32> {
        self.step_max_m.map(|step_m| step_m * (1.0 + 2e-6) + 4e-6 * self.radius_max_m)
    }

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
        if let Some(step_m) = self.step_max_m
            && !(0.0..=MAX_RANGE_M).contains(&step_m)
        {
            return fail("step_max_m", step_m.to_string(), format!("0 to {MAX_RANGE_M} metres"));
        }
        Ok(())
    }
}
