//! Pipelines over the scene's vertices.

use assign::{DepthMapping, Gpu};

use crate::{DEPTH_FORMAT, Vertex};

/// The fixed state of a pipeline.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    /// The format of colours.
    pub format: wgpu::TextureFormat,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
    /// The direction of depth.
    pub depth: DepthMapping,
    /// Whether it blends colours over the opaque surfaces.
    pub is_glass: bool,
}

impl Draw {
    /// A pipeline over vertices of position, normal and colour. Without a fragment shader, it draws depth.
    pub fn pipeline(
        self,
        gpu: &Gpu,
        module: &wgpu::ShaderModule,
        group: &wgpu::BindGroupLayout,
        fragment: Option<&str>,
    ) -> wgpu::RenderPipeline {
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(group)],
            immediate_size: 0,
        });
        let nearer = match self.depth {
            DepthMapping::Standard => wgpu::CompareFunction::Less,
            DepthMapping::Reversed => wgpu::CompareFunction::Greater,
        };
        let is_opaque = fragment.is_some() && !self.is_glass;
        let targets = [Some(wgpu::ColorTargetState {
            format: self.format,
            blend: self.is_glass.then_some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        })];
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: fragment,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(Vertex::LAYOUT)],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(fragment.is_none()),
                depth_compare: Some(if is_opaque { wgpu::CompareFunction::Equal } else { nearer }),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module,
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
