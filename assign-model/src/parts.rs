//! Cuts models into parts.

use assign::{AssignError, ModelBox};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// The most parts along one axis of a model's box. Larger models get larger parts.
const MAX_PARTS_PER_AXIS: f32 = 64.0;

/// The most parts. Their records take 128 MiB.
const MAX_PARTS: u64 = 1 << 24;

/// A model as shaders read it: `struct Model` of `models.wesl`. 80 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ModelRecord {
    /// Centre of the box, world space, metres.
    pub center_world: [f32; 3],
    /// Group of its first part.
    pub first_group: u32,
    /// Orthonormal axes of the box, world space.
    pub axis_x: [f32; 3],
    /// Parts along the first axis.
    pub parts_x: u32,
    /// Second axis.
    pub axis_y: [f32; 3],
    /// Parts along the second axis.
    pub parts_y: u32,
    /// Third axis.
    pub axis_z: [f32; 3],
    /// Parts along the third axis.
    pub parts_z: u32,
    /// Half the size of the box along its axes, metres, extended by `slack_m`.
    pub half_extents_m: [f32; 3],
    /// How much the box and its parts are extended on each side, metres.
    pub slack_m: f32,
}

/// The records of all models, and the model of each part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// One record per model.
    pub models: Vec<ModelRecord>,
    /// The model of each group.
    pub model_of_group: Vec<u32>,
}

/// A box is extended by this share of its distance from the origin. Sixteen units in the last place
/// bound how far rounding moves a sample in the box's frame.
const ROUNDING: f32 = 16.0 * f32::EPSILON;

/// A box is also extended by this share of its size, because a rasteriser's depth of a large
/// triangle is off by as much, and walls are models without thickness. Samples that depth moves
/// further are outside and read the list of all lights.
const DEPTH_ERROR: f32 = 1.0e-3;

impl Parts {
    /// Cuts boxes into parts of at most `limit_m` along each axis, or a 64th of the model if that
    /// is more. `None` leaves them whole.
    pub fn new(models: &[ModelBox], limit_m: Option<f32>) -> Result<Self, AssignError> {
        let mut parts = Self::default();
        for model in models {
            let extents = 2.0 * model.half_extents_m;
            let counts = match limit_m {
                Some(limit_m) => {
                    (extents / limit_m).ceil().clamp(Vec3::ONE, Vec3::splat(MAX_PARTS_PER_AXIS))
                }
                None => Vec3::ONE,
            };
            let counts = counts.to_array().map(|n| n as u32);
            let first_group = parts.model_of_group.len();
            let total = counts.iter().map(|&n| u64::from(n)).product::<u64>();
            if first_group as u64 + total > MAX_PARTS {
                return Err(AssignError::Parameter {
                    field: "size of a part".into(),
                    value: format!(
                        "{} m, which makes more than {MAX_PARTS} parts",
                        limit_m.unwrap_or(f32::INFINITY)
                    ),
                    accepted: format!("large enough for {MAX_PARTS} parts of all models together"),
                });
            }
            let magnitude =
                model.center_world.abs().max_element() + model.half_extents_m.max_element();
            let size = model.half_extents_m.max_element();
            let slack_m = ROUNDING * magnitude + DEPTH_ERROR * size;
            parts.model_of_group.resize(first_group + total as usize, parts.models.len() as u32);
            let [axis_x, axis_y, axis_z] = model.axes.map(|axis| axis.to_array());
            parts.models.push(ModelRecord {
                center_world: model.center_world.to_array(),
                first_group: first_group as u32,
                axis_x,
                parts_x: counts[0],
                axis_y,
                parts_y: counts[1],
                axis_z,
                parts_z: counts[2],
                half_extents_m: (model.half_extents_m + slack_m).to_array(),
                slack_m,
            });
        }
        Ok(parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(half_extents_m: Vec3) -> ModelBox {
        ModelBox { center_world: Vec3::ZERO, axes: [Vec3::X, Vec3::Y, Vec3::Z], half_extents_m }
    }

    #[test]
    fn a_limit_cuts_long_axes() {
        let models = [model(Vec3::new(5.0, 0.0, 1.0)), model(Vec3::splat(0.1))];
        let parts = Parts::new(&models, Some(2.0)).unwrap();
        let first = parts.models[0];
        assert_eq!([first.parts_x, first.parts_y, first.parts_z], [5, 1, 1]);
        assert_eq!(parts.model_of_group, [0, 0, 0, 0, 0, 1]);
        assert_eq!(parts.models[1].first_group, 5);
        assert_eq!(Parts::new(&models, None).unwrap().model_of_group, [0, 1]);
    }

    #[test]
    fn too_many_parts_are_refused() {
        let model = model(Vec3::splat(1e3));
        assert_eq!(Parts::new(&[model], Some(1e-3)).unwrap().model_of_group.len(), 64 * 64 * 64);
        let error = Parts::new(&[model; 65], Some(1e-3)).unwrap_err().to_string();
        assert!(error.contains("0.001 m"), "{error}");
    }
}
