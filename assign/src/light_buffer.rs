//! Lights on the GPU, faulty ones quarantined.

use bytemuck::cast_slice;
use glam::Vec3;

use crate::{AssignError, Gpu, Light, LightEmission, LightFault, LightKind, LightSphere};

/// A light that was left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RejectedLight {
    /// Its index in the renderer's list.
    pub index: usize,
    /// What is wrong with it.
    pub fault: LightFault,
}

/// The lights of a frame on the GPU: spheres for culling, emissions and shapes for shading.
///
/// Lights keep their order; faulty ones are left out, so a light's index here is its place among
/// the accepted.
#[derive(Debug)]
pub struct LightBuffer {
    lights: Vec<Light>,
    rejected: Vec<RejectedLight>,
    has_spots: bool,
    bounds: Option<(Vec3, Vec3)>,
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
}

/// The most lights that an entry's 30 bits can name.
pub const MAX_LIGHTS: usize = (1 << 30) - 1;

impl LightBuffer {
    /// Uploads `lights`, leaving out those that [`Light::check`] faults.
    pub fn new(gpu: &Gpu, lights: &[Light]) -> Result<Self, AssignError> {
        let mut buffer = Self {
            lights: Vec::new(),
            rejected: Vec::new(),
            has_spots: false,
            bounds: None,
            spheres: gpu.storage("light spheres", 0)?,
            emissions: gpu.storage("light emissions", 0)?,
            shapes: gpu.storage("light shapes", 0)?,
        };
        buffer.update(gpu, lights)?;
        Ok(buffer)
    }

    /// Replaces the lights. The buffers grow as needed, so bind groups that hold them must be
    /// made anew: [`FrameBindings`](crate::FrameBindings) does.
    pub fn update(&mut self, gpu: &Gpu, lights: &[Light]) -> Result<(), AssignError> {
        if lights.len() > MAX_LIGHTS {
            return Err(AssignError::Parameter {
                field: "lights".into(),
                value: lights.len().to_string(),
                accepted: format!("at most {MAX_LIGHTS}"),
            });
        }
        let mut accepted = Vec::with_capacity(lights.len());
        let mut rejected = Vec::new();
        for (index, light) in lights.iter().enumerate() {
            match light.check() {
                Ok(()) => accepted.push(*light),
                Err(fault) => rejected.push(RejectedLight { index, fault }),
            }
        }
        let spheres: Vec<LightSphere> = accepted.iter().map(Light::sphere).collect();
        let mut shapes = Vec::new();
        let emissions: Vec<LightEmission> =
            accepted.iter().map(|l| l.emission(&mut shapes)).collect();
        // All buffers before any field: after an error the old lights are whole.
        let [sphere_bytes, emission_bytes, shape_bytes] =
            [cast_slice(&spheres), cast_slice(&emissions), cast_slice(&shapes)];
        let larger = [
            fitting(gpu, &self.spheres, "light spheres", sphere_bytes)?,
            fitting(gpu, &self.emissions, "light emissions", emission_bytes)?,
            fitting(gpu, &self.shapes, "light shapes", shape_bytes)?,
        ];
        [self.spheres, self.emissions, self.shapes] = larger;
        gpu.queue.write_buffer(&self.spheres, 0, sphere_bytes);
        gpu.queue.write_buffer(&self.emissions, 0, emission_bytes);
        gpu.queue.write_buffer(&self.shapes, 0, shape_bytes);
        self.has_spots = accepted.iter().any(|l| l.kind() == LightKind::Spot);
        self.bounds = accepted
            .iter()
            .map(|l| (l.position - l.range_m, l.position + l.range_m))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        self.lights = accepted;
        self.rejected = rejected;
        Ok(())
    }

    /// Number of lights that were accepted.
    pub fn count(&self) -> u32 {
        self.lights.len() as u32
    }

    /// The accepted lights, in the order of their indices.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The lights that were left out.
    pub fn rejected(&self) -> &[RejectedLight] {
        &self.rejected
    }

    /// Whether any light is a spot: shaders are compiled for what there is.
    pub fn has_spots(&self) -> bool {
        self.has_spots
    }

    /// World-space box around all supports, metres; `None` without lights.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
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
}

/// The buffer where `bytes` fit, else a larger one.
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
