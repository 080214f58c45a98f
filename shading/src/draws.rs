//! A draw of a scene: some triangles of consecutive instances of one mesh, and the properties that decide its pipeline.

use crate::materials::MaterialKey;

/// One indexed draw of consecutive instances of one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Draw {
    pub(crate) key: DrawKey,
    pub(crate) material: u32,
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    pub(crate) base_vertex: i32,
    pub(crate) first_instance: u32,
    pub(crate) instance_count: u32,
    /// Whether its material is transparent.
    pub(crate) is_transparent: bool,
}

/// The properties of a draw that decide its pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct DrawKey {
    pub(crate) material: MaterialKey,
    pub(crate) mirrored: bool,
}

impl Draw {
    /// Issues it.
    pub(crate) fn issue(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.draw_indexed(
            self.first_index..self.first_index + self.index_count,
            self.base_vertex,
            self.first_instance..self.first_instance + self.instance_count,
        );
    }
}
