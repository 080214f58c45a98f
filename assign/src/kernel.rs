//! Makes what compute kernels need: bind group layouts, bind groups and pipelines over whole buffers.
//!
//! A kernel is an entry point of a module that [`Shader`](crate::Shader) linked. Layouts and pipelines
//! come from the device's store ([`Gpu::bind_group_layout`], [`Gpu::compute_pipeline`]), so equal ones
//! are made once. `conformance::run_kernel` runs a kernel once, for tests and examples.

use crate::{
    Gpu,
    entries::{entry, storage_entry, uniform_entry},
};

/// The most workgroups of a dispatch along one axis.
pub const MAX_WORKGROUPS: u32 = 65_535;

/// The kind of a buffer binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// A uniform buffer.
    Uniform,
    /// A uniform buffer with a dynamic offset, given when the bind group is set.
    UniformAt,
    /// A storage buffer that the kernel only reads.
    Read,
    /// A storage buffer that the kernel reads and writes.
    Write,
}

impl Slot {
    /// The layout entry of this slot.
    pub fn entry(self, binding: u32, stages: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
        match self {
            Self::Uniform => uniform_entry(binding, stages),
            Self::UniformAt => wgpu::BindGroupLayoutEntry {
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: None,
                },
                ..uniform_entry(binding, stages)
            },
            Self::Read => storage_entry(binding, stages, true),
            Self::Write => storage_entry(binding, stages, false),
        }
    }
}

/// The layout of `slots` at bindings 0, 1, 2 and so on.
pub fn layout(
    gpu: &Gpu,
    label: &str,
    stages: wgpu::ShaderStages,
    slots: &[Slot],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> =
        (0..).zip(slots).map(|(binding, slot)| slot.entry(binding, stages)).collect();
    gpu.bind_group_layout(label, &entries)
}

/// A bind group of whole buffers at bindings 0, 1, 2 and so on. What is bound in every frame goes through
/// [`KeptBindGroup`](crate::KeptBindGroup) instead.
pub fn bind_buffers(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entries: Vec<_> =
        (0..).zip(buffers).map(|(binding, buffer)| entry(binding, buffer)).collect();
    bind_entries(gpu, layout, &entries)
}

/// A bind group of any entries.
pub fn bind_entries(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    entries: &[wgpu::BindGroupEntry<'_>],
) -> wgpu::BindGroup {
    gpu.bind_group("kernel", layout, entries)
}

/// The pipeline of an entry point over bind groups 0, 1, 2 and so on. A kernel that leaves some groups
/// unused takes `Option`s, `None` for each of those. Its workgroup memory starts undefined: the kernel
/// writes what it reads.
pub fn pipeline<'a, L: Copy + Into<Option<&'a wgpu::BindGroupLayout>>>(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    layouts: &[L],
) -> wgpu::ComputePipeline {
    let layouts: Vec<_> = layouts.iter().copied().map(Into::into).collect();
    gpu.compute_pipeline(module, entry_point, &layouts, false)
}

/// Workgroups of `size` lanes for `items`, at most [`MAX_WORKGROUPS`]: kernels stride over the rest.
pub fn workgroups(items: u64, size: u32) -> u32 {
    items.div_ceil(u64::from(size)).min(u64::from(MAX_WORKGROUPS)) as u32
}
