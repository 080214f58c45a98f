//! Lights that a renderer's own kernel writes: its buffers, and what they must be.

use glam::Vec3;

use super::given::MAX_LIGHTS;
use crate::{AssignError, Gpu, LightKinds, MAX_RANGE_M, MIN_RANGE_M};

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
///   and its normal and area are those of its vertices. The half axes of a disc are as long as its
///   radius, at right angles to each other and to its normal. A sphere has neither half axes nor a
///   normal, and a line has one half axis. Their areas are those of their radius and length.
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
    /// `array<vec4f>`: the shapes that the emissions' indices point to, usage `STORAGE`. To
    /// [read](crate::LightBuffer::read) spots and area lights back, also `COPY_SRC`.
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

/// The error of a field of [`GpuLights`].
pub(super) fn refused(field: &str, value: String, accepted: String) -> AssignError {
    AssignError::Parameter { field: format!("lights from the GPU: {field}"), value, accepted }
}

impl GpuLights<'_> {
    /// [`step_max_m`](Self::step_max_m) with the rounding that the GPU's check allows.
    pub(super) fn step_m(&self) -> Option<f32> {
        self.step_max_m.map(|step_m| step_m * (1.0 + 2e-6) + 4e-6 * self.radius_max_m)
    }

    /// Checks everything but the lights themselves.
    pub(super) fn check(&self, gpu: &Gpu) -> Result<(), AssignError> {
        let fail = |field, value, accepted| Err(refused(field, value, accepted));
        if self.capacity as usize > MAX_LIGHTS {
            return fail("capacity", self.capacity.to_string(), format!("at most {MAX_LIGHTS}"));
        }
        // No binding may be empty.
        let records = (u64::from(self.capacity) * 16).max(16);
        for (name, buffer, least) in [
            ("spheres", self.spheres, records),
            ("emissions", self.emissions, records),
            ("shapes", self.shapes, 16),
        ] {
            check_buffer(name, buffer, least, wgpu::BufferUsages::STORAGE)?;
            // The whole buffer is bound.
            let (bytes, limit) = (buffer.size(), gpu.max_storage_bytes());
            if bytes > limit {
                let accepted = format!("at most {limit} bytes, the largest binding of the device");
                return fail(name, format!("{bytes} bytes"), accepted);
            }
            if !bytes.is_multiple_of(4) {
                return fail(name, format!("{bytes} bytes"), "a multiple of 4 bytes".into());
            }
        }
        let end = self.count_offset.saturating_add(4);
        check_buffer("count", self.count, end, wgpu::BufferUsages::COPY_SRC)?;
        if !self.count_offset.is_multiple_of(4) {
            return fail("count_offset", self.count_offset.to_string(), "a multiple of 4".into());
        }
        let (low, high) = self.bounds;
        if !(low.is_finite() && high.is_finite() && low.cmple(high).all()) {
            let accepted = "finite corners, lowest first".into();
            return fail("bounds", format!("{low} to {high}"), accepted);
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

/// Checks the size and the usage of a buffer.
fn check_buffer(
    name: &str,
    buffer: &wgpu::Buffer,
    least: u64,
    usage: wgpu::BufferUsages,
) -> Result<(), AssignError> {
    if buffer.size() < least {
        let accepted = format!("at least {least} bytes");
        return Err(refused(name, format!("{} bytes", buffer.size()), accepted));
    }
    check_usage(name, buffer, usage, "")
}

/// Checks the usage of a buffer; `purpose` follows the accepted usage.
pub(super) fn check_usage(
    name: &str,
    buffer: &wgpu::Buffer,
    usage: wgpu::BufferUsages,
    purpose: &str,
) -> Result<(), AssignError> {
    if buffer.usage().contains(usage) {
        return Ok(());
    }
    let accepted = format!("usage {usage:?}{purpose}");
    Err(refused(name, format!("{:?}", buffer.usage()), accepted))
}
