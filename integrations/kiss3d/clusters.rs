//! Lists of lights for a scene of kiss3d: lightbench's part of the frame.

use std::error::Error;

use assign::{
    Assignment, Bounds, CullSettings, EncoderPasses, Fewer, Frame, FrameBindings, Gpu, Kept, Light,
    LightBuffer, SampleDomain, Slots, View, Viewport,
    glam::{Mat4, Vec3},
    wgpu,
};
use assign_clustered::{Clustered, Occupancy};
use bytemuck::{Pod, Zeroable};
use kiss3d::prelude::{Camera3d, CollectedLight, Context, LightType};

/// First bindings of the view and of the lists in bind group 0. Binding 0 is the camera.
const VIEW: u32 = 1;
const LISTS: u32 = VIEW + 4;

/// The camera in the material's shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct CameraUniform {
    world_to_clip: Mat4,
    light_count: u32,
    padding: [u32; 3],
}

/// The lists of one camera, and the bind group through which a material reads them.
pub(crate) struct Clusters {
    gpu: Gpu,
    strategy: Box<dyn Assignment>,
    lights: LightBuffer,
    bindings: FrameBindings,
    samples: SampleDomain,
    camera: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: Option<wgpu::BindGroup>,
}

impl Clusters {
    /// Wraps kiss3d's device. `most` loses all lights but the first ones, which a comparison must notice.
    pub(crate) fn new(sample_count: u32, most: Option<u32>) -> Result<Self, Box<dyn Error>> {
        let context = Context::get();
        let info = context.adapter.get_info();
        let gpu = Gpu::new((*context.device).clone(), (*context.queue).clone(), info);
        let (bounds, occupancy) = (Bounds::Explicit, Occupancy::Sparse);
        let size = "32x32x24".parse()?;
        let mut strategy: Box<dyn Assignment> =
            Box::new(Clustered::new(&gpu, size, bounds, occupancy, CullSettings::default())?);
        if let Some(most) = most {
            strategy = Box::new(Fewer::new(&gpu, strategy, Kept::First, most)?);
        }
        let stages = wgpu::ShaderStages::FRAGMENT;
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let mut entries = vec![assign::uniform_entry(0, both)];
        entries.extend(FrameBindings::layout_entries(VIEW, stages));
        entries.extend(strategy.lookup().layout_entries(LISTS, stages));
        Ok(Self {
            lights: LightBuffer::new(&gpu, &[])?,
            bindings: FrameBindings::new(&gpu),
            samples: match sample_count {
                1 => SampleDomain::OpaqueSurfaces,
                _ => SampleDomain::NearSurfaces,
            },
            camera: gpu.uniform("camera", size_of::<CameraUniform>() as u64),
            layout: gpu.bind_group_layout("lit", &entries),
            group: None,
            strategy,
            gpu,
        })
    }

    /// What the material's shader needs to look lights up.
    pub(crate) fn wgsl(&self) -> Result<String, Box<dyn Error>> {
        let slots = Slots { view: (0, VIEW), lists_group: 0, first_binding: LISTS, prefix: "lb_" };
        let lookup = self.strategy.lookup();
        Ok(match self.samples {
            SampleDomain::OpaqueSurfaces => lookup.wgsl_at_surfaces(&slots)?,
            _ => lookup.wgsl(&slots)?,
        })
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    pub(crate) fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The camera, the view, the lights and the lists; `None` before the first frame.
    pub(crate) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.group.as_ref()
    }

    /// Uploads kiss3d's lights and sizes the buffers. `depth` is kiss3d's own depth buffer. Returns the view for
    /// [`record`](Self::record).
    pub(crate) fn prepare(
        &mut self,
        camera: &dyn Camera3d,
        collected: &[CollectedLight],
        depth: &wgpu::TextureView,
    ) -> Result<View, Box<dyn Error>> {
        let lights: Vec<Light> = collected.iter().filter_map(light).collect();
        self.lights.update(&self.gpu, &lights)?;
        let (pose, view_to_clip) = camera.view_transform_pair(0);
        let world_to_view = pose.to_mat4();
        let (width, height) = (depth.texture().width(), depth.texture().height());
        // kiss3d's projections are OpenGL's, but wgpu takes them as they are: clip z from 0 to 1 is drawn.
        let viewport = Viewport { x: 0, y: 0, width, height };
        let view = View::from_matrices(world_to_view, view_to_clip, viewport)?;
        let uniform = CameraUniform {
            world_to_clip: view_to_clip * world_to_view,
            light_count: self.lights.count(),
            padding: [0; 3],
        };
        self.gpu.queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&uniform));
        let frame = Frame::new(&view, &self.lights).with_depth(depth).sampled_at(self.samples);
        self.bindings.update(&self.gpu, &frame)?;
        self.strategy.prepare(&self.gpu, &frame)?;
        let mut entries = vec![assign::entry(0, &self.camera)];
        entries.extend(self.bindings.bind_entries(VIEW));
        entries.extend(self.strategy.lookup().bind_entries(LISTS));
        self.group = Some(self.gpu.bind_group("lit", &self.layout, &entries));
        Ok(view)
    }

    /// Records the passes that make the lists, after the depth of the surfaces.
    pub(crate) fn record(
        &mut self,
        view: &View,
        depth: &wgpu::TextureView,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let frame = Frame::new(view, &self.lights).with_depth(depth).sampled_at(self.samples);
        self.strategy.record(&frame, &mut EncoderPasses { encoder });
    }
}

/// A point light of kiss3d. Directional lights reach everything and need no list. This program has no spots.
fn light(light: &CollectedLight) -> Option<Light> {
    let LightType::Point { attenuation_radius } = light.light_type else { return None };
    let intensity: Vec3 = light.color * light.intensity;
    Some(Light::point(light.world_position, attenuation_radius, intensity))
}
