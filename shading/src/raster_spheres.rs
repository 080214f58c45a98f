//! `RasterSphere`: deferred lighting by drawing each light's volume (Watrous 2024).
//!
//! There are no lists: the rasteriser finds the pixels that a light may reach. The pass draws the
//! back faces of a sphere around each light where they lie behind the surface. Every fragment adds
//! one light to one pixel, and blending sums them. So a pixel is read and written once per volume
//! that covers it.

use assign::{
    AssignError, DepthMapping, LightBuffer, LightKinds, LightReader, Passes, Storage, Suns, View,
};
use glam::Vec3;
use wgpu::util::DeviceExt;

use crate::{
    AreaModel, Cut, LightingOptions, Renderer, ShadingError, ShadowModel,
    bound_shadows::mount_rays,
    gbuffer_inputs::{GBufferInputs, PIXELS_GROUP},
    lighting_inputs::LightingInputs,
    loop_rounds::LightTotals,
    raster::Orientation,
    shaders::{LISTS_GROUP, lighting_modules},
    targets::{DEPTH_FORMAT, RADIANCE_FORMAT},
};

/// The largest relative difference of a channel to no culling that this method may show. It sums in
/// the order of the lights, as all methods do, but through the render target. A blend unit may
/// round a product and a sum together, or in another order.
pub const RASTER_SPHERE_TOLERANCE: f64 = 1e-3;

/// Light volumes as spheres of triangles.
#[derive(Debug)]
pub struct RasterSpheres {
    volumes: wgpu::RenderPipeline,
    /// Draws emission and suns, if there are any.
    first: Option<wgpu::RenderPipeline>,
    layout: wgpu::BindGroupLayout,
    triangles: wgpu::Buffer,
    vertex_count: u32,
    options: LightingOptions,
    orientation: Orientation,
    images: GBufferInputs,
    inputs: LightingInputs,
}

impl RasterSpheres {
    /// Creates the pipelines. Returns an error if the device cannot blend into single precision, or if the renderer
    /// draws layers.
    ///
    /// With [`Cut::Hard`] a light ends abruptly. If this shader rounds differently from that of no
    /// culling, a sample at the very edge of a range gains or loses the light's whole share.
    pub fn new(
        renderer: &Renderer,
        kinds: LightKinds,
        area: AreaModel,
        cut: Cut,
        suns: Suns,
        shadows: ShadowModel,
    ) -> Result<Self, ShadingError> {
        let options =
            LightingOptions { kinds, area, cut, suns, shadows, ..LightingOptions::default() };
        let gpu = &renderer.gpu;
        if renderer.layers.is_some() {
            return Err(AssignError::Unsupported {
                strategy: "RasterSphere".into(),
                asked: "layers over the opaque surfaces".into(),
                reason: "its volumes light only the opaque surfaces in the depth buffer".into(),
            }
            .into());
        }
        renderer.check_one_sample("RasterSphere")?;
        if !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
            return Err(AssignError::Unsupported {
                strategy: "RasterSphere".into(),
                asked: "an image in single precision".into(),
                reason: format!("{} does not blend 32-bit floats", gpu.info.name),
            }
            .into());
        }
        let images = GBufferInputs::of_scene(&renderer.scene);
        let inputs = LightingInputs::new(gpu, options, renderer.shadows.bound())?;
        let stages = wgpu::ShaderStages::FRAGMENT;
        let mut entries = images.layout(stages);
        entries.extend(LightingInputs::layout(inputs.bound(), stages));
        let layout = gpu.bind_group_layout("raster spheres", &entries);
        let shader = options.set_flags(images.set_flags(lighting_modules(LISTS_GROUP)));
        let module = mount_rays(shader, inputs.images()).create(gpu, "package::raster_spheres")?;
        let pipeline = |vertex, fragment, volumes| {
            pipeline(renderer, &layout, &module, [vertex, fragment], volumes)
        };
        let triangles = sphere();
        Ok(Self {
            volumes: pipeline("vertex_volume", "fragment_volume", true),
            first: (images.emissive || !suns.is_empty())
                .then(|| pipeline("vertex_all", "fragment_first", false)),
            vertex_count: triangles.len() as u32,
            triangles: gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("sphere"),
                contents: bytemuck::cast_slice(&triangles),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            layout,
            options,
            orientation: renderer.orientation,
            images,
            inputs,
        })
    }

    /// Records the pass `shade`, after depth and G-buffer.
    pub fn record(
        &self,
        renderer: &Renderer,
        view: &View,
        lights: &LightBuffer,
        passes: &mut dyn Passes,
    ) -> Result<(), ShadingError> {
        let made = self.options.kinds;
        if !made.cover(lights.kinds()) {
            return Err(ShadingError::Kinds { made, lights: lights.kinds() });
        }
        if self.orientation != renderer.orientation {
            return Err(ShadingError::Orientation);
        }
        renderer.check_bound_shadows(self.inputs.shadows(), false)?;
        // Each fragment adds only one light, so each is checked separately.
        let ray_rounds = renderer.shadows.ray_rounds();
        for light in LightTotals::of_each(lights) {
            light.with_rays(ray_rounds).check(
                &renderer.gpu,
                self.options,
                LightReader::Stored(Storage::Lists),
            )?;
        }
        let targets = &renderer.targets;
        let mut entries = self.images.entries(targets);
        entries.extend(self.inputs.entries());
        let group = renderer.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("raster spheres"),
            layout: &self.layout,
            entries: &entries,
        });
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &targets.radiance,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            // Depth is read-only, because the shader samples it as well.
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        };
        let port = view.viewport;
        passes.render("shade", &descriptor, &mut |pass| {
            let [x, y, width, height] = [port.x, port.y, port.width, port.height].map(|v| v as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
            pass.set_bind_group(PIXELS_GROUP, &group, &[]);
            if let Some(first) = &self.first {
                pass.set_pipeline(first);
                pass.draw(0..3, 0..1);
            }
            pass.set_pipeline(&self.volumes);
            pass.set_vertex_buffer(0, self.triangles.slice(..));
            pass.draw(0..self.vertex_count, 0..lights.count());
        });
        Ok(())
    }
}

fn pipeline(
    renderer: &Renderer,
    pixels: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
    volumes: bool,
) -> wgpu::RenderPipeline {
    let device = &renderer.gpu.device;
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(fragment),
        bind_group_layouts: &[Some(renderer.frame.layout()), None, Some(pixels)],
        immediate_size: 0,
    });
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let position = wgpu::VertexBufferLayout {
        array_stride: size_of::<Vec3>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    };
    // The back face of a volume lies behind the surfaces that it may light.
    let behind = match renderer.orientation.depth {
        DepthMapping::Standard => wgpu::CompareFunction::GreaterEqual,
        DepthMapping::Reversed => wgpu::CompareFunction::LessEqual,
    };
    let buffers = [Some(position)];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: if volumes { &buffers } else { &[] },
        },
        primitive: wgpu::PrimitiveState {
            front_face: if renderer.orientation.is_mirrored {
                wgpu::FrontFace::Cw
            } else {
                wgpu::FrontFace::Ccw
            },
            cull_mode: volumes.then_some(wgpu::Face::Front),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(if volumes { behind } else { wgpu::CompareFunction::Always }),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: RADIANCE_FORMAT,
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Triangles around the unit ball, counter-clockwise from outside: an icosahedron, each face
/// divided into four, scaled until every face lies outside the ball.
fn sphere() -> Vec<Vec3> {
    let golden = 0.5 * (1.0 + 5_f32.sqrt());
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z).normalize();
    let mut corners = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        corners.extend([corner(a, b, 0.0), corner(0.0, a, b), corner(b, 0.0, a)]);
    }
    // A face consists of three corners that are each other's nearest.
    let edge = corners[1..].iter().map(|c| c.distance(corners[0])).fold(f32::MAX, f32::min) * 1.01;
    let near = |a: Vec3, b: Vec3| a.distance(b) < edge;
    let mut triangles = Vec::new();
    for i in 0..corners.len() {
        for j in i + 1..corners.len() {
            for k in j + 1..corners.len() {
                let [a, b, c] = [corners[i], corners[j], corners[k]];
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (b - a).cross(c - a).dot(a) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    let halves = |[a, b, c]: [Vec3; 3]| {
        let [ab, bc, ca] = [a + b, b + c, c + a].map(Vec3::normalize);
        [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
    };
    let faces: Vec<[Vec3; 3]> = triangles.into_iter().flat_map(halves).collect();
    let distance = |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a).normalize().dot(*a);
    let nearest = faces.iter().map(distance).fold(f32::MAX, f32::min);
    // Scale a little further than touching, because of rounding.
    let scale = 1.0001 / nearest;
    faces.into_iter().flatten().map(|corner| corner * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sphere_encloses_the_unit_ball() {
        let triangles = sphere();
        assert_eq!(triangles.len(), 240);
        for face in triangles.chunks(3) {
            let normal = (face[1] - face[0]).cross(face[2] - face[0]).normalize();
            let distance = normal.dot(face[0]);
            assert!((1.0..1.1).contains(&distance), "{face:?}: {distance}");
        }
    }
}
