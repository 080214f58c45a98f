//! Places meshes as models: once per node, by EXT_mesh_gpu_instancing, or by the joints of a skin.

use glam::{DMat3, Mat4, Quat, Vec3, Vec4};
use gltf::json::{Index, accessor::Accessor, scene::Node};

use super::{
    Warnings,
    file::File,
    meshes::Meshes,
    placed::{MAX_INSTANCES, MAX_TRIANGLES, Placed},
    skins::Skins,
    walk::Visit,
};
use crate::{Aabb, Instance, Model, SceneError};

/// The most models that EXT_mesh_gpu_instancing may make. A few bytes of a file can ask for many.
const MAX_MODELS: usize = 1 << 22;

/// The extension that draws a node's mesh many times.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

impl Placed {
    /// Draws a node's mesh, if it has one.
    pub(super) fn add_models(
        &mut self,
        file: &File,
        visit: &Visit,
        name: &str,
        meshes: &mut Meshes,
        skins: &mut Skins<'_>,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let node = &file.root.nodes[visit.ix];
        let Some(mesh) = node.mesh else {
            return Ok(());
        };
        let range = meshes.ranges[mesh.value()].clone();
        if range.is_empty() {
            return Ok(());
        }
        if let Some(skin) = node.skin
            && let Some(range) =
                skins.pose(skin.value(), &visit.to_world, range.clone(), meshes, warnings)?
        {
            if instances(file, visit.ix, node)?.is_some() {
                warnings.add(format!(
                    "node {name:?}: {INSTANCING} is ignored because the mesh is skinned"
                ));
            }
            // The joints place a skinned mesh, not the node that holds it.
            self.add_model(name, range, Mat4::IDENTITY, meshes, warnings);
            return Ok(());
        }
        let Some(transforms) = instances(file, visit.ix, node)? else {
            self.add_model(name, range, visit.to_world, meshes, warnings);
            return Ok(());
        };
        if self.models.len() + transforms.len() > MAX_MODELS {
            let field = format!("nodes[{}].extensions.{INSTANCING} instances", visit.ix);
            let accepted = format!("at most {MAX_MODELS} models in all");
            return Err(file.invalid(field, transforms.len(), accepted));
        }
        for (ix, transform) in transforms.into_iter().enumerate() {
            let to_world = visit.to_world * transform;
            if !to_world.is_finite() {
                let field = format!("nodes[{}].extensions.{INSTANCING} instance {ix}", visit.ix);
                return Err(file.invalid(field, "not finite", "finite"));
            }
            self.add_model(&format!("{name} #{ix}"), range.clone(), to_world, meshes, warnings);
        }
        Ok(())
    }

    fn add_model(
        &mut self,
        name: &str,
        range: std::ops::Range<u32>,
        object_to_world: Mat4,
        meshes: &Meshes,
        warnings: &mut Warnings,
    ) {
        if is_line(&object_to_world) {
            warnings.add(format!("node {name:?} is scaled to a line or a point and is not drawn"));
            return;
        }
        let parts = &meshes.meshes[range.start as usize..range.end as usize];
        let triangles = parts.iter().map(|mesh| mesh.triangle_count() as u64).sum();
        self.triangles = self.triangles.saturating_add(triangles);
        if self.triangles > MAX_TRIANGLES || self.instances.len() > MAX_INSTANCES {
            return;
        }
        let bounds = parts.iter().fold(Aabb::EMPTY, |all, mesh| all.union(mesh.bounds));
        let model = self.models.len() as u32;
        self.models.push(Model { name: name.into(), bounds_object: bounds, object_to_world });
        self.instances.extend(range.map(|mesh| Instance { mesh, model }));
    }
}

/// Whether a transform leaves every triangle without area. A transform that only flattens does not.
fn is_line(transform: &Mat4) -> bool {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_mat4(transform.as_dmat4());
    [x.cross(y), y.cross(z), z.cross(x)].iter().all(|c| *c == glam::DVec3::ZERO)
}

/// The transforms that EXT_mesh_gpu_instancing gives a node's mesh.
fn instances(file: &File, ix: usize, node: &Node) -> Result<Option<Vec<Mat4>>, SceneError> {
    let extensions = node.extensions.as_ref().map(|e| &e.others);
    let Some(extension) = extensions.and_then(|all| all.get(INSTANCING)) else {
        return Ok(None);
    };
    let field = |name: &str| format!("nodes[{ix}].extensions.{INSTANCING}.attributes.{name}");
    let attribute = |name: &str| -> Result<Option<Index<Accessor>>, SceneError> {
        let Some(value) = extension.get("attributes").and_then(|all| all.get(name)) else {
            return Ok(None);
        };
        let accessors = file.root.accessors.len();
        let index = value.as_u64().filter(|index| *index < accessors as u64);
        let index = index.and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
            file.invalid(field(name), value, format!("the index of an accessor, below {accessors}"))
        })?;
        Ok(Some(Index::new(index)))
    };
    let translations = attribute("TRANSLATION")?.map(|a| file.floats::<3>(a)).transpose()?;
    let rotations = attribute("ROTATION")?.map(|a| file.floats::<4>(a)).transpose()?;
    let scales = attribute("SCALE")?.map(|a| file.floats::<3>(a)).transpose()?;
    let counts = [
        ("TRANSLATION", translations.as_ref().map(Vec::len)),
        ("ROTATION", rotations.as_ref().map(Vec::len)),
        ("SCALE", scales.as_ref().map(Vec::len)),
    ];
    let mut counts = counts.into_iter().filter_map(|(name, count)| Some((name, count?)));
    // An application's own attributes do not move instances, so one instance stands for all.
    let (_, count) = counts.next().unwrap_or(("", 1));
    if let Some((name, other)) = counts.find(|(_, other)| *other != count) {
        let accepted = format!("{count}, the count of the attribute before it");
        return Err(file.invalid(format!("{} count", field(name)), other, accepted));
    }
    let transform = |ix: usize| {
        let translation = translations.as_ref().map_or(Vec3::ZERO, |all| all[ix].into());
        let rotation = rotations.as_ref().map_or(Vec4::W, |all| all[ix].into());
        let scale = scales.as_ref().map_or(Vec3::ONE, |all| all[ix].into());
        let rotation = Quat::from_vec4(rotation.try_normalize().unwrap_or(Vec4::W));
        Mat4::from_scale_rotation_translation(scale, rotation, translation)
    };
    Ok(Some((0..count).map(transform).collect()))
}
