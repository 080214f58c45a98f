//! The memory of clusters equals the table of the crate's documentation. No GPU runs.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Assignment, Bounds, CullSettings, Frame, Gpu, Light, LightBuffer, SampleDomain, View,
};
use assign_clustered::{ClusterOptions, Clustered, Normals, Occupancy, SpecularCut};
use glam::Vec3;

/// Any texture view that can be bound as an image of the G-buffer.
fn image(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 256, height: 256, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

#[test]
fn bytes_per_group_are_those_of_the_table() {
    let gpu = Gpu::noop().unwrap();
    let depth = image(&gpu, wgpu::TextureFormat::Depth32Float);
    let normals = image(&gpu, wgpu::TextureFormat::Rgba16Float);
    let base_color = image(&gpu, wgpu::TextureFormat::Rgba8Unorm);
    let lights = LightBuffer::new(&gpu, &[Light::point(Vec3::ZERO, 1.0, Vec3::ONE)]).unwrap();
    let bytes = |strategy: &mut Clustered, width| {
        let view = View::look_at(Vec3::Z, Vec3::ZERO, 1.0, 0.1, [width, 256]);
        let mut frame = Frame::new(&view, &lights).sampled_at(SampleDomain::OpaqueSurfaces);
        frame.depth = Some(&depth);
        frame.normals = Some(&normals);
        frame.base_color = Some(&base_color);
        strategy.prepare(&gpu, &frame).unwrap();
        let entries = strategy.lists().entries().size();
        (strategy.lists().group_count(), strategy.memory_bytes() - entries)
    };
    let (implicit, explicit) = (Bounds::Implicit, Bounds::Explicit);
    let (dense, sparse, aware) = (Occupancy::Dense, Occupancy::Sparse, Occupancy::DepthAware);
    let bins = Normals::Bins(6);
    let cut = SpecularCut::Below(0.001);
    let none = (Normals::None, SpecularCut::None, None);
    for (bounds, occupancy, (normals, cut, reach), per_group) in [
        (implicit, dense, none, 8),
        (implicit, sparse, none, 8 + 8),
        (explicit, dense, none, 8 + 28),
        (explicit, sparse, none, 8 + 28),
        (implicit, aware, none, 8 + 4),
        (explicit, aware, none, 8 + 28),
        (explicit, sparse, (bins, SpecularCut::None, None), 60),
        (explicit, sparse, (bins, cut, None), 72),
        (explicit, sparse, (Normals::None, SpecularCut::None, Some(8.0)), 8 + 28 + 4),
    ] {
        let size = "16x16x8".parse().unwrap();
        let settings = CullSettings::default();
        let plain = ClusterOptions::new(size, bounds, occupancy, settings);
        let options = ClusterOptions { normals, cut, reach, ..plain };
        let mut strategy = Clustered::with_options(&gpu, options).unwrap();
        let (few, small) = bytes(&mut strategy, 64);
        let (many, large) = bytes(&mut strategy, 256);
        let found = (large - small) / u64::from(many - few);
        assert_eq!(found, per_group, "{}: bytes per group", strategy.id());
    }
}
