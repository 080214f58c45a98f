//! The renderer's lights on the CPU: the sound ones in order, and the faulty ones.

use bytemuck::cast_slice;
use glam::Vec3;

use crate::{
    AssignError, Light, LightEmission, LightFault, LightKinds, LightShape, LightSphere, MIN_RANGE_M,
};

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
    /// The sound lights in the renderer's order. With `keeps_indices`, dark lights take the places of all others.
    pub(super) fn new(all: &[Light], keeps_indices: bool) -> Self {
        let mut lights = Vec::with_capacity(all.len());
        let mut indices = Vec::with_capacity(all.len());
        let mut rejected = Vec::new();
        for (index, light) in all.iter().enumerate() {
            let fault = light.check().err();
            // Where indices stay, a dark light is in nobody's way.
            if let Some(fault) = fault.filter(|fault| !keeps_indices || *fault != LightFault::DARK)
            {
                rejected.push(RejectedLight { index, fault });
            }
            let is_kept = keeps_indices || fault.is_none();
            if is_kept {
                lights.push(*light);
                indices.push(index as u32);
            }
        }
        if keeps_indices {
            darken(&mut lights);
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

/// Checks the number of lights.
pub(super) fn check_count(lights: usize) -> Result<(), AssignError> {
    if lights <= MAX_LIGHTS {
        return Ok(());
    }
    Err(AssignError::Parameter {
        field: "lights".into(),
        value: lights.to_string(),
        accepted: format!("at most {MAX_LIGHTS}"),
    })
}

/// Makes lights that are faulty or of intensity 0 into dark ones that reach nothing. They stand where the first sound
/// light stands, so that no box grows because of them.
fn darken(lights: &mut [Light]) {
    let is_sound = |light: &&Light| light.check().is_ok();
    let position = lights.iter().find(is_sound).map_or(Vec3::ZERO, |light| light.position);
    for light in lights.iter_mut().filter(|light| light.check().is_err()) {
        let shape = LightShape::Point;
        *light = Light { position, range_m: MIN_RANGE_M, intensity: Vec3::ZERO, shape };
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
