//! The node hierarchy: placed models, lights and cameras.

use assign::{Light, Sun};
use glam::{DMat4, DVec3, Mat4, Quat, Vec3, Vec4};
use gltf::json::{Index, scene::Node};

use super::{
    Warnings, area_lights, cameras,
    file::File,
    meshes::Meshes,
    models::{MAX_INSTANCES, MAX_TRIANGLES},
    skins::Skins,
    warnings::kept_name,
};
use crate::{Camera, Instance, Model, SceneError};

/// The most nodes between cameras and their roots, all cameras together: a deep tree can hold a
/// camera at every node. The animation of further cameras is not looked for.
const MAX_CHAIN_NODES: usize = 1 << 16;

/// What the nodes place.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) models: Vec<Model>,
    pub(super) instances: Vec<Instance>,
    /// Their ranges are infinite where the file gives none.
    pub(super) lights: Vec<Light>,
    pub(super) suns: Vec<Sun>,
    pub(super) cameras: Vec<Camera>,
    /// For each camera, the nodes from the root to the one that holds it.
    pub(super) camera_chains: Vec<Vec<usize>>,
    /// How many nodes these hold together.
    chain_nodes: usize,
    /// Every node counts its mesh's; beyond [`MAX_TRIANGLES`], instances are no longer kept.
    pub(super) triangles: u64,
}

/// A node of the scene that is drawn, and where.
pub(super) struct Visit {
    pub(super) ix: usize,
    pub(super) to_world: Mat4,
    /// Where the node is and which way it looks: scales of 0 are taken for 1, so that it turns directions
    /// where `to_world` loses them.
    placed: DMat4,
    /// Whether neither it nor a node above it is hidden (KHR_node_visibility).
    is_visible: bool,
}

/// The nodes of a scene, parents before their children.
pub(super) struct Walk {
    pub(super) visits: Vec<Visit>,
    /// The parent of every node that is reached.
    pub(super) parents: Vec<Option<usize>>,
}

/// A node's local transform, before any animation.
#[derive(Clone, Copy, Debug)]
pub(super) enum Local {
    Matrix(Mat4),
    Parts { translation: Vec3, rotation: Quat, scale: Vec3 },
}

impl Local {
    pub(super) fn of(node: &Node) -> Self {
        if let Some(matrix) = node.matrix {
            return Self::Matrix(Mat4::from_cols_array(&matrix));
        }
        let rotation = node.rotation.map_or(Quat::IDENTITY, |r| Quat::from_array(r.0));
        Self::Parts {
            translation: node.translation.map_or(Vec3::ZERO, Vec3::from),
            rotation: if rotation.length_squared() > 0.0 {
                rotation.normalize()
            } else {
                Quat::IDENTITY
            },
            scale: node.scale.map_or(Vec3::ONE, Vec3::from),
        }
    }

    pub(super) fn matrix(&self) -> Mat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// The matrix with axes of length 0 replaced, so that it still turns what looks along them.
    pub(super) fn facing(&self) -> Mat4 {
        match *self {
            Self::Matrix(matrix) => with_axes(matrix),
            Self::Parts { translation, rotation, scale } => {
                let scale = Vec3::select(scale.cmpeq(Vec3::ZERO), Vec3::ONE, scale);
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// A matrix whose axes of length 0 are replaced by ones across the others.
fn with_axes(matrix: Mat4) -> Mat4 {
    let mut axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec4::truncate);
    for ix in 0..3 {
        if axes[ix] != Vec3::ZERO {
            continue;
        }
        let (next, last) = (axes[(ix + 1) % 3], axes[(ix + 2) % 3]);
        let across = next.cross(last).try_normalize();
        let any = || {
            let other = if next == Vec3::ZERO { last } else { next };
            let unit = other.try_normalize().map(|axis| axis.any_orthonormal_vector());
            unit.unwrap_or(Vec3::AXES[ix])
        };
        axes[ix] = across.unwrap_or_else(any);
    }
    let [x, y, z] = axes.map(|axis| axis.extend(0.0));
    Mat4::from_cols(x, y, z, matrix.w_axis)
}

/// Walks the default scene (or the first, or all nodes without a parent). World space begins at
/// `origin` of the file: transforms are multiplied in f64, so that nothing is lost far away.
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
        let local = Local::of(node);
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

/// Places what the visited nodes hold.
pub(super) fn place(
    file: &File,
    walk: &Walk,
    meshes: &mut Meshes,
    warnings: &mut Warnings,
) -> Result<Placed, SceneError> {
    let mut placed = Placed::default();
    let mut skins = Skins::new(file, walk);
    for visit in &walk.visits {
        let node = &file.root.nodes[visit.ix];
        let name = node.name.as_deref().map_or_else(|| format!("node {}", visit.ix), kept_name);
        if visit.is_visible {
            placed.add_models(file, visit, &name, meshes, &mut skins, warnings)?;
            placed.add_lights(file, visit, warnings)?;
        }
        if let Some((index, camera)) =
            node.camera.and_then(|index| Some((index, file.root.get(index)?)))
        {
            let camera = cameras::placed(file, index.value(), camera, &name, &visit.placed)?;
            placed.cameras.push(camera);
            let chain = placed.chain_within_limits(&walk.parents, visit.ix, warnings);
            placed.camera_chains.push(chain);
        }
    }
    if placed.triangles > MAX_TRIANGLES {
        return Err(file.invalid(
            "scene triangles (each node counts its mesh's)",
            placed.triangles,
            format!("at most {MAX_TRIANGLES}"),
        ));
    }
    if placed.instances.len() > MAX_INSTANCES {
        let accepted = format!("at most {MAX_INSTANCES}");
        let field = "scene meshes (each node counts those of its own)";
        return Err(file.invalid(field, "too many", accepted));
    }
    Ok(placed)
}

/// The lights and suns of the visited nodes alone.
pub(super) fn lights(
    file: &File,
    walk: &Walk,
    warnings: &mut Warnings,
) -> Result<(Vec<Light>, Vec<Sun>), SceneError> {
    let mut placed = Placed::default();
    for visit in walk.visits.iter().filter(|visit| visit.is_visible) {
        placed.add_lights(file, visit, warnings)?;
    }
    Ok((placed.lights, placed.suns))
}

/// KHR_node_visibility: a hidden node hides all nodes below it.
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

impl Placed {
    /// The nodes from the root to a camera's; none beyond [`MAX_CHAIN_NODES`].
    fn chain_within_limits(
        &mut self,
        parents: &[Option<usize>],
        leaf: usize,
        warnings: &mut Warnings,
    ) -> Vec<usize> {
        let left = MAX_CHAIN_NODES - self.chain_nodes;
        let upwards = std::iter::successors(Some(leaf), |ix| parents[*ix]);
        let mut chain: Vec<_> = upwards.take(left + 1).collect();
        if chain.len() > left {
            self.chain_nodes = MAX_CHAIN_NODES;
            warnings.add("too many cameras in too deep a tree: not all animations are read".into());
            return Vec::new();
        }
        self.chain_nodes += chain.len();
        chain.reverse();
        chain
    }

    fn add_lights(
        &mut self,
        file: &File,
        visit: &Visit,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let node = &file.root.nodes[visit.ix];
        self.add_light(file, node, &visit.placed, warnings)?;
        let area = area_lights::of_node(file, visit.ix, node, visit.to_world, warnings)?;
        self.lights.extend(area);
        Ok(())
    }
}
