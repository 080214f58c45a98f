//! Short forms of wgpu's descriptors for this crate's many small kernels.

use assign::{AssignError, Gpu, Shader, entry, storage_entry, uniform_entry};

/// What a binding of a kernel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    /// A uniform buffer.
    Uniform,
    /// A uniform buffer, bound at an offset given with the bind group.
    UniformAt,
    /// A storage buffer that is only read.
    Read,
    /// A storage buffer.
    Write,
}

/// A layout of `slots`, bindings 0, 1, 2 and so on.
pub(crate) fn layout(
    gpu: &Gpu,
    label: &str,
    stages: wgpu::ShaderStages,
    slots: &[Slot],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(slots)
        .map(|(binding, slot)| match slot {
            Slot::Uniform => uniform_entry(binding, stages),
            Slot::UniformAt => wgpu::BindGroupLayoutEntry {
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: None,
                },
                ..uniform_entry(binding, stages)
            },
            Slot::Read => storage_entry(binding, stages, true),
            Slot::Write => storage_entry(binding, stages, false),
        })
        .collect();
    gpu.bind_group_layout(label, &entries)
}

/// A bind group of whole buffers, bindings 0, 1, 2 and so on.
pub(crate) fn group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..).zip(buffers).map(|(at, buffer)| entry(at, buffer)).collect();
    group_of(gpu, layout, &entries)
}

/// A bind group.
pub(crate) fn group_of(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    entries: &[wgpu::BindGroupEntry<'_>],
) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries })
}

/// A layout of bind groups 0, 1, 2 and so on.
pub(crate) fn pipeline_layout(
    gpu: &Gpu,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    })
}

/// A compute pipeline of an entry point.
pub(crate) fn compute(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::ComputePipeline {
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    // The kernels write the workgroup memory that they read.
    gpu.compute_pipeline(module, entry_point, &layouts, false)
}

/// Makes a shader module whose loops are not counted.
pub(crate) fn uncounted(
    gpu: &Gpu,
    shader: &Shader<'_>,
    root: &str,
) -> Result<wgpu::ShaderModule, AssignError> {
    // SAFETY: the loops of this crate's shaders run over ranges clamped to their buffers, and end
    // by themselves whatever the buffers hold.
    #[allow(unsafe_code, reason = "counted loops are not unrolled; these end by themselves")]
    unsafe {
        shader.create_uncounted(gpu, root)
    }
}

/// Workgroups for `items`, `size` a workgroup; kernels stride over what is left beyond the device's
/// limit.
pub(crate) fn workgroups(items: u64, size: u32) -> u32 {
    items.div_ceil(u64::from(size)).min(65_535) as u32
}
