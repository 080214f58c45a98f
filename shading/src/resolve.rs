//! The pass `resolve`: the image of several samples per pixel is their mean.

use assign::{AssignError, Gpu, Passes, texture};

use crate::{
    gbuffer_inputs::PIXELS_GROUP,
    shaders::{LISTS_GROUP, lighting_modules},
    targets::RADIANCE_FORMAT,
};

/// Samples per pixel, if there are several: WebGPU has no other number.
pub(crate) const SAMPLES: u32 = 4;

/// Bindings of `resolve.wesl`.
const SAMPLES_BINDING: u32 = 0;
const RADIANCE_BINDING: u32 = 4;

/// The pipeline of the pass.
#[derive(Debug)]
pub(crate) struct Resolve {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl Resolve {
    /// Checks the number of samples per pixel. `None` for one.
    pub(crate) fn new(
        gpu: &Gpu,
        samples: u32,
        has_layers: bool,
    ) -> Result<Option<Self>, AssignError> {
        let refused = |accepted: &str| {
            let (field, value) = ("samples per pixel".into(), samples.to_string());
            Err(AssignError::Parameter { field, value, accepted: accepted.into() })
        };
        match samples {
            1 => return Ok(None),
            SAMPLES if has_layers => return refused("1 under layers"),
            SAMPLES => {}
            _ => return refused("1 or 4"),
        }
        let stages = wgpu::ShaderStages::COMPUTE;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: stages,
            ty,
            count: None,
        };
        let layout = gpu.bind_group_layout(
            "resolve",
            &[
                entry(
                    SAMPLES_BINDING,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: false },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: true,
                    },
                ),
                entry(
                    RADIANCE_BINDING,
                    wgpu::BindingType::StorageTexture {
                        access: wgpu::StorageTextureAccess::WriteOnly,
                        format: RADIANCE_FORMAT,
                        view_dimension: wgpu::TextureViewDimension::D2,
                    },
                ),
            ],
        );
        let module = lighting_modules(LISTS_GROUP).create(gpu, "package::resolve")?;
        let pipeline = gpu.compute_pipeline(&module, "resolve", &[None, None, Some(&layout)], true);
        Ok(Some(Self { layout, pipeline }))
    }

    /// Records the pass.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        samples: &wgpu::TextureView,
        radiance: &wgpu::TextureView,
        [width, height]: [u32; 2],
        passes: &mut dyn Passes,
    ) {
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("resolve"),
            layout: &self.layout,
            entries: &[texture(SAMPLES_BINDING, samples), texture(RADIANCE_BINDING, radiance)],
        });
        passes.compute("resolve", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(PIXELS_GROUP, &group, &[]);
            pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        });
    }
}
