//! The images of a frame: depth, G-buffer, radiance.

use assign::{AssignError, Gpu, Needs, View, Viewport};

use crate::{Mode, ShadingError, geometry::SceneGpu};

/// Depth format of all passes.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Base colour and metallic.
pub(crate) const BASE_COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Shading normal and roughness.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Emitted radiance.
pub(crate) const EMISSIVE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Reflectance of the dielectric share at normal and at grazing incidence.
pub(crate) const DIELECTRIC_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Lit radiance in single precision, so that images compare bit for bit.
pub(crate) const RADIANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Lit radiance of several samples per pixel: WebGPU has no such image in single precision.
pub(crate) const SAMPLES_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Index of the model.
pub(crate) const MODEL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// The render targets of one size.
#[derive(Debug)]
pub struct Targets {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Depth of the opaque surfaces.
    pub depth: wgpu::TextureView,
    /// Base colour, sRGB; metallic in alpha.
    pub base_color: wgpu::TextureView,
    /// World-space shading normal; perceptual roughness in alpha. 0 where no triangle was drawn.
    pub normal: wgpu::TextureView,
    /// Emitted radiance, if the scene emits.
    pub emissive: Option<wgpu::TextureView>,
    /// Reflectance of the dielectric share at normal incidence and, in alpha, at grazing incidence.
    /// Present only if the scene has other dielectrics than glTF's default.
    pub dielectric: Option<wgpu::TextureView>,
    /// Index of each pixel's model, if a strategy needs it.
    pub model_ids: wgpu::TextureView,
    /// The lit image, linear RGB.
    pub radiance: wgpu::TextureView,
    /// The texture of `radiance`.
    pub radiance_texture: wgpu::Texture,
    /// Lit radiance of each sample, if pixels have several.
    pub(crate) samples: Option<wgpu::TextureView>,
}

impl Targets {
    /// Creates targets that contain the view's viewport.
    pub(crate) fn new(
        gpu: &Gpu,
        view: &View,
        scene: &SceneGpu,
        samples: u32,
    ) -> Result<Self, ShadingError> {
        let viewport = view.viewport;
        let width = viewport.x.saturating_add(viewport.width);
        let height = viewport.y.saturating_add(viewport.height);
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(ShadingError::Size { width, height, limit });
        }
        let (needed, offered) = (36, gpu.device.limits().max_color_attachment_bytes_per_sample);
        if scene.has_emissive() && scene.has_dielectrics() && offered < needed {
            let what = "a pixel of the G-buffer with emission and reflectances".into();
            let (bytes, limit) = (needed.into(), offered.into());
            return Err(AssignError::TooLarge { what, bytes, limit }.into());
        }
        // Bytes per pixel: depth 4, base colour 4, normal 8, emissive 8, model 4, radiance 16, and
        // 8 for reflectances if they differ. The largest image must be read back through one
        // buffer.
        let pixels = u64::from(width) * u64::from(height);
        let readable = gpu.device.limits().max_buffer_size;
        if pixels * 16 > readable {
            let what = format!("an image of {width}x{height}");
            return Err(AssignError::TooLarge { what, bytes: pixels * 16, limit: readable }.into());
        }
        let what = format!("images of {width}x{height}");
        let texel = if scene.has_dielectrics() { 52 } else { 44 };
        let more = if samples > 1 { u64::from(samples) * (4 + 8) } else { 0 };
        let make = || Self::make(gpu, [width, height], scene, samples);
        Ok(gpu.allocate(&what, pixels * (texel + more), make)?)
    }

    /// Refuses a viewport that the images do not hold.
    pub(crate) fn check_holds(&self, viewport: Viewport) -> Result<(), ShadingError> {
        let [width, height] = self.size;
        if viewport.x.saturating_add(viewport.width) > width
            || viewport.y.saturating_add(viewport.height) > height
        {
            return Err(ShadingError::Mismatch {
                left: [viewport.width, viewport.height],
                right: self.size,
            });
        }
        Ok(())
    }

    /// Bytes of the images that a mode draws only for a strategy with these needs: the models of
    /// pixels and, in forward shading, the G-buffer.
    pub fn bytes_for(&self, mode: Mode, needs: Needs) -> u64 {
        let mut formats = Vec::new();
        if mode.has_model_pass(needs) {
            formats.push(MODEL_FORMAT);
        }
        if mode.is_forward() && mode.has_gbuffer(needs) {
            formats.extend([BASE_COLOR_FORMAT, NORMAL_FORMAT]);
            formats.extend(self.emissive.as_ref().map(|_| EMISSIVE_FORMAT));
            formats.extend(self.dielectric.as_ref().map(|_| DIELECTRIC_FORMAT));
        }
        let texel = |format: wgpu::TextureFormat| format.block_copy_size(None).unwrap_or(0);
        let texels: u32 = formats.into_iter().map(texel).sum();
        self.size.map(u64::from).iter().product::<u64>() * u64::from(texels)
    }

    /// The lit image as the target of a pass that draws over it.
    pub(crate) fn radiance_kept(&self) -> wgpu::RenderPassColorAttachment<'_> {
        wgpu::RenderPassColorAttachment {
            view: &self.radiance,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        }
    }

    fn make(gpu: &Gpu, size: [u32; 2], scene: &SceneGpu, samples: u32) -> Self {
        let [width, height] = size;
        let texture_of = |label, format, usage, sample_count| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let texture = |label, format, usage| texture_of(label, format, usage, 1);
        let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
        let view_of = |t: &wgpu::Texture| t.create_view(&wgpu::TextureViewDescriptor::default());
        let radiance_texture = texture(
            "radiance",
            RADIANCE_FORMAT,
            wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC,
        );
        Self {
            size,
            depth: view_of(&texture_of("depth", DEPTH_FORMAT, sampled, samples)),
            samples: (samples > 1)
                .then(|| view_of(&texture_of("samples", SAMPLES_FORMAT, sampled, samples))),
            base_color: view_of(&texture("base colour", BASE_COLOR_FORMAT, sampled)),
            normal: view_of(&texture("normal", NORMAL_FORMAT, sampled)),
            emissive: scene
                .has_emissive()
                .then(|| view_of(&texture("emissive", EMISSIVE_FORMAT, sampled))),
            dielectric: scene
                .has_dielectrics()
                .then(|| view_of(&texture("dielectric", DIELECTRIC_FORMAT, sampled))),
            model_ids: view_of(&texture("model ids", MODEL_FORMAT, sampled)),
            radiance: view_of(&radiance_texture),
            radiance_texture,
        }
    }
}
