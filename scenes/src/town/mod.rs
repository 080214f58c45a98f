//! An old town on a slope: blocks of gabled houses around yards, paved streets, gardens, a square
//! with a church and a market, and a meadow around it all.
//!
//! Some seventy things are made, each with one mesh per surface. Thousands of models place them, so
//! about a hundred times as many triangles are drawn as are stored. X runs east and z south. The
//! ground rises northwards and is level at the square.

mod church;
mod furniture;
mod house;
mod kit;
mod land;
mod materials;
mod paving;
mod place;
mod plants;
mod roof;
#[cfg(test)]
mod tests;
mod textures;
mod tour;
mod window;

use glam::Mat4;
use kit::Parts;
use land::Land;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::{Aabb, Instance, Mesh, Model, Scene, extent};

/// The size of a town.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TownSize {
    /// 7 by 7 blocks in full detail: 280 m across, some 7 million triangles drawn.
    Full,
    /// 2 by 2 blocks in coarse detail, some 60 thousand triangles, for tests and software
    /// adapters.
    Small,
}

impl TownSize {
    /// Blocks along each side.
    fn blocks(self) -> u32 {
        match self {
            Self::Full => 7,
            Self::Small => 2,
        }
    }
}

/// A procedural town. `seed` decides the shape and place of each house, and every leaf.
pub fn town(seed: u64, size: TownSize) -> Scene {
    let land = Land::new(size.blocks());
    let mut town = Town {
        rng: Pcg64Mcg::seed_from_u64(seed),
        fine: size == TownSize::Full,
        meshes: Vec::new(),
        models: Vec::new(),
        instances: Vec::new(),
    };
    let texture_seed = town.rng.random::<u32>() >> 8;
    town.build(&land);
    let mut scene = Scene {
        name: match size {
            TownSize::Full => "town".into(),
            TownSize::Small => "town-small".into(),
        },
        meshes: town.meshes,
        materials: materials::make(),
        images: textures::make(texture_seed),
        instances: town.instances,
        models: town.models,
        lights: Vec::new(),
        open_lights: Vec::new(),
        light_animation: None,
        suns: Vec::new(),
        cameras: Vec::new(),
        view_camera: 0,
        origin: glam::DVec3::ZERO,
        path: tour::path(&land),
        bounds: Aabb::EMPTY,
        core_bounds: Aabb::EMPTY,
        warnings: Vec::new(),
    };
    scene.bounds = extent::bounds(&scene);
    scene.core_bounds = scene.bounds;
    scene
}

/// A town under construction.
struct Town {
    rng: Pcg64Mcg,
    fine: bool,
    meshes: Vec<Mesh>,
    models: Vec<Model>,
    instances: Vec<Instance>,
}

/// A thing that can be placed any number of times.
#[derive(Clone)]
struct Thing {
    name: &'static str,
    meshes: Vec<u32>,
}

impl Town {
    /// Stores a thing's meshes.
    fn thing(&mut self, name: &'static str, parts: Parts) -> Thing {
        let first = self.meshes.len() as u32;
        let meshes = parts.0.into_iter().map(|(surface, b)| b.mesh(name, surface as u32));
        self.meshes.extend(meshes);
        Thing { name, meshes: (first..self.meshes.len() as u32).collect() }
    }

    /// Places a thing.
    fn place(&mut self, thing: &Thing, object_to_world: Mat4) {
        let model = self.models.len() as u32;
        let parts = thing.meshes.iter().map(|ix| self.meshes[*ix as usize].bounds);
        let bounds_object = parts.fold(Aabb::EMPTY, Aabb::union);
        self.models.push(Model { name: thing.name.into(), bounds_object, object_to_world });
        self.instances.extend(thing.meshes.iter().map(|mesh| Instance { mesh: *mesh, model }));
    }

    /// Places one of `things`, chosen at random.
    fn place_any(&mut self, things: &[Thing], object_to_world: Mat4) {
        let ix = self.rng.random_range(0..things.len());
        self.place(&things[ix], object_to_world);
    }
}
