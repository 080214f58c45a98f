//! The default scene.
use glam::{Mat4, Vec3};
use crate::{Aabb, CameraPath, Instance, Material, Mesh, Model, Pose, Scene, Vertex};

/// A rectangular court with arcades.
pub fn atrium(_seed: u64) -> Scene {
    let vertex = |x: f32, z: f32| Vertex { position: [x, 0.0, z], normal: [0.0, 1.0, 0.0], tangent: [1.0, 0.0, 0.0, 1.0], uv: [x, z] };
    let bounds = Aabb::new(Vec3::new(-15.0, 0.0, -10.0), Vec3::new(15.0, 0.0, 10.0));
    let mesh = Mesh {
        name: "floor".into(),
        vertices: vec![vertex(-15.0, -10.0), vertex(-15.0, 10.0), vertex(15.0, 10.0), vertex(15.0, -10.0)],
        indices: vec![0, 1, 2, 0, 2, 3], material: 0, bounds,
    };
    let mut scene = Scene {
        name: "atrium".into(), meshes: vec![mesh], materials: vec![Material { metallic: 0.0, roughness: 0.3, ..Material::default() }], images: vec![],
        instances: vec![Instance { mesh: 0, model: 0 }],
        models: vec![Model { name: "floor".into(), bounds_object: bounds, object_to_world: Mat4::IDENTITY }],
        lights: vec![], cameras: vec![], path: CameraPath::still(Pose::new(Vec3::new(-12.0, 1.7, 5.0), Vec3::ZERO)),
        bounds, core_bounds: bounds, warnings: vec![],
    };
    scene.bounds.max.y = 8.0;
    scene.core_bounds = scene.bounds;
    scene
}
