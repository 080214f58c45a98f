//! Lights on the GPU: the sound lights in order, the hierarchy over them, and the faulty lights
//! that were omitted.

use std::time::{Duration, Instant};

use bytemuck::cast_slice;
use glam::Vec3;

use crate::{
    AssignError, Gpu, Light, LightEmission, LightFault, LightKinds, LightOrder, LightSphere,
    light_nodes::{LightNode, nodes},
};

/// A faulty light that was omitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RejectedLight {
    /// The light's index in the renderer's list.
    pub index: usize,
    /// What is wrong with it.
    pub fault: LightFault,
}

/// A frame's lights on the GPU: spheres and the hierarchy for culling, emissions and shapes for
/// shading.
///
/// The buffer omits faulty lights and sorts the others by its [`LightOrder`]. A light's index is
/// its place in that order; [`given_index`](Self::given_index) converts it to an index in the
/// renderer's list.
#[derive(Debug)]
pub struct LightBuffer {
    order: LightOrder,
    lights: Vec<Light>,
    given: Vec<u32>,
    rejected: Vec<RejectedLight>,
    kinds: LightKinds,
    bounds: Option<(Vec3, Vec3)>,
    position_bounds: Option<(Vec3, Vec3)>,
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
    nodes: wgpu::Buffer,
    build_time: Duration,
}

/// The most lights that a list entry's 30 bits can index.
pub const MAX_LIGHTS: usize = (1 << 30) - 1;

impl LightBuffer {
    /// Uploads `lights` in the order of the slice. Omits the lights that [`Light::check`] rejects.
    pub fn new(gpu: &Gpu, lights: &[Light]) -> Result<Self, AssignError> {
        Self::ordered(gpu, lights, LightOrder::Given)
    }

    /// Uploads `lights` sorted by `order`. Omits the lights that [`Light::check`] rejects.
    pub fn ordered(gpu: &Gpu, lights: &[Light], order: LightOrder) -> Result<Self, AssignError> {
        let mut buffer = Self {
            order,
            lights: Vec::new(),
            given: Vec::new(),
            rejected: Vec::new(),
            kinds: LightKinds::default(),
            bounds: None,
            position_bounds: None,
            spheres: gpu.storage("light spheres", 0)?,
            emissions: gpu.storage("light emissions", 0)?,
            shapes: gpu.storage("light shapes", 0)?,
            nodes: gpu.storage("light nodes", size_of::<LightNode>() as u64)?,
            build_time: Duration::ZERO,
        };
        buffer.update(gpu, lights)?;
        Ok(buffer)
    }

    /// Replaces the lights. Buffers grow as needed, so bind groups that hold them must be made
    /// again, as [`FrameBindings`](crate::FrameBindings) does.
    pub fn update(&mut self, gpu: &Gpu, lights: &[Light]) -> Result<(), AssignError> {
        if lights.len() > MAX_LIGHTS {
            return Err(AssignError::Parameter {
                field: "lights".into(),
                value: lights.len().to_string(),
                accepted: format!("at most {MAX_LIGHTS}"),
            });
        }
        let mut sound = Vec::with_capacity(lights.len());
        let mut indices = Vec::with_capacity(lights.len());
        let mut rejected = Vec::new();
        for (index, light) in lights.iter().enumerate() {
            match light.check() {
                Ok(()) => {
                    sound.push(*light);
                    indices.push(index as u32);
                }
                Err(fault) => rejected.push(RejectedLight { index, fault }),
            }
        }
        let began = Instant::now();
        let order = self.order.indices(&sound);
        let accepted: Vec<Light> = order.iter().map(|&ix| sound[ix as usize]).collect();
        let given: Vec<u32> = order.iter().map(|&ix| indices[ix as usize]).collect();
        let nodes = nodes(&accepted);
        let build_time = began.elapsed();
        let spheres: Vec<LightSphere> = accepted.iter().map(Light::sphere).collect();
        let mut shapes = Vec::new();
        let emissions: Vec<LightEmission> =
            accepted.iter().map(|l| l.emission(&mut shapes)).collect();
        // Makes all buffers before it changes any field, so that the old lights stay whole after an
        // error.
        let [sphere_bytes, emission_bytes, shape_bytes, node_bytes] =
            [cast_slice(&spheres), cast_slice(&emissions), cast_slice(&shapes), cast_slice(&nodes)];
        let larger = [
            fitting(gpu, &self.spheres, "light spheres", sphere_bytes)?,
            fitting(gpu, &self.emissions, "light emissions", emission_bytes)?,
            fitting(gpu, &self.shapes, "light shapes", shape_bytes)?,
            fitting(gpu, &self.nodes, "light nodes", node_bytes)?,
        ];
        [self.spheres, self.emissions, self.shapes, self.nodes] = larger;
        gpu.queue.write_buffer(&self.spheres, 0, sphere_bytes);
        gpu.queue.write_buffer(&self.emissions, 0, emission_bytes);
        gpu.queue.write_buffer(&self.shapes, 0, shape_bytes);
        gpu.queue.write_buffer(&self.nodes, 0, node_bytes);
        self.kinds = LightKinds::among(&accepted);
        let around = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
        self.bounds = accepted
            .iter()
            .map(|l| (l.position - l.radius_m(), l.position + l.radius_m()))
            .reduce(around);
        self.position_bounds = accepted.iter().map(|l| (l.position, l.position)).reduce(around);
        self.lights = accepted;
        self.given = given;
        self.build_time = build_time;
        self.rejected = rejected;
        Ok(())
    }

    /// Number of lights that were accepted.
    pub fn count(&self) -> u32 {
        self.lights.len() as u32
    }

    /// The accepted lights by index.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The index in the renderer's list of a light of this buffer; `None` if there is no such
    /// light.
    pub fn given_index(&self, light: u32) -> Option<u32> {
        self.given.get(light as usize).copied()
    }

    /// The order of the lights.
    pub fn order(&self) -> LightOrder {
        self.order
    }

    /// How long the CPU took to sort the lights and to build the hierarchy over them.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// The faulty lights that were omitted.
    pub fn rejected(&self) -> &[RejectedLight] {
        &self.rejected
    }

    /// The kinds of the accepted lights. Shaders are compiled for them.
    pub fn kinds(&self) -> LightKinds {
        self.kinds
    }

    /// World-space box around all supports, metres; `None` without lights.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// World-space box around all positions, metres, without the ranges; `None` without lights.
    pub fn position_bounds(&self) -> Option<(Vec3, Vec3)> {
        self.position_bounds
    }

    /// The spheres: `array<LightSphere>`.
    pub fn spheres(&self) -> &wgpu::Buffer {
        &self.spheres
    }

    /// The emissions: `array<LightEmission>`.
    pub fn emissions(&self) -> &wgpu::Buffer {
        &self.emissions
    }

    /// The shapes: `array<vec4f>`.
    pub fn shapes(&self) -> &wgpu::Buffer {
        &self.shapes
    }

    /// The hierarchy: `array<LightNode>`, one box per 64 lights.
    pub fn nodes(&self) -> &wgpu::Buffer {
        &self.nodes
    }
}

/// The buffer if `bytes` fit into it, else a larger one.
fn fitting(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    label: &str,
    bytes: &[u8],
) -> Result<wgpu::Buffer, AssignError> {
    if bytes.len() as u64 > buffer.size() {
        gpu.storage(label, bytes.len() as u64)
    } else {
        Ok(buffer.clone())
    }
}
