//! The light hierarchy: boxes around consecutive lights.
//!
//! Level 1 has a box around every [`NODE_LIGHTS`] consecutive lights, level 2 a box around every 64 of
//! those, and level 3 a box around every 64 of these. Few lights have fewer levels ([`NodeLevels`]).
//! Each lane of a workgroup tests one box of the highest level; the workgroup then tests only the
//! boxes below those that reach its group, and at last only the lights below boxes that do. Nodes
//! need no pointers, lists still ascend, and one kernel makes each level on the GPU for lights that
//! move. The [`LightOrder`](crate::LightOrder) decides how small the boxes are.
//!
//! Boxes hold the full range of every light, and the outlines of area lights. Two settings test
//! each light by another volume. `WhereDiffuse` tests only the diffuse range, so it tests some
//! lights in vain. `AreaBounds::Ball` tests balls around the outlines, which are larger than the
//! boxes' contents; it lists fewer lights through nodes than from the linear list.
//!
//! Worked example: 130 lights have three nodes, over lights 0 to 63, 64 to 127, and 128 to 129. Room
//! for 300,000 lights has 4,688 nodes from place 0 on, 74 parents from place 4,688 on, and 2
//! grandparents from place 4,762 on.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::{Light, LightShape, intersect::LightVolume};

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

/// Lights from which on there is a second level. Below, a workgroup tests the nodes in a few rounds.
const PARENTS_FROM: u32 = 16_384;

/// Lights from which on there is a third level.
const GRANDPARENTS_FROM: u32 = 262_144;

/// Where each level of the hierarchy begins in the array of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NodeLevels {
    /// Number of levels, 1 to 3.
    pub(crate) levels: u32,
    /// Nodes of level 1, which begin at place 0.
    pub(crate) nodes: u32,
    /// Place of the first node of level 2.
    pub(crate) first_parent: u32,
    /// Place of the first node of level 3.
    pub(crate) first_grandparent: u32,
    /// Nodes of all levels.
    pub(crate) total: u32,
}

impl NodeLevels {
    /// The levels over at most `lights` lights.
    pub(crate) fn over(lights: u32) -> Self {
        let children = NODE_LIGHTS as u32;
        let levels = 1 + u32::from(lights > PARENTS_FROM) + u32::from(lights > GRANDPARENTS_FROM);
        let nodes = lights.div_ceil(children);
        let parents = if levels > 1 { nodes.div_ceil(children) } else { 0 };
        let grandparents = if levels > 2 { parents.div_ceil(children) } else { 0 };
        Self {
            levels,
            nodes,
            first_parent: nodes,
            first_grandparent: nodes + parents,
            total: nodes + parents + grandparents,
        }
    }
}

/// The nodes of all levels over lights in the order of their buffer.
pub(crate) fn nodes(lights: &[Light]) -> Vec<LightNode> {
    let boxes = |boxes: &mut dyn Iterator<Item = (Vec3, Vec3)>| {
        boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).map(|(min, max)| LightNode {
            min_world: min.to_array(),
            max_world: max.to_array(),
            ..LightNode::default()
        })
    };
    let corners = |node: &LightNode| (node.min_world.into(), node.max_world.into());
    let levels = NodeLevels::over(lights.len() as u32);
    let mut all: Vec<LightNode> = lights
        .chunks(NODE_LIGHTS)
        .filter_map(|chunk| boxes(&mut chunk.iter().map(light_box)))
        .collect();
    let mut first = 0;
    for _ in 1..levels.levels {
        let above: Vec<LightNode> = all[first..]
            .chunks(NODE_LIGHTS)
            .filter_map(|chunk| boxes(&mut chunk.iter().map(corners)))
            .collect();
        first = all.len();
        all.extend(above);
    }
    all
}

/// A box around a light's support and its position, world space, metres.
pub(crate) fn light_box(light: &Light) -> (Vec3, Vec3) {
    let [low, high] = extents(light);
    // Rounded outwards: each sum is accurate to half a unit in the last place.
    let down = |v: Vec3| Vec3::from_array(v.to_array().map(f32::next_down));
    let up = |v: Vec3| Vec3::from_array(v.to_array().map(f32::next_up));
    (down(light.position - low), up(light.position + high))
}

/// How far a light's support extends from its position against and along the axes, metres.
fn extents(light: &Light) -> [Vec3; 2] {
    // The volume gives the same for a ball, but takes six square roots.
    if light.shape == LightShape::Point {
        return [Vec3::splat(light.range_m); 2];
    }
    volume_extents(&LightVolume::from(light))
}

/// How far any volume extends from its position against and along the axes, metres.
fn volume_extents(volume: &LightVolume) -> [Vec3; 2] {
    let along = |axis: Vec3| volume.extent_along(axis);
    [
        Vec3::new(along(Vec3::NEG_X), along(Vec3::NEG_Y), along(Vec3::NEG_Z)),
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MAX_RANGE_M, MIN_RANGE_M};

    #[test]
    fn points_extend_as_their_volumes_do() {
        for range_m in [MIN_RANGE_M, 0.1, 1.0 / 3.0, 7.3, 1e4, MAX_RANGE_M] {
            let light = Light::point(Vec3::new(0.3, -7.1, 1e3), range_m, Vec3::ONE);
            assert_eq!(extents(&light), volume_extents(&LightVolume::from(&light)), "{range_m}");
        }
    }

    #[test]
    fn levels_follow_one_another() {
        for lights in [0, 1, 64, 65, 16_384, 16_385, 262_144, 262_145, 1_048_577] {
            let at = |ix: u32| Light::point(Vec3::new(ix as f32, 0.0, 0.0), 0.5, Vec3::ONE);
            let lights: Vec<Light> = (0..lights).map(at).collect();
            let all = nodes(&lights);
            let levels = NodeLevels::over(lights.len() as u32);
            assert_eq!(all.len(), levels.total as usize, "{levels:?}");
            let x =
                |place: u32| [all[place as usize].min_world[0], all[place as usize].max_world[0]];
            if levels.levels > 1 {
                assert_eq!(x(levels.first_parent + 1)[0], x(64)[0], "{levels:?}");
                assert_eq!(x(levels.first_parent)[1], x(63)[1], "{levels:?}");
            }
            if levels.levels > 2 {
                assert_eq!(x(levels.first_grandparent)[1], x(64 * 64 - 1)[1], "{levels:?}");
            }
        }
    }
}
