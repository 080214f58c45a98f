//! Entries of bind groups with textures, which several passes need.

/// Colours and normals: texels that are read without filtering.
pub(crate) const TEXELS: wgpu::TextureSampleType =
    wgpu::TextureSampleType::Float { filterable: false };

/// A layout entry of a texture that a compute pass reads.
pub(crate) fn texture_layout(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

/// A bind group entry of a texture.
pub(crate) fn texture(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}
