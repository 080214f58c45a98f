//! Computes normals and tangents that a file leaves out.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{DVec3, Vec3, Vec4};

use crate::{Mesh, Vertex};

/// Gives every triangle its own vertices and flat normals. Returns the old index of each vertex.
pub(super) fn flatten(mesh: &mut Mesh) -> Vec<u32> {
    let corner = |ix: &u32| mesh.vertices[*ix as usize];
    let mut vertices: Vec<Vertex> = mesh.indices.iter().map(corner).collect();
    for triangle in vertices.chunks_exact_mut(3) {
        let normal = face_normal([0, 1, 2].map(|i| triangle[i].position)).to_array();
        for vertex in triangle {
            vertex.normal = normal;
        }
    }
    mesh.vertices = vertices;
    let indices = (0..mesh.vertices.len() as u32).collect();
    std::mem::replace(&mut mesh.indices, indices)
}

/// The unit normal of a triangle, or zero where it has no area. It is computed in f64, because the
/// areas of tiny triangles underflow in f32.
fn face_normal(corners: [[f32; 3]; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|p| Vec3::from(p).as_dvec3());
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}

/// Makes all normals unit vectors. Normals without a direction become the normal of their triangle,
/// or +Y. Returns the number of those.
pub(super) fn repair_normals(mesh: &mut Mesh) -> usize {
    let mut broken = vec![false; mesh.vertices.len()];
    let mut count = 0;
    for (vertex, broken) in mesh.vertices.iter_mut().zip(&mut broken) {
        let unit = Vec3::from(vertex.normal).as_dvec3().try_normalize();
        *broken = unit.is_none();
        count += usize::from(*broken);
        vertex.normal = unit.map_or(Vec3::Y, DVec3::as_vec3).to_array();
    }
    if count > 0 {
        for triangle in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|i| mesh.vertices[triangle[i] as usize].position);
            let normal = face_normal(corners);
            for ix in triangle.iter().map(|ix| *ix as usize) {
                if broken[ix] && normal != Vec3::ZERO {
                    mesh.vertices[ix].normal = normal.to_array();
                    broken[ix] = false;
                }
            }
        }
    }
    count
}

/// Makes all tangents unit vectors perpendicular to their normals, with a sign of 1 or -1. Tangents
/// without a direction become an arbitrary one.
pub(super) fn repair_tangents(mesh: &mut Mesh) {
    for vertex in &mut mesh.vertices {
        let normal = Vec3::from(vertex.normal);
        let given = Vec4::from(vertex.tangent);
        let direction = given.truncate();
        let along = direction - normal * normal.dot(direction);
        let unit = along
            .is_finite()
            .then(|| along.try_normalize())
            .flatten()
            .unwrap_or_else(|| normal.any_orthonormal_vector());
        let sign = if given.w < 0.0 { -1.0 } else { 1.0 };
        vertex.tangent = unit.extend(sign).to_array();
    }
}

/// Computes tangents by MikkTSpace and splits vertices whose corners disagree. Returns the old
/// index of each vertex.
pub(super) fn generate(mesh: &mut Mesh) -> Vec<u32> {
    let mut corners = Corners { tangents: vec![[0.0, 0.0, 0.0, 1.0]; mesh.indices.len()], mesh };
    // This fails only for meshes without a usable triangle. `repair_tangents` repairs their
    // tangents.
    let _ = generate_tangents(&mut corners);
    let tangents = corners.tangents;
    let mut split: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let mut vertices = Vec::with_capacity(mesh.vertices.len());
    let mut sources = Vec::with_capacity(mesh.vertices.len());
    for (index, tangent) in mesh.indices.iter_mut().zip(tangents) {
        let key = (*index, tangent.map(f32::to_bits));
        let (from, source) = (*index, mesh.vertices[*index as usize]);
        *index = *split.entry(key).or_insert_with(|| {
            vertices.push(Vertex { tangent, ..source });
            sources.push(from);
            vertices.len() as u32 - 1
        });
    }
    mesh.vertices = vertices;
    sources
}

/// A mesh as MikkTSpace reads it: by triangle and corner.
struct Corners<'a> {
    mesh: &'a Mesh,
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> &Vertex {
        &self.mesh.vertices[self.mesh.indices[face * 3 + corner] as usize]
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangle_count()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertex(face, corner).position
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertex(face, corner).normal
    }

    /// The v axis points up in MikkTSpace and down in glTF.
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.vertex(face, corner).uv;
        [u, 1.0 - v]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[face * 3 + corner] = space.unwrap_or_default().tangent_encoded();
    }
}
