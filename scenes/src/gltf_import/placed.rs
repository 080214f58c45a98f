//! What the nodes of a scene place, and how much of it there may be.

use assign::{Light, Sun};

use crate::{Camera, Instance, Model};

/// The most triangles drawn, every node counting its mesh's. A small file can place one large
/// mesh often, and what follows takes time and memory by that number.
pub(super) const MAX_TRIANGLES: u64 = 200_000_000;

/// The most meshes drawn, every node counting those of its own.
pub(super) const MAX_INSTANCES: usize = 1 << 23;

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
    pub(super) chain_nodes: usize,
    /// Every node counts its mesh's; beyond [`MAX_TRIANGLES`], instances are no longer kept.
    pub(super) triangles: u64,
}
