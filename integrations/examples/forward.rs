//! A forward renderer of its own that lights opaque surfaces and glass through lightbench.
//!
//! `cargo run -p integrations --example forward` draws two cameras in one submission while 300 lights move, and writes the last
//! frame to `forward.png`. Depth is reversed, and the far plane is infinitely far.
//!
//! The code between the marks `integration` is all that a renderer adds. It uses plain WGSL, and one bind group for its
//! own data, the view, the lights and the lists.

use std::{error::Error, ops::Range};

use assign::{
    AssignError, Assignment, Bounds, CullSettings, DepthMapping, EncoderPasses, Frame,
    FrameBindings, Gpu, LightBuffer, LightOrder, SampleDomain, Slots, View, Viewport,
};
use assign_clustered::{Clustered, Occupancy};
use bytemuck::{Pod, Zeroable};
use glam::Mat4;
use integrations::{Draw, Shot, Target, lights_at, open_device, scene, split_screen};

/// The renderer's own shader. Its `View` and `view` do not clash with those of the look-up.
const SHADER: &str = "
struct View { world_to_clip: mat4x4f, light_count: u32 }
@group(0) @binding(0) var<uniform> view: View;
struct Vertex {
  @builtin(position) @invariant position: vec4f,
  @location(0) normal: vec3f,
  @location(1) color: vec4f,
}
@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) color: vec4f) -> Vertex {
  return Vertex(view.world_to_clip * vec4f(position, 1.0), normal, color);
}

// integration: begin
// What one light adds. Both loops call it.
fn light_at(light: u32, position: vec3f, normal: vec3f) -> vec3f {
  let sphere = lb_light_spheres[light];
  let to_light = sphere.position_world - position;
  let distance_2 = dot(to_light, to_light);
  let cosine = abs(dot(normal, to_light)) * inverseSqrt(max(distance_2, lb_MIN_DISTANCE_2));
  let fall_off = lb_fall_off(distance_2, sphere.radius_m, lb_MIN_DISTANCE_2);
  return lb_light_emissions[light].intensity * (cosine * fall_off);
}

@fragment
fn listed_lights(in: Vertex) -> @location(0) vec4f {
  let sample = lb_sample_at(in.position.xy, in.position.z, in.normal, 0u);
  var sum = vec3f(0.02);
  var cursor = lb_open_lights(sample);
  while lb_next_light(&cursor) {
    sum += light_at(cursor.entry & lb_ENTRY_LIGHT, sample.position_world, in.normal);
  }
  return vec4f(in.color.rgb * sum, in.color.a);
}
// integration: end

// The renderer's own loop, which tests compare with.
@fragment
fn all_lights(in: Vertex) -> @location(0) vec4f {
  let sample = lb_sample_at(in.position.xy, in.position.z, in.normal, 0u);
  var sum = vec3f(0.02);
  for (var light = 0u; light < view.light_count; light++) {
    sum += light_at(light, sample.position_world, in.normal);
  }
  return vec4f(in.color.rgb * sum, in.color.a);
}
";

// integration: begin

/// First bindings of the view and of the lists in the renderer's bind group 0. Binding 0 is its own.
const VIEW: u32 = 1;
const LISTS: u32 = VIEW + 4;

/// Strategies of a camera: for opaque surfaces and for glass.
type Pair = [Box<dyn Assignment>; 2];

/// The lights of one camera, for opaque surfaces or for glass.
struct CameraLights {
    strategy: Box<dyn Assignment>,
    bindings: FrameBindings,
    samples: SampleDomain,
}

impl CameraLights {
    fn new(gpu: &Gpu, strategy: Box<dyn Assignment>, samples: SampleDomain) -> Self {
        Self { strategy, bindings: FrameBindings::new(gpu), samples }
    }

    /// What a material's shader needs to look lights up.
    fn wgsl(&self) -> Result<String, AssignError> {
        let slots = Slots { view: (0, VIEW), lists_group: 0, first_binding: LISTS, prefix: "lb_" };
        match self.samples {
            SampleDomain::OpaqueSurfaces => self.strategy.lookup().wgsl_at_surfaces(&slots),
            _ => self.strategy.lookup().wgsl(&slots),
        }
    }

    fn layout_entries(&self) -> Vec<wgpu::BindGroupLayoutEntry> {
        let stages = wgpu::ShaderStages::FRAGMENT;
        let mut entries = FrameBindings::layout_entries(VIEW, stages);
        entries.extend(self.strategy.lookup().layout_entries(LISTS, stages));
        entries
    }

    fn bind_entries(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        let mut entries = self.bindings.bind_entries(VIEW);
        entries.extend(self.strategy.lookup().bind_entries(LISTS));
        entries
    }

    fn frame<'a>(&self, view: &'a View, lights: &'a LightBuffer, target: &'a Target) -> Frame<'a> {
        Frame::new(view, lights).with_depth(&target.depth).sampled_at(self.samples)
    }

    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View,
        lights: &LightBuffer,
        target: &Target,
    ) -> Result<(), AssignError> {
        let frame = self.frame(view, lights, target);
        self.bindings.update(gpu, &frame)?;
        self.strategy.prepare(gpu, &frame)
    }

    fn record(
        &mut self,
        view: &View,
        lights: &LightBuffer,
        target: &Target,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let frame = self.frame(view, lights, target);
        self.strategy.record(&frame, &mut EncoderPasses { encoder });
    }
}

// integration: end

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct CameraUniform {
    world_to_clip: Mat4,
    light_count: u32,
    padding: [u32; 3],
}

struct Camera {
    uniform: wgpu::Buffer,
    opaque: CameraLights,
    glass: CameraLights,
}

/// The pipelines of a material: depth only, the lights of lists, or all lights.
struct Material {
    layout: wgpu::BindGroupLayout,
    depth: wgpu::RenderPipeline,
    listed: wgpu::RenderPipeline,
    all: wgpu::RenderPipeline,
}

impl Material {
    fn new(gpu: &Gpu, lights: &CameraLights, draw: Draw) -> Result<Self, AssignError> {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((lights.wgsl()? + SHADER).into()),
        });
        let mut entries = lights.layout_entries();
        entries.push(assign::uniform_entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT));
        let layout = gpu.bind_group_layout("material", &entries);
        let make = |fragment| draw.pipeline(gpu, &module, &layout, fragment);
        let (listed, all) = (make(Some("listed_lights")), make(Some("all_lights")));
        Ok(Self { depth: make(None), listed, all, layout })
    }

    fn lit(&self, own_loop: bool) -> &wgpu::RenderPipeline {
        if own_loop { &self.all } else { &self.listed }
    }

    fn bind(&self, gpu: &Gpu, camera: &wgpu::Buffer, lights: &CameraLights) -> wgpu::BindGroup {
        let mut entries = lights.bind_entries();
        entries.push(assign::entry(0, camera));
        assign::kernel::bind_entries(gpu, &self.layout, &entries)
    }
}

/// The renderer.
pub(crate) struct Forward {
    cameras: Vec<Camera>,
    vertices: wgpu::Buffer,
    opaque_vertices: u32,
    all_vertices: u32,
    opaque: Material,
    glass: Material,
}

impl Forward {
    /// Makes the pipelines, and the state of each camera. `make` returns a strategy for opaque surfaces, and one for
    /// glass in front of them.
    pub(crate) fn new(
        gpu: &Gpu,
        draw: Draw,
        camera_count: usize,
        make: &dyn Fn(&Gpu) -> Result<Pair, AssignError>,
    ) -> Result<Self, AssignError> {
        // integration: begin
        let surfaces = match draw.samples {
            1 => SampleDomain::OpaqueSurfaces,
            _ => SampleDomain::NearSurfaces,
        };
        // integration: end
        let camera = || {
            let [opaque, glass] = make(gpu)?;
            Ok(Camera {
                uniform: gpu.uniform("camera", size_of::<CameraUniform>() as u64),
                opaque: CameraLights::new(gpu, opaque, surfaces),
                glass: CameraLights::new(gpu, glass, SampleDomain::InFront),
            })
        };
        // All cameras share the pipelines of the first one.
        let first = camera()?;
        let opaque = Material::new(gpu, &first.opaque, draw)?;
        let glass = Material::new(gpu, &first.glass, Draw { is_glass: true, ..draw })?;
        let more = (1..camera_count).map(|_| camera());
        let cameras = std::iter::once(Ok(first)).chain(more).collect::<Result<_, AssignError>>()?;
        let (scene, opaque_vertices) = scene();
        let bytes: &[u8] = bytemuck::cast_slice(&scene);
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
        let vertices = gpu.buffer("vertices", bytes.len() as u64, usage)?;
        gpu.queue.write_buffer(&vertices, 0, bytes);
        let all_vertices = scene.len() as u32;
        Ok(Self { cameras, vertices, opaque_vertices, all_vertices, opaque, glass })
    }

    /// Draws all shots in one submission, each with a camera of its own. With `own_loop`, every pixel loops over all
    /// lights.
    pub(crate) fn draw(
        &mut self,
        gpu: &Gpu,
        target: &Target,
        lights: &LightBuffer,
        shots: &[Shot],
        own_loop: bool,
    ) -> Result<(), AssignError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut shown = Vec::new();
        for (camera, Shot { world_to_clip, view }) in self.cameras.iter_mut().zip(shots) {
            let uniform = CameraUniform {
                world_to_clip: *world_to_clip,
                light_count: lights.count(),
                padding: [0; 3],
            };
            gpu.queue.write_buffer(&camera.uniform, 0, bytemuck::bytes_of(&uniform));
            // integration: begin
            camera.opaque.prepare(gpu, view, lights, target)?;
            camera.glass.prepare(gpu, view, lights, target)?;
            // integration: end
            let opaque = self.opaque.bind(gpu, &camera.uniform, &camera.opaque);
            let glass = self.glass.bind(gpu, &camera.uniform, &camera.glass);
            shown.push((view.viewport, opaque, glass));
        }

        // The depth of opaque surfaces, which strategies may read.
        let clear = shots.first().map(|shot| shot.view.depth_clear());
        let mut pass = target.begin(&mut encoder, clear);
        for (viewport, opaque, _) in &shown {
            let opaque = (&self.opaque.depth, opaque, 0..self.opaque_vertices);
            self.draw_view(&mut pass, *viewport, [opaque]);
        }
        drop(pass);

        // integration: begin
        lights.record(&mut EncoderPasses { encoder: &mut encoder });
        for (camera, Shot { view, .. }) in self.cameras.iter_mut().zip(shots) {
            camera.opaque.record(view, lights, target, &mut encoder);
            camera.glass.record(view, lights, target, &mut encoder);
        }
        // integration: end

        let mut pass = target.begin(&mut encoder, None);
        for (viewport, opaque, glass) in &shown {
            let opaque = (self.opaque.lit(own_loop), opaque, 0..self.opaque_vertices);
            let glass = (self.glass.lit(own_loop), glass, self.opaque_vertices..self.all_vertices);
            self.draw_view(&mut pass, *viewport, [opaque, glass]);
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Draws vertices into a viewport.
    fn draw_view<const DRAWS: usize>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        viewport: Viewport,
        draws: [(&wgpu::RenderPipeline, &wgpu::BindGroup, Range<u32>); DRAWS],
    ) {
        let Viewport { x, y, width, height } = viewport;
        pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        for (pipeline, group, vertices) in draws {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(vertices, 0..1);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let gpu = open_device()?;
    let size = [512, 192];
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    // integration: begin
    let clusters = |gpu: &Gpu, bounds, occupancy| -> Result<Box<dyn Assignment>, AssignError> {
        let (size, settings) = ("32x32x24".parse()?, CullSettings::default());
        Ok(Box::new(Clustered::new(gpu, size, bounds, occupancy, settings)?))
    };
    let make = |gpu: &Gpu| {
        Ok([
            clusters(gpu, Bounds::Explicit, Occupancy::Sparse)?,
            clusters(gpu, Bounds::Implicit, Occupancy::Dense)?,
        ])
    };
    // integration: end
    let draw = Draw { format, samples: 1, depth: DepthMapping::Reversed, is_glass: false };
    let mut renderer = Forward::new(&gpu, draw, 2, &make)?;
    let target = Target::new(&gpu, format, size, draw.samples);
    let mut lights =
        LightBuffer::ordered(&gpu, &lights_at(0.0, 300), LightOrder::Gpu { every: 1 })?;
    for frame in 0..8 {
        lights.update(&gpu, &lights_at(frame as f32 / 30.0, 300))?;
        renderer.draw(&gpu, &target, &lights, &split_screen(size), false)?;
    }
    target.save(&gpu, "forward.png")?;
    println!("forward.png: {} lights on {}", lights.count(), gpu.info.name);
    Ok(())
}
