//! The images that a renderer draws into.

use std::error::Error;

use assign::{AssignError, Gpu};

/// The format of depth.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What the cameras draw into.
pub struct Target {
    /// The image.
    pub color: wgpu::Texture,
    /// The depth of opaque surfaces.
    pub depth: wgpu::TextureView,
}

impl Target {
    /// A target that can be read.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat, size: [u32; 2]) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
        Self {
            color: texture(format, wgpu::TextureUsages::COPY_SRC),
            depth: depth.create_view(&Default::default()),
        }
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
