//! The light hierarchy: boxes around consecutive lights.
//!
//! The hierarchy has two levels. Each lane of a workgroup tests one box; the workgroup then tests
//! only the lights below boxes that reach its group. A box holds the supports of [`NODE_LIGHTS`]
//! consecutive lights. So nodes need no pointers, lists still ascend, and one kernel over the light
//! buffer could build the nodes on the GPU for moving lights. The [`LightOrder`](crate::LightOrder)
//! decides how small the boxes are.
//!
//! Boxes hold the full range of every light, and the outlines of area lights. Two settings test
//! each light by another volume. `WhereDiffuse` tests only the diffuse range, so it tests some
//! lights in vain. `AreaBounds::Ball` tests balls around the outlines, which are larger than the
//! boxes' contents; it lists fewer lights through nodes than from the linear list.
//!
//! Worked example: 130 lights have three nodes, over lights 0 to 63, 64 to 127, and 128 to 129.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::{Light, intersect::LightVolume};

/// Lights below one node: `NODE_LIGHTS` of `cull.wesl`.
pub(crate) const NODE_LIGHTS: usize = 64;

/// A box around the supports of consecutive lights: `struct LightNode` of `lights.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LightNode {
    /// Lowest corner, world space, metres.
    pub min_world: [f32; 3],
    /// Pads to 16 bytes.
    pub padding: f32,
    /// Highest corner, world space, metres.
    pub max_world: [f32; 3],
    /// Pads to 32 bytes.
    pub padding_2: f32,
}

/// The nodes over lights in the order of their buffer.
pub(crate) fn nodes(lights: &[Light]) -> Vec<LightNode> {
    let boxes = lights.chunks(NODE_LIGHTS).filter_map(|chunk| {
        chunk.iter().map(light_box).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    });
    boxes
        .map(|(min, max)| LightNode {
            min_world: min.to_array(),
            max_world: max.to_array(),
            ..LightNode::default()
        })
        .collect()
}

/// A box around a light's support and its position, world space, metres.
pub(crate) fn light_box(light: &Light) -> (Vec3, Vec3) {
    let volume = LightVolume::from(light);
    let along = |axis: Vec3| volume.extent_along(axis);
    let low = Vec3::new(along(Vec3::NEG_X), along(Vec3::NEG_Y), along(Vec3::NEG_Z));
    let high = Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z));
    // Rounded outwards: each sum is accurate to half a unit in the last place.
    let down = |v: Vec3| Vec3::from_array(v.to_array().map(f32::next_down));
    let up = |v: Vec3| Vec3::from_array(v.to_array().map(f32::next_up));
    (down(light.position - low), up(light.position + high))
}
