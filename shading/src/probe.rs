//! What the GPU saw: each pixel's position, normal and group, copied to the CPU for the truth.

use assign::{Assignment, EncoderPasses, Frame, Passes, View, entry, storage_entry};
use bytemuck::pod_collect_to_vec;

use crate::{
    Renderer, ShadingError,
    lighting::{MODEL_BINDING, TEXELS, compute_pipeline, texture, texture_entry},
    raster::LISTS_GROUP,
    shaders,
};

/// The view samples of a frame with the groups a strategy put them in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// World-space positions, metres, as shading reconstructs them.
    pub positions: Vec<[f32; 3]>,
    /// World-space shading normals of unit length, as the G-buffer holds them.
    pub normals: Vec<[f32; 3]>,
    /// The group of each sample.
    pub groups: Vec<u32>,
    /// The pixel of each sample, index into the viewport, rows from the top.
    pub pixels: Vec<u32>,
}

/// Records what [`probe`] reads beside depth: G-buffer, and model ids where the strategy needs them.
/// Forward shading draws neither.
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

/// Asks the strategy for every pixel's group, blocking.
///
/// Depth, normals and model ids are those of the last recorded geometry passes: see
/// [`record_for_probe`].
pub fn probe(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
) -> Result<Samples, ShadingError> {
    let gpu = &renderer.gpu;
    let pixels = u64::from(frame.view.viewport.width) * u64::from(frame.view.viewport.height);
    let seen = gpu.storage("probe samples", pixels * 32)?;
    let groups = gpu.storage("probe groups", pixels * 4)?;
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut entries = vec![
        texture_entry(0, wgpu::TextureSampleType::Depth),
        texture_entry(1, TEXELS),
        storage_entry(2, stages, false),
        storage_entry(3, stages, false),
    ];
    let mut resources = vec![
        texture(0, &renderer.targets.depth),
        texture(1, &renderer.targets.normal),
        entry(2, &seen),
        entry(3, &groups),
    ];
    let model_ids = strategy.needs().models;
    if model_ids {
        entries.push(texture_entry(MODEL_BINDING, wgpu::TextureSampleType::Uint));
        resources.push(texture(MODEL_BINDING, &renderer.targets.model_ids));
    }
    let layout = gpu.bind_group_layout("probe", &entries);
    let lookup = strategy.lookup();
    let module = shaders::lighting(LISTS_GROUP)
        .strategy(lookup.module)
        .flag("model_ids", model_ids)
        .create(gpu, "package::probe")?;
    let pipeline =
        compute_pipeline(gpu, &[renderer.frame.layout(), lookup.layout, &layout], &module, "probe");
    let images = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("probe"),
        layout: &layout,
        entries: &resources,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let viewport = frame.view.viewport;
    EncoderPasses { encoder: &mut encoder }.compute("probe", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
        pass.set_bind_group(2, &images, &[]);
        pass.dispatch_workgroups(viewport.width.div_ceil(8), viewport.height.div_ceil(8), 1);
    });
    gpu.queue.submit([encoder.finish()]);
    let seen: Vec<[[f32; 4]; 2]> = pod_collect_to_vec(&gpu.read(&seen, pixels * 32)?);
    let groups: Vec<u32> = pod_collect_to_vec(&gpu.read(&groups, pixels * 4)?);
    let mut samples = Samples::default();
    for (pixel, ([position, normal], group)) in seen.into_iter().zip(groups).enumerate() {
        if position[3] > 0.5 {
            samples.positions.push([position[0], position[1], position[2]]);
            samples.normals.push([normal[0], normal[1], normal[2]]);
            samples.groups.push(group);
            samples.pixels.push(pixel as u32);
        }
    }
    Ok(samples)
}
