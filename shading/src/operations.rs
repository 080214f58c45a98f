//! Counts light operations: how many terms of lights the lists name, how many of those shading
//! evaluates, and how many would be visible.

use std::{iter::Sum, ops::Add};

use assign::{AssignError, Assignment, Frame, entry, storage_entry, uniform_entry};
use bytemuck::pod_collect_to_vec;

use crate::{
    LightingOptions, Renderer, ShadingError,
    bound_shadows::mount_rays,
    gbuffer_inputs::GBufferInputs,
    lighting_inputs::LightingInputs,
    pixel_pass::PixelPass,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Numbers of terms of lights at samples, summed over an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terms {
    /// Diffuse terms.
    pub diffuse: u64,
    /// Specular terms.
    pub specular: u64,
    /// The specular terms at samples beyond the diffuse range of the light.
    pub outer_specular: u64,
}

/// Light operations. One operation is one term of one light at one sample (Swarbrick 2025, appendix
/// I).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Terms that the samples' lists name. The paper counts these.
    pub listed: Terms,
    /// Listed terms that shading evaluates. At each sample, it skips terms that add nothing there.
    pub evaluated: Terms,
    /// Listed terms that would be visible, 0 to 2 of each light and sample. A term is visible if
    /// its luminance, on a white surface and from a colourless light, is above 0.005 on a display
    /// of gamma 2.2. Both terms together are visible if their luminance is above 0.01.
    pub perceptible: u64,
    /// The same for both terms of every listed light, whichever of them its entry names. The
    /// difference to [`perceptible`](Self::perceptible) would be visible but is not drawn.
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

/// Bindings of the counts and the exposure.
const COUNTS_BINDING: u32 = 8;
const EXPOSURE_BINDING: u32 = 9;

/// Counts the operations of a frame's lists. Blocks. `exposure` is the factor from radiance to the
/// display's scale. The G-buffer and model ids are those of the last recorded geometry passes: see
/// [`record_for_probe`](crate::record_for_probe).
pub fn count_operations(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    options: LightingOptions,
    exposure: f32,
) -> Result<Operations, ShadingError> {
    let gpu = &renderer.gpu;
    if let Some(most) = options.specular_reach {
        return Err(AssignError::Parameter {
            field: "specular reach".into(),
            value: most.to_string(),
            accepted: "off while light operations are counted".into(),
        }
        .into());
    }
    renderer.lights.check_counted(gpu, options, strategy.lookup().module.wesl().reader)?;
    let viewport = frame.view.viewport;
    let bytes = u64::from(viewport.width) * u64::from(viewport.height) * 32;
    let counts = gpu.storage("operations", bytes)?;
    let shown = gpu.uniform("exposure", 16);
    gpu.queue.write_buffer(&shown, 0, bytemuck::bytes_of(&[exposure, 0.0, 0.0, 0.0]));
    let stages = wgpu::ShaderStages::COMPUTE;
    let inputs = LightingInputs::new(gpu, options, renderer.shadows.bound())?;
    let mut layout =
        vec![storage_entry(COUNTS_BINDING, stages, false), uniform_entry(EXPOSURE_BINDING, stages)];
    layout.extend(LightingInputs::layout(inputs.bound(), stages));
    let mut resources = vec![entry(COUNTS_BINDING, &counts), entry(EXPOSURE_BINDING, &shown)];
    resources.extend(inputs.entries());
    let pass = PixelPass {
        name: "operations",
        entry_point: "count_operations",
        shader: mount_rays(options.set_flags(lighting_modules(LISTS_GROUP)), inputs.images()),
        images: GBufferInputs::of_sample(strategy.needs().models),
        layout,
        resources,
        strategy: Some(strategy),
        is_alone: false,
        bounds: None,
    };
    pass.submit(renderer, viewport)?;
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
