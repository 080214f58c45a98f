//! Places what the nodes hold: models, lights and cameras.

use super::{
    Warnings, area_lights, cameras,
    file::File,
    meshes::Meshes,
    placed::{MAX_INSTANCES, MAX_TRIANGLES, Placed},
    skins::Skins,
    walk::{Visit, Walk},
    warnings::kept_name,
};
use crate::SceneError;

/// The most nodes between cameras and their roots, for all cameras together. A deep tree can hold a
/// camera at every node. The animations of further cameras are not read.
const MAX_CHAIN_NODES: usize = 1 << 16;

/// Places the meshes, lights and cameras of the visited nodes.
pub(super) fn place(
    file: &File,
    walk: &Walk,
    meshes: &mut Meshes,
    warnings: &mut Warnings,
) -> Result<Placed, SceneError> {
    let mut placed = Placed::default();
    let mut skins = Skins::new(file, walk);
    for visit in &walk.visits {
        let node = &file.root.nodes[visit.ix];
        let name = node.name.as_deref().map_or_else(|| format!("node {}", visit.ix), kept_name);
        if visit.is_visible {
            placed.add_models(file, visit, &name, meshes, &mut skins, warnings)?;
            placed.add_lights(file, visit, warnings)?;
        }
        if let Some((index, camera)) =
            node.camera.and_then(|index| Some((index, file.root.get(index)?)))
        {
            let camera = cameras::placed(file, index.value(), camera, &name, &visit.placed)?;
            placed.cameras.push(camera);
            let chain = placed.chain_within_limits(&walk.parents, visit.ix, warnings);
            placed.camera_chains.push(chain);
        }
    }
    if placed.triangles > MAX_TRIANGLES {
        return Err(file.invalid(
            "scene triangles (each node counts its mesh's)",
            placed.triangles,
            format!("at most {MAX_TRIANGLES}"),
        ));
    }
    if placed.instances.len() > MAX_INSTANCES {
        let accepted = format!("at most {MAX_INSTANCES}");
        let field = "scene meshes (each node counts those of its own)";
        return Err(file.invalid(field, "too many", accepted));
    }
    Ok(placed)
}

/// Only the lights and suns of the visited nodes, and no models.
pub(super) fn lights(
    file: &File,
    walk: &Walk,
    warnings: &mut Warnings,
) -> Result<Placed, SceneError> {
    let mut placed = Placed::default();
    for visit in walk.visits.iter().filter(|visit| visit.is_visible) {
        placed.add_lights(file, visit, warnings)?;
    }
    Ok(placed)
}

impl Placed {
    /// The nodes from the root to a camera's node; empty after [`MAX_CHAIN_NODES`].
    fn chain_within_limits(
        &mut self,
        parents: &[Option<usize>],
        leaf: usize,
        warnings: &mut Warnings,
    ) -> Vec<usize> {
        let left = MAX_CHAIN_NODES - self.chain_nodes;
        let upwards = std::iter::successors(Some(leaf), |ix| parents[*ix]);
        let mut chain: Vec<_> = upwards.take(left + 1).collect();
        if chain.len() > left {
            self.chain_nodes = MAX_CHAIN_NODES;
            warnings.add(
                "too many nodes lie above cameras: the animations of further cameras are not read"
                    .into(),
            );
            return Vec::new();
        }
        self.chain_nodes += chain.len();
        chain.reverse();
        chain
    }

    fn add_lights(
        &mut self,
        file: &File,
        visit: &Visit,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let node = &file.root.nodes[visit.ix];
        let first = self.lights.len();
        self.add_light(file, node, &visit.placed, warnings)?;
        self.light_nodes.extend((first..self.lights.len()).map(|light| (visit.ix, light)));
        let area = area_lights::of_node(file, visit.ix, node, visit.to_world, warnings)?;
        self.lights.extend(area);
        Ok(())
    }
}
