//! Meshes under construction, one for each surface of a thing.

use glam::Mat4;

use super::materials::Surface;
use crate::builder::Builder;

/// A thing under construction: one mesh for each of its surfaces.
#[derive(Clone, Default)]
pub(super) struct Parts(pub(super) Vec<(Surface, Builder)>);

impl Parts {
    /// The mesh of one surface.
    pub(super) fn mesh(&mut self, surface: Surface) -> &mut Builder {
        let ix = self.0.iter().position(|(known, _)| *known == surface).unwrap_or_else(|| {
            self.0.push((surface, Builder::default()));
            self.0.len() - 1
        });
        &mut self.0[ix].1
    }

    /// Adds a copy of another thing, moved and turned but not scaled.
    pub(super) fn append(&mut self, other: &Self, rigid: &Mat4) {
        for (surface, builder) in &other.0 {
            self.mesh(*surface).append(builder, rigid);
        }
    }

    /// Adds a copy of one mesh.
    pub(super) fn append_to(&mut self, surface: Surface, builder: &Builder, rigid: &Mat4) {
        self.mesh(surface).append(builder, rigid);
    }
}
