//! What a renderer provides for each strategy, and what its look-up takes: a table for README.

use std::fmt::Write;

use assign::{
    AssignError, Frame, FrameBindings, Gpu, Light, LightBuffer, Lookup, ModelBox, Needs, View,
};
use glam::{Mat4, Vec3};

use super::{Method, Options, rows};

/// The frame for which memory is counted: pixels, and lights.
const SIZE: [u32; 2] = [1920, 1080];
const LIGHTS: u32 = 1_000;

/// The table, Markdown: a row per family, at its default parameters. Nothing is drawn, so any device will do.
///
/// # Errors
///
/// As the strategies that it makes and prepares.
pub fn plug_in_markdown(gpu: &Gpu) -> Result<String, AssignError> {
    let mut table = format!(
        "| strategy | also needs | buffers in a fragment shader | memory at {} x {} with {LIGHTS} lights |\n|---|---|---|---|\n",
        SIZE[0], SIZE[1]
    );
    for row in rows() {
        let options = Options { parameters: row.default.into(), ..Options::default() };
        let Method::Lists { mut strategy, .. } = (row.make)(gpu, &options)? else { continue };
        if row.krate == "assign" {
            continue;
        }
        prepare(gpu, strategy.as_mut())?;
        let [uniforms, storage] = buffers(&strategy.lookup());
        let needs = needed(strategy.needs());
        let mib = strategy.memory_bytes() as f64 / f64::from(1 << 20);
        let id = row.default_id();
        let _ = writeln!(
            table,
            "| `{id}` | {needs} | {uniforms} uniform, {storage} storage | {mib:.1} MiB |"
        );
    }
    Ok(table)
}

/// Uniform and storage buffers of a shader that looks lights up: those of the view, the lights and the look-up.
fn buffers(lookup: &Lookup<'_>) -> [usize; 2] {
    let stages = wgpu::ShaderStages::FRAGMENT;
    let mut entries = FrameBindings::layout_entries(0, stages);
    entries.extend(lookup.layout_entries(0, stages));
    let is = |ty: wgpu::BufferBindingType| {
        entries
            .iter()
            .filter(
                |entry| matches!(entry.ty, wgpu::BindingType::Buffer { ty: of, .. } if of == ty),
            )
            .count()
    };
    [is(wgpu::BufferBindingType::Uniform), is(wgpu::BufferBindingType::Storage { read_only: true })]
}

/// What the renderer provides, in words.
fn needed(needs: Needs) -> String {
    let words = [
        (needs.depth, "depth"),
        (needs.normals, "normals"),
        (needs.materials, "base colours"),
        (needs.models, "boxes of models"),
        (needs.triangles, "triangles"),
    ];
    let words: Vec<&str> = words.iter().filter(|(is, _)| *is).map(|(_, word)| *word).collect();
    if words.is_empty() { "nothing".into() } else { words.join(", ") }
}

/// Prepares a frame that has everything a strategy may need.
fn prepare(gpu: &Gpu, strategy: &mut dyn assign::Assignment) -> Result<(), AssignError> {
    let light = |i: u32| Light::point(Vec3::new(i as f32 * 0.01, 1.0, 0.0), 1.0, Vec3::ONE);
    let lights: Vec<Light> = (0..LIGHTS).map(light).collect();
    let lights = LightBuffer::new(gpu, &lights)?;
    let view = View::look_at(Vec3::new(5.0, 1.0, 9.0), Vec3::new(5.0, 1.0, 0.0), 1.0, 0.1, SIZE);
    let texture = |format| {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    };
    let depth = texture(wgpu::TextureFormat::Depth32Float);
    let colors = texture(wgpu::TextureFormat::Rgba16Float);
    let models = [ModelBox::new(Mat4::IDENTITY, Vec3::ZERO, Vec3::ONE)];
    let frame = Frame::new(&view, &lights)
        .with_depth(&depth)
        .with_normals(&colors)
        .with_base_color(&colors)
        .with_models(&models)
        .with_surface_bounds(Vec3::ZERO, Vec3::ONE);
    strategy.prepare(gpu, &frame)
}
