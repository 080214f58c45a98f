//! The images that a renderer draws into.

use std::error::Error;

use assign::{
    AssignError, Gpu, UNFILTERED, entry,
    kernel::{self, Slot},
};

/// The format of depth.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What the cameras draw into.
pub struct Target {
    /// The image.
    pub color: wgpu::Texture,
    /// The depth of opaque surfaces.
    pub depth: wgpu::TextureView,
}

/// Copies the red value of each sample: those of a pixel one after the other.
const COPY_SAMPLES: &str = "
@group(0) @binding(0) var<storage, read_write> values: array<f32>;
@group(0) @binding(1) var image: texture_multisampled_2d<f32>;
@compute @workgroup_size(8, 8)
fn copy(@builtin(global_invocation_id) pixel: vec3u) {
  let size = textureDimensions(image);
  if any(pixel.xy >= size) { return; }
  let count = textureNumSamples(image);
  let first = (pixel.y * size.x + pixel.x) * count;
  for (var i = 0u; i < count; i++) {
    values[first + i] = textureLoad(image, pixel.xy, i32(i)).x;
  }
}";

impl Target {
    /// A target that can be read, with 1 or 4 samples per pixel.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, size: [u32; 2], samples: u32) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
        let readable = match samples {
            1 => wgpu::TextureUsages::COPY_SRC,
            _ => wgpu::TextureUsages::TEXTURE_BINDING,
        };
        Self { color: texture(format, readable), depth: depth.create_view(&Default::default()) }
    }

    /// Begins a pass that clears depth and draws only it, or one that draws colours.
    pub fn begin<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        clear_depth: Option<f32>,
    ) -> wgpu::RenderPass<'a> {
        let color = self.color.create_view(&Default::default());
        let colors = [Some(wgpu::RenderPassColorAttachment {
            view: &color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })];
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: if clear_depth.is_some() { &[] } else { &colors },
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: clear_depth.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// The red value of each sample of an image with several samples per pixel, as the bytes of f32: row after row, and
    /// those of a pixel one after the other.
    pub fn read_samples(&self, gpu: &Gpu) -> Result<Vec<u8>, AssignError> {
        let (width, height) = (self.color.width(), self.color.height());
        let bytes = u64::from(width * height * self.color.sample_count()) * 4;
        let (values, staging) = (gpu.storage("samples", bytes)?, gpu.staging("samples", bytes)?);
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(COPY_SAMPLES.into()),
        });
        let stages = wgpu::ShaderStages::COMPUTE;
        let image = wgpu::BindGroupLayoutEntry {
            ty: wgpu::BindingType::Texture {
                sample_type: UNFILTERED,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: true,
            },
            ..Slot::Write.entry(1, stages)
        };
        let layout = gpu.bind_group_layout("samples", &[Slot::Write.entry(0, stages), image]);
        let pipeline = kernel::pipeline(gpu, &module, "copy", &[&layout]);
        let view = self.color.create_view(&Default::default());
        let image = wgpu::BindGroupEntry {
            binding: 1,
            resource: wgpu::BindingResource::TextureView(&view),
        };
        let group = kernel::bind_entries(gpu, &layout, &[entry(0, &values), image]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&values, 0, &staging, 0, bytes);
        gpu.queue.submit([encoder.finish()]);
        gpu.map(&staging)
    }

    /// The image's bytes, row after row. The rows must be multiples of 256 bytes.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, AssignError> {
        let texel = self.color.format().block_copy_size(None).unwrap_or(4);
        let row = self.color.width() * texel;
        let bytes = u64::from(row * self.color.height());
        let staging = gpu.staging("image", bytes)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            self.color.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        gpu.map(&staging)
    }

    /// Writes an image of four bytes per pixel as PNG.
    pub fn save(&self, gpu: &Gpu, path: &str) -> Result<(), Box<dyn Error>> {
        let (width, height) = (self.color.width(), self.color.height());
        let bytes = self.read(gpu)?;
        Ok(image::save_buffer(path, &bytes, width, height, image::ColorType::Rgba8)?)
    }
}
