//! Buffers of lights as a renderer's own kernel would write them.

use bytemuck::cast_slice;
use glam::Vec3;

use super::{plan::Lit, run_kernel::upload};
use crate::{AssignError, Gpu, GpuLights, Light, LightKinds, light_buffer::Records};

/// A renderer's own buffers.
pub(super) struct Feed {
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
    count: wgpu::Buffer,
    capacity: u32,
    bounds: (Vec3, Vec3),
    radius_max_m: f32,
}

/// The number of lights is the second word of its buffer.
const COUNT_OFFSET: u64 = 4;

impl Feed {
    /// Makes room for the lights of every frame.
    pub(super) fn new(gpu: &Gpu, frames: &[Lit]) -> Result<Self, AssignError> {
        let capacity = frames.iter().map(|lit| lit.lights.len()).max().unwrap_or(0);
        let shapes = frames.iter().map(|lit| Records::new(&lit.lights).shapes.len()).max();
        let sound = || frames.iter().flat_map(|lit| &lit.lights).filter(|l| l.check().is_ok());
        Ok(Self {
            spheres: upload(gpu, "own spheres", &vec![[0.0_f32; 4]; capacity])?,
            emissions: upload(gpu, "own emissions", &vec![[0.0_f32; 4]; capacity])?,
            shapes: upload(gpu, "own shapes", &vec![[0.0_f32; 4]; shapes.unwrap_or(0).max(1)])?,
            count: upload(gpu, "own count", &[u32::MAX, 0, u32::MAX, 0])?,
            capacity: capacity as u32,
            bounds: (
                sound().map(|l| l.position).fold(Vec3::splat(1e9), Vec3::min),
                sound().map(|l| l.position).fold(Vec3::splat(-1e9), Vec3::max),
            ),
            radius_max_m: sound().map(Light::radius_m).fold(1.0, f32::max),
        })
    }

    /// Writes a frame's lights, faulty ones as they are, and their number.
    pub(super) fn write(&self, gpu: &Gpu, lights: &[Light]) {
        let records = Records::new(lights);
        let [spheres, emissions, shapes] = records.bytes();
        gpu.queue.write_buffer(&self.spheres, 0, spheres);
        gpu.queue.write_buffer(&self.emissions, 0, emissions);
        gpu.queue.write_buffer(&self.shapes, 0, shapes);
        gpu.queue.write_buffer(&self.count, COUNT_OFFSET, cast_slice(&[lights.len() as u32]));
    }

    /// The buffers as the contract takes them.
    pub(super) fn lights(&self) -> GpuLights<'_> {
        GpuLights {
            spheres: &self.spheres,
            emissions: &self.emissions,
            shapes: &self.shapes,
            count: &self.count,
            count_offset: COUNT_OFFSET,
            capacity: self.capacity,
            kinds: LightKinds::EVERY,
            bounds: self.bounds,
            radius_max_m: self.radius_max_m,
            step_max_m: None,
        }
    }
}
