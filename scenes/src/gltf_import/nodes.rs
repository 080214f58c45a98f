//! The node hierarchy: placed models, lights and cameras.

use std::f32::consts::PI;

use assign::{Light, Sun};
use glam::{Mat4, Quat, Vec3};
use gltf::json::{
    Index,
    camera::{Camera as JsonCamera, Type as CameraType},
    scene::Node,
    validation::Checked,
};

use super::{Warnings, area_lights, file::File, meshes::Meshes};
use crate::{Aabb, Camera, Instance, Lens, Model, Pose, SceneError};

/// The most triangles drawn, every node counting its mesh's. A small file can place one large
/// mesh often, and what follows takes time and memory by that number.
pub(super) const MAX_TRIANGLES: u64 = 200_000_000;

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
    /// Every node counts its mesh's; beyond [`MAX_TRIANGLES`], instances are no longer kept.
    triangles: u64,
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
}

/// Walks the default scene (or the first, or all nodes without a parent).
pub(super) fn load(
    file: &File,
    meshes: &Meshes,
    warnings: &mut Warnings,
) -> Result<Placed, SceneError> {
    let nodes = &file.root.nodes;
    let mut placed = Placed::default();
    let mut parents = vec![None; nodes.len()];
    let mut seen = vec![false; nodes.len()];
    let mut stack: Vec<_> = roots(file).into_iter().rev().map(|ix| (ix, Mat4::IDENTITY)).collect();
    while let Some((ix, parent_to_world)) = stack.pop() {
        if std::mem::replace(&mut seen[ix], true) {
            return Err(file.invalid(
                format!("nodes[{ix}]"),
                "reached twice",
                "in a tree: one parent each, no cycle",
            ));
        }
        let node = &nodes[ix];
        let to_world = parent_to_world * Local::of(node).matrix();
        if !to_world.is_finite() {
            return Err(file.invalid(format!("nodes[{ix}] transform"), "not finite", "finite"));
        }
        let name = node.name.clone().unwrap_or_else(|| format!("node {ix}"));
        if let Some(mesh) = node.mesh {
            placed.add_model(&name, mesh.value(), to_world, meshes, warnings);
        }
        placed.add_light(file, node, to_world, warnings)?;
        placed.lights.extend(area_lights::of_node(file, ix, node, to_world)?);
        if let Some(camera) = node.camera.and_then(|camera| file.root.get(camera)) {
            let chain = chain(&parents, ix);
            placed.add_camera(camera, &name, to_world, chain, warnings);
        }
        for child in node.children.iter().flatten().rev() {
            parents[child.value()] = Some(ix);
            stack.push((child.value(), to_world));
        }
    }
    if placed.triangles > MAX_TRIANGLES {
        return Err(file.invalid(
            "scene triangles (each node counts its mesh's)",
            placed.triangles,
            format!("at most {MAX_TRIANGLES}"),
        ));
    }
    Ok(placed)
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

fn chain(parents: &[Option<usize>], leaf: usize) -> Vec<usize> {
    let mut chain: Vec<_> = std::iter::successors(Some(leaf), |ix| parents[*ix]).collect();
    chain.reverse();
    chain
}

impl Placed {
    fn add_model(
        &mut self,
        name: &str,
        mesh: usize,
        object_to_world: Mat4,
        meshes: &Meshes,
        warnings: &mut Warnings,
    ) {
        let range = meshes.ranges[mesh].clone();
        if range.start == range.end {
            return;
        }
        if object_to_world.determinant() == 0.0 {
            warnings.add(format!("node {name:?}: scaled to no volume, not drawn"));
            return;
        }
        let parts = &meshes.meshes[range.start as usize..range.end as usize];
        let triangles = parts.iter().map(|mesh| mesh.triangle_count() as u64).sum();
        self.triangles = self.triangles.saturating_add(triangles);
        if self.triangles > MAX_TRIANGLES {
            return;
        }
        let bounds = parts.iter().fold(Aabb::EMPTY, |all, mesh| all.union(mesh.bounds));
        let model = self.models.len() as u32;
        self.models.push(Model { name: name.into(), bounds_object: bounds, object_to_world });
        self.instances.extend(range.map(|mesh| Instance { mesh, model }));
    }

    fn add_camera(
        &mut self,
        json: &JsonCamera,
        node_name: &str,
        to_world: Mat4,
        chain: Vec<usize>,
        warnings: &mut Warnings,
    ) {
        let name = json.name.clone().unwrap_or_else(|| node_name.into());
        let (lens, near_m, far_m) = match (json.type_, &json.perspective, &json.orthographic) {
            (Checked::Valid(CameraType::Perspective), Some(p), _) => {
                (Lens::Perspective { fov_y: p.yfov }, p.znear, p.zfar)
            }
            (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
                let lens =
                    Lens::Orthographic { half_width: o.xmag.abs(), half_height: o.ymag.abs() };
                (lens, o.znear, Some(o.zfar))
            }
            _ => {
                warnings.add(format!("camera {name:?} is left out: no projection"));
                return;
            }
        };
        let (lens_ok, least_near) = match lens {
            Lens::Perspective { fov_y } => (fov_y > 0.0 && fov_y < PI, f32::MIN_POSITIVE),
            Lens::Orthographic { half_width, half_height } => {
                (half_width > 0.0 && half_height > 0.0, 0.0)
            }
        };
        let far_ok = far_m.is_none_or(|far| far > near_m && far.is_finite());
        if !(lens_ok && near_m >= least_near && near_m.is_finite() && far_ok) {
            warnings.add(format!(
                "camera {name:?} is left out: field of view, near or far out of range"
            ));
            return;
        }
        self.camera_chains.push(chain);
        self.cameras.push(Camera { name, pose: pose(&to_world), lens, near_m, far_m });
    }
}

/// A glTF camera looks down its node's -Z; scale does not matter.
pub(super) fn pose(to_world: &Mat4) -> Pose {
    let eye = to_world.w_axis.truncate();
    let forward = (-to_world.z_axis.truncate()).normalize_or(Vec3::NEG_Z);
    let up = to_world.y_axis.truncate();
    let up = (up - forward * forward.dot(up)).normalize_or(forward.any_orthonormal_vector());
    Pose { eye, target: eye + forward, up }
}
