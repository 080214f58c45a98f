//! Collects what this crate's many small kernels use: the short forms of `assign::kernel`, layouts of pipelines
//! that are made here, and shader modules without loop counters.

pub(crate) use assign::kernel::{Slot, bind_buffers, bind_entries, layout, pipeline, workgroups};
use assign::{AssignError, Gpu, Shader};

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
