//! What the nodes of a scene place, and its limits.

use assign::{Light, Sun};

use crate::{Camera, Instance, Model};

/// The most triangles drawn; every node counts the triangles of its mesh. A small file can place
/// one large mesh often, and later steps take time and memory per placed triangle.
pub(super) const MAX_TRIANGLES: u64 = 200_000_000;

/// The most meshes drawn; every node counts its own.
pub(super) const MAX_INSTANCES: usize = 1 << 23;

/// The models, lights and cameras of the nodes.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) models: Vec<Model>,
    pub(super) instances: Vec<Instance>,
    /// The range of a light is infinite where the file gives none.
    pub(super) lights: Vec<Light>,
    /// The node and the index of each light of KHR_lights_punctual among `lights`.
    pub(super) light_nodes: Vec<(usize, usize)>,
    pub(super) suns: Vec<Sun>,
    pub(super) cameras: Vec<Camera>,
    /// For each camera, the nodes from the root to the one that holds it.
    pub(super) camera_chains: Vec<Vec<usize>>,
    /// The total number of these nodes.
    pub(super) chain_nodes: usize,
    /// Every node counts the triangles of its mesh. Beyond [`MAX_TRIANGLES`], instances are no
    /// longer kept.
    pub(super) triangles: u64,
}
