//! The pass `blend`: transparent surfaces and particles, from back to front.

use assign::{Assignment, Passes, View, entry, storage_entry};

use crate::{
    Renderer, ShadingError,
    layers::{capture_buffers::CaptureBuffers, fog::FogVolume, order::Item, scene::LayerScene},
    lighting_inputs::LightingInputs,
    raster::{Lists, RasterPass, RasterPipelines, SheetPass, blended},
    shaders::{LISTS_GROUP, lighting_modules},
    targets::DEPTH_FORMAT,
};

/// Bind group 2: what vertices read, and what fragments do.
const DRAWN_GROUP: u32 = 2;
const PARTICLES_BINDING: u32 = 19;

/// What fragments do with their samples, and what they need for it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fragments<'a> {
    /// They light them, behind the fog if there is one.
    Light(&'a LightingInputs, Option<&'a FogVolume>),
    /// They record the samples that no opaque surface hides. The depth buffer decides.
    Capture(&'a CaptureBuffers, &'a wgpu::TextureView),
}

impl<'a> Fragments<'a> {
    /// Layout entries of bind group 2.
    fn layout(self) -> Vec<wgpu::BindGroupLayoutEntry> {
        let stages = wgpu::ShaderStages::FRAGMENT;
        match self {
            Self::Light(inputs, fog) => {
                let fog = fog.map(|_| FogVolume::layout(stages));
                LightingInputs::layout(inputs.bound(), stages)
                    .chain(fog.into_iter().flatten())
                    .collect()
            }
            Self::Capture(..) => {
                let mut layout = CaptureBuffers::layout(stages).to_vec();
                layout.push(CaptureBuffers::depth_layout(stages));
                layout
            }
        }
    }

    /// Bind group entries of bind group 2.
    fn entries(self) -> Vec<wgpu::BindGroupEntry<'a>> {
        match self {
            Self::Light(inputs, fog) => {
                inputs.entries().chain(fog.into_iter().flat_map(FogVolume::entries)).collect()
            }
            Self::Capture(buffers, depth) => {
                let mut entries = buffers.entries().to_vec();
                entries.push(CaptureBuffers::depth_entry(depth));
                entries
            }
        }
    }

    fn has_fog(self) -> bool {
        matches!(self, Self::Light(_, Some(_)))
    }
}

/// The pipelines of the pass.
#[derive(Debug)]
pub(super) struct Blend {
    sheets: Option<(RasterPipelines, wgpu::BindGroupLayout)>,
    particles: Option<(wgpu::RenderPipeline, wgpu::BindGroupLayout)>,
}

impl Blend {
    /// Compiles the pipelines. Without `lists`, fragments capture their samples.
    pub(super) fn new(
        renderer: &Renderer,
        layers: &LayerScene,
        lists: Option<Lists<'_>>,
        fragments: Fragments<'_>,
    ) -> Result<Self, ShadingError> {
        let Renderer { gpu, frame, scene, orientation, .. } = renderer;
        let sheets = if layers.kinds().sheets {
            let mut entries = vec![
                storage_entry(0, wgpu::ShaderStages::VERTEX, true),
                storage_entry(1, wgpu::ShaderStages::FRAGMENT, true),
            ];
            entries.extend(fragments.layout());
            let layout = gpu.bind_group_layout("sheets", &entries);
            let pass = SheetPass { lists, layout: &layout, fogged: fragments.has_fog() };
            let pass = RasterPass::Sheets(pass);
            Some((RasterPipelines::new(gpu, frame.layout(), scene, *orientation, pass)?, layout))
        } else {
            None
        };
        let particles = if layers.kinds().particles {
            let mut entries =
                vec![storage_entry(PARTICLES_BINDING, wgpu::ShaderStages::VERTEX, true)];
            entries.extend(fragments.layout());
            let layout = gpu.bind_group_layout("particles", &entries);
            Some((particle_pipeline(renderer, lists, &layout, fragments.has_fog())?, layout))
        } else {
            None
        };
        Ok(Self { sheets, particles })
    }

    /// Records the pass, after everything else.
    pub(super) fn record(
        &self,
        renderer: &Renderer,
        layers: &LayerScene,
        view: &View,
        (strategy, fragments): (Option<&dyn Assignment>, Fragments<'_>),
        passes: &mut dyn Passes,
    ) {
        let Renderer { gpu, frame, scene, targets, .. } = renderer;
        let group = |layout, buffers: &[wgpu::BindGroupEntry<'_>]| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("blend"),
                layout,
                entries: &[buffers, &fragments.entries()].concat(),
            })
        };
        let sheets = self.sheets.as_ref().map(|(pipelines, layout)| {
            let buffers = [entry(0, &scene.instances), entry(1, &scene.materials.factors)];
            (pipelines, group(layout, &buffers))
        });
        let particles = self.particles.as_ref().map(|(pipeline, layout)| {
            let buffers = [entry(PARTICLES_BINDING, &layers.particle_buffer)];
            (pipeline, group(layout, &buffers))
        });
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(targets.radiance_kept())],
            // Depth is read-only.
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        };
        passes.render("blend", &descriptor, &mut |pass| {
            let port = view.viewport;
            let [x, y, width, height] = [port.x, port.y, port.width, port.height].map(|v| v as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_bind_group(0, frame.bind_group(), &[]);
            if let Some(strategy) = strategy {
                pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
            }
            for item in &layers.items {
                match (item, &sheets, &particles) {
                    (Item::Sheet(ix), Some((pipelines, group)), _) => {
                        let sheet = &scene.sheets[*ix];
                        let Some(pipeline) = pipelines.get(sheet.draw.key) else { continue };
                        pass.set_bind_group(DRAWN_GROUP, group, &[]);
                        scene.draw_sheet(pass, sheet, pipeline);
                    }
                    (Item::Particles(places), _, Some((pipeline, group))) => {
                        pass.set_pipeline(pipeline);
                        pass.set_bind_group(DRAWN_GROUP, group, &[]);
                        pass.draw(0..4, places.clone());
                    }
                    _ => {}
                }
            }
        });
    }
}

fn particle_pipeline(
    renderer: &Renderer,
    lists: Option<Lists<'_>>,
    drawn: &wgpu::BindGroupLayout,
    fogged: bool,
) -> Result<wgpu::RenderPipeline, ShadingError> {
    let gpu = &renderer.gpu;
    let mut shader =
        lighting_modules(LISTS_GROUP).flag("captures", lists.is_none()).flag("fogged", fogged);
    if let Some(Lists { lookup, options, .. }) = lists {
        shader = options.set_flags(shader).strategy(lookup.module);
        shader = shader.without_subgroups().looks_up_anywhere();
    }
    // SAFETY: its loops count up to the number of suns or vertices, or end with the strategy's look-up, which
    // returns at most as many lights as a `u32` counts. Loops in look-ups end: those of `assign` do, and the
    // strategy's author guarantees it of its own.
    #[allow(unsafe_code, reason = "its loops end")]
    let module = unsafe { shader.create_uncounted(gpu, "package::particles") }?;
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("particles"),
        bind_group_layouts: &[
            Some(renderer.frame.layout()),
            lists.map(|lists| lists.lookup.layout()),
            Some(drawn),
        ],
        immediate_size: 0,
    });
    let nearer = match renderer.orientation.depth {
        assign::DepthMapping::Standard => wgpu::CompareFunction::LessEqual,
        assign::DepthMapping::Reversed => wgpu::CompareFunction::GreaterEqual,
    };
    Ok(gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("particles"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex_particle"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(nearer),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment_particle"),
            compilation_options: Default::default(),
            targets: &[Some(blended(lists.is_some()))],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
