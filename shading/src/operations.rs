//! Light operations: how many terms of lights the lists name, how many of those shading evaluates, and how
//! many would be seen.

use std::{iter::Sum, ops::Add};

use assign::{Assignment, EncoderPasses, Frame, Passes, entry, storage_entry, uniform_entry};
use bytemuck::pod_collect_to_vec;

use crate::{
    LightingOptions, Renderer, ShadingError,
    lighting::{MODEL_BINDING, TEXELS, compute_pipeline, texture, texture_entry},
    lighting_inputs::LightingInputs,
    raster::LISTS_GROUP,
    shaders,
};

/// Terms of lights at samples, summed over an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terms {
    /// Diffuse terms.
    pub diffuse: u64,
    /// Specular terms.
    pub specular: u64,
    /// Of the specular terms, those at samples beyond the reach of the light's diffuse term.
    pub outer_specular: u64,
}

/// Light operations: one term of one light at one sample each (Swarbrick 2025, appendix I).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Terms that the samples' lists name. The paper counts these.
    pub listed: Terms,
    /// Listed terms that shading evaluates: it leaves out, sample by sample, what adds nothing there.
    pub evaluated: Terms,
    /// Listed terms whose light would be seen, 0 to 2 of each pair: on a white surface, under a
    /// colourless light, its luminance on a display of gamma 2.2 is above 0.005, or both terms' above
    /// 0.01.
    pub perceptible: u64,
    /// The same of every listed light's two terms, whichever of them its entry names. The difference to
    /// [`perceptible`](Self::perceptible) would be seen and is not drawn.
    pub perceptible_of_lights: u64,
}

impl Add for Terms {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            diffuse: self.diffuse + other.diffuse,
            specular: self.specular + other.specular,
            outer_specular: self.outer_specular + other.outer_specular,
        }
    }
}

impl Sum for Operations {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            listed: a.listed + b.listed,
            evaluated: a.evaluated + b.evaluated,
            perceptible: a.perceptible + b.perceptible,
            perceptible_of_lights: a.perceptible_of_lights + b.perceptible_of_lights,
        })
    }
}

/// Where the counts and the exposure are bound.
const COUNTS_BINDING: u32 = 8;
const EXPOSURE_BINDING: u32 = 9;

/// Counts the operations of a frame's lists, blocking. `exposure` is the factor from radiance to the
/// display's scale. G-buffer and model ids are those of the last recorded geometry passes: see
/// [`record_for_probe`](crate::record_for_probe).
pub fn count_operations(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    options: LightingOptions,
    exposure: f32,
) -> Result<Operations, ShadingError> {
    let gpu = &renderer.gpu;
    renderer.lights.check_counted(gpu, options)?;
    let viewport = frame.view.viewport;
    let bytes = u64::from(viewport.width) * u64::from(viewport.height) * 32;
    let counts = gpu.storage("operations", bytes)?;
    let shown = gpu.uniform("exposure", 16);
    gpu.queue.write_buffer(&shown, 0, bytemuck::bytes_of(&[exposure, 0.0, 0.0, 0.0]));
    let stages = wgpu::ShaderStages::COMPUTE;
    let targets = &renderer.targets;
    let mut entries = vec![
        texture_entry(0, wgpu::TextureSampleType::Depth),
        texture_entry(1, TEXELS),
        texture_entry(2, TEXELS),
        storage_entry(COUNTS_BINDING, stages, false),
        uniform_entry(EXPOSURE_BINDING, stages),
    ];
    let mut resources = vec![
        texture(0, &targets.depth),
        texture(1, &targets.base_color),
        texture(2, &targets.normal),
        entry(COUNTS_BINDING, &counts),
        entry(EXPOSURE_BINDING, &shown),
    ];
    let inputs = LightingInputs::new(gpu, options)?;
    entries.extend(LightingInputs::layout(inputs.bound(), stages));
    resources.extend(inputs.entries());
    let model_ids = strategy.needs().models;
    if model_ids {
        entries.push(texture_entry(MODEL_BINDING, wgpu::TextureSampleType::Uint));
        resources.push(texture(MODEL_BINDING, &targets.model_ids));
    }
    let layout = gpu.bind_group_layout("operations", &entries);
    let lookup = strategy.lookup();
    let module = options
        .set_flags(shaders::lighting(LISTS_GROUP))
        .strategy(lookup.module)
        .flag("model_ids", model_ids)
        .create(gpu, "package::operations")?;
    let layouts = [renderer.frame.layout(), lookup.layout, &layout];
    let pipeline = compute_pipeline(gpu, &layouts, &module, "count_operations");
    let images = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("operations"),
        layout: &layout,
        entries: &resources,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    EncoderPasses { encoder: &mut encoder }.compute("operations", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
        pass.set_bind_group(2, &images, &[]);
        pass.dispatch_workgroups(viewport.width.div_ceil(8), viewport.height.div_ceil(8), 1);
    });
    gpu.queue.submit([encoder.finish()]);
    let counts: Vec<[[u32; 4]; 2]> = pod_collect_to_vec(&gpu.read(&counts, bytes)?);
    let terms = |[diffuse, specular, outer, _]: [u32; 4]| Terms {
        diffuse: diffuse.into(),
        specular: specular.into(),
        outer_specular: outer.into(),
    };
    let of_pixel = |[listed, evaluated]: [[u32; 4]; 2]| Operations {
        listed: terms(listed),
        evaluated: terms(evaluated),
        perceptible: listed[3].into(),
        perceptible_of_lights: evaluated[3].into(),
    };
    Ok(counts.into_iter().map(of_pixel).sum())
}
