//! The lighting pass: shades all pixels with one strategy's lists, in one mode.

use assign::{AssignError, Assignment, Gpu, Passes, View, check_listed_reach, texture};

use crate::{
    Cut, LightingOptions, Mode, Renderer, ShadingError,
    bound_shadows::BoundShadows,
    gbuffer_inputs::{GBufferInputs, PIXELS_GROUP},
    layers::LayerPasses,
    lighting_inputs::{Bound, LightingInputs},
    raster::{Lists, Orientation, RasterPass, RasterPipelines},
    shaders::{LISTS_GROUP, lighting_modules},
    targets::RADIANCE_FORMAT,
};

/// The binding in [`PIXELS_GROUP`] of the image that deferred lighting writes.
const RADIANCE_BINDING: u32 = 4;

/// The lighting pass of one strategy and mode. It is recorded as the pass `shade`, followed by those of the layers
/// that the renderer draws.
#[derive(Debug)]
pub struct Lighting {
    kind: Kind,
    layers: Option<LayerPasses>,
    options: LightingOptions,
    /// The shadows that it reads.
    shadows: Option<BoundShadows>,
}

#[derive(Debug)]
enum Kind {
    Deferred(Box<Deferred>),
    Forward(Forward),
}

#[derive(Debug)]
struct Forward {
    pipelines: RasterPipelines,
    orientation: Orientation,
    scene: wgpu::BindGroup,
    /// Whether depth is drawn before lighting.
    has_depth: bool,
}

impl Lighting {
    /// Compiles the strategy's look-up into the pipeline's shader. The pass is for the renderer's
    /// present view and layers: another direction of depth, a view that is mirrored, and other layers need a new
    /// pass.
    pub fn new(
        renderer: &Renderer,
        strategy: &dyn Assignment,
        mode: Mode,
        options: LightingOptions,
    ) -> Result<Self, ShadingError> {
        if !options.exit_weight.is_finite() {
            return Err(AssignError::Parameter {
                field: "exit_weight".into(),
                value: options.exit_weight.to_string(),
                accepted: "a finite number: 0, or -1 to evaluate every light".into(),
            }
            .into());
        }
        if let Some(lights) = options.compensation.filter(|lights| !(1.0..=1e9).contains(lights)) {
            return Err(AssignError::Parameter {
                field: "compensation".into(),
                value: lights.to_string(),
                accepted: "a number of lights, 1 to 1e9".into(),
            }
            .into());
        }
        if let Some(threshold) = options.stochastic {
            assign::check_threshold(threshold)?;
            if options.compensation.is_some() {
                return Err(AssignError::Parameter {
                    field: "compensation".into(),
                    value: "on".into(),
                    accepted: "off with stochastic light culling, whose number of lights is random"
                        .into(),
                }
                .into());
            }
        }
        check_reach(options, strategy)?;
        if !mode.is_forward() {
            renderer.check_one_sample("deferred shading")?;
        }
        if options.shadows.casts_rays() && renderer.layers.is_some() {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: options.shadows.to_string(),
                accepted:
                    "none or one with maps where there are transparent surfaces, particles and fog"
                        .into(),
            }
            .into());
        }
        let needs = strategy.needs();
        let gpu = &renderer.gpu;
        let inputs = LightingInputs::new(gpu, options, renderer.shadows.bound())?;
        let lists = Lists { lookup: strategy.lookup(), options, images: inputs.images() };
        let shadows = inputs.shadows().cloned();
        let kind = match mode {
            Mode::Deferred | Mode::DeferredIds => {
                Kind::Deferred(Box::new(Deferred::new(renderer, lists, needs.models, inputs)?))
            }
            Mode::Forward | Mode::ForwardNoPrepass => {
                let has_depth = mode.has_prepass(needs);
                let pipelines = RasterPipelines::new(
                    gpu,
                    renderer.frame.layout(),
                    &renderer.scene,
                    renderer.orientation,
                    RasterPass::Forward { lists, has_depth },
                )?;
                let scene = renderer.scene.bind_group(gpu, &inputs);
                let orientation = renderer.orientation;
                Kind::Forward(Forward { pipelines, orientation, scene, has_depth })
            }
        };
        let layers = match &renderer.layers {
            Some(layers) => Some(LayerPasses::new(renderer, layers, lists)?),
            None => None,
        };
        Ok(Self { kind, layers, options, shadows })
    }

    /// The options with which it was created.
    pub fn options(&self) -> LightingOptions {
        self.options
    }

    /// Records the pass `shade`, after the strategy's own passes, and those of layers. Returns an error if the
    /// prepared lights or the renderer's layers are of a kind for which the shader was not compiled, if depth or
    /// winding are, or if the shadow maps are not drawn for the lights.
    pub fn record(
        &self,
        renderer: &Renderer,
        view: &View,
        strategy: &dyn Assignment,
        passes: &mut dyn Passes,
    ) -> Result<(), ShadingError> {
        let made = self.options.kinds;
        let lights = renderer.lights;
        if !made.cover(lights.kinds) {
            return Err(ShadingError::Kinds { made, lights: lights.kinds });
        }
        let made = self.layers.as_ref().map(LayerPasses::kinds).unwrap_or_default();
        if made != renderer.layer_kinds() {
            return Err(ShadingError::Layers { made, drawn: renderer.layer_kinds() });
        }
        lights.check(&renderer.gpu, self.options, strategy.lookup().module.wesl().reader)?;
        renderer.check_bound_shadows(self.shadows.as_ref(), strategy.needs().occluders)?;
        match &self.kind {
            Kind::Deferred(deferred) => deferred.record(renderer, view, strategy, passes),
            Kind::Forward(Forward { pipelines, orientation, scene, has_depth }) => {
                if *orientation != renderer.orientation {
                    return Err(ShadingError::Orientation);
                }
                let groups = (strategy.bind_group(), scene);
                renderer.record_radiance(("shade", *has_depth), view, pipelines, groups, passes);
            }
        }
        if let (Some(layers), Some(scene)) = (&self.layers, &renderer.layers) {
            layers.record(renderer, scene, view, strategy, passes);
        }
        Ok(())
    }
}

/// Refuses specular terms that reach farther than the strategy's lists, and options that say otherwise how light ends.
fn check_reach(options: LightingOptions, strategy: &dyn Assignment) -> Result<(), AssignError> {
    let Some(most) = options.specular_reach else { return Ok(()) };
    check_listed_reach(strategy, most)?;
    let without = |field: &str, value: String, accepted: &str| {
        let (field, accepted) = (field.into(), accepted.into());
        Err(AssignError::Parameter { field, value, accepted })
    };
    if options.cut == Cut::Never {
        let accepted = "windowed or hard with a specular reach: with never, no term ends";
        return without("cut", options.cut.name().into(), accepted);
    }
    if let Some(lights) = options.compensation {
        let accepted = "off with a specular reach, which counts lights of one term too";
        return without("compensation", lights.to_string(), accepted);
    }
    if let Some(threshold) = options.stochastic {
        let accepted = "off with a specular reach: random ranges hold for both terms";
        return without("stochastic threshold", threshold.to_string(), accepted);
    }
    Ok(())
}

#[derive(Debug)]
struct Deferred {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    images: GBufferInputs,
    inputs: LightingInputs,
}

impl Deferred {
    fn new(
        renderer: &Renderer,
        lists: Lists<'_>,
        model_ids: bool,
        inputs: LightingInputs,
    ) -> Result<Self, ShadingError> {
        let gpu = &renderer.gpu;
        let images = GBufferInputs { model_ids, ..GBufferInputs::of_scene(&renderer.scene) };
        let layout = deferred_layout(gpu, images, inputs.bound());
        let shader = lists
            .set_flags(images.set_flags(lighting_modules(LISTS_GROUP)))
            .strategy(lists.lookup.module);
        // SAFETY: its loops count up to the number of suns, maps or pixels, halve a list, or end with the strategy's look-up, which
        // returns at most as many lights as a `u32` counts. Loops in look-ups end: those of `assign` do,
        // and the strategy's author guarantees it of its own.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::deferred") }?;
        let layouts = [Some(renderer.frame.layout()), Some(lists.lookup.layout()), Some(&layout)];
        let pipeline = gpu.compute_pipeline(&module, "shade", &layouts, true);
        Ok(Self { pipeline, layout, images, inputs })
    }

    fn record(
        &self,
        renderer: &Renderer,
        view: &View,
        strategy: &dyn Assignment,
        passes: &mut dyn Passes,
    ) {
        let targets = &renderer.targets;
        let mut entries = self.images.entries(targets);
        entries.push(texture(RADIANCE_BINDING, &targets.radiance));
        entries.extend(self.inputs.entries());
        let group = renderer.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shade"),
            layout: &self.layout,
            entries: &entries,
        });
        passes.compute("shade", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
            pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
            pass.set_bind_group(PIXELS_GROUP, &group, &[]);
            pass.dispatch_workgroups(
                view.viewport.width.div_ceil(8),
                view.viewport.height.div_ceil(8),
                1,
            );
        });
    }
}

fn deferred_layout(gpu: &Gpu, images: GBufferInputs, bound: Bound) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut entries = images.layout(stages);
    entries.push(wgpu::BindGroupLayoutEntry {
        binding: RADIANCE_BINDING,
        visibility: stages,
        ty: wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: RADIANCE_FORMAT,
            view_dimension: wgpu::TextureViewDimension::D2,
        },
        count: None,
    });
    entries.extend(LightingInputs::layout(bound, stages));
    gpu.bind_group_layout("shade", &entries)
}
