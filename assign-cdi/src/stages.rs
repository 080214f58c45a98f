//! Stages of a build: the directions that one dispatch covers, and the sizes of dispatches.

use assign::{AssignError, Gpu};
use bytemuck::{Pod, Zeroable, bytes_of};

use crate::{Build, DeepImageSettings};

/// One dispatch over directions: `struct Stage` of `build.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct StageUniform {
    /// First direction of the dispatch.
    pub first_direction: u32,
    /// 0 counts fragments, 1 writes them.
    pub mode: u32,
}

/// Mode of a stage that counts fragments: `COUNT` of `build.wesl`.
pub(crate) const COUNT: u32 = 0;
/// Mode of a stage that writes fragments: `FILL` of `build.wesl`.
pub(crate) const FILL: u32 = 1;

/// What the kernels that size dispatches read: `struct Plan` of `plan.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct PlanUniform {
    /// Directions per stage over large triangles.
    pub directions_at_once: u32,
}

/// Sizes of indirect dispatches: `struct Dispatches` of `plan.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct DispatchSizes {
    /// Workgroups over samples.
    pub samples: [u32; 3],
    /// Pads to a multiple of 16 bytes.
    pub padding: u32,
    /// Workgroups over large triangles.
    pub large: [u32; 3],
    /// Pads to a multiple of 16 bytes.
    pub padding_end: u32,
}

/// Offset of the dispatch over large triangles, bytes.
pub(crate) const LARGE_AT: u64 = 16;

/// Bytes from one [`StageUniform`] to the next.
const STAGE_STRIDE: u32 = 256;

/// The buffers of the stages, and of the sizes of their dispatches.
#[derive(Debug)]
pub(crate) struct Stages {
    /// One [`StageUniform`] every 256 bytes: first those that count, then those that write.
    uniforms: wgpu::Buffer,
    /// Stages per mode.
    count: u32,
    /// [`PlanUniform`].
    pub(crate) plan: wgpu::Buffer,
    /// [`DispatchSizes`].
    pub(crate) dispatches: wgpu::Buffer,
}

impl Stages {
    pub(crate) fn new(gpu: &Gpu, settings: &DeepImageSettings) -> Result<Self, AssignError> {
        let count = first_directions(settings).count() as u32;
        let stride = u64::from(STAGE_STRIDE);
        let uniforms = gpu.uniform("stages", 2 * u64::from(count) * stride);
        let modes = [COUNT, FILL].into_iter();
        let all = modes.flat_map(|mode| first_directions(settings).map(move |first| (first, mode)));
        for (at, (first_direction, mode)) in (0_u64..).zip(all) {
            let stage = StageUniform { first_direction, mode };
            gpu.queue.write_buffer(&uniforms, at * stride, bytes_of(&stage));
        }
        let plan = gpu.uniform("plan", 16);
        let directions_at_once = match settings.build {
            Build::SinglePass { .. } => 1,
            Build::PerDirection { at_once, .. } => at_once,
        };
        gpu.queue.write_buffer(&plan, 0, bytes_of(&PlanUniform { directions_at_once }));
        let copies = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | copies;
        let dispatches = gpu.buffer("dispatches", size_of::<DispatchSizes>() as u64, usage)?;
        Ok(Self { uniforms, count, plan, dispatches })
    }

    /// One stage at binding 0. A dynamic offset selects it.
    pub(crate) fn entry(&self) -> wgpu::BindGroupEntry<'_> {
        wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &self.uniforms,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<StageUniform>() as u64),
            }),
        }
    }

    /// Dynamic offsets of the stages of a mode.
    pub(crate) fn offsets(&self, mode: u32) -> impl Iterator<Item = u32> + use<> {
        let first = mode * self.count;
        (first..first + self.count).map(|stage| stage * STAGE_STRIDE)
    }

    /// Bytes of its buffers on the GPU.
    pub(crate) fn bytes(&self) -> u64 {
        self.uniforms.size() + self.plan.size() + self.dispatches.size()
    }
}

/// Directions per stage.
pub(crate) fn at_once(settings: &DeepImageSettings) -> u32 {
    match settings.build {
        Build::SinglePass { .. } => settings.directions.count(),
        Build::PerDirection { at_once, .. } => at_once,
    }
}

/// First direction of each stage.
fn first_directions(settings: &DeepImageSettings) -> impl Iterator<Item = u32> + use<> {
    (0..settings.directions.count()).step_by(at_once(settings).max(1) as usize)
}
