//! The passes of fog that are the same for all strategies: `fog-sum` and `fog-apply`.

use assign::{FrameBindings, Gpu, Passes, View, texture, texture_entry};

use crate::{
    ShadingError,
    gbuffer_inputs::PIXELS_GROUP,
    layers::fog::{FogVolume, volume_layout, written_volume_layout},
    shaders::{LISTS_GROUP, lighting_modules},
    targets::{RADIANCE_FORMAT, Targets},
};

/// Bindings in [`PIXELS_GROUP`].
const DEPTH_BINDING: u32 = 0;
const SCATTERED_BINDING: u32 = 19;
const WRITTEN_BINDING: u32 = 20;

/// The pipelines of both passes.
#[derive(Debug)]
pub(super) struct FogPasses {
    sum: (wgpu::ComputePipeline, wgpu::BindGroupLayout),
    apply: (wgpu::RenderPipeline, wgpu::BindGroupLayout),
}

impl FogPasses {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, ShadingError> {
        // Equal layouts are the same object, so these fit the renderer's own bind group of the frame.
        let frame = FrameBindings::new(gpu);
        let stages = wgpu::ShaderStages::COMPUTE;
        let sum_layout = gpu.bind_group_layout(
            "fog-sum",
            &[
                FogVolume::grid_layout(stages),
                volume_layout(SCATTERED_BINDING, stages),
                written_volume_layout(WRITTEN_BINDING),
            ],
        );
        let module = lighting_modules(LISTS_GROUP).create(gpu, "package::fog_sum")?;
        let layouts = [Some(frame.layout()), None, Some(&sum_layout)];
        let sum = gpu.compute_pipeline(&module, "sum_fog", &layouts, true);
        let stages = wgpu::ShaderStages::FRAGMENT;
        let mut entries =
            vec![texture_entry(DEPTH_BINDING, stages, wgpu::TextureSampleType::Depth)];
        entries.extend(FogVolume::layout(stages));
        let apply_layout = gpu.bind_group_layout("fog-apply", &entries);
        let apply = apply_pipeline(gpu, &frame, &apply_layout)?;
        Ok(Self { sum: (sum, sum_layout), apply: (apply, apply_layout) })
    }

    /// Records `fog-sum` and `fog-apply`, after `fog-light` and the opaque surfaces.
    pub(super) fn record(
        &self,
        gpu: &Gpu,
        frame: &FrameBindings,
        targets: &Targets,
        (volume, view): (&FogVolume, &View),
        passes: &mut dyn Passes,
    ) {
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("fog"),
                layout,
                entries,
            })
        };
        let (pipeline, layout) = &self.sum;
        let scattered = texture(SCATTERED_BINDING, &volume.scattered);
        let sums = texture(WRITTEN_BINDING, &volume.sums);
        let pixels = group(layout, &[volume.grid_entry(), scattered, sums]);
        let [width, height, _] = volume.counts();
        passes.compute("fog-sum", &mut |pass| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, frame.bind_group(), &[]);
            pass.set_bind_group(PIXELS_GROUP, &pixels, &[]);
            pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        });
        let (pipeline, layout) = &self.apply;
        let mut entries = vec![texture(DEPTH_BINDING, &targets.depth)];
        entries.extend(volume.entries());
        let pixels = group(layout, &entries);
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(targets.radiance_kept())],
            ..Default::default()
        };
        passes.render("fog-apply", &descriptor, &mut |pass| {
            let port = view.viewport;
            let [x, y, width, height] = [port.x, port.y, port.width, port.height].map(|v| v as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, frame.bind_group(), &[]);
            pass.set_bind_group(PIXELS_GROUP, &pixels, &[]);
            pass.draw(0..3, 0..1);
        });
    }
}

fn apply_pipeline(
    gpu: &Gpu,
    frame: &FrameBindings,
    pixels: &wgpu::BindGroupLayout,
) -> Result<wgpu::RenderPipeline, ShadingError> {
    let module =
        lighting_modules(LISTS_GROUP).flag("fogged", true).create(gpu, "package::fog_apply")?;
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("fog-apply"),
        bind_group_layouts: &[Some(frame.layout()), None, Some(pixels)],
        immediate_size: 0,
    });
    // The image that is there times the share that comes through, plus the scattered light. Alpha stays.
    let color = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::SrcAlpha,
        operation: wgpu::BlendOperation::Add,
    };
    Ok(gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("fog-apply"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex_fog"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment_fog"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: RADIANCE_FORMAT,
                blend: Some(wgpu::BlendState { color, alpha: color }),
                write_mask: wgpu::ColorWrites::COLOR,
            })],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
