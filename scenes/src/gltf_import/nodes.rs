//! The node hierarchy: placed models, lights and cameras.

use assign::{Light, LightShape};
use glam::{DMat4, DVec3, Mat4, Quat, Vec3};
use gltf::json::{
    Index,
    extensions::scene::khr_lights_punctual::{Light as JsonLight, Type as LightType},
    scene::Node,
    validation::Checked,
};

use super::{Warnings, area_lights, cameras, file::File, meshes::Meshes};
use crate::{Aabb, Camera, Instance, Model, SceneError, lights::THRESHOLD};

/// The most triangles drawn, every node counting its mesh's. A small file can place one large
/// mesh often, and what follows takes time and memory by that number.
pub(super) const MAX_TRIANGLES: u64 = 200_000_000;

/// What the nodes place.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) models: Vec<Model>,
    pub(super) instances: Vec<Instance>,
    pub(super) lights: Vec<Light>,
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

/// Walks the default scene (or the first, or all nodes without a parent). World space begins at
/// `origin` of the file: transforms are multiplied in f64, so that nothing is lost far away.
pub(super) fn load(
    file: &File,
    meshes: &Meshes,
    origin: DVec3,
    warnings: &mut Warnings,
) -> Result<Placed, SceneError> {
    let nodes = &file.root.nodes;
    let mut placed = Placed::default();
    let mut parents = vec![None; nodes.len()];
    let mut seen = vec![false; nodes.len()];
    let root = DMat4::from_translation(-origin);
    let mut stack: Vec<_> = roots(file).into_iter().rev().map(|ix| (ix, root)).collect();
    while let Some((ix, parent_to_world)) = stack.pop() {
        if std::mem::replace(&mut seen[ix], true) {
            return Err(file.invalid(
                format!("nodes[{ix}]"),
                "reached twice",
                "in a tree: one parent each, no cycle",
            ));
        }
        let node = &nodes[ix];
        let exact = parent_to_world * Local::of(node).matrix().as_dmat4();
        let to_world = exact.as_mat4();
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
            let camera_ix = node.camera.map_or(0, |camera| camera.value());
            placed.cameras.push(cameras::placed(file, camera_ix, camera, &name, &exact)?);
            placed.camera_chains.push(chain(&parents, ix));
        }
        for child in node.children.iter().flatten().rev() {
            parents[child.value()] = Some(ix);
            stack.push((child.value(), exact));
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

    fn add_light(
        &mut self,
        file: &File,
        node: &Node,
        to_world: Mat4,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let of_node = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let Some(reference) = of_node else {
            return Ok(());
        };
        let of_root = file.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let lights = of_root.map_or(&[][..], |e| &e.lights);
        let ix = reference.light.value();
        let json = lights.get(ix).ok_or_else(|| {
            file.invalid("KHR_lights_punctual.light", ix, format!("below {}", lights.len()))
        })?;
        let name = json.name.clone().unwrap_or_else(|| format!("light {ix}"));
        let Some(light) = convert_light(json, to_world) else {
            warnings.add(format!("light {name:?}: directional lights are left out"));
            return Ok(());
        };
        self.lights.push(light);
        Ok(())
    }
}

/// Intensity is candela times colour. A light without a range gets the one at which its
/// unoccluded illuminance falls to [`THRESHOLD`]. Faulty lights are converted too, to be reported
/// where lights are uploaded. `None` for directional lights.
fn convert_light(json: &JsonLight, to_world: Mat4) -> Option<Light> {
    let pose = cameras::pose(&to_world.as_dmat4());
    let intensity = Vec3::from(json.color) * json.intensity;
    let shines =
        intensity.is_finite() && intensity.min_element() >= 0.0 && intensity.max_element() > 0.0;
    // Of a faulty intensity follows no range: the fault to report is the intensity's.
    let unbounded = || if shines { Light::range_from_threshold(intensity, THRESHOLD) } else { 1.0 };
    let shape = match (&json.type_, &json.spot) {
        (Checked::Valid(LightType::Point), _) => LightShape::Point,
        (Checked::Valid(LightType::Spot), Some(spot)) => LightShape::Spot {
            direction: pose.forward(),
            inner_angle: spot.inner_cone_angle.min(spot.outer_cone_angle),
            outer_angle: spot.outer_cone_angle,
        },
        _ => return None,
    };
    Some(Light {
        position: pose.eye,
        range_m: json.range.unwrap_or_else(unbounded),
        intensity,
        shape,
    })
}
