//! The renderer's lights on the CPU: the sound ones in order, and the faulty ones.

use bytemuck::cast_slice;
use glam::Vec3;

use crate::{Light, LightEmission, LightFault, LightKinds, LightSphere};

/// A faulty light that was omitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RejectedLight {
    /// The light's index in the renderer's list.
    pub index: usize,
    /// What is wrong with it.
    pub fault: LightFault,
}

/// The most lights that a list entry's 30 bits can index.
pub const MAX_LIGHTS: usize = (1 << 30) - 1;

/// The sound lights of a renderer's list, and what was found on the way.
#[derive(Clone, Debug, Default)]
pub(super) struct Given {
    /// The sound lights, in order.
    pub(super) lights: Vec<Light>,
    /// The index in the renderer's list of each of them.
    pub(super) indices: Vec<u32>,
    pub(super) rejected: Vec<RejectedLight>,
    pub(super) kinds: LightKinds,
    /// Box around all supports.
    pub(super) bounds: Option<(Vec3, Vec3)>,
    /// Box around all positions.
    pub(super) position_bounds: Option<(Vec3, Vec3)>,
}

impl Given {
    /// The sound lights in the renderer's order.
    pub(super) fn new(all: &[Light]) -> Self {
        let mut lights = Vec::with_capacity(all.len());
        let mut indices = Vec::with_capacity(all.len());
        let mut rejected = Vec::new();
        for (index, light) in all.iter().enumerate() {
            match light.check() {
                Ok(()) => {
                    lights.push(*light);
                    indices.push(index as u32);
                }
                Err(fault) => rejected.push(RejectedLight { index, fault }),
            }
        }
        let around = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
        let support = |l: &Light| (l.position - l.radius_m(), l.position + l.radius_m());
        Self {
            kinds: LightKinds::among(&lights),
            bounds: lights.iter().map(support).reduce(around),
            position_bounds: lights.iter().map(|l| (l.position, l.position)).reduce(around),
            lights,
            indices,
            rejected,
        }
    }

    /// Puts the lights in an order, a permutation of their places.
    pub(super) fn reorder(&mut self, order: &[u32]) {
        self.lights = order.iter().map(|&ix| self.lights[ix as usize]).collect();
        self.indices = order.iter().map(|&ix| self.indices[ix as usize]).collect();
    }
}

/// The records of lights, as the GPU reads them.
#[derive(Debug, Default)]
pub(crate) struct Records {
    pub(crate) spheres: Vec<LightSphere>,
    pub(crate) emissions: Vec<LightEmission>,
    pub(crate) shapes: Vec<[f32; 4]>,
}

impl Records {
    pub(crate) fn new(lights: &[Light]) -> Self {
        let mut shapes = Vec::new();
        Self {
            spheres: lights.iter().map(Light::sphere).collect(),
            emissions: lights.iter().map(|light| light.emission(&mut shapes)).collect(),
            shapes,
        }
    }

    /// Spheres, emissions and shapes.
    pub(crate) fn bytes(&self) -> [&[u8]; 3] {
        [cast_slice(&self.spheres), cast_slice(&self.emissions), cast_slice(&self.shapes)]
    }
}
