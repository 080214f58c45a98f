//! A renderer of your own that uses dense clusters: a plane seen from above, and one light loop.
//!
//! Run it with `cargo run -p lightbench-assign-clustered --example own_renderer`. It draws a plane under 500 lights with a
//! compute shader that uses only the look-up of lightbench. It prints how many lights each pixel looped over.

use std::error::Error;

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Frame, FrameBindings, Gpu, Light, LightBuffer,
    Passes, Shader, View, entry, storage_entry,
};
use assign_clustered::{Clustered, Occupancy};
use glam::Vec3;

/// The renderer's own shader. It finds the plane under each pixel and sums the lights of the pixel's list.
const SHADE: &str = "
import package::lights::light_spheres;
import package::lists::ENTRY_LIGHT;
import package::look_up::{next_light, open_lights};
import package::sample::ViewSample;
import package::view::{view, eye_world, ndc_of_pixel, position_view_at, world_of_view};
import package::window::{fall_off, MIN_DISTANCE_2};

@group(2) @binding(0) var<storage, read_write> image: array<vec4f>;

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) thread: vec3u) {
  let pixel = vec2f(thread.xy) + 0.5;
  if any(pixel > view.viewport_size) {
    return;
  }
  // The pixel's ray meets the plane y = 0 at view depth `t`.
  let ahead = world_of_view(position_view_at(ndc_of_pixel(pixel), 1.0)) - eye_world();
  let t = -eye_world().y / ahead.y;
  let position = eye_world() + t * ahead;
  var cursor = open_lights(ViewSample(pixel, 0.5, t, position, vec3f(0.0, 1.0, 0.0), 0u));
  var brightness = 0.0;
  var listed = 0.0;
  while next_light(&cursor) {
    listed += 1.0;
    let sphere = light_spheres[cursor.entry & ENTRY_LIGHT];
    let to_light = sphere.position_world - position;
    // The ball around a point light has the light's range as its radius.
    brightness += fall_off(dot(to_light, to_light), sphere.radius_m, MIN_DISTANCE_2);
  }
  image[thread.x + thread.y * u32(view.viewport_size.x)] = vec4f(brightness, listed, 0.0, 1.0);
}
";

fn main() -> Result<(), Box<dyn Error>> {
    // The renderer's device, lights and camera.
    let gpu = Gpu::open(None)?;
    let (width, height) = (160, 90);
    let light = |i: u32| {
        let (x, z) = ((i % 25) as f32 - 12.0, (i / 25) as f32 - 10.0);
        Light::point(Vec3::new(x * 2.0, 0.5, z * 2.0), 1.5, Vec3::ONE)
    };
    let lights = LightBuffer::new(&gpu, &(0..500).map(light).collect::<Vec<_>>())?;
    let view = View::look_at(Vec3::new(0.0, 12.0, 16.0), Vec3::ZERO, 1.0, 0.1, [width, height]);

    // Once: the strategy, and its look-up spliced into the renderer's shader.
    let mut strategy = Clustered::new(
        &gpu,
        "32x32x16".parse()?,
        Bounds::Implicit,
        Occupancy::Dense,
        CullSettings::default(),
    )?;
    let module = Shader::new(1)
        .strategy(strategy.lookup().module)
        .module("package::shade", SHADE)
        .create(&gpu, "package::shade")?;
    let mut bindings = FrameBindings::new(&gpu);
    let image = gpu.storage("image", u64::from(width * height) * 16)?;
    let image_layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[storage_entry(0, wgpu::ShaderStages::COMPUTE, false)],
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[
            Some(bindings.layout()),
            Some(strategy.lookup().layout()),
            Some(&image_layout),
        ],
        immediate_size: 0,
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layout),
        module: &module,
        entry_point: Some("shade"),
        compilation_options: Default::default(),
        cache: None,
    });
    let target = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &image_layout,
        entries: &[entry(0, &image)],
    });

    // Each frame: prepare, record, shade.
    let frame = Frame::new(&view, &lights);
    bindings.update(&gpu, &frame)?;
    strategy.prepare(&gpu, &frame)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    strategy.record(&frame, &mut passes);
    passes.compute("shade", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, bindings.bind_group(), &[]);
        pass.set_bind_group(1, strategy.bind_group(), &[]);
        pass.set_bind_group(2, &target, &[]);
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
    });
    gpu.queue.submit([encoder.finish()]);

    let pixels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&gpu.read(&image, image.size())?);
    let listed = pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64;
    let lit = pixels.iter().filter(|p| p[0] > 0.0).count();
    println!(
        "{} on {}: {listed:.1} of {} lights per pixel, {lit} of {} pixels lit",
        strategy.id(),
        gpu.info.name,
        lights.count(),
        pixels.len()
    );
    Ok(())
}
