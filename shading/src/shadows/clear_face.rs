//! Clears single faces of the shadow atlas, where others must keep their depth.

use assign::{AssignError, Gpu, Shader};

use crate::targets::DEPTH_FORMAT;

/// A pipeline that sets the depth of a viewport to infinitely far, whatever it was.
pub(super) fn clear_face(gpu: &Gpu) -> Result<wgpu::RenderPipeline, AssignError> {
    let shader =
        Shader::new(1).module("package::clear_depth", include_str!("../shaders/clear_depth.wesl"));
    let module = shader.create(gpu, "package::clear_depth")?;
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("clear a face"),
        ..Default::default()
    });
    Ok(gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("clear a face"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    }))
}
