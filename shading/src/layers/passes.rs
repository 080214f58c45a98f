//! The passes of layers of one strategy.

use assign::{AssignError, Assignment, Passes, View, texture};

use crate::{
    Renderer, ShadingError,
    gbuffer_inputs::PIXELS_GROUP,
    layers::{
        blend::{Blend, Fragments},
        fog::{FogVolume, written_volume_layout},
        options::LayerKinds,
        scene::LayerScene,
    },
    lighting_inputs::LightingInputs,
    raster::Lists,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Binding in [`PIXELS_GROUP`] of the image that `fog-light` writes.
const SCATTERED_BINDING: u32 = 20;

/// Froxels of a workgroup of `fog-light`, along each axis.
const FROXELS: u32 = 4;

/// The passes of layers, with one strategy's look-up.
#[derive(Debug)]
pub(crate) struct LayerPasses {
    kinds: LayerKinds,
    inputs: LightingInputs,
    fog_light: Option<(wgpu::ComputePipeline, wgpu::BindGroupLayout)>,
    blend: Option<Blend>,
}

impl LayerPasses {
    /// Compiles the strategy's look-up into the layers' shaders.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for brightness compensation, which fog and particles do not know.
    pub(crate) fn new(
        renderer: &Renderer,
        layers: &LayerScene,
        lists: Lists<'_>,
    ) -> Result<Self, ShadingError> {
        let kinds = layers.kinds();
        if lists.options.compensation.is_some() && (kinds.fog || kinds.particles) {
            return Err(AssignError::Parameter {
                field: "compensation".into(),
                value: "on".into(),
                accepted: "off with fog and particles, which scatter all light of their lists"
                    .into(),
            }
            .into());
        }
        let inputs = LightingInputs::new(&renderer.gpu, lists.options, renderer.shadows.bound())?;
        let fragments = Fragments::Light(&inputs, layers.fog_volume());
        let blend = match kinds.is_blended() {
            true => Some(Blend::new(renderer, layers, Some(lists), fragments)?),
            false => None,
        };
        let fog_light = match kinds.fog {
            true => Some(fog_light(renderer, lists, &inputs)?),
            false => None,
        };
        Ok(Self { kinds, inputs, fog_light, blend })
    }

    /// The kinds of layers that it was compiled for.
    pub(crate) fn kinds(&self) -> LayerKinds {
        self.kinds
    }

    /// Records all passes of layers, after `shade`.
    pub(crate) fn record(
        &self,
        renderer: &Renderer,
        layers: &LayerScene,
        view: &View,
        strategy: &dyn Assignment,
        passes: &mut dyn Passes,
    ) {
        let Renderer { gpu, frame, targets, .. } = renderer;
        if let (Some((volume, shared)), Some((pipeline, layout))) = (&layers.fog, &self.fog_light) {
            let mut entries: Vec<_> = self.inputs.entries().collect();
            entries.push(volume.grid_entry());
            entries.push(texture(SCATTERED_BINDING, &volume.scattered));
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("fog-light"),
                layout,
                entries: &entries,
            });
            let [x, y, z] = volume.counts().map(|count| count.div_ceil(FROXELS));
            passes.compute("fog-light", &mut |pass| {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, frame.bind_group(), &[]);
                pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
                pass.set_bind_group(PIXELS_GROUP, &group, &[]);
                pass.dispatch_workgroups(x, y, z);
            });
            shared.record(gpu, frame, targets, (volume, view), passes);
        }
        if let Some(blend) = &self.blend {
            let fragments = Fragments::Light(&self.inputs, layers.fog_volume());
            blend.record(renderer, layers, view, (Some(strategy), fragments), passes);
        }
    }
}

fn fog_light(
    renderer: &Renderer,
    Lists { lookup, options, .. }: Lists<'_>,
    inputs: &LightingInputs,
) -> Result<(wgpu::ComputePipeline, wgpu::BindGroupLayout), ShadingError> {
    let gpu = &renderer.gpu;
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut entries: Vec<_> = LightingInputs::layout(inputs.bound(), stages).collect();
    entries.push(FogVolume::grid_layout(stages));
    entries.push(written_volume_layout(SCATTERED_BINDING));
    let layout = gpu.bind_group_layout("fog-light", &entries);
    let shader = options
        .set_flags(lighting_modules(LISTS_GROUP))
        .strategy(lookup.module)
        .looks_up_anywhere();
    // SAFETY: its loops count up to the number of suns, vertices, maps or texels, or end with the strategy's look-up, which
    // returns at most as many lights as a `u32` counts. Loops in look-ups end: those of `assign` do, and the
    // strategy's author guarantees it of its own.
    #[allow(unsafe_code, reason = "its loops end")]
    let module = unsafe { shader.create_uncounted(gpu, "package::fog_light") }?;
    let layouts = [Some(renderer.frame.layout()), Some(lookup.layout()), Some(&layout)];
    Ok((gpu.compute_pipeline(&module, "light_froxels", &layouts, true), layout))
}
