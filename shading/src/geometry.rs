//! Uploads a scene's triangles and draws them in a fixed order.

use assign::{AssignError, Gpu, entry, storage_entry};
use bytemuck::{Pod, Zeroable, cast_slice};
use glam::{Mat3, Vec3};
use scenes::{Instance, Model, Scene};
use wgpu::util::DeviceExt;

use crate::{
    ShadingError,
    draws::{Draw, DrawKey},
    lighting_inputs::{Bound, LightingInputs},
    materials::{MaterialKey, Materials},
    mesh_buffers::{MeshRange, colors, concatenate},
    pieces::{Piece, seen_draws},
};

/// `scene.wesl`, `struct Instance`. 112 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct InstanceRecord {
    /// Object to world.
    pub object_to_world: [[f32; 4]; 4],
    /// First column of the inverse transpose.
    pub normal_x: [f32; 3],
    /// Index of the model.
    pub model_ix: u32,
    /// Second column.
    pub normal_y: [f32; 3],
    /// Index of the material.
    pub material_ix: u32,
    /// Third column.
    pub normal_z: [f32; 3],
    /// -1 where the transform mirrors.
    pub handedness: f32,
}

/// A transparent surface: one instance of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    pub(crate) draw: Draw,
    /// The centre of the box around it, world space.
    pub(crate) center_world: Vec3,
}

/// A scene's geometry and materials on the GPU: bind group 2. Clones share them.
#[derive(Clone, Debug)]
pub struct SceneGpu {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// Colours of all vertices, if any mesh has colours.
    colors: Option<wgpu::Buffer>,
    pub(crate) draws: Vec<Draw>,
    /// Parts of all draws, in their order.
    pub(crate) pieces: Vec<Piece>,
    /// Its transparent surfaces.
    pub(crate) sheets: Vec<Sheet>,
    pub(crate) materials: Materials,
    /// Layouts of bind group 2, one for each of [`Bound::ALL`].
    layouts: [wgpu::BindGroupLayout; Bound::ALL.len()],
    pub(crate) instances: wgpu::Buffer,
}

impl SceneGpu {
    /// Uploads a scene.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, ShadingError> {
        let materials = Materials::new(gpu, scene)?;
        let (ranges, vertex_bytes, index_bytes) = concatenate(scene);
        let Planned { records, draws, pieces, sheets } = plan(scene, &materials, &ranges);
        let buffer = |label: &str, bytes: &[u8], usage| {
            check_size(gpu, label, bytes.len() as u64, usage)?;
            let descriptor =
                wgpu::util::BufferInitDescriptor { label: Some(label), contents: bytes, usage };
            gpu.allocate(label, bytes.len() as u64, || gpu.device.create_buffer_init(&descriptor))
        };
        let vertices = buffer("vertices", &vertex_bytes, wgpu::BufferUsages::VERTEX)?;
        let indices = buffer("indices", &index_bytes, wgpu::BufferUsages::INDEX)?;
        let colors = colors(scene);
        let colors = (!colors.is_empty())
            .then(|| buffer("vertex colours", cast_slice(&colors), wgpu::BufferUsages::VERTEX))
            .transpose()?;
        let instances = buffer("instances", cast_slice(&records), wgpu::BufferUsages::STORAGE)?;
        let layout = |bound| {
            let stages = wgpu::ShaderStages::FRAGMENT;
            let geometry = [
                storage_entry(0, wgpu::ShaderStages::VERTEX, true),
                storage_entry(1, stages, true),
            ];
            let entries: Vec<_> =
                geometry.into_iter().chain(LightingInputs::layout(bound, stages)).collect();
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("scene"),
                entries: &entries,
            })
        };
        let layouts = Bound::ALL.map(layout);
        Ok(Self { vertices, indices, colors, draws, pieces, sheets, materials, layouts, instances })
    }

    /// Layout of bind group 2.
    pub(crate) fn layout(&self, bound: Bound) -> &wgpu::BindGroupLayout {
        &self.layouts[bound.index()]
    }

    /// Bind group 2, together with the inputs of lighting.
    pub(crate) fn bind_group(&self, gpu: &Gpu, inputs: &LightingInputs) -> wgpu::BindGroup {
        let geometry = [entry(0, &self.instances), entry(1, &self.materials.factors)];
        let entries: Vec<_> = geometry.into_iter().chain(inputs.entries()).collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout: self.layout(inputs.bound()),
            entries: &entries,
        })
    }

    /// Whether any material emits.
    pub fn has_emissive(&self) -> bool {
        self.materials.has_emissive
    }

    /// Whether any material has a reflectance other than that of glTF's default dielectric.
    pub(crate) fn has_dielectrics(&self) -> bool {
        self.materials.has_dielectrics
    }

    /// Whether any material has an alpha mask.
    pub fn has_mask(&self) -> bool {
        self.draws.iter().any(|draw| draw.key.material.mask)
    }

    /// The keys of all pipelines that its draws need.
    pub(crate) fn keys(&self) -> Vec<DrawKey> {
        unique(self.draws.iter())
    }

    /// The keys of all pipelines that its transparent surfaces need.
    pub(crate) fn sheet_keys(&self) -> Vec<DrawKey> {
        unique(self.draws.iter().filter(|draw| draw.is_transparent))
    }

    /// Binds the buffers of vertices and indices.
    fn bind_vertices(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        if let Some(colors) = &self.colors {
            pass.set_vertex_buffer(1, colors.slice(..));
        }
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Draws a transparent surface, with the textures of its material.
    pub(crate) fn draw_sheet(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        Sheet { draw, .. }: &Sheet,
        pipeline: &wgpu::RenderPipeline,
    ) {
        self.bind_vertices(pass);
        pass.set_pipeline(pipeline);
        if let Some(group) = self.materials.bind_group(draw.material) {
            pass.set_bind_group(3, group, &[]);
        }
        draw.issue(pass);
    }

    /// Issues all draws, or only those of opaque surfaces, sorted by pipeline. `pipeline` looks up a pipeline.
    pub(crate) fn draw<'a>(
        &'a self,
        pass: &mut wgpu::RenderPass<'_>,
        textures: bool,
        only_opaque: bool,
        pipeline: impl Fn(DrawKey) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        let draws = self.draws.iter().filter(|draw| !(only_opaque && draw.is_transparent));
        self.draw_each(pass, textures, draws.copied(), pipeline);
    }

    /// Draws all pieces that may be seen, or only those of opaque surfaces, sorted by pipeline. `pipeline` looks up a
    /// pipeline.
    pub(crate) fn draw_pieces<'a>(
        &'a self,
        pass: &mut wgpu::RenderPass<'_>,
        (textures, only_opaque): (bool, bool),
        may_see: impl Fn([Vec3; 2]) -> bool,
        pipeline: impl Fn(DrawKey) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        let seen = seen_draws(&self.draws, &self.pieces, may_see);
        let draws = seen.into_iter().filter(|draw| !(only_opaque && draw.is_transparent));
        self.draw_each(pass, textures, draws, pipeline);
    }

    /// Issues draws in their order.
    fn draw_each<'a>(
        &'a self,
        pass: &mut wgpu::RenderPass<'_>,
        textures: bool,
        draws: impl IntoIterator<Item = Draw>,
        pipeline: impl Fn(DrawKey) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        self.bind_vertices(pass);
        let mut bound = (None, None);
        for draw in draws {
            let Some(pipeline) = pipeline(draw.key) else {
                continue;
            };
            if bound.0 != Some(draw.key) {
                pass.set_pipeline(pipeline);
            }
            if textures
                && bound != (Some(draw.key), Some(draw.material))
                && let Some(group) = self.materials.bind_group(draw.material)
            {
                pass.set_bind_group(3, group, &[]);
            }
            bound = (Some(draw.key), Some(draw.material));
            draw.issue(pass);
        }
    }
}

fn unique<'a>(draws: impl Iterator<Item = &'a Draw>) -> Vec<DrawKey> {
    let mut keys: Vec<DrawKey> = draws.map(|draw| draw.key).collect();
    keys.sort_unstable();
    keys.dedup();
    keys
}

fn check_size(
    gpu: &Gpu,
    what: &str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<(), AssignError> {
    let limit = if usage.contains(wgpu::BufferUsages::STORAGE) {
        gpu.max_storage_bytes()
    } else {
        gpu.device.limits().max_buffer_size
    };
    if bytes > limit {
        return Err(AssignError::TooLarge { what: what.into(), bytes, limit });
    }
    Ok(())
}

/// Instances sorted by pipeline, material and mesh; one draw for each run of one mesh; the parts of draws; and the
/// transparent surfaces.
#[derive(Default)]
struct Planned {
    records: Vec<InstanceRecord>,
    draws: Vec<Draw>,
    pieces: Vec<Piece>,
    sheets: Vec<Sheet>,
}

fn plan(scene: &Scene, materials: &Materials, ranges: &[MeshRange]) -> Planned {
    let mut order: Vec<(DrawKey, u32, &Instance)> = scene
        .instances
        .iter()
        .map(|instance| {
            let mesh = &scene.meshes[instance.mesh as usize];
            let material = mesh.material;
            let vertex_colors = !mesh.colors.is_empty();
            let key = DrawKey {
                material: MaterialKey { vertex_colors, ..materials.key(material) },
                mirrored: scene.models[instance.model as usize].is_mirrored(),
            };
            (key, material, instance)
        })
        .collect();
    order.sort_by_key(|(key, material, instance)| (*key, *material, instance.mesh));
    let records = order
        .iter()
        .map(|(_, material, instance)| {
            record(&scene.models[instance.model as usize], instance.model, *material)
        })
        .collect();
    let Planned { mut draws, mut pieces, mut sheets, .. } = Planned::default();
    let mut first = 0;
    for run in order.chunk_by(|a, b| a.0 == b.0 && a.1 == b.1 && a.2.mesh == b.2.mesh) {
        let (key, material, instance) = run[0];
        let range = ranges[instance.mesh as usize];
        let draw = Draw {
            key,
            material,
            first_index: range.first_index,
            index_count: range.index_count,
            base_vertex: range.base_vertex,
            first_instance: first,
            instance_count: run.len() as u32,
            is_transparent: scene.materials[material as usize].is_transparent(),
        };
        for (first_instance, (.., instance)) in (first..).zip(run) {
            let placed = scene.models[instance.model as usize].object_to_world;
            let mesh = &scene.meshes[instance.mesh as usize];
            let draw_ix = draws.len() as u32;
            pieces.extend(Piece::of_instance(
                draw_ix,
                mesh,
                range.first_index,
                first_instance,
                placed,
            ));
        }
        draws.push(draw);
        if draw.is_transparent {
            let bounds = scene.meshes[instance.mesh as usize].bounds;
            sheets.extend((first..).zip(run).map(|(first_instance, (.., instance))| {
                let placed = scene.models[instance.model as usize].object_to_world;
                Sheet {
                    draw: Draw { first_instance, instance_count: 1, ..draw },
                    center_world: placed.transform_point3(bounds.center()),
                }
            }));
        }
        first += run.len() as u32;
    }
    Planned { records, draws, pieces, sheets }
}

pub(crate) fn record(model: &Model, model_ix: u32, material_ix: u32) -> InstanceRecord {
    let linear = Mat3::from_mat4(model.object_to_world);
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    // The cofactor matrix is the inverse transpose times the determinant. It also exists for a
    // transform that flattens. Its longest column is scaled to 1, so that tiny models stay in the
    // range of f32.
    let cofactors = [y.cross(z), z.cross(x), x.cross(y)];
    let longest = cofactors.iter().map(|c| c.length()).fold(f32::MIN_POSITIVE, f32::max);
    let handedness = if model.is_mirrored() { -1.0 } else { 1.0 };
    let [normal_x, normal_y, normal_z] = cofactors.map(|c| (c * (handedness / longest)).to_array());
    InstanceRecord {
        object_to_world: model.object_to_world.to_cols_array_2d(),
        normal_x,
        model_ix,
        normal_y,
        material_ix,
        normal_z,
        handedness,
    }
}
