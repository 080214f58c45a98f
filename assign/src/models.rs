//! The boxes around a scene's models.

use glam::{Mat4, Vec3};

/// The oriented box around a model. Every sample of the model lies in it, up to the rounding of
/// depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelBox {
    /// Centre, world space, metres.
    pub center_world: Vec3,
    /// Orthonormal axes, world space.
    pub axes: [Vec3; 3],
    /// Half the size along each axis, metres, `>= 0`.
    pub half_extents_m: Vec3,
}

impl ModelBox {
    /// The oriented box around the transformed box from `min_object` to `max_object`. The transform
    /// may be any affine one: scaled, mirrored, sheared or flat.
    pub fn new(object_to_world: Mat4, min_object: Vec3, max_object: Vec3) -> Self {
        let half = 0.5 * (max_object - min_object);
        let edges = [0, 1, 2].map(|i| object_to_world.col(i).truncate() * half[i]);
        // Gram-Schmidt, longest edge first, because the box must follow that edge most closely.
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| edges[b].length_squared().total_cmp(&edges[a].length_squared()));
        let first = edges[order[0]].normalize_or(Vec3::X);
        let second = edges[order[1]].reject_from_normalized(first);
        let second = second.normalize_or(first.any_orthonormal_vector());
        let axes = [first, second, first.cross(second)];
        let extent = |axis: Vec3| edges.iter().map(|edge| edge.dot(axis).abs()).sum::<f32>();
        Self {
            center_world: object_to_world.transform_point3(0.5 * (min_object + max_object)),
            axes,
            half_extents_m: Vec3::from_array(axes.map(extent)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_and_scaled_box_is_fitted_exactly() {
        let turn = Mat4::from_rotation_y(0.7) * Mat4::from_scale(Vec3::new(-2.0, 1.0, 0.5));
        let model = ModelBox::new(turn, Vec3::ZERO, Vec3::splat(2.0));
        let mut sizes = model.half_extents_m.to_array();
        sizes.sort_by(f32::total_cmp);
        assert!(Vec3::from(sizes).abs_diff_eq(Vec3::new(0.5, 1.0, 2.0), 1e-6), "{model:?}");
    }

    #[test]
    fn boxes_contain_sheared_and_flat_models() {
        let mut shear = Mat4::from_rotation_x(0.3);
        shear.y_axis.x = 1.5;
        for transform in [shear, Mat4::from_scale(Vec3::new(1.0, 0.0, 3.0)), Mat4::ZERO] {
            let model = ModelBox::new(transform, Vec3::NEG_ONE, Vec3::new(1.0, 2.0, 3.0));
            for corner in 0..8 {
                let at = |bit: i32, low: f32, high: f32| if corner & bit == 0 { low } else { high };
                let corner = Vec3::new(at(1, -1.0, 1.0), at(2, -1.0, 2.0), at(4, -1.0, 3.0));
                let offset = transform.transform_point3(corner) - model.center_world;
                for (axis, half) in model.axes.iter().zip(model.half_extents_m.to_array()) {
                    assert!(
                        offset.dot(*axis).abs() <= half + 1e-5,
                        "corner {corner} lies outside its box: {transform}"
                    );
                }
            }
        }
    }
}
