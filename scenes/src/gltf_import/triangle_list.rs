//! Turns strips and fans of triangles into a list.

use gltf::json::mesh::Mode;

/// The indices of a triangle list. Indices of an incomplete triangle at the end are dropped.
pub(super) fn triangle_list(mode: Mode, mut indices: Vec<u32>) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .flat_map(|(ix, w)| {
                let odd = ix % 2;
                [w[0], w[1 + odd], w[2 - odd]]
            })
            .collect(),
        Mode::TriangleFan => {
            indices.windows(2).skip(1).flat_map(|w| [w[0], w[1], indices[0]]).collect()
        }
        _ => {
            indices.truncate(indices.len() / 3 * 3);
            indices
        }
    }
}
