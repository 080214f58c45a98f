//! Reflective shadow maps that tests fill on the CPU.

use assign::{EncoderPasses, Gpu, Light, LightShape, Projection, View};
use assign_cdi::{Rsm, VplBuffer, VplSettings};
use bytemuck::cast_slice;
use glam::{Vec2, Vec3, Vec4};

/// A map whose texels come from a function on the CPU.
pub(crate) struct Map {
    pub(crate) gpu: Gpu,
    pub(crate) view: View,
    pub(crate) light: Light,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) normals: wgpu::TextureView,
    pub(crate) base_color: wgpu::TextureView,
}

/// A surface seen through a texel: its view depth, normal, base colour and metallic.
pub(crate) type Hit = (f32, Vec3, Vec4);

pub(crate) fn spot(outer_angle: f32) -> Light {
    Light {
        shape: LightShape::Spot { direction: Vec3::NEG_Y, inner_angle: 0.0, outer_angle },
        ..Light::point(Vec3::new(0.5, 3.0, -0.25), 1e4, Vec3::new(8.0, 4.0, 2.0))
    }
}

impl Map {
    /// Makes the map of a light that looks down. `meet` gets each texel's direction in world space, of length 1 along the
    /// view's axis.
    pub(crate) fn new(size: [u32; 2], light: Light, meet: impl Fn(Vec3) -> Option<Hit>) -> Self {
        let LightShape::Spot { outer_angle, .. } = light.shape else { panic!("not a spot") };
        let gpu = Gpu::open(None).unwrap();
        let target = light.position - Vec3::Y;
        let mut view = View::look_at(light.position, target, 1.0, 0.01, size);
        let reach = Vec2::splat(outer_angle.tan() * 1.001);
        view.projection = Projection::Perspective { min: -reach, max: reach };
        // The viewport has an offset in larger textures.
        (view.viewport.x, view.viewport.y) = (3, 1);
        let full = [size[0] + 5, size[1] + 2];
        let mut depths = vec![0.0_f32; (full[0] * full[1]) as usize];
        let mut normals = vec![[0.0_f32; 4]; depths.len()];
        let mut colors = vec![[0.0_f32; 4]; depths.len()];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let share = (Vec2::new(x as f32, y as f32) + 0.5)
                    / Vec2::new(size[0] as f32, size[1] as f32);
                let ndc = Vec2::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y);
                let ray = (ndc * reach).extend(-1.0);
                let ray_world = view.world_to_view.inverse().transform_vector3(ray);
                if let Some((depth, normal, color)) = meet(ray_world) {
                    let at = ((y + 1) * full[0] + x + 3) as usize;
                    let clip = view.view_to_clip() * (ray * depth).extend(1.0);
                    depths[at] = clip.z / clip.w;
                    normals[at] = normal.extend(0.5).to_array();
                    colors[at] = color.to_array();
                }
            }
        }
        Self {
            depth: depth_texture(&gpu, full, &depths),
            normals: float_texture(&gpu, full, &normals),
            base_color: float_texture(&gpu, full, &colors),
            gpu,
            view,
            light,
        }
    }

    pub(crate) fn rsm(&self) -> Rsm<'_> {
        Rsm {
            depth: &self.depth,
            normals: &self.normals,
            base_color: &self.base_color,
            view: &self.view,
            light: &self.light,
        }
    }

    /// Runs both passes. `range_m` gives every VPL a range by its index.
    pub(crate) fn run(&self, buffer: &mut VplBuffer, range_m: impl Fn(u32) -> f32) {
        let gpu = &self.gpu;
        buffer.prepare(gpu, &self.rsm()).unwrap();
        let ranges: Vec<f32> = (0..buffer.capacity()).map(range_m).collect();
        gpu.queue.write_buffer(buffer.ranges_m(), 0, cast_slice(&ranges));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        buffer.record_choose(&mut passes);
        buffer.record_keep(&mut passes);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Lights of all VPLs, each with a range of one metre.
    pub(crate) fn lights(&self, settings: VplSettings) -> Vec<Light> {
        let mut buffer = VplBuffer::new(&self.gpu, settings).unwrap();
        self.run(&mut buffer, |_| 0.5);
        buffer.read(&self.gpu).unwrap()
    }
}

/// Writes the texels of a texture.
pub(crate) fn upload(gpu: &Gpu, texture: &wgpu::Texture, [width, height]: [u32; 2], texels: &[u8]) {
    gpu.queue.write_texture(
        texture.as_image_copy(),
        texels,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(texels.len() as u32 / height),
            rows_per_image: None,
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
}

pub(crate) fn texture(
    gpu: &Gpu,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    let written = if format.is_depth_stencil_format() {
        wgpu::TextureUsages::RENDER_ATTACHMENT
    } else {
        wgpu::TextureUsages::COPY_DST
    };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | written,
        view_formats: &[],
    })
}

pub(crate) fn float_texture(gpu: &Gpu, size: [u32; 2], texels: &[[f32; 4]]) -> wgpu::TextureView {
    let texture = texture(gpu, size, wgpu::TextureFormat::Rgba32Float);
    upload(gpu, &texture, size, cast_slice(texels));
    texture.create_view(&Default::default())
}

/// A depth texture with these depths. A draw must write it: a triangle over the image reads them from another texture.
pub(crate) fn depth_texture(gpu: &Gpu, size: [u32; 2], depths: &[f32]) -> wgpu::TextureView {
    const DRAW: &str = "
@group(0) @binding(0) var depths: texture_2d<f32>;
@vertex fn vertex(@builtin(vertex_index) ix: u32) -> @builtin(position) vec4f {
  return vec4f(f32(ix & 1u) * 4.0 - 1.0, f32(ix >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
  return textureLoad(depths, vec2u(at.xy), 0).r;
}";
    let source = texture(gpu, size, wgpu::TextureFormat::R32Float);
    upload(gpu, &source, size, cast_slice(depths));
    let depth = texture(gpu, size, wgpu::TextureFormat::Depth32Float);
    let target = depth.create_view(&Default::default());
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(DRAW.into()),
    });
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
        }],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &target,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    target
}

pub(crate) const WHITE: Vec4 = Vec4::new(1.0, 1.0, 1.0, 0.0);

pub(crate) const HALF_WALL_M: f32 = 2.0;

/// A room without a ceiling: coloured walls at +-2 m around the light, and a floor at y = 0.
pub(crate) fn room(light: &Light) -> impl Fn(Vec3) -> Option<Hit> + use<> {
    let eye = light.position;
    move |ray: Vec3| {
        let to = |axis: usize, at: f32| {
            let t = (at - eye[axis]) / ray[axis];
            (t > 1e-6 && t.is_finite()).then_some(t)
        };
        let walls = [
            (to(1, 0.0), Vec3::Y, Vec4::new(0.8, 0.7, 0.6, 0.0)),
            (to(0, -HALF_WALL_M), Vec3::X, Vec4::new(0.9, 0.1, 0.1, 0.0)),
            // Half a metal.
            (to(0, HALF_WALL_M), Vec3::NEG_X, Vec4::new(0.1, 0.9, 0.1, 0.5)),
            (to(2, -HALF_WALL_M), Vec3::Z, Vec4::new(0.5, 0.5, 0.9, 0.0)),
            (to(2, HALF_WALL_M), Vec3::NEG_Z, Vec4::ZERO),
        ];
        walls
            .into_iter()
            .filter_map(|(t, normal, color)| Some((t?, normal, color)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
