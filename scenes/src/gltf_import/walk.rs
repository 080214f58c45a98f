//! Walks the node hierarchy: which nodes a scene has, and where each is.

use glam::{DMat4, DVec3, Mat4};
use gltf::json::{Index, scene::Node};

use super::file::File;
use crate::{SceneError, animated_node::Local};

/// A node of the scene, and where it is.
pub(super) struct Visit {
    pub(super) ix: usize,
    pub(super) to_world: Mat4,
    /// Place and direction of the node. Scales of 0 count as 1, so it keeps directions that
    /// `to_world` loses.
    pub(super) placed: DMat4,
    /// Whether neither it nor a node above it is hidden (KHR_node_visibility).
    pub(super) is_visible: bool,
}

/// The nodes of a scene. Parents come before their children.
pub(super) struct Walk {
    pub(super) visits: Vec<Visit>,
    /// The parent of every node that the walk reaches.
    pub(super) parents: Vec<Option<usize>>,
}

/// Walks the default scene, or the first one, or all nodes without a parent. World space begins at
/// `origin` of the file. Transforms are multiplied in f64, so that places far away keep their
/// digits.
pub(super) fn walk(file: &File, origin: DVec3) -> Result<Walk, SceneError> {
    let nodes = &file.root.nodes;
    let mut parents = vec![None; nodes.len()];
    let mut seen = vec![false; nodes.len()];
    let root = DMat4::from_translation(-origin);
    let mut stack: Vec<_> =
        roots(file).into_iter().rev().map(|ix| (ix, root, root, true)).collect();
    let mut visits = Vec::new();
    while let Some((ix, parent_to_world, parent_facing, shows)) = stack.pop() {
        if std::mem::replace(&mut seen[ix], true) {
            return Err(file.invalid(
                format!("nodes[{ix}]"),
                "reached twice",
                "in a tree: one parent each, no cycle",
            ));
        }
        let node = &nodes[ix];
        let local = Local::from_node(node);
        if let Some(row) = node.matrix.map(|m| [m[3], m[7], m[11], m[15]])
            && row != [0.0, 0.0, 0.0, 1.0]
        {
            let accepted = "0, 0, 0, 1: an affine transform";
            return Err(file.invalid(
                format!("nodes[{ix}].matrix last row"),
                format!("{row:?}"),
                accepted,
            ));
        }
        let exact = parent_to_world * local.matrix().as_dmat4();
        let to_world = exact.as_mat4();
        if !to_world.is_finite() {
            return Err(file.invalid(format!("nodes[{ix}] transform"), "not finite", "finite"));
        }
        let facing = parent_facing * local.facing().as_dmat4();
        let is_visible = shows && is_visible(node);
        for child in node.children.iter().flatten().rev() {
            parents[child.value()] = Some(ix);
            stack.push((child.value(), exact, facing, is_visible));
        }
        let placed = DMat4 { w_axis: exact.w_axis, ..facing };
        visits.push(Visit { ix, to_world, placed, is_visible });
    }
    Ok(Walk { visits, parents })
}

/// KHR_node_visibility: a hidden node also hides all nodes below it.
fn is_visible(node: &Node) -> bool {
    let extensions = node.extensions.as_ref().map(|e| &e.others);
    let visibility = extensions.and_then(|all| all.get("KHR_node_visibility"));
    visibility.and_then(|v| v.get("visible")?.as_bool()).unwrap_or(true)
}

fn roots(file: &File) -> Vec<usize> {
    let scenes = &file.root.scenes;
    let scene = file.root.scene.map_or(0, |scene| scene.value());
    if let Some(scene) = scenes.get(scene) {
        return scene.nodes.iter().map(Index::value).collect();
    }
    let mut is_child = vec![false; file.root.nodes.len()];
    for child in file.root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
        is_child[child.value()] = true;
    }
    (0..is_child.len()).filter(|ix| !is_child[*ix]).collect()
}
