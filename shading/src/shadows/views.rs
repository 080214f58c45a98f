//! The views of the faces of shadow maps.

use assign::{AssignError, Gpu, ViewUniform};
use bytemuck::{Zeroable, bytes_of};

use super::face::Face;

/// The views of all faces in one buffer, bound at an offset for each face.
#[derive(Debug)]
pub(super) struct Views {
    pub(super) buffer: wgpu::Buffer,
    /// Bind group 0 of the pass.
    pub(super) group: wgpu::BindGroup,
    /// Bytes from one face's view to the next.
    pub(super) stride: u32,
}

impl Views {
    /// Uploads them; returns the layout of the bind group too.
    pub(super) fn new(
        gpu: &Gpu,
        faces: &[Face],
    ) -> Result<(Self, wgpu::BindGroupLayout), AssignError> {
        let size = size_of::<ViewUniform>();
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment;
        let stride = (size as u32).next_multiple_of(alignment.max(1));
        let bytes = u64::from(stride) * faces.len().max(1) as u64;
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.buffer("views of shadow maps", bytes, usage)?;
        let layout = gpu.bind_group_layout(
            "shadow maps",
            &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(size as u64),
                },
                count: None,
            }],
        );
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow maps"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &buffer,
                    offset: 0,
                    size: wgpu::BufferSize::new(size as u64),
                }),
            }],
        });
        let views = Self { buffer, group, stride };
        views.write(gpu, faces);
        Ok((views, layout))
    }

    /// Uploads the views of faces, at most as many as there were at first.
    pub(super) fn write(&self, gpu: &Gpu, faces: &[Face]) {
        let mut bytes = vec![0; self.stride as usize * faces.len()];
        for (slot, face) in bytes.chunks_mut(self.stride as usize).zip(faces) {
            let view = ViewUniform {
                world_to_view: face.world_to_view.to_cols_array_2d(),
                view_to_clip: face.view_to_clip.to_cols_array_2d(),
                ..ViewUniform::zeroed()
            };
            slot[..size_of::<ViewUniform>()].copy_from_slice(bytes_of(&view));
        }
        gpu.queue.write_buffer(&self.buffer, 0, &bytes);
    }
}
