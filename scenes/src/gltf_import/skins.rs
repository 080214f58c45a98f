//! Poses skinned meshes by their joints, at the place where the nodes rest.
//!
//! The weighted sum of the matrices of its joints, `joint_to_world * inverse_bind`, moves each
//! vertex. The node that holds the mesh moves nothing (glTF 2.0, section 3.7.3.3).

use std::{collections::HashMap, ops::Range, rc::Rc};

use glam::{Mat3, Mat4, Vec3, Vec4};

use super::{Warnings, file::File, influence::Influence, meshes::Meshes, walk::Walk};
use crate::{Aabb, Mesh, SceneError, Vertex};

/// The most vertices and indices of all posed copies together. Many nodes can share one large mesh.
const MAX_ELEMENTS: usize = 1 << 26;

/// The skins of a file, and the places of their joints.
pub(super) struct Skins<'a> {
    file: &'a File,
    /// The place of each node of the scene.
    to_world: Vec<Option<Mat4>>,
    /// For each skin used so far, the matrix by which each joint moves a vertex.
    matrices: HashMap<usize, Option<Rc<[Mat4]>>>,
    /// Vertices and indices of the copies made so far.
    elements: usize,
}

impl<'a> Skins<'a> {
    pub(super) fn new(file: &'a File, walk: &Walk) -> Self {
        let mut to_world = vec![None; file.root.nodes.len()];
        for visit in &walk.visits {
            to_world[visit.ix] = Some(visit.to_world);
        }
        Self { file, to_world, matrices: HashMap::new(), elements: 0 }
    }

    /// Adds posed copies of meshes and returns their range. Returns `None` where one of the meshes
    /// has no joints, or where a joint stands outside the scene; the node then places them. The
    /// node's transform only decides whether triangles turn round: they do where it mirrors.
    pub(super) fn pose(
        &mut self,
        skin: usize,
        node_to_world: &Mat4,
        range: Range<u32>,
        meshes: &mut Meshes,
        warnings: &mut Warnings,
    ) -> Result<Option<Range<u32>>, SceneError> {
        let Some(matrices) = self.matrices(skin)? else {
            warnings.add(format!(
                "skin {skin}: joints lie outside the scene, so its meshes are drawn without a pose"
            ));
            return Ok(None);
        };
        let parts = range.start as usize..range.end as usize;
        if parts.clone().any(|ix| !meshes.influences.contains_key(&ix)) {
            warnings.add(format!("skin {skin}: meshes without JOINTS_0 are drawn without a pose"));
            return Ok(None);
        }
        let first = meshes.meshes.len() as u32;
        for ix in parts {
            self.elements += meshes.meshes[ix].vertices.len() + meshes.meshes[ix].indices.len();
            if self.elements > MAX_ELEMENTS {
                let field = "vertices and indices of skinned meshes (each node counts its own)";
                let accepted = format!("at most {MAX_ELEMENTS}");
                return Err(self.file.invalid(field, self.elements, accepted));
            }
            let influences = &meshes.influences[&ix];
            let posed = pose(&meshes.meshes[ix], influences, &matrices);
            let mut posed = posed.ok_or_else(|| {
                let accepted = format!("below {}, its number of joints", matrices.len());
                self.file.invalid(format!("skins[{skin}] JOINTS_0"), "out of range", accepted)
            })?;
            if node_to_world.determinant() < 0.0 {
                posed.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
            }
            if !posed.bounds.size().is_finite() {
                let field = format!("skins[{skin}] posed vertices");
                return Err(self.file.invalid(field, "not finite", "finite"));
            }
            meshes.meshes.push(posed);
        }
        Ok(Some(first..meshes.meshes.len() as u32))
    }

    /// The matrix by which each joint moves a vertex; `None` where a joint is not in the scene.
    /// Read once per skin.
    fn matrices(&mut self, skin: usize) -> Result<Option<Rc<[Mat4]>>, SceneError> {
        if let Some(known) = self.matrices.get(&skin) {
            return Ok(known.clone());
        }
        let read = self.read_matrices(skin)?.map(Rc::from);
        self.matrices.insert(skin, read.clone());
        Ok(read)
    }

    fn read_matrices(&self, skin: usize) -> Result<Option<Vec<Mat4>>, SceneError> {
        let skins = &self.file.root.skins;
        let json = skins.get(skin).ok_or_else(|| {
            self.file.invalid("nodes' skin", skin, format!("below {}", skins.len()))
        })?;
        let inverse_bind = match json.inverse_bind_matrices {
            Some(accessor) => self.file.floats::<16>(accessor)?,
            None => vec![Mat4::IDENTITY.to_cols_array(); json.joints.len()],
        };
        if inverse_bind.len() < json.joints.len() {
            let field = format!("skins[{skin}].inverseBindMatrices count");
            let accepted = format!("at least {}, the number of joints", json.joints.len());
            return Err(self.file.invalid(field, inverse_bind.len(), accepted));
        }
        let joints = json.joints.iter().zip(&inverse_bind);
        let matrix = |(joint, inverse_bind): (&gltf::json::Index<_>, _)| {
            let to_world = (*self.to_world.get(joint.value())?)?;
            Some(to_world * Mat4::from_cols_array(inverse_bind))
        };
        Ok(joints.map(matrix).collect())
    }
}

/// A mesh posed by its joints, in world space; `None` where the index of a joint is out of range.
fn pose(mesh: &Mesh, influences: &[Influence], matrices: &[Mat4]) -> Option<Mesh> {
    let mut posed = mesh.clone();
    for (vertex, influence) in posed.vertices.iter_mut().zip(influences) {
        let mut blend = Mat4::ZERO;
        for (joint, weight) in influence.joints.into_iter().zip(influence.weights) {
            if weight != 0.0 {
                blend += *matrices.get(joint as usize)? * weight;
            }
        }
        *vertex = moved(vertex, &blend);
    }
    posed.bounds = Aabb::from_points(posed.vertices.iter().map(|v| Vec3::from(v.position)));
    Some(posed)
}

/// A transformed vertex. Normals are transformed by the cofactors, which stay finite where the
/// transform flattens.
fn moved(vertex: &Vertex, transform: &Mat4) -> Vertex {
    let linear = Mat3::from_mat4(*transform);
    let Mat3 { x_axis: x, y_axis: y, z_axis: z } = linear;
    let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let old_normal = Vec3::from(vertex.normal);
    let mirrored = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    let normal = (cofactors * old_normal * mirrored).normalize_or(old_normal);
    let tangent = Vec4::from(vertex.tangent);
    let along = linear * tangent.truncate();
    let along = (along - normal * normal.dot(along))
        .try_normalize()
        .unwrap_or_else(|| normal.any_orthonormal_vector());
    Vertex {
        position: transform.transform_point3(vertex.position.into()).to_array(),
        normal: normal.to_array(),
        tangent: along.extend(tangent.w * mirrored).to_array(),
        uv: vertex.uv,
    }
}
