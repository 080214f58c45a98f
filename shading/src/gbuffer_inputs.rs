//! Binds depth and G-buffer for the passes that read drawn pixels with `gbuffer.wesl`.

use assign::{Shader, UNFILTERED, texture, texture_entry};

use crate::{geometry::SceneGpu, targets::Targets};

/// Bind group of depth and G-buffer, and of the pass's other inputs and outputs.
pub(crate) const PIXELS_GROUP: u32 = 2;

/// Bindings of `gbuffer.wesl`.
const DEPTH: u32 = 0;
const BASE_COLOR: u32 = 1;
const NORMAL: u32 = 2;
const EMISSIVE: u32 = 3;
const MODEL: u32 = 5;
const DIELECTRIC: u32 = 11;

/// The images that a pass reads besides depth, base colour and normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GBufferInputs {
    pub(crate) emissive: bool,
    pub(crate) dielectrics: bool,
    pub(crate) model_ids: bool,
}

impl GBufferInputs {
    /// The images that the scene's surfaces fill, without the model of each pixel.
    pub(crate) fn of_scene(scene: &SceneGpu) -> Self {
        let (emissive, dielectrics) = (scene.has_emissive(), scene.has_dielectrics());
        Self { emissive, dielectrics, model_ids: false }
    }

    /// Only the images that determine a pixel's sample, with its model if a strategy needs it.
    pub(crate) fn of_sample(model_ids: bool) -> Self {
        Self { emissive: false, dielectrics: false, model_ids }
    }

    /// Sets the flags that compile the loads of these images.
    pub(crate) fn set_flags(self, shader: Shader<'_>) -> Shader<'_> {
        shader
            .flag("emissive", self.emissive)
            .flag("dielectrics", self.dielectrics)
            .flag("model_ids", self.model_ids)
    }

    /// Layout entries of [`PIXELS_GROUP`].
    pub(crate) fn layout(self, stages: wgpu::ShaderStages) -> Vec<wgpu::BindGroupLayoutEntry> {
        let images = [
            (DEPTH, wgpu::TextureSampleType::Depth, true),
            (BASE_COLOR, UNFILTERED, true),
            (NORMAL, UNFILTERED, true),
            (EMISSIVE, UNFILTERED, self.emissive),
            (MODEL, wgpu::TextureSampleType::Uint, self.model_ids),
            (DIELECTRIC, UNFILTERED, self.dielectrics),
        ];
        let entry = |(binding, sample_type, _)| texture_entry(binding, stages, sample_type);
        images.into_iter().filter(|&(.., is_read)| is_read).map(entry).collect()
    }

    /// Bind group entries of [`PIXELS_GROUP`].
    pub(crate) fn entries(self, targets: &Targets) -> Vec<wgpu::BindGroupEntry<'_>> {
        let images = [
            (DEPTH, Some(&targets.depth)),
            (BASE_COLOR, Some(&targets.base_color)),
            (NORMAL, Some(&targets.normal)),
            (EMISSIVE, targets.emissive.as_ref().filter(|_| self.emissive)),
            (MODEL, self.model_ids.then_some(&targets.model_ids)),
            (DIELECTRIC, targets.dielectric.as_ref().filter(|_| self.dielectrics)),
        ];
        let entry = |(binding, image): (u32, Option<_>)| Some(texture(binding, image?));
        images.into_iter().filter_map(entry).collect()
    }
}
