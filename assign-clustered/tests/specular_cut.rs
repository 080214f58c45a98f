//! A specular threshold takes the specular flag, and that alone, from area lights too dull for it.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Assignment, Bounds, CullSettings, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Emitter,
    EncoderPasses, Frame, Gpu, Light, LightBuffer, View, conformance::flat_depth,
};
use assign_clustered::{Clustered, Normals, Occupancy};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];

/// An image of one colour, half floats: of 0 and 1 alone, whose bits are told here.
fn flat(gpu: &Gpu, texel: [f32; 4]) -> wgpu::TextureView {
    let bits = texel.map(|x| if x == 0.0 { 0_u16 } else { 0x3c00 });
    let size = wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let texels = vec![bits; (SIZE[0] * SIZE[1]) as usize];
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(8 * SIZE[0]),
        rows_per_image: None,
    };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
    texture.create_view(&Default::default())
}

/// The flags of the lights that any group lists, one another's all or none.
fn flags(gpu: &Gpu, threshold: f32, bins: u32) -> [u32; 3] {
    // A wall that faces the eye two metres away, of roughness 1 and white: a clip depth of near / 2.
    let view = View::look_at(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 1.0, 0.1, SIZE);
    let depth = flat_depth(gpu, SIZE, 0.05);
    let normals = flat(gpu, [0.0, 0.0, 1.0, 1.0]);
    let base_color = flat(gpu, [1.0, 1.0, 1.0, 0.0]);
    let emitter = |share: f32| Emitter::rectangle(Vec3::X, Vec3::NEG_Y).with_diffuse_share(share);
    let position = Vec3::new(0.0, 0.0, 3.0);
    let lights = [
        Light::point(position, 20.0, Vec3::ONE),
        Light::area(emitter(1.0), position, 20.0, Vec3::ONE),
        // Its diffuse light ends before the wall.
        Light::area(emitter(0.05), position, 20.0, Vec3::ONE),
    ];
    let lights = LightBuffer::new(gpu, &lights).unwrap();
    assert!(lights.rejected().is_empty());
    let mut strategy = Clustered::with_normals(
        gpu,
        "64x64x8".parse().unwrap(),
        Bounds::Explicit,
        Occupancy::Sparse,
        Normals::Bins(bins),
        threshold,
        CullSettings::default(),
    )
    .unwrap();
    let frame = Frame::new(&view, &lights)
        .with_depth(&depth)
        .with_normals(&normals)
        .with_base_color(&base_color);
    strategy.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let lists = strategy.lists().snapshot(gpu).unwrap();
    assert!(lists.counters.occupied_groups > 0, "{:?}", lists.counters);
    let mut flags = [0; 3];
    for group in 0..strategy.lists().group_count() {
        for entry in lists.entries_of(group).unwrap() {
            flags[(entry & ENTRY_LIGHT) as usize] |= entry & !ENTRY_LIGHT;
        }
    }
    flags
}

#[test]
fn dull_area_lights_lose_their_specular_flag() {
    let gpu = Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"));
    let both = ENTRY_DIFFUSE | ENTRY_SPECULAR;
    for bins in [1, 6] {
        assert_eq!(flags(&gpu, 0.0, bins), [both, both, ENTRY_SPECULAR], "lossless");
        assert_eq!(flags(&gpu, 1e-9, bins), [both, both, ENTRY_SPECULAR], "brighter than that");
        // The light's own radiance is 1/4, and roughness 1 reflects a small part of it.
        assert_eq!(flags(&gpu, 10.0, bins), [both, ENTRY_DIFFUSE, 0], "duller than that");
    }
}
