//! Lighting with one strategy's lists, in one mode.

use assign::{AssignError, Assignment, Gpu, LightKinds, Passes, Shader, Suns, View};
use serde::{Deserialize, Serialize};

use crate::{
    AreaModel, Mode, Renderer, ShadingError,
    lighting_inputs::{Bound, LightingInputs},
    raster::{LISTS_GROUP, Lists, RasterPass, RasterPipelines},
    shaders,
};

/// The lighting pass of one strategy and mode; recorded as the pass `shade`.
#[derive(Debug)]
pub struct Lighting {
    kind: Kind,
    options: LightingOptions,
}

/// How the lights of a list are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightingOptions {
    /// The kinds of lights that it lights.
    pub kinds: LightKinds,
    /// A light is left out of a sample, before its BRDF, where its fall-off or the cosine of
    /// incidence is at most this. 0 leaves out what adds nothing, out of range (the survey's
    /// bounding sphere, Watrous 2024), cone or horizon, and changes no bit of the image, for the
    /// shader is one, told by a uniform; [`EVALUATE_ALL`](Self::EVALUATE_ALL) leaves out nothing.
    /// Anything above 0 loses light: per square metre of the fall-off, and as a cosine.
    pub exit_weight: f32,
    /// How the fall-off ends at a light's range.
    pub cut: Cut,
    /// How the light of area lights is integrated.
    pub area: AreaModel,
    /// Brightness compensation (Archer, Leach, Knowles 2019, section 3.2): a sample's radiance times
    /// this number over that of the lights that add something to it, within a factor of 4. It hides
    /// where virtual point lights lie thick or thin, and is no light that anything sends: `None`,
    /// which changes no bit, wherever errors are measured.
    pub compensation: Option<f32>,
    /// Suns, which light every sample beside its list; without any, nothing of them is compiled or
    /// bound.
    pub suns: Suns,
}

/// How a light's fall-off ends at its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cut {
    /// Smoothly: times `(1 - (d / range)^4)^2`.
    #[default]
    Windowed,
    /// At once: inverse square up to the range, 0 beyond.
    Hard,
}

impl Cut {
    /// As in results: `windowed` or `hard`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Windowed => "windowed",
            Self::Hard => "hard",
        }
    }
}

impl LightingOptions {
    /// The [`exit_weight`](Self::exit_weight) with which every light of a list is evaluated.
    pub const EVALUATE_ALL: f32 = -1.0;

    /// Compiles what they ask for.
    pub(crate) fn set_flags(self, shader: Shader<'_>) -> Shader<'_> {
        let shader = shader
            .light_kinds(self.kinds)
            .flag("hard_cut", self.cut == Cut::Hard)
            .flag("compensation", self.compensation.is_some())
            .flag("suns", !self.suns.is_empty());
        let flags = self.area.flags().iter();
        flags.fold(shader, |shader, flag| shader.flag(flag, self.kinds.areas))
    }
}

#[derive(Debug)]
enum Kind {
    Deferred(Deferred),
    Forward(Forward),
}

#[derive(Debug)]
struct Forward {
    pipelines: RasterPipelines,
    scene: wgpu::BindGroup,
    /// Whether depth is drawn before.
    has_depth: bool,
}

impl Lighting {
    /// Splices the strategy's look-up into the pipeline's shader. It is made for the renderer's mapping
    /// of depth, and must be made anew where that changes.
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
        let lists = Lists { lookup: strategy.lookup(), options };
        let needs = strategy.needs();
        let gpu = &renderer.gpu;
        let inputs = LightingInputs::new(gpu, options)?;
        let kind = match mode {
            Mode::Deferred | Mode::DeferredIds => {
                Kind::Deferred(Deferred::new(renderer, lists, needs.models, inputs)?)
            }
            Mode::Forward | Mode::ForwardNoPrepass => {
                let has_depth = mode.has_prepass(needs);
                let pipelines = RasterPipelines::new(
                    gpu,
                    &renderer.frame,
                    &renderer.scene,
                    renderer.depth_mapping,
                    RasterPass::Forward { lists, has_depth },
                )?;
                let scene = renderer.scene.bind_group(gpu, &inputs);
                Kind::Forward(Forward { pipelines, scene, has_depth })
            }
        };
        Ok(Self { kind, options })
    }

    /// What it was made with.
    pub fn options(&self) -> LightingOptions {
        self.options
    }

    /// Records the pass `shade`, after the strategy's own. An error where the prepared lights
    /// are of a kind that the shader was made without.
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
        lights.check(&renderer.gpu, self.options)?;
        match &self.kind {
            Kind::Deferred(deferred) => deferred.record(renderer, view, strategy, passes),
            Kind::Forward(Forward { pipelines, scene, has_depth }) => {
                let groups = (strategy.bind_group(), scene);
                renderer.record_radiance(("shade", *has_depth), view, pipelines, groups, passes);
            }
        }
        Ok(())
    }
}

#[derive(Debug)]
struct Deferred {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    model_ids: bool,
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
        let emissive = renderer.scene.has_emissive();
        let dielectrics = renderer.scene.has_dielectrics();
        let layout = deferred_layout(gpu, [emissive, model_ids, dielectrics], inputs.bound());
        let shader = lists
            .options
            .set_flags(shaders::lighting(LISTS_GROUP))
            .strategy(lists.lookup.module)
            .flag("model_ids", model_ids)
            .flag("dielectrics", dielectrics)
            .flag("emissive", emissive);
        // SAFETY: its loops count up to the number of suns and to the length of a list, which is a
        // `u32` read once. The strategy's author vouches for its look-up.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::deferred") }?;
        let pipeline = compute_pipeline(
            gpu,
            &[renderer.frame.layout(), lists.lookup.layout, &layout],
            &module,
            "shade",
        );
        Ok(Self { pipeline, layout, model_ids, inputs })
    }

    fn record(
        &self,
        renderer: &Renderer,
        view: &View,
        strategy: &dyn Assignment,
        passes: &mut dyn Passes,
    ) {
        let targets = &renderer.targets;
        let mut entries = vec![
            texture(0, &targets.depth),
            texture(1, &targets.base_color),
            texture(2, &targets.normal),
            texture(4, &targets.radiance),
        ];
        entries.extend(self.inputs.entries());
        entries.extend(targets.emissive.as_ref().map(|view| texture(3, view)));
        let dielectric = targets.dielectric.as_ref();
        entries.extend(dielectric.map(|view| texture(DIELECTRIC_BINDING, view)));
        if self.model_ids {
            entries.push(texture(MODEL_BINDING, &targets.model_ids));
        }
        let images = renderer.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shade"),
            layout: &self.layout,
            entries: &entries,
        });
        passes.compute("shade", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
            pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
            pass.set_bind_group(2, &images, &[]);
            pass.dispatch_workgroups(
                view.viewport.width.div_ceil(8),
                view.viewport.height.div_ceil(8),
                1,
            );
        });
    }
}

/// A compute pipeline over bind groups 0, 1, ….
pub(crate) fn compute_pipeline(
    gpu: &Gpu,
    layouts: &[&wgpu::BindGroupLayout],
    module: &wgpu::ShaderModule,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let layouts: Vec<Option<&wgpu::BindGroupLayout>> = layouts.iter().map(|l| Some(*l)).collect();
    gpu.compute_pipeline(module, entry_point, &layouts, true)
}

/// A bind group entry of an image.
pub(crate) fn texture(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}

/// A layout entry of an image that compute reads.
pub(crate) fn texture_entry(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

/// What a compute pass reads of a colour image: texels, unfiltered.
pub(crate) const TEXELS: wgpu::TextureSampleType =
    wgpu::TextureSampleType::Float { filterable: false };

/// Where deferred lighting and the probe bind model ids.
pub(crate) const MODEL_BINDING: u32 = 5;

/// Where deferred lighting binds what dielectrics reflect.
const DIELECTRIC_BINDING: u32 = 11;

fn deferred_layout(
    gpu: &Gpu,
    [emissive, model_ids, dielectrics]: [bool; 3],
    bound: Bound,
) -> wgpu::BindGroupLayout {
    let mut entries = vec![
        texture_entry(0, wgpu::TextureSampleType::Depth),
        texture_entry(1, TEXELS),
        texture_entry(2, TEXELS),
        wgpu::BindGroupLayoutEntry {
            binding: 4,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: crate::targets::RADIANCE_FORMAT,
                view_dimension: wgpu::TextureViewDimension::D2,
            },
            count: None,
        },
    ];
    entries.extend(LightingInputs::layout(bound, wgpu::ShaderStages::COMPUTE));
    if emissive {
        entries.push(texture_entry(3, TEXELS));
    }
    if dielectrics {
        entries.push(texture_entry(DIELECTRIC_BINDING, TEXELS));
    }
    if model_ids {
        entries.push(texture_entry(MODEL_BINDING, wgpu::TextureSampleType::Uint));
    }
    gpu.bind_group_layout("shade", &entries)
}
