//! The default scene: two storeys of arcades around a rectangular court under an open sky.
//!
//! The outer walls enclose 30 by 20 metres. The court within measures 22 by 12 metres, and 24
//! columns line it on each storey. Everything is made of profiles, surfaces and boxes; repeated
//! parts are instances of one mesh. X runs along the court, and the floor is y = 0.

mod materials;
mod parts;
mod path;
#[cfg(test)]
mod tests;
mod textures;

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Mat4, Vec2, Vec3};
use materials::Surface;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::{
    Aabb, Instance, Mesh, Model, Scene,
    builder::{Builder, arc, sharp},
    extent,
};

/// Half the size of the court, and half the size inside the outer walls, along x and z, metres.
const COURT: Vec2 = Vec2::new(11.0, 6.0);
const OUTER: Vec2 = Vec2::new(15.0, 10.0);

/// Number of bays along the long and short sides, and their widths, metres.
const BAYS: [u32; 2] = [8, 4];
const BAY_M: [f32; 2] = [2.75, 3.0];

/// Floor, height of the columns, and underside of the ceiling above, for both storeys, metres.
const STOREYS: [[f32; 3]; 2] = [[0.0, 3.5, 5.7], [6.1, 2.7, 4.9]];

/// Upper edge of the roof, metres.
const ROOF_M: f32 = 11.3;

/// The procedural default scene. `seed` decides the folds and colours of the cloths, the vases, and
/// the veins of the stones.
pub fn atrium(seed: u64) -> Scene {
    let mut hall = Hall {
        rng: Pcg64Mcg::seed_from_u64(seed),
        meshes: Vec::new(),
        models: Vec::new(),
        instances: Vec::new(),
    };
    // Leave room for the offsets that separate the noises.
    let texture_seed = hall.rng.random::<u32>() >> 8;
    hall.shell();
    hall.floors();
    for storey in 0..2 {
        hall.arcade(storey);
        hall.ceiling(storey);
        hall.cornice(storey);
    }
    hall.furniture();
    hall.cloths();
    let mut scene = Scene {
        name: "atrium".into(),
        meshes: hall.meshes,
        materials: materials::make(),
        images: textures::make(texture_seed),
        instances: hall.instances,
        models: hall.models,
        lights: Vec::new(),
        open_lights: Vec::new(),
        light_animation: None,
        suns: Vec::new(),
        cameras: Vec::new(),
        view_camera: 0,
        origin: glam::DVec3::ZERO,
        path: path::path(),
        bounds: Aabb::EMPTY,
        core_bounds: Aabb::EMPTY,
        warnings: Vec::new(),
    };
    scene.bounds = extent::bounds(&scene);
    scene.core_bounds = scene.bounds;
    scene
}

struct Hall {
    rng: Pcg64Mcg,
    meshes: Vec<Mesh>,
    models: Vec<Model>,
    instances: Vec<Instance>,
}

/// One side of the court: the kind of its bays, and its place.
struct Side {
    kind: usize,
    to_world: Mat4,
    /// From the middle of the court to this side, metres.
    reach: f32,
}

/// The four sides. In a side's own space, x runs along it, z points into the court, and its columns
/// stand at z = 0.
fn sides() -> [Side; 4] {
    [(0, 0.0), (1, FRAC_PI_2), (0, PI), (1, -FRAC_PI_2)].map(|(kind, turn)| {
        let reach = if kind == 0 { COURT.y } else { COURT.x };
        let to_world = Mat4::from_rotation_y(turn) * Mat4::from_translation(Vec3::Z * -reach);
        Side { kind, to_world, reach }
    })
}

impl Hall {
    fn add_mesh(&mut self, name: &str, builder: Builder, surface: Surface) -> u32 {
        self.add_mesh_of(name, builder, surface as u32)
    }

    fn add_mesh_of(&mut self, name: &str, builder: Builder, material: u32) -> u32 {
        self.meshes.push(builder.mesh(name, material));
        self.meshes.len() as u32 - 1
    }

    fn place(&mut self, name: &str, meshes: &[u32], object_to_world: Mat4) {
        let model = self.models.len() as u32;
        let parts = meshes.iter().map(|ix| self.meshes[*ix as usize].bounds);
        let bounds_object = parts.fold(Aabb::EMPTY, Aabb::union);
        self.models.push(Model { name: name.into(), bounds_object, object_to_world });
        let instances = meshes.iter().map(|mesh| Instance { mesh: *mesh, model });
        self.instances.extend(instances);
    }

    fn add(&mut self, name: &str, builder: Builder, surface: Surface) {
        let mesh = self.add_mesh(name, builder, surface);
        self.place(name, &[mesh], Mat4::IDENTITY);
    }

    /// Outer walls with pilasters, and the roof over the upper walkway.
    fn shell(&mut self) {
        let mut walls = Builder::default();
        let (x, z, t) = (OUTER.x, OUTER.y, 0.5);
        for side in [-1.0, 1.0] {
            let (near, far) = (z * side, (z + t) * side);
            walls.block(
                Vec3::new(-x - t, -0.5, near.min(far)),
                Vec3::new(x + t, ROOF_M + 0.5, near.max(far)),
            );
            let (near, far) = (x * side, (x + t) * side);
            walls.block(
                Vec3::new(near.min(far), -0.5, -z),
                Vec3::new(near.max(far), ROOF_M + 0.5, z),
            );
        }
        self.add("outer walls", walls, Surface::Ashlar);
        let mut pilaster = Builder::default();
        pilaster.block_on(Vec3::ZERO, Vec3::new(0.66, 0.3, 0.36));
        pilaster.block_on(Vec3::Y * 0.3, Vec3::new(0.5, 4.4, 0.24));
        let cap = sharp(&[[0.0, 0.0], [0.04, 0.0], [0.04, 0.08], [0.1, 0.16], [0.1, 0.24]]);
        pilaster.moulding(Vec3::new(-0.3, 4.7, 0.1), Vec3::new(0.3, 4.7, 0.1), Vec3::Z, 0.0, &cap);
        pilaster.block_on(Vec3::Y * 4.7, Vec3::new(0.6, 0.24, 0.26));
        let pilaster = self.add_mesh("pilaster", pilaster, Surface::Limestone);
        for side in sides() {
            let wall = if side.kind == 0 { OUTER.y } else { OUTER.x } - side.reach;
            for i in 0..=BAYS[side.kind] {
                let x = (i as f32 - 0.5 * BAYS[side.kind] as f32) * BAY_M[side.kind];
                for [floor, ..] in STOREYS {
                    let height = if floor > 0.0 { 4.9 / 4.94 * 0.96 } else { 1.0 };
                    let at = Mat4::from_translation(Vec3::new(x, floor, 0.1 - wall))
                        * Mat4::from_scale(Vec3::new(1.0, height, 1.0));
                    self.place("pilaster", &[pilaster], side.to_world * at);
                }
            }
        }
        self.add(
            "roof",
            parts::ring(ROOF_M - 0.3, ROOF_M, COURT - 0.3, OUTER),
            Surface::Terracotta,
        );
    }

    /// Chequered marble below, pavers in the court, terracotta above.
    fn floors(&mut self) {
        let [mut white, mut dark, mut court] = [(); 3].map(|()| Builder::default());
        let tile = 0.5;
        let count = (OUTER / tile).as_ivec2();
        for i in -count.x..count.x {
            for k in -count.y..count.y {
                let corner = Vec2::new(i as f32, k as f32) * tile;
                let middle = (corner + 0.5 * tile).abs();
                let at = Vec3::new(corner.x, 0.0, corner.y);
                let border = (middle - (COURT - 0.9)).max_element();
                let to = if border < -0.5 {
                    continue;
                } else if (-0.5..0.0).contains(&border) || (i + k) % 2 == 0 {
                    &mut dark
                } else {
                    &mut white
                };
                to.quad(at, Vec3::Z * tile, Vec3::X * tile);
            }
        }
        // Pavers with worn edges around the fountain.
        let (from, step) = (Vec2::new(-9.5, -4.5), Vec2::new(1.0, 1.0));
        for i in 0..19 {
            for k in 0..9 {
                let foot = from + step * (Vec2::new(i as f32, k as f32) + 0.5);
                parts::paver(&mut court, Vec3::new(foot.x, 0.0, foot.y), 0.98, 0.014);
            }
        }
        let bed = Vec3::new(-9.6, -0.012, -4.6);
        court.quad(bed, Vec3::Z * 9.2, Vec3::X * 19.2);
        self.add("floor white", white, Surface::MarbleWhite);
        self.add("floor dark", dark, Surface::MarbleDark);
        self.add("court pavers", court, Surface::Limestone);
        let upper = parts::ring(STOREYS[0][2], STOREYS[1][0], COURT - 0.28, OUTER);
        self.add("upper floor", upper, Surface::Terracotta);
    }

    /// Columns and arches of one storey.
    fn arcade(&mut self, storey: usize) {
        let [floor, height, ceiling] = STOREYS[storey];
        let name = ["lower", "upper"][storey];
        let radius = [0.27, 0.22][storey];
        let column = parts::column(height, radius);
        let column = self.add_mesh(&format!("{name} column"), column, Surface::Limestone);
        let bays = BAY_M.map(|width| {
            let bay = parts::arch_bay(width, height, ceiling);
            self.add_mesh(&format!("{name} arch"), bay, Surface::Limestone)
        });
        let rails = BAY_M.map(|width| {
            let rail = parts::balustrade(width - 0.7);
            self.add_mesh("balustrade", rail, Surface::MarbleHoned)
        });
        for side in sides() {
            let (count, width) = (BAYS[side.kind], BAY_M[side.kind]);
            for i in 0..count {
                let x = (i as f32 + 0.5 - 0.5 * count as f32) * width;
                let at = side.to_world * Mat4::from_translation(Vec3::new(x, floor, 0.0));
                self.place(&format!("{name} arch"), &[bays[side.kind]], at);
                if storey == 1 {
                    self.place("balustrade", &[rails[side.kind]], at);
                }
                // Place only the column on each bay's left, because sides share their corners.
                let left = Mat4::from_translation(Vec3::X * (-0.5 * width));
                self.place(&format!("{name} column"), &[column], at * left);
            }
        }
    }

    /// Coffers over the walkways of one storey, and a lantern in every second bay.
    fn ceiling(&mut self, storey: usize) {
        let [floor, _, ceiling] = STOREYS[storey];
        let under = floor + ceiling;
        let depth = 2.0;
        let coffers =
            BAY_M.map(|width| self.add_mesh("coffer", parts::coffer(width, depth), Surface::Wood));
        let corner = self.add_mesh("coffer", parts::coffer(2.0, 2.0), Surface::Wood);
        let (metal, glass) = parts::lantern(1.1);
        let metal = self.add_mesh("lantern", metal, Surface::Iron);
        let glass = self.add_mesh("lantern glass", glass, Surface::Glow);
        for side in sides() {
            let (count, width) = (BAYS[side.kind], BAY_M[side.kind]);
            for i in 0..count {
                let x = (i as f32 + 0.5 - 0.5 * count as f32) * width;
                for row in [-1.0, -3.0] {
                    let at = Mat4::from_translation(Vec3::new(x, under, row));
                    self.place("coffer", &[coffers[side.kind]], side.to_world * at);
                }
                if i % 2 == storey as u32 {
                    let at = Mat4::from_translation(Vec3::new(x, under, -2.0));
                    self.place("lantern", &[metal, glass], side.to_world * at);
                }
            }
            if side.kind == 0 {
                for (x, z) in [(-14.0, -1.0), (-12.0, -1.0), (-14.0, -3.0), (-12.0, -3.0)] {
                    for sign in [-1.0, 1.0] {
                        let at = Mat4::from_translation(Vec3::new(x * sign, under, z));
                        self.place("coffer", &[corner], side.to_world * at);
                    }
                }
            }
        }
    }

    /// A moulded cornice around the court at the top of a storey, with dentils below.
    fn cornice(&mut self, storey: usize) {
        let [floor, _, ceiling] = STOREYS[storey];
        let base = floor + ceiling;
        let mut profile = sharp(&[[0.28, -0.02], [0.34, -0.02], [0.34, 0.1]]);
        profile.push(Vec2::new(0.34, 0.1));
        profile.extend(arc([0.34, 0.2], [0.1, 0.1], -90.0, 0.0, 6));
        profile.extend(sharp(&[[0.44, 0.2], [0.5, 0.22], [0.5, 0.32]]));
        profile.push(Vec2::new(0.5, 0.32));
        profile.extend(arc([0.5, 0.38], [0.06, 0.06], -90.0, 90.0, 6));
        profile.extend(sharp(&[[0.5, 0.44], [0.2, 0.44]]));
        let (mut moulding, mut dentils) = (Builder::default(), Builder::default());
        for side in sides() {
            let half = 0.5 * BAYS[side.kind] as f32 * BAY_M[side.kind];
            let point = |x: f32, z: f32| side.to_world.transform_point3(Vec3::new(x, base, z));
            let out = side.to_world.transform_vector3(Vec3::Z);
            moulding.moulding(point(-half, 0.0), point(half, 0.0), out, -1.0, &profile);
            let count = (2.0 * half / 0.22) as i32 - 3;
            for i in 0..count {
                let x = (i as f32 + 0.5 - 0.5 * count as f32) * 0.22;
                let size = (point(0.12, 0.06) - point(0.0, 0.0)).abs();
                dentils.block_on(point(x, 0.37), Vec3::new(size.x, 0.1, size.z));
            }
        }
        self.add("cornice", moulding, Surface::MarbleHoned);
        self.add("dentils", dentils, Surface::MarbleHoned);
    }

    /// Fountain and vases.
    fn furniture(&mut self) {
        let [stone, water, bronze] = parts::fountain();
        let stone = self.add_mesh("fountain", stone, Surface::MarbleHoned);
        let water = self.add_mesh("water", water, Surface::Water);
        let bronze = self.add_mesh("bronze knot", bronze, Surface::Bronze);
        self.place("fountain", &[stone, water, bronze], Mat4::IDENTITY);
        let clay = self.add_mesh("clay vase", parts::vase(0.9), Surface::Terracotta);
        let glazed = self.add_mesh("glazed vase", parts::vase(0.7), Surface::Glaze);
        for x in [-8.25, -2.75, 2.75, 8.25] {
            for z in [-1.0, 1.0] {
                let vase = if self.rng.random::<f32>() < 0.5 { clay } else { glazed };
                let turn = Mat4::from_rotation_y(TAU * self.rng.random::<f32>());
                let court = Mat4::from_translation(Vec3::new(x, 0.0, z * (COURT.y - 0.75)));
                self.place("vase", &[vase], court * turn);
                let wall = Mat4::from_translation(Vec3::new(x - 1.375, 0.0, z * (OUTER.y - 0.5)));
                self.place("vase", &[clay], wall * turn);
            }
        }
    }

    /// Banners from the upper rail, three weaves in four colours.
    fn cloths(&mut self) {
        let colors = [Surface::Crimson, Surface::Blue, Surface::Green, Surface::Gold];
        let rod = {
            let mut rod = Builder::default();
            rod.block(Vec3::new(-0.85, -0.025, -0.025), Vec3::new(0.85, 0.025, 0.025));
            self.add_mesh("banner rod", rod, Surface::Bronze)
        };
        let first: usize = self.rng.random_range(0..colors.len());
        for (side_ix, side) in sides().iter().enumerate() {
            let (count, width) = (BAYS[side.kind], BAY_M[side.kind]);
            for i in 0..count - 1 {
                let color = colors[(first + side_ix + i as usize) % colors.len()];
                let phase = TAU * self.rng.random::<f32>();
                let drop = 2.9 + 0.3 * self.rng.random::<f32>();
                let cloth = self.add_mesh("banner", parts::banner(1.5, drop, phase), color);
                let x = (i as f32 + 1.0 - 0.5 * count as f32) * width;
                let at = Mat4::from_translation(Vec3::new(x, STOREYS[1][0], 0.78));
                self.place("banner", &[cloth, rod], side.to_world * at);
            }
        }
    }
}
