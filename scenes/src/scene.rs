//! A scene in main memory: indexed meshes, placed by models, with materials, lights and cameras.

use assign::{Light, LightShape, Sun};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3};

use crate::{Aabb, CameraPath, Framing, Image, LightAnimation, Material, Pose, SceneError};

/// Everything that is drawn, lit, and looked from. World space is right-handed with +Y up, in
/// metres.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Its id, or its file's stem (the folder's name where that is "scene").
    pub name: String,
    /// Geometry, each with one material.
    pub meshes: Vec<Mesh>,
    /// At least one material.
    pub materials: Vec<Material>,
    /// Images that the materials' textures refer to.
    pub images: Vec<Image>,
    /// What is drawn: meshes placed by models.
    pub instances: Vec<Instance>,
    /// Placed objects. Per-model assignment uses them as groups.
    pub models: Vec<Model>,
    /// The scene's own lights; may be empty. They include faulty ones, which uploading quarantines
    /// and reports.
    pub lights: Vec<Light>,
    /// How the scene's file moves some of these lights; `None` if they all stand still.
    pub light_animation: Option<LightAnimation>,
    /// Indices of the lights whose file gives no range. [`close_ranges`](crate::close_ranges) chose
    /// their range.
    pub open_lights: Vec<u32>,
    /// The scene's own suns, at most [`MAX_SUNS`](assign::MAX_SUNS). None is faulty.
    pub suns: Vec<Sun>,
    /// The scene's own cameras; may be empty.
    pub cameras: Vec<Camera>,
    /// Index of the camera that gives lens and planes by default: the one that the path animates,
    /// otherwise the first. It is out of range if the scene has no camera.
    pub view_camera: usize,
    /// The origin of world space, in the coordinates of the scene's file, metres. It is 0 unless
    /// the scene stands far from the origin of its file.
    pub origin: DVec3,
    /// The path of a camera through the scene. Frame 0 shows much of it.
    pub path: CameraPath,
    /// Box around all triangles, world space.
    pub bounds: Aabb,
    /// Box around the part that most triangles belong to, world space: [`Scene::bounds`] without a
    /// far backdrop. Scattered lights lie in it.
    pub core_bounds: Aabb,
    /// What the importer left out or changed, one line each.
    pub warnings: Vec<String>,
}

/// One vertex, object space. 48 bytes without padding.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Position, metres.
    pub position: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Unit tangent (the direction of increasing u), and the sign of the bitangent
    /// `cross(normal, tangent) * w`.
    pub tangent: [f32; 4],
    /// Texture coordinate. The v axis points down the image.
    pub uv: [f32; 2],
}

/// A triangle list with one material: a glTF primitive.
#[derive(Clone, PartialEq)]
pub struct Mesh {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Vertices, object space.
    pub vertices: Vec<Vertex>,
    /// Three per triangle, counter-clockwise seen from the front; each below `vertices.len()`.
    pub indices: Vec<u32>,
    /// Factors on the base colour: linear RGB and opacity, 0..=1. Either one per vertex, or none at
    /// all.
    pub colors: Vec<[f32; 4]>,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// Box around the vertices, object space.
    pub bounds: Aabb,
}

impl std::fmt::Debug for Mesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "Mesh({:?}, {} vertices, {} triangles, material {})",
            self.name,
            self.vertices.len(),
            self.triangle_count(),
            self.material
        )
    }
}

impl Mesh {
    /// How many triangles it has.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Its triangles' corners, object space.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [Vec3; 3]> + '_ {
        (0..self.triangle_count()).map(|ix| self.triangle(ix))
    }

    fn triangle(&self, ix: usize) -> [Vec3; 3] {
        let corners = &self.indices[3 * ix..3 * ix + 3];
        std::array::from_fn(|i| Vec3::from(self.vertices[corners[i] as usize].position))
    }
}

/// An object placed in the world: a glTF node with a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Box around all its meshes, object space.
    pub bounds_object: Aabb,
    /// Affine, possibly not invertible. A negative determinant mirrors, which reverses the winding
    /// of triangles.
    pub object_to_world: Mat4,
}

impl Model {
    /// Whether it reverses the winding of triangles.
    pub fn is_mirrored(&self) -> bool {
        // The determinant is computed in f64, because tiny ones are 0 in f32.
        self.object_to_world.as_dmat4().determinant() < 0.0
    }
}

/// A mesh drawn with its model's transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Index into [`Scene::models`].
    pub model: u32,
}

/// A camera that came with the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Where it is and where it looks.
    pub pose: Pose,
    /// How it projects.
    pub lens: Lens,
    /// Distance of the near plane, metres.
    pub near_m: f32,
    /// Distance of the far plane, metres; `None` is infinitely far.
    pub far_m: Option<f32>,
    /// Where its image lies in the window and in the target.
    pub framing: Framing,
}

/// A camera's projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective.
    Perspective {
        /// Full vertical field of view, radians.
        fov_y: f32,
    },
    /// Orthographic.
    Orthographic {
        /// Half the width of the view, metres.
        half_width: f32,
        /// Half the height of the view, metres.
        half_height: f32,
    },
}

impl Scene {
    /// The number of triangles drawn. Each instance counts the triangles of its mesh.
    pub fn triangle_count(&self) -> u64 {
        let count = |instance: &Instance| self.meshes[instance.mesh as usize].triangle_count();
        self.instances.iter().map(|i| count(i) as u64).sum()
    }

    /// The corners of every triangle drawn, world space. Triangles are counter-clockwise seen from
    /// the front, even where the model mirrors.
    pub fn world_triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.every_nth_triangle(1)
    }

    /// At most `most` triangles of [`Scene::world_triangles`], evenly chosen, or all if there are
    /// no more.
    pub(crate) fn sampled_triangles(&self, most: u64) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.every_nth_triangle(self.triangle_count().div_ceil(most).max(1) as usize)
    }

    fn every_nth_triangle(&self, step: usize) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        // How many triangles of the next instance to skip.
        let mut skipped = 0;
        self.instances.iter().flat_map(move |instance| {
            let model = &self.models[instance.model as usize];
            let mirrored = model.is_mirrored();
            let mesh = &self.meshes[instance.mesh as usize];
            let chosen = (skipped..mesh.triangle_count()).step_by(step);
            skipped = skipped + chosen.len() * step - mesh.triangle_count();
            chosen.map(move |ix| {
                let triangle = mesh.triangle(ix);
                let [a, b, c] = triangle.map(|p| model.object_to_world.transform_point3(p));
                if mirrored { [a, c, b] } else { [a, b, c] }
            })
        })
    }

    /// Copies the scene `side` x `side` times along X and Z, with its lights. The first copy stays
    /// in place. Suns shine on all copies. Camera, path and [`Scene::core_bounds`] stay those of
    /// the first copy.
    ///
    /// # Errors
    ///
    /// [`SceneError::OutOfRange`] unless `side` is 1 to 64 and there are at most 200,000,000
    /// triangles.
    pub fn replicated(mut self, side: u32) -> Result<Self, SceneError> {
        let copies = u64::from(side) * u64::from(side);
        let out =
            |value: String, accepted| SceneError::OutOfRange { field: "copies", value, accepted };
        if !(1..=64).contains(&side) {
            return Err(out(side.to_string(), "1 to 64 along each side"));
        }
        if self.triangle_count().saturating_mul(copies) > 200_000_000 {
            let value = format!("{copies} of {} triangles", self.triangle_count());
            return Err(out(value, "at most 200000000 triangles together"));
        }
        let size = self.bounds.max - self.bounds.min;
        let (models, instances) = (self.models.clone(), self.instances.clone());
        let (lights, open_lights) = (self.lights.clone(), self.open_lights.clone());
        let animated = self.light_animation.as_ref().map(|a| a.lights.clone());
        for (x, z) in (0..side).flat_map(|x| (0..side).map(move |z| (x, z))).skip(1) {
            let by = Vec3::new(x as f32 * size.x, 0.0, z as f32 * size.z);
            let first = self.models.len() as u32;
            self.models.extend(models.iter().map(|model| Model {
                object_to_world: Mat4::from_translation(by) * model.object_to_world,
                ..model.clone()
            }));
            let moved = |i: &Instance| Instance { model: first + i.model, ..*i };
            self.instances.extend(instances.iter().map(moved));
            let first_light = self.lights.len();
            self.open_lights.extend(open_lights.iter().map(|ix| first_light as u32 + ix));
            if let (Some(animation), Some(lights)) = (&mut self.light_animation, &animated) {
                animation.lights.extend(LightAnimation::copied(lights, first_light, by));
            }
            self.lights.extend(lights.iter().map(|l| Light { position: l.position + by, ..*l }));
        }
        let last = (side - 1) as f32;
        self.bounds.max += Vec3::new(last * size.x, 0.0, last * size.z);
        Ok(self)
    }

    /// The scene without emitting materials, so that only lights light it.
    #[must_use]
    pub fn without_emission(mut self) -> Self {
        for material in &mut self.materials {
            material.emissive = Vec3::ZERO;
            material.emissive_texture = None;
        }
        self
    }

    /// The scene with one roughness on all surfaces, and without metal: textures of roughness and metalness are left out.
    /// `None` keeps the scene as it is.
    ///
    /// # Errors
    ///
    /// [`SceneError::OutOfRange`] unless `roughness` is within 0..=1.
    pub fn with_roughness(mut self, roughness: Option<f64>) -> Result<Self, SceneError> {
        let Some(roughness) = roughness else { return Ok(self) };
        if !(0.0..=1.0).contains(&roughness) {
            return Err(SceneError::OutOfRange {
                field: "roughness",
                value: roughness.to_string(),
                accepted: "between 0 and 1",
            });
        }
        for material in &mut self.materials {
            material.roughness = roughness as f32;
            material.metallic = 0.0;
            material.metallic_roughness_texture = None;
        }
        Ok(self)
    }

    /// The scene, uniformly scaled about the origin.
    ///
    /// Geometry, boxes, cameras, the path and the positions of the scene's own lights, also of
    /// animated ones, scale by `factor`. The ranges of these lights scale by `factor` and their intensities by its square,
    /// so that the lit image stays the same. Suns stay as they are.
    ///
    /// # Errors
    ///
    /// [`SceneError::OutOfRange`] unless `factor` is finite and within 1e-6..=1e6.
    pub fn scaled(mut self, factor: f64) -> Result<Self, SceneError> {
        if !(1e-6..=1e6).contains(&factor) {
            return Err(SceneError::OutOfRange {
                field: "scene scale",
                value: factor.to_string(),
                accepted: "between 0.000001 and 1000000",
            });
        }
        self.origin *= factor;
        let factor = factor as f32;
        let scale = Mat4::from_scale(Vec3::splat(factor));
        for model in &mut self.models {
            model.object_to_world = scale * model.object_to_world;
        }
        for light in &mut self.lights {
            light.position *= factor;
            light.range_m *= factor;
            light.intensity *= factor * factor;
            if let LightShape::Area(emitter) = &mut light.shape {
                *emitter = emitter.scaled(factor);
            }
            if let LightShape::Vpl { min_distance_m, .. } = &mut light.shape {
                *min_distance_m *= factor;
            }
        }
        if let Some(animation) = &mut self.light_animation {
            animation.scale_by(factor);
        }
        for camera in &mut self.cameras {
            camera.pose = camera.pose.scaled(factor);
            camera.near_m *= factor;
            camera.far_m = camera.far_m.map(|far| far * factor);
            if let Some(plane) = &mut camera.framing.clip_plane {
                plane.w *= factor;
            }
            if let Lens::Orthographic { half_width, half_height } = &mut camera.lens {
                *half_width *= factor;
                *half_height *= factor;
            }
        }
        self.path = self.path.scaled(factor);
        for bounds in [&mut self.bounds, &mut self.core_bounds] {
            *bounds = Aabb::new(bounds.min * factor, bounds.max * factor);
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use assign::Light;
    use glam::Vec3;

    #[test]
    fn copies_stand_beside_the_original() {
        let mut one = crate::atrium(1);
        one.lights = vec![Light::point(Vec3::Y, 1.0, Vec3::ONE)];
        let four = one.clone().replicated(2).expect("in range");
        assert_eq!(four.triangle_count(), 4 * one.triangle_count());
        assert_eq!((four.models.len(), four.lights.len()), (4 * one.models.len(), 4));
        let size = one.bounds.max - one.bounds.min;
        assert_eq!(four.lights[3].position, Vec3::new(size.x, 1.0, size.z));
        assert_eq!((four.bounds.min, four.core_bounds), (one.bounds.min, one.core_bounds));
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for corner in four.world_triangles().flatten() {
            (low, high) = (low.min(corner), high.max(corner));
        }
        let off = (low - four.bounds.min).abs().max((high - four.bounds.max).abs());
        assert!(off.max_element() < 1e-4 * size.length(), "{low} {high} {:?}", four.bounds);
        assert_ne!(four.hash(), one.hash());
        let refused = one.replicated(0).expect_err("none").to_string();
        assert!(refused.contains("copies is 0"), "{refused}");
    }

    #[test]
    fn emission_can_be_left_out() {
        let atrium = crate::atrium(1);
        let emits = |scene: &crate::Scene| scene.materials.iter().any(|m| m.emissive != Vec3::ZERO);
        assert!(emits(&atrium));
        let dark = atrium.clone().without_emission();
        assert!(!emits(&dark));
        assert_ne!(dark.hash(), atrium.hash());
    }

    #[test]
    fn samples_are_every_nth_triangle() {
        let scene = crate::atrium(1);
        let all: Vec<_> = scene.world_triangles().collect();
        assert_eq!(all.len() as u64, scene.triangle_count());
        for most in [all.len(), all.len() / 2, 1000, 7, 1] {
            let step = all.len().div_ceil(most);
            let expected: Vec<_> = all.iter().copied().step_by(step).collect();
            let sample: Vec<_> = scene.sampled_triangles(most as u64).collect();
            assert!(sample == expected && sample.len() <= most, "{most}");
        }
    }
}
