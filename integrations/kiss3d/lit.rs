//! A material of kiss3d that looks its lights up in lists.

use std::{any::Any, cell::RefCell, error::Error, rc::Rc};

use assign::{
    Gpu,
    glam::{Mat4, Vec3, Vec4},
    wgpu,
};
use bytemuck::{Pod, Zeroable};
use kiss3d::{
    glamx::Pose3,
    prelude::{
        Camera3d, Context, GpuData, GpuMesh3d, InstancesBuffer3d, LightCollection, Material3d,
        ObjectData3d, PipelineCache, RenderContext, RenderPhase, multisample_state,
        vertex_index::VERTEX_INDEX_FORMAT,
    },
};

use crate::clusters::Clusters;

/// What the material draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Draws {
    /// Depth only, from which the lists are made.
    Depth,
    /// The lights of lists.
    ListedLights,
    /// All lights.
    AllLights,
}

/// What the program shares with the material.
pub(crate) struct Shared {
    pub(crate) clusters: Clusters,
    pub(crate) draws: Draws,
}

/// An object in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct ObjectUniform {
    to_world: Mat4,
    normal_to_world: Mat4,
    color: Vec4,
}

/// What each object has of its own.
struct Object {
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl GpuData for Object {
    fn as_any(&self) -> &dyn Any {
        self
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }
}

/// The material.
pub(crate) struct Lit {
    gpu: Gpu,
    shared: Rc<RefCell<Shared>>,
    object_layout: wgpu::BindGroupLayout,
    depth: PipelineCache,
    listed: PipelineCache,
    all: PipelineCache,
}

impl Lit {
    pub(crate) fn new(shared: Rc<RefCell<Shared>>) -> Result<Self, Box<dyn Error>> {
        let Shared { clusters, .. } = &*shared.borrow();
        let gpu = clusters.gpu().clone();
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("lit"),
            source: wgpu::ShaderSource::Wgsl((clusters.wgsl()? + include_str!("lit.wgsl")).into()),
        });
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let object_layout = gpu.bind_group_layout("object", &[assign::uniform_entry(0, stages)]);
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("lit"),
            bind_group_layouts: &[Some(clusters.layout()), Some(&object_layout)],
            immediate_size: 0,
        });
        let cache = |fragment: Option<&'static str>| {
            let (gpu, module, layout) = (gpu.clone(), module.clone(), layout.clone());
            PipelineCache::new(move |samples| pipeline(&gpu, &module, &layout, fragment, samples))
        };
        let (listed, all) = (cache(Some("listed_lights")), cache(Some("all_lights")));
        Ok(Self {
            depth: cache(None),
            listed,
            all,
            object_layout,
            gpu: gpu.clone(),
            shared: shared.clone(),
        })
    }
}

/// A pipeline over kiss3d's meshes. Without a fragment shader, it draws depth.
fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    fragment: Option<&str>,
    samples: u32,
) -> wgpu::RenderPipeline {
    let attributes = [0, 1].map(|location| {
        [wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x3,
            offset: 0,
            shader_location: location,
        }]
    });
    let buffers = [0, 1].map(|ix: usize| {
        Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vec3>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes[ix],
        })
    });
    let targets = [Some(Context::render_format().into())];
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: fragment,
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: Context::depth_format(),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: multisample_state(samples),
        fragment: fragment.map(|entry_point| wgpu::FragmentState {
            module,
            entry_point: Some(entry_point),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl Material3d for Lit {
    fn create_gpu_data(&self) -> Box<dyn GpuData> {
        let uniform = self.gpu.uniform("object", size_of::<ObjectUniform>() as u64);
        let entries = [assign::entry(0, &uniform)];
        let group = self.gpu.bind_group("object", &self.object_layout, &entries);
        Box::new(Object { uniform, group })
    }

    fn prepare(
        &mut self,
        _pass: usize,
        transform: Pose3,
        scale: Vec3,
        _camera: &mut dyn Camera3d,
        _lights: &LightCollection,
        data: &ObjectData3d,
        gpu_data: &mut dyn GpuData,
        _width: u32,
        _height: u32,
    ) {
        let Some(object) = gpu_data.as_any().downcast_ref::<Object>() else { return };
        let color = data.color();
        let uniform = ObjectUniform {
            to_world: transform.to_mat4() * Mat4::from_scale(scale),
            normal_to_world: transform.to_mat4() * Mat4::from_scale(scale.recip()),
            color: Vec4::new(color.r, color.g, color.b, color.a),
        };
        self.gpu.queue.write_buffer(&object.uniform, 0, bytemuck::bytes_of(&uniform));
    }

    fn render(
        &mut self,
        _pass: usize,
        _transform: Pose3,
        _scale: Vec3,
        _camera: &mut dyn Camera3d,
        _lights: &LightCollection,
        _data: &ObjectData3d,
        mesh: &mut GpuMesh3d,
        _instances: &mut InstancesBuffer3d,
        gpu_data: &mut dyn GpuData,
        render_pass: &mut wgpu::RenderPass<'_>,
        context: &RenderContext,
    ) {
        let shared = self.shared.borrow();
        let Some(group) = shared.clusters.group() else { return };
        let Some(object) = gpu_data.as_any().downcast_ref::<Object>() else { return };
        if context.phase != RenderPhase::Opaque {
            return;
        }
        for vectors in [mesh.coords(), mesh.normals()] {
            let Ok(mut vectors) = vectors.write() else { return };
            vectors.load_to_gpu();
        }
        let Ok(mut faces) = mesh.faces().write() else { return };
        faces.load_to_gpu();
        drop(faces);
        let buffers = (mesh.coords_buffer(), mesh.normals_buffer(), mesh.faces_buffer());
        let (Some(positions), Some(normals), Some(faces)) = buffers else { return };
        let pipeline = match shared.draws {
            Draws::Depth => &self.depth,
            Draws::ListedLights => &self.listed,
            Draws::AllLights => &self.all,
        };
        render_pass.set_pipeline(&pipeline.get(context.sample_count));
        render_pass.set_bind_group(0, group, &[]);
        render_pass.set_bind_group(1, &object.group, &[]);
        render_pass.set_vertex_buffer(0, positions.slice(..));
        render_pass.set_vertex_buffer(1, normals.slice(..));
        render_pass.set_index_buffer(faces.slice(..), VERTEX_INDEX_FORMAT);
        render_pass.draw_indexed(0..mesh.num_indices(), 0, 0..1);
    }
}
