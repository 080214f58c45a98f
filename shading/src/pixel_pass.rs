//! Runs a compute pass with one thread per pixel at once: probe, light operations, surfaces.

use assign::{AssignError, Assignment, EncoderPasses, GroupShape, Passes, Shader, Viewport};

use crate::{
    Renderer,
    gbuffer_inputs::{GBufferInputs, PIXELS_GROUP},
    shaders::LISTS_GROUP,
};

/// The shader of such a pass, with its inputs and outputs.
pub(crate) struct PixelPass<'a> {
    /// The pass's name. Its shader is the module `package::NAME`.
    pub(crate) name: &'static str,
    pub(crate) entry_point: &'static str,
    pub(crate) shader: Shader<'a>,
    /// The images that the pass reads.
    pub(crate) images: GBufferInputs,
    /// The rest of [`PIXELS_GROUP`]: layout entries and resources.
    pub(crate) layout: Vec<wgpu::BindGroupLayoutEntry>,
    pub(crate) resources: Vec<wgpu::BindGroupEntry<'a>>,
    /// The strategy whose look-up the shader calls.
    pub(crate) strategy: Option<&'a dyn Assignment>,
    /// Whether each lane looks lights up for itself, as in fragment shaders.
    pub(crate) is_alone: bool,
    /// The shape of the strategy's bounds, if the shader calls its `group_bounds`.
    pub(crate) bounds: Option<GroupShape>,
}

impl PixelPass<'_> {
    /// Runs the pass over a viewport of the renderer's targets, and submits it.
    pub(crate) fn submit(self, renderer: &Renderer, viewport: Viewport) -> Result<(), AssignError> {
        renderer.check_one_sample(self.name)?;
        let gpu = &renderer.gpu;
        let mut entries = self.images.layout(wgpu::ShaderStages::COMPUTE);
        entries.extend(self.layout);
        let layout = gpu.bind_group_layout(self.name, &entries);
        let mut resources = self.images.entries(&renderer.targets);
        resources.extend(self.resources);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.name),
            layout: &layout,
            entries: &resources,
        });
        let mut shader = self.images.set_flags(self.shader);
        let lookup = self.strategy.map(|strategy| strategy.lookup());
        if let Some(lookup) = &lookup {
            shader = shader.strategy(lookup.module);
            if self.is_alone {
                shader = shader.without_subgroups();
            }
            if let Some(shape) = self.bounds {
                shader = shader.group_bounds(shape);
            }
        }
        let module = shader.create(gpu, &format!("package::{}", self.name))?;
        let lists = lookup.map(|lookup| lookup.layout());
        let layouts = [Some(renderer.frame.layout()), lists, Some(&layout)];
        let pipeline = gpu.compute_pipeline(&module, self.entry_point, &layouts, true);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        EncoderPasses { encoder: &mut encoder }.compute(self.name, &mut |pass| {
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
            if let Some(strategy) = self.strategy {
                pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
            }
            pass.set_bind_group(PIXELS_GROUP, &group, &[]);
            pass.dispatch_workgroups(viewport.width.div_ceil(8), viewport.height.div_ceil(8), 1);
        });
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}
