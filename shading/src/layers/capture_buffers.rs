//! The buffers to which passes write their samples, instead of lighting them.

use assign::{AssignError, Gpu, entry, storage_entry, texture, texture_entry};
use bytemuck::cast_slice;

use crate::probe::CAPTURED_BYTES;

/// Bindings of `capture.wesl` in group 2.
const KEPT_BINDING: u32 = 22;
const COUNT_BINDING: u32 = 23;
const DEPTH_BINDING: u32 = 25;

/// What a pass writes its samples to.
#[derive(Debug)]
pub(super) struct CaptureBuffers {
    /// Records of the samples that are kept.
    pub(super) kept: wgpu::Buffer,
    /// The number of samples, and of which every so many one is kept.
    pub(super) count: wgpu::Buffer,
}

impl CaptureBuffers {
    /// Makes room for `room` samples, of which every `step`th one is kept.
    pub(super) fn new(gpu: &Gpu, room: u32, step: u32) -> Result<Self, AssignError> {
        let count = gpu.storage("capture count", 8)?;
        gpu.queue.write_buffer(&count, 0, cast_slice(&[0, step]));
        // A shader's array has at least one element.
        let kept = gpu.storage("captured samples", u64::from(room.max(1)) * CAPTURED_BYTES)?;
        Ok(Self { kept, count })
    }

    pub(super) fn layout(stages: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 2] {
        [KEPT_BINDING, COUNT_BINDING].map(|binding| storage_entry(binding, stages, false))
    }

    pub(super) fn entries(&self) -> [wgpu::BindGroupEntry<'_>; 2] {
        [entry(KEPT_BINDING, &self.kept), entry(COUNT_BINDING, &self.count)]
    }

    /// The depths of opaque surfaces, which hide fragments.
    pub(super) fn depth_layout(stages: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
        texture_entry(DEPTH_BINDING, stages, wgpu::TextureSampleType::Depth)
    }

    pub(super) fn depth_entry(depth: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
        texture(DEPTH_BINDING, depth)
    }
}
