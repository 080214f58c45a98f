//! What scenarios are made of: surfaces, rooms, lights and a camera.

use std::f32::consts::PI;

use assign::{Emitter, Light, LightShape, Sun};
use glam::{DVec3, Mat4, Vec2, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::moves::{self, Move};
use crate::{
    Aabb, Camera, Framing, Image, Instance, Lens, Material, Model, Pose, Scene,
    builder::{Builder, arc},
    extent,
    random::{random_color, random_direction},
};

/// The irradiance at which a scenario's lights would end if they had no window.
const IRRADIANCE: f32 = 0.05;

/// The vertical field of view of most cameras, radians.
const FOV_Y: f32 = 1.0;

/// A scenario under construction.
pub(super) struct Kit {
    pub(super) rng: Pcg64Mcg,
    pub(super) lights: Vec<Light>,
    /// The poses between which the camera jumps.
    pub(super) cuts: Vec<Pose>,
    /// The origin of world space, in the coordinates of a file.
    pub(super) origin: DVec3,
    pub(super) images: Vec<Image>,
    pub(super) suns: Vec<Sun>,
    camera: Camera,
    /// The distance of what the camera looks at, metres.
    focus_m: f32,
    scene: Vec<Part>,
    materials: Vec<Material>,
}

/// A mesh with its own model.
struct Part {
    name: &'static str,
    builder: Builder,
    material: u32,
    object_to_world: Mat4,
}

/// Rough grey.
pub(super) const STONE: u32 = 0;
/// Rough ochre.
pub(super) const CLAY: u32 = 1;
/// Rough dark blue.
pub(super) const SLATE: u32 = 2;
/// Half polished white.
pub(super) const GLAZE: u32 = 3;
/// Nearly a mirror.
pub(super) const POLISH: u32 = 4;

/// A surface without textures.
pub(super) fn plain(name: &str, color: [f32; 3], roughness: f32, metallic: f32) -> Material {
    Material {
        name: name.into(),
        base_color: Vec3::from(color).extend(1.0),
        metallic,
        roughness,
        ..Material::default()
    }
}

impl Kit {
    pub(super) fn new(seed: u64) -> Self {
        let pose = Pose::new(Vec3::ZERO, Vec3::NEG_Z);
        let camera = Camera {
            name: "scenario".into(),
            pose,
            lens: Lens::Perspective { fov_y: FOV_Y },
            near_m: 0.05,
            far_m: Some(60.0),
            framing: Framing::PLAIN,
        };
        let materials = vec![
            plain("stone", [0.55, 0.53, 0.5], 0.8, 0.0),
            plain("clay", [0.55, 0.33, 0.18], 0.7, 0.0),
            plain("slate", [0.16, 0.2, 0.3], 0.6, 0.0),
            plain("glaze", [0.7, 0.72, 0.7], 0.3, 0.0),
            plain("polish", [0.75, 0.75, 0.78], 0.06, 1.0),
        ];
        Self {
            rng: Pcg64Mcg::seed_from_u64(seed),
            lights: Vec::new(),
            cuts: Vec::new(),
            origin: DVec3::ZERO,
            images: Vec::new(),
            suns: Vec::new(),
            camera,
            focus_m: 1.0,
            scene: Vec::new(),
            materials,
        }
    }

    /// Adds a material and returns its index.
    pub(super) fn material(&mut self, material: Material) -> u32 {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// Adds a mesh with its own model, in world space.
    pub(super) fn add(
        &mut self,
        name: &'static str,
        material: u32,
        make: impl FnOnce(&mut Builder),
    ) {
        self.place(name, material, Mat4::IDENTITY, make);
    }

    /// Adds a mesh that a transform places.
    pub(super) fn place(
        &mut self,
        name: &'static str,
        material: u32,
        object_to_world: Mat4,
        make: impl FnOnce(&mut Builder),
    ) {
        let mut builder = Builder::default();
        make(&mut builder);
        self.scene.push(Part { name, builder, material, object_to_world });
    }

    /// A floor at height 0, as a grid of quads.
    pub(super) fn floor(&mut self, material: u32, low: [f32; 2], high: [f32; 2]) {
        let (low, size) = (Vec2::from(low), Vec2::from(high) - Vec2::from(low));
        self.add("floor", material, |b| {
            b.surface(8, 8, |u, v| Vec3::new(low.x + size.x * u, 0.0, low.y + size.y * (1.0 - v)));
        });
    }

    /// A box that stands on the floor.
    pub(super) fn block(&mut self, material: u32, foot: Vec3, size: Vec3) {
        self.add("block", material, |b| b.block_on(foot, size));
    }

    /// A ball.
    pub(super) fn ball(&mut self, material: u32, center: Vec3, radius_m: f32) {
        self.add("ball", material, |b| {
            let profile = arc([0.0, 0.0], [radius_m, radius_m], -90.0, 90.0, 10);
            b.lathe(center, 18, &profile);
        });
    }

    /// A hall of 12 by 4.5 by 20 m with columns and balls at many depths, its open end at z = 4. The camera looks
    /// down its length.
    pub(super) fn hall(&mut self) {
        self.floor(STONE, [-6.0, -16.0], [6.0, 4.0]);
        let wall =
            |b: &mut Builder, corner: Vec3, along: Vec3| b.quad(corner, along, 4.5 * Vec3::Y);
        self.add("walls", CLAY, |b| {
            wall(b, Vec3::new(-6.0, 0.0, 4.0), Vec3::new(0.0, 0.0, -20.0));
            wall(b, Vec3::new(-6.0, 0.0, -16.0), Vec3::new(12.0, 0.0, 0.0));
            wall(b, Vec3::new(6.0, 0.0, -16.0), Vec3::new(0.0, 0.0, 20.0));
        });
        // `quad` faces `u x v`: along x up faces the inside of the hall.
        for row in 0..4 {
            let z = -1.5 - 3.8 * row as f32;
            for x in [-3.4, 3.4] {
                self.block(GLAZE, Vec3::new(x, 0.0, z), Vec3::new(0.6, 3.6, 0.6));
            }
            let x = if row % 2 == 0 { -1.1 } else { 1.2 };
            self.ball(SLATE, Vec3::new(x, 0.7, z - 1.2), 0.7);
        }
        self.look(Vec3::new(0.3, 1.7, 3.2), Vec3::new(0.0, 1.2, -7.0));
    }

    /// The box in which a hall's lights lie.
    pub(super) fn hall_box() -> Aabb {
        Aabb::new(Vec3::new(-5.8, 0.1, -15.8), Vec3::new(5.8, 4.2, 2.0))
    }

    /// Puts the camera at `eye`, looking at `target`.
    pub(super) fn look(&mut self, eye: Vec3, target: Vec3) {
        self.camera.pose = Pose::new(eye, target);
        self.focus_m = eye.distance(target);
    }

    /// Where the camera is.
    pub(super) fn eye(&self) -> Vec3 {
        self.camera.pose.eye
    }

    /// The world-space point at a view-space offset: right, up and forward of the eye, metres.
    pub(super) fn ahead(&self, offset: Vec3) -> Vec3 {
        let to_world = self.camera.pose.world_to_view().inverse();
        to_world.transform_point3(offset * Vec3::new(1.0, 1.0, -1.0))
    }

    /// Sets near and far plane, metres; without a far plane, `None`.
    pub(super) fn planes(&mut self, near_m: f32, far_m: Option<f32>) {
        (self.camera.near_m, self.camera.far_m) = (near_m, far_m);
        self.camera.framing.is_endless = far_m.is_none();
    }

    /// Sets the projection.
    pub(super) fn lens(&mut self, lens: Lens) {
        self.camera.lens = lens;
    }

    /// Sets where the image lies.
    pub(super) fn framing(&mut self, change: impl FnOnce(&mut Framing)) {
        change(&mut self.camera.framing);
    }

    /// A random number.
    pub(super) fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.rng.random::<f32>()
    }

    /// A random number whose logarithm is uniform.
    pub(super) fn log_range(&mut self, low: f32, high: f32) -> f32 {
        self.range(low.ln(), high.ln()).exp()
    }

    /// A random point in a box.
    pub(super) fn point_in(&mut self, room: Aabb) -> Vec3 {
        let share = Vec3::from_array(std::array::from_fn(|_| self.rng.random::<f32>()));
        room.min + share * (room.max - room.min)
    }

    /// A random unit vector.
    pub(super) fn direction(&mut self) -> Vec3 {
        random_direction(&mut self.rng).as_vec3()
    }

    /// A random colour, bright enough for its range.
    pub(super) fn intensity(&mut self, range_m: f32) -> Vec3 {
        random_color(&mut self.rng) * (IRRADIANCE * range_m * range_m)
    }

    /// A point light of random colour.
    pub(super) fn point_light(&mut self, position: Vec3, range_m: f32) -> Light {
        let intensity = self.intensity(range_m);
        Light::point(position, range_m, intensity)
    }

    /// Adds point lights at random places in a box, with ranges between two lengths.
    pub(super) fn scatter(&mut self, count: usize, room: Aabb, ranges_m: (f32, f32)) {
        for _ in 0..count {
            let position = self.point_in(room);
            let range_m = self.log_range(ranges_m.0, ranges_m.1);
            let light = self.point_light(position, range_m);
            self.lights.push(light);
        }
    }

    /// A spot of random colour; angles are half angles in radians.
    pub(super) fn spot(
        &mut self,
        position: Vec3,
        direction: Vec3,
        (inner_angle, outer_angle): (f32, f32),
        range_m: f32,
    ) -> Light {
        let shape = LightShape::Spot {
            direction: direction.normalize_or(Vec3::NEG_Y),
            inner_angle,
            outer_angle: outer_angle.min(PI),
        };
        Light { shape, ..self.point_light(position, range_m) }
    }

    /// Adds spots of 4 m at random places in a box. Their half angles lie between two, in radians, and are full within
    /// a share of that.
    pub(super) fn scatter_spots(
        &mut self,
        count: usize,
        room: Aabb,
        (narrow, wide): (f32, f32),
        inner_share: f32,
    ) {
        for _ in 0..count {
            let place = self.point_in(room);
            let (direction, outer) = (self.direction(), self.range(narrow, wide));
            let spot = self.spot(place, direction, (inner_share * outer, outer), 4.0);
            self.lights.push(spot);
        }
    }

    /// A rectangle of random colour, from its half axes. It emits towards `half_x` x `half_y`.
    pub(super) fn rectangle(
        &mut self,
        center: Vec3,
        [half_x, half_y]: [Vec3; 2],
        range_m: f32,
    ) -> Light {
        let intensity = self.intensity(range_m);
        Light::area(Emitter::rectangle(half_x, half_y), center, range_m, intensity)
    }

    /// Moves everything that was added so far, and the camera.
    pub(super) fn shift(&mut self, by: Vec3) {
        for part in &mut self.scene {
            part.object_to_world = Mat4::from_translation(by) * part.object_to_world;
        }
        self.lights.iter_mut().for_each(|light| light.position += by);
        let poses = self.cuts.iter_mut().chain([&mut self.camera.pose]);
        poses.for_each(|pose| pose.eye += by);
        if let Some(plane) = &mut self.camera.framing.clip_plane {
            plane.w -= plane.truncate().dot(by);
        }
    }

    /// The pose of a camera at `eye` that looks at `target`.
    pub(super) fn cut(&mut self, eye: [f32; 3], target: [f32; 3]) {
        self.cuts.push(Pose::new(eye.into(), target.into()));
    }

    /// The finished scene, with the path of a move of the camera.
    pub(super) fn scene(self, name: String, way: Option<Move>) -> Scene {
        let Camera { pose, lens, .. } = self.camera;
        let path = moves::path(way, pose, lens, self.focus_m, &self.cuts);
        let mut scene = Scene {
            name,
            meshes: Vec::new(),
            materials: self.materials,
            images: self.images,
            instances: Vec::new(),
            models: Vec::new(),
            lights: self.lights,
            light_animation: None,
            open_lights: Vec::new(),
            suns: self.suns,
            cameras: vec![self.camera],
            view_camera: 0,
            origin: self.origin,
            path,
            bounds: Aabb::EMPTY,
            core_bounds: Aabb::EMPTY,
            warnings: Vec::new(),
        };
        for part in self.scene {
            let mesh = part.builder.mesh(part.name, part.material);
            let ix = scene.meshes.len() as u32;
            scene.instances.push(Instance { mesh: ix, model: ix });
            scene.models.push(Model {
                name: part.name.into(),
                bounds_object: mesh.bounds,
                object_to_world: part.object_to_world,
            });
            scene.meshes.push(mesh);
        }
        scene.bounds = extent::bounds(&scene);
        scene.core_bounds = scene.bounds;
        scene
    }
}
