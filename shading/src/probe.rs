//! Copies each pixel's position, normal and group from the GPU, to check lists on the CPU.

use assign::{Assignment, Frame, Passes, View, entry, storage_entry};
use bytemuck::{pod_collect_to_vec, pod_read_unaligned};

use crate::{
    Renderer, ShadingError,
    gbuffer_inputs::GBufferInputs,
    pixel_pass::PixelPass,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `probe.wesl`.
const SEEN_BINDING: u32 = 8;
const GROUPS_BINDING: u32 = 9;

/// Binding of captured samples in `asked.wesl`.
const CAPTURED_BINDING: u32 = 24;

/// Bytes of `struct CapturedSample` of `capture.wesl`.
pub(crate) const CAPTURED_BYTES: u64 = 32;

/// The view samples of a frame, and the group of each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// World-space positions, metres, as shading reconstructs them.
    pub positions: Vec<[f32; 3]>,
    /// World-space shading normals of unit length, from the G-buffer.
    pub normals: Vec<[f32; 3]>,
    /// The group of each sample.
    pub groups: Vec<u32>,
    /// The pixel of each sample: an index into the viewport, rows from the top. Captured samples have places in
    /// their buffer instead.
    pub pixels: Vec<u32>,
}

/// Records the passes that [`probe`] reads besides depth: the G-buffer, and model ids if the
/// strategy needs them. Forward shading draws neither.
pub fn record_for_probe(
    renderer: &Renderer,
    view: &View,
    strategy: &dyn Assignment,
    passes: &mut dyn Passes,
) {
    renderer.record_gbuffer(view, passes);
    if strategy.needs().models {
        renderer.record_model_ids(view, passes);
    }
}

/// Computes every pixel's group by the strategy's look-up. Blocks.
///
/// Depth, normals and model ids are those of the last recorded geometry passes: see
/// [`record_for_probe`].
pub fn probe(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
) -> Result<Samples, ShadingError> {
    probe_at(renderer, strategy, frame, None)
}

/// Has a pass look captured samples up, instead of those of pixels.
pub(crate) fn ask_captured<'a>(pass: &mut PixelPass<'a>, captured: Option<&'a wgpu::Buffer>) {
    let Some(captured) = captured else { return };
    let stages = wgpu::ShaderStages::COMPUTE;
    pass.shader = pass.shader.clone().flag("captured", true).looks_up_anywhere();
    pass.layout.push(storage_entry(CAPTURED_BINDING, stages, true));
    pass.resources.push(entry(CAPTURED_BINDING, captured));
}

/// The same for captured samples, if there are any: at most one per pixel.
pub(crate) fn probe_at(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    captured: Option<&wgpu::Buffer>,
) -> Result<Samples, ShadingError> {
    let gpu = &renderer.gpu;
    let pixels = u64::from(frame.view.viewport.width) * u64::from(frame.view.viewport.height);
    let seen = gpu.storage("probe samples", pixels * 32)?;
    let groups = gpu.storage("probe groups", pixels * 4)?;
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut pass = PixelPass {
        name: "probe",
        entry_point: "probe",
        shader: lighting_modules(LISTS_GROUP),
        images: GBufferInputs::of_sample(strategy.needs().models),
        layout: vec![
            storage_entry(SEEN_BINDING, stages, false),
            storage_entry(GROUPS_BINDING, stages, false),
        ],
        resources: vec![entry(SEEN_BINDING, &seen), entry(GROUPS_BINDING, &groups)],
        strategy: Some(strategy),
        is_alone: false,
        bounds: None,
    };
    ask_captured(&mut pass, captured);
    pass.submit(renderer, frame.view.viewport)?;
    let seen = gpu.read(&seen, pixels * 32)?;
    let groups: Vec<u32> = pod_collect_to_vec(&gpu.read(&groups, pixels * 4)?);
    let mut samples = Samples {
        positions: Vec::with_capacity(groups.len()),
        normals: Vec::with_capacity(groups.len()),
        groups: Vec::with_capacity(groups.len()),
        pixels: Vec::with_capacity(groups.len()),
    };
    for (pixel, (seen, group)) in seen.chunks_exact(32).zip(groups).enumerate() {
        let [position, normal]: [[f32; 4]; 2] = pod_read_unaligned(seen);
        if position[3] > 0.5 {
            samples.positions.push([position[0], position[1], position[2]]);
            samples.normals.push([normal[0], normal[1], normal[2]]);
            samples.groups.push(group);
            samples.pixels.push(pixel as u32);
        }
    }
    Ok(samples)
}
