//! Vertices, indices and colours of all meshes of a scene, one after the other, as the GPU gets them.

use bytemuck::cast_slice;
use scenes::{Scene, Vertex};

/// The place of a mesh in the shared buffers.
#[derive(Clone, Copy)]
pub(crate) struct MeshRange {
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    pub(crate) base_vertex: i32,
}

/// Concatenates all meshes: their ranges, vertex bytes and index bytes.
pub(crate) fn concatenate(scene: &Scene) -> (Vec<MeshRange>, Vec<u8>, Vec<u8>) {
    let mut vertices: Vec<u8> = Vec::new();
    let mut indices: Vec<u8> = Vec::new();
    let ranges = scene
        .meshes
        .iter()
        .map(|mesh| {
            let range = MeshRange {
                first_index: (indices.len() / 4) as u32,
                index_count: mesh.indices.len() as u32,
                base_vertex: (vertices.len() / size_of::<Vertex>()) as i32,
            };
            vertices.extend_from_slice(cast_slice(&mesh.vertices));
            indices.extend_from_slice(cast_slice(&mesh.indices));
            range
        })
        .collect();
    (ranges, vertices, indices)
}

/// Concatenates the vertex colours of all meshes, white where a mesh has none. Empty if no mesh has
/// colours.
pub(crate) fn colors(scene: &Scene) -> Vec<[f32; 4]> {
    if scene.meshes.iter().all(|mesh| mesh.colors.is_empty()) {
        return Vec::new();
    }
    let of_mesh = |mesh: &scenes::Mesh| {
        let mut colors = mesh.colors.clone();
        colors.resize(mesh.vertices.len(), [1.0; 4]);
        colors
    };
    scene.meshes.iter().flat_map(of_mesh).collect()
}
