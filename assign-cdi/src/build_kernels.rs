//! The kernels that build deep images, and their layouts.

use assign::{AssignError, Gpu, Shader};

use crate::{
    Build, Coverage, DeepImageSettings, Raster, Storage,
    kernel::{self, Slot},
};

/// The pipelines that a build uses.
#[derive(Debug)]
pub(crate) struct BuildKernels {
    pub(crate) build_layout: wgpu::BindGroupLayout,
    pub(crate) stage_layout: wgpu::BindGroupLayout,
    pub(crate) plan_layout: wgpu::BindGroupLayout,
    pub(crate) plan_large: wgpu::ComputePipeline,
    pub(crate) plan_samples: wgpu::ComputePipeline,
    pub(crate) check_total: wgpu::ComputePipeline,
    pub(crate) check_links: wgpu::ComputePipeline,
    pub(crate) finders: Finders,
}

/// The pipelines that find fragments.
#[derive(Debug)]
pub(crate) enum Finders {
    SinglePass {
        samplers: Samplers,
        spread: wgpu::ComputePipeline,
    },
    PerDirection {
        find_large: wgpu::ComputePipeline,
        small: wgpu::ComputePipeline,
        large: wgpu::ComputePipeline,
    },
}

/// The pipelines that take samples.
#[derive(Debug)]
pub(crate) enum Samplers {
    Compute { small: wgpu::ComputePipeline, large: wgpu::ComputePipeline },
    Fragment(Draw),
}

/// The GPU's rasteriser takes samples.
#[derive(Debug)]
pub(crate) struct Draw {
    pub(crate) pipeline: wgpu::RenderPipeline,
    pub(crate) read_layout: wgpu::BindGroupLayout,
    pub(crate) write_layout: wgpu::BindGroupLayout,
    /// A render target that the pass needs but does not write.
    pub(crate) target: wgpu::TextureView,
}

/// The modules of the kernels of a build. [`BUILD_ROOTS`] names the root modules.
pub fn build_shader(settings: &DeepImageSettings) -> Shader<'static> {
    let conservative =
        matches!(settings.build, Build::PerDirection { coverage: Coverage::Conservative, .. });
    Shader::new(3)
        .module("package::deep_images", include_str!("shaders/deep_images.wesl"))
        .module("package::counting", include_str!("shaders/counting.wesl"))
        .module("package::build", include_str!("shaders/build.wesl"))
        .module("package::emit", include_str!("shaders/emit.wesl"))
        .module("package::triangles", include_str!("shaders/triangles.wesl"))
        .module("package::samples", include_str!("shaders/samples.wesl"))
        .module("package::draw_samples", include_str!("shaders/draw_samples.wesl"))
        .module("package::from_samples", include_str!("shaders/from_samples.wesl"))
        .module("package::from_triangles", include_str!("shaders/from_triangles.wesl"))
        .module("package::plan", include_str!("shaders/plan.wesl"))
        .flag("linked", settings.storage == Storage::LinkedLists)
        .flag("conservative", conservative)
}

/// The root modules of [`build_shader`].
pub const BUILD_ROOTS: [&str; 5] = [
    "package::samples",
    "package::draw_samples",
    "package::from_samples",
    "package::from_triangles",
    "package::plan",
];

impl BuildKernels {
    pub(crate) fn new(gpu: &Gpu, settings: &DeepImageSettings) -> Result<Self, AssignError> {
        let shader = build_shader(settings);
        let stages = wgpu::ShaderStages::COMPUTE;
        let (read, write) = (Slot::Read, Slot::Write);
        let build_slots = [Slot::Uniform, read, read, write, write, write, write, read, write];
        let build_layout = kernel::layout(gpu, "deep images", stages, &build_slots);
        let stage_layout = kernel::layout(gpu, "stage", stages, &[Slot::UniformAt]);
        let plan_slots = [Slot::Uniform, Slot::Uniform, write, read, write];
        let plan_layout = kernel::layout(gpu, "plan", stages, &plan_slots);
        let plan = kernel::uncounted(gpu, &shader, "package::plan")?;
        let planner = |entry_point| kernel::pipeline(gpu, &plan, entry_point, &[&plan_layout]);
        let staged = |module: &wgpu::ShaderModule, entry_point| {
            kernel::pipeline(gpu, module, entry_point, &[&build_layout, &stage_layout])
        };
        let finders = match settings.build {
            Build::SinglePass { raster, .. } => {
                let spread = kernel::uncounted(gpu, &shader, "package::from_samples")?;
                Finders::SinglePass {
                    samplers: match raster {
                        Raster::Compute => {
                            let module = kernel::uncounted(gpu, &shader, "package::samples")?;
                            let make =
                                |name| kernel::pipeline(gpu, &module, name, &[&build_layout]);
                            Samplers::Compute {
                                small: make("make_samples"),
                                large: make("make_large_samples"),
                            }
                        }
                        Raster::Fragment => Samplers::Fragment(Draw::new(gpu, settings, &shader)?),
                    },
                    spread: staged(&spread, "spread_samples"),
                }
            }
            Build::PerDirection { .. } => {
                let module = kernel::uncounted(gpu, &shader, "package::from_triangles")?;
                Finders::PerDirection {
                    find_large: kernel::pipeline(gpu, &module, "find_large", &[&build_layout]),
                    small: staged(&module, "put_small"),
                    large: staged(&module, "put_large"),
                }
            }
        };
        Ok(Self {
            plan_large: planner("plan_large"),
            plan_samples: planner("plan_samples"),
            check_total: planner("check_total"),
            check_links: planner("check_links"),
            finders,
            build_layout,
            stage_layout,
            plan_layout,
        })
    }
}

impl Draw {
    fn new(
        gpu: &Gpu,
        settings: &DeepImageSettings,
        shader: &Shader<'_>,
    ) -> Result<Self, AssignError> {
        let module = kernel::uncounted(gpu, shader, "package::draw_samples")?;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let read_layout = kernel::layout(gpu, "draw samples", both, &[Slot::Uniform, Slot::Read]);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let write_layout = kernel::layout(gpu, "draw samples", fragment, &[Slot::Write; 2]);
        let format = wgpu::TextureFormat::R8Unorm;
        let side = settings.side_cells();
        let texture = gpu.allocate("target of samples", u64::from(side).pow(2), || {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("target of samples"),
                size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        })?;
        let layout = kernel::pipeline_layout(gpu, &[&read_layout, &write_layout]);
        let pipeline = gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("draw samples"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("pull_vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("append_sample"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend: None,
                    write_mask: wgpu::ColorWrites::empty(),
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { pipeline, read_layout, write_layout, target })
    }
}
