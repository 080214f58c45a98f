//! The atlas of shadow maps, and what a device must have to read it.

use assign::{AssignError, Gpu};

use crate::targets::DEPTH_FORMAT;

/// Storage buffers that a shader with lists and shadows may bind: lights and lists 6, materials, the table of area
/// lights, and the records of maps.
pub(super) const STORAGE_BUFFERS: u32 = 9;

/// Refuses devices on which shaders cannot bind as many storage buffers as they need for `what`.
pub(super) fn check_device(gpu: &Gpu, what: &str, buffers: u32) -> Result<(), AssignError> {
    let has = gpu.device.limits().max_storage_buffers_per_shader_stage;
    if has >= buffers {
        return Ok(());
    }
    Err(AssignError::Limit {
        strategy: what.into(),
        limit: "max_storage_buffers_per_shader_stage",
        needs: buffers.into(),
        has: has.into(),
    })
}

/// An atlas of depths, texels.
pub(super) fn atlas(gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow maps"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
