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
        let mut found = Found::default();
        for (index, light) in all.iter().enumerate() {
            let fault = light.check().err();
            // Where indices stay, a dark light is in nobody's way.
            if let Some(fault) = fault.filter(|fault| !keeps_indices || *fault != LightFault::DARK)
            {
                rejected.push(RejectedLight { index, fault });
            }
            let is_kept = keeps_indices || fault.is_none();
            if is_kept {
                if !keeps_indices {
                    found.add(light);
                }
                lights.push(*light);
                indices.push(index as u32);
            }
        }
        if keeps_indices {
            darken(&mut lights);
            lights.iter().for_each(|light| found.add(light));
        }
        let is_empty = lights.is_empty();
        Self {
            kinds: found.kinds,
            bounds: (!is_empty).then_some(found.bounds),
            position_bounds: (!is_empty).then_some(found.position_bounds),
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

/// What the lights have in common, found in one pass over them.
struct Found {
    kinds: LightKinds,
    bounds: (Vec3, Vec3),
    position_bounds: (Vec3, Vec3),
}

impl Default for Found {
    /// No lights.
    fn default() -> Self {
        let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        Self { kinds: LightKinds::default(), bounds: none, position_bounds: none }
    }
}

impl Found {
    fn add(&mut self, light: &Light) {
        let around = |a: (Vec3, Vec3), low: Vec3, high: Vec3| (a.0.min(low), a.1.max(high));
        let (position, radius_m) = (light.position, light.radius_m());
        self.kinds = self.kinds.including(light);
        self.bounds = around(self.bounds, position - radius_m, position + radius_m);
        self.position_bounds = around(self.position_bounds, position, position);
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
        let records = lights.iter().map(|light| (light.sphere(), light.emission(&mut shapes)));
        let (spheres, emissions) = records.unzip();
        Self { spheres, emissions, shapes }
    }

    /// Spheres, emissions and shapes.
    pub(crate) fn bytes(&self) -> [&[u8]; 3] {
        [cast_slice(&self.spheres), cast_slice(&self.emissions), cast_slice(&self.shapes)]
    }
}
