//! What adds lights to cells: compute lanes, or the rasteriser.

use assign::{AssignError, Gpu, LightKinds, Passes, kernel};

use super::shader::{HybridShader, LISTS_GROUP};

/// What walks the tiles of each light's outline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scatter {
    /// 32 lanes of a compute shader per light (Archer et al. 2019).
    #[default]
    Compute,
    /// The rasteriser: one instance per light, one fragment per tile (Örtegren and Persson 2016, "Clustered Shading:
    /// Assigning Lights Using Conservative Rasterization in DirectX 12", GPU Pro 7; also in Bevy and Godot). The
    /// device needs `wgpu::DownlevelFlags::FRAGMENT_WRITABLE_STORAGE`, which all of WebGPU has.
    Raster,
}

/// Format of the raster target. Nothing is written to it: a render pass must have a target.
const TARGET: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

impl Scatter {
    /// Its segment of an id: `/raster`, or nothing.
    pub fn segment(self) -> &'static str {
        match self {
            Self::Compute => "",
            Self::Raster => "/raster",
        }
    }

    /// The stages that read and write cells.
    pub(super) fn stages(self) -> wgpu::ShaderStages {
        match self {
            Self::Compute => wgpu::ShaderStages::COMPUTE,
            Self::Raster => wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT,
        }
    }

    /// The stages that read the cells' uniforms.
    pub(super) fn uniform_stages(self) -> wgpu::ShaderStages {
        match self {
            Self::Compute => wgpu::ShaderStages::COMPUTE,
            Self::Raster => wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::VERTEX_FRAGMENT,
        }
    }
}

/// The pipeline that adds lights to cells.
#[derive(Clone, Debug)]
pub(super) enum ScatterPipeline {
    Compute(wgpu::ComputePipeline),
    Raster(wgpu::RenderPipeline),
}

/// What a scatter pass binds: the frame and the cells.
pub(super) type Bound<'a> = [Option<&'a wgpu::BindGroup>; 2];

/// The raster target: one pixel per tile.
#[derive(Debug)]
pub(super) struct Target(wgpu::TextureView);

impl ScatterPipeline {
    /// Compiles it for kinds of lights. `layouts` are those of the frame and of the cells.
    pub(super) fn new(
        gpu: &Gpu,
        scatter: Scatter,
        kinds: LightKinds,
        layouts: [&wgpu::BindGroupLayout; 2],
    ) -> Result<Self, AssignError> {
        Ok(match scatter {
            Scatter::Compute => {
                let module = HybridShader::Scatter.create(gpu, kinds)?;
                Self::Compute(kernel::pipeline(gpu, &module, "scatter", &layouts))
            }
            Scatter::Raster => {
                let module = HybridShader::Raster.create(gpu, kinds)?;
                Self::Raster(raster_pipeline(gpu, &module, layouts))
            }
        })
    }

    /// Records a pass over so many lights. `workgroups` are those of the compute pipeline.
    pub(super) fn record(
        &self,
        name: &str,
        lights: u32,
        workgroups: [u32; 2],
        (bound, target): (Bound<'_>, &Target),
        passes: &mut dyn Passes,
    ) {
        match self {
            Self::Compute(pipeline) => passes.compute(name, &mut |pass| {
                pass.set_bind_group(0, bound[0], &[]);
                pass.set_bind_group(LISTS_GROUP, bound[1], &[]);
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(workgroups[0], workgroups[1], 1);
            }),
            Self::Raster(pipeline) => {
                let attachment = wgpu::RenderPassColorAttachment {
                    view: &target.0,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Discard,
                    },
                };
                let descriptor = wgpu::RenderPassDescriptor {
                    color_attachments: &[Some(attachment)],
                    ..Default::default()
                };
                passes.render(name, &descriptor, &mut |pass| {
                    pass.set_bind_group(0, bound[0], &[]);
                    pass.set_bind_group(LISTS_GROUP, bound[1], &[]);
                    pass.set_pipeline(pipeline);
                    pass.draw(0..4, 0..lights);
                });
            }
        }
    }
}

impl Target {
    pub(super) fn new(gpu: &Gpu) -> Self {
        Self(target(gpu, [1; 2]))
    }

    /// Gives it one pixel per tile.
    pub(super) fn resize(&mut self, gpu: &Gpu, tiles: [u32; 2]) {
        if [self.0.texture().width(), self.0.texture().height()] != tiles {
            self.0 = target(gpu, tiles);
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        u64::from(self.0.texture().width()) * u64::from(self.0.texture().height())
    }
}

fn target(gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("tiles"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TARGET,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn raster_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layouts: [&wgpu::BindGroupLayout; 2],
) -> wgpu::RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("hybrid raster"),
        bind_group_layouts: &layouts.map(Some),
        immediate_size: 0,
    });
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("hybrid raster"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner_of_light"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("add_to_tile"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: TARGET,
                blend: None,
                write_mask: wgpu::ColorWrites::empty(),
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
