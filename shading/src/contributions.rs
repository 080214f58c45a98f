//! Evaluates single lights at one pixel on the GPU, with the functions that shading calls.

use assign::{Frame, entry, storage_entry, uniform_entry};
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice, pod_collect_to_vec, pod_read_unaligned};

use crate::{
    LightingOptions, Renderer, ShadingError,
    bound_shadows::mount_rays,
    gbuffer_inputs::GBufferInputs,
    lighting_inputs::LightingInputs,
    pixel_pass::PixelPass,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `contributions.wesl`.
const PIXEL_BINDING: u32 = 8;
const ENTRIES_BINDING: u32 = 9;
const RADIANCE_BINDING: u32 = 12;
const SURFACE_BINDING: u32 = 13;

/// What a pixel shows, as shading reads it from depth and G-buffer: `struct PixelSurface` of
/// `contributions.wesl`. 96 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PixelSurface {
    /// World-space position, metres, and 1.
    pub position_world: [f32; 4],
    /// World-space unit shading normal, and perceptual roughness.
    pub normal_roughness: [f32; 4],
    /// Base colour, linear RGB, and metallic.
    pub base_color: [f32; 4],
    /// Reflectance of the dielectric share at normal incidence, linear RGB, and at grazing incidence.
    pub dielectric: [f32; 4],
    /// Radiance that the surface emits, linear RGB, and the sample's clip depth.
    pub emission: [f32; 4],
    /// Radiance from all suns, linear RGB, and the sample's view depth, metres.
    pub from_suns: [f32; 4],
}

/// A pixel's surface, and what single lights add to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelLight {
    /// The surface.
    pub surface: PixelSurface,
    /// Radiance that each asked entry adds, linear RGB, in the order asked. Its sum in the order of a list differs
    /// from the image by rounding only, except with brightness compensation.
    pub radiance: Vec<[f32; 3]>,
}

/// Evaluates entries at a pixel: each a light's slot and the flags of the terms to evaluate, as in lists. `None` if
/// the pixel shows no surface. Blocks.
///
/// `pixel` counts from the upper left corner of the viewport. Depth and G-buffer are those of the last recorded
/// geometry passes. In forward modes the G-buffer rounds normals and colours, which shading does not: see
/// [`record_for_probe`](crate::record_for_probe).
pub fn light_pixel(
    renderer: &Renderer,
    frame: &Frame<'_>,
    options: LightingOptions,
    pixel: [u32; 2],
    entries: &[u32],
) -> Result<Option<PixelLight>, ShadingError> {
    let viewport = frame.view.viewport;
    let threads = viewport.width as usize * viewport.height as usize;
    let mut lit = PixelLight::default();
    // Without entries one pass reads the surface.
    let mut rest = entries;
    loop {
        let (some, after) = rest.split_at(rest.len().min(threads));
        let (surface, radiance) = evaluate(renderer, frame, options, pixel, some)?;
        if surface.position_world[3] == 0.0 {
            return Ok(None);
        }
        lit.surface = surface;
        lit.radiance.extend(radiance);
        rest = after;
        if rest.is_empty() {
            return Ok(Some(lit));
        }
    }
}

/// Evaluates at most one entry per pixel of the viewport.
fn evaluate(
    renderer: &Renderer,
    frame: &Frame<'_>,
    options: LightingOptions,
    [x, y]: [u32; 2],
    entries: &[u32],
) -> Result<(PixelSurface, Vec<[f32; 3]>), ShadingError> {
    let gpu = &renderer.gpu;
    let viewport = frame.view.viewport;
    let pixel = gpu.uniform("asked pixel", 16);
    let asked = [viewport.x + x, viewport.y + y, entries.len() as u32, 0];
    gpu.queue.write_buffer(&pixel, 0, bytes_of(&asked));
    let asked = gpu.storage("asked entries", size_of_val(entries) as u64)?;
    gpu.queue.write_buffer(&asked, 0, cast_slice(entries));
    let radiance_bytes = entries.len() as u64 * 16;
    let radiance = gpu.storage("radiance of entries", radiance_bytes)?;
    let surface_bytes = size_of::<PixelSurface>() as u64;
    let surface = gpu.storage("surface of a pixel", surface_bytes)?;
    let stages = wgpu::ShaderStages::COMPUTE;
    let images = GBufferInputs::of_scene(&renderer.scene);
    let inputs = LightingInputs::new(gpu, options, renderer.shadows.bound())?;
    renderer.check_bound_shadows(inputs.shadows(), false)?;
    let mut layout = vec![
        uniform_entry(PIXEL_BINDING, stages),
        storage_entry(ENTRIES_BINDING, stages, true),
        storage_entry(RADIANCE_BINDING, stages, false),
        storage_entry(SURFACE_BINDING, stages, false),
    ];
    layout.extend(LightingInputs::layout(inputs.bound(), stages));
    let mut resources = vec![
        entry(PIXEL_BINDING, &pixel),
        entry(ENTRIES_BINDING, &asked),
        entry(RADIANCE_BINDING, &radiance),
        entry(SURFACE_BINDING, &surface),
    ];
    resources.extend(inputs.entries());
    let pass = PixelPass {
        name: "contributions",
        entry_point: "evaluate",
        shader: mount_rays(options.set_flags(lighting_modules(LISTS_GROUP)), inputs.images()),
        images,
        layout,
        resources,
        strategy: None,
        is_alone: false,
        bounds: None,
    };
    pass.submit(renderer, viewport)?;
    let surface = pod_read_unaligned(&gpu.read(&surface, surface_bytes)?);
    let radiance: Vec<[f32; 4]> = pod_collect_to_vec(&gpu.read(&radiance, radiance_bytes)?);
    Ok((surface, radiance.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()))
}
