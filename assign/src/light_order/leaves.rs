//! The order of the leaves of a bounding volume hierarchy, which the CPU builds over lights that stand still.

use std::time::Duration;

use obvhs::{BvhBuildParams, aabb::Aabb, bvh2::builder::build_bvh2};

use super::{morton, morton_codes};
use crate::{Light, light_nodes::light_box};

/// The most lights at one place for which a hierarchy is built. The search for pairs to merge is
/// quadratic in coincident boxes.
const MOST_COINCIDENT: usize = 20_000;

/// The lights' indices in the order of the leaves, depth first.
pub(super) fn in_order(lights: &[Light]) -> Vec<u32> {
    if lights.len() < 2 || most_coincident(lights) > MOST_COINCIDENT {
        return morton(lights);
    }
    let boxes: Vec<Aabb> = lights
        .iter()
        .map(|light| {
            let (min, max) = light_box(light);
            Aabb::new(min.into(), max.into())
        })
        .collect();
    if lights.len() > MOST_COINCIDENT {
        let order = morton(lights);
        if is_row(order.iter().map(|&light| boxes[light as usize]).collect()) {
            return order;
        }
    }
    let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
    let mut order = Vec::with_capacity(lights.len());
    let mut open = vec![0_u32];
    while let Some(node) = open.pop() {
        let Some(node) = bvh.nodes.get(node as usize) else { continue };
        if node.prim_count > 0 {
            let first = node.first_index as usize;
            order.extend(&bvh.primitive_indices[first..first + node.prim_count as usize]);
        } else {
            open.extend([node.first_index + 1, node.first_index]);
        }
    }
    // Falls back to Morton order if the hierarchy lost or repeated a light.
    let mut seen = vec![false; lights.len()];
    order.retain(|&light| {
        seen.get_mut(light as usize).is_some_and(|seen| !std::mem::replace(seen, true))
    });
    if order.len() == lights.len() { order } else { morton(lights) }
}

/// Whether most boxes are equally close to both neighbours, as in a row of equal lights. There too,
/// the search merges only one pair at a time. Pairs, groups of four and so on may form such a row
/// as well.
fn is_row(mut boxes: Vec<Aabb>) -> bool {
    while boxes.len() > MOST_COINCIDENT {
        let costs: Vec<f32> = boxes.windows(2).map(|w| w[0].union(&w[1]).half_area()).collect();
        let ties = costs.windows(2).filter(|w| w[0] == w[1]).count();
        if 2 * ties > boxes.len() {
            return true;
        }
        boxes = boxes.chunks_exact(2).map(|pair| pair[0].union(&pair[1])).collect();
    }
    false
}

/// The most lights that share one Morton code.
fn most_coincident(lights: &[Light]) -> usize {
    let mut codes = morton_codes(lights);
    codes.sort_unstable();
    codes.chunk_by(|a, b| a == b).map(<[u64]>::len).max().unwrap_or(0)
}
