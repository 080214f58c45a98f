//! Scenes of rectangles, and the pipeline's images of a scene.

use assign::{EncoderPasses, Everything, Gpu, Light, LightBuffer, Suns, View};
use glam::{Mat4, Vec3, Vec4};
use scenes::{Aabb, CameraPath, Image, Instance, Material, Mesh, Model, Pose, Scene, Vertex};
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, Renderer, record_before_lighting,
    traced::GBufferSamples,
};

/// Rectangles, each given by a centre and two half edges. They face the cross product of the edges.
pub(crate) fn scene_of(quads: &[[Vec3; 3]], material: Material, images: Vec<Image>) -> Scene {
    let vertex = |[center, x, y]: &[Vec3; 3], u: f32, v: f32| Vertex {
        position: (*center + *x * u + *y * v).to_array(),
        normal: x.cross(*y).normalize().to_array(),
        tangent: x.normalize().extend(1.0).to_array(),
        uv: [0.5 + 0.5 * u, 0.5 - 0.5 * v],
    };
    let bounds = Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let meshes = quads.iter().map(|quad| Mesh {
        name: "quad".into(),
        vertices: corners.map(|(u, v)| vertex(quad, u, v)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        colors: Vec::new(),
        material: 0,
        bounds,
    });
    Scene {
        name: "quads".into(),
        meshes: meshes.collect(),
        materials: vec![material],
        images,
        instances: (0..quads.len() as u32).map(|mesh| Instance { mesh, model: 0 }).collect(),
        models: vec![Model {
            name: "all".into(),
            bounds_object: bounds,
            object_to_world: Mat4::IDENTITY,
        }],
        lights: Vec::new(),
        open_lights: Vec::new(),
        light_animation: None,
        suns: Vec::new(),
        cameras: Vec::new(),
        view_camera: 0,
        origin: glam::DVec3::ZERO,
        path: CameraPath::still(Pose::new(Vec3::ZERO, Vec3::NEG_Z)),
        bounds,
        core_bounds: bounds,
        warnings: Vec::new(),
    }
}

pub(crate) fn grey(albedo: f32) -> Material {
    let base_color = Vec4::new(albedo, albedo, albedo, 1.0);
    Material { base_color, metallic: 0.0, roughness: 0.6, ..Material::default() }
}

/// The G-buffer of a view, and its image in a mode.
pub(crate) fn rasterise(
    gpu: &Gpu,
    scene: &Scene,
    view: &View,
    lights: &[Light],
    suns: Suns,
    mode: Mode,
) -> (GBufferSamples, HdrImage) {
    let lights = LightBuffer::new(gpu, lights).unwrap();
    let mut renderer = Renderer::new(gpu, scene, view).unwrap();
    renderer.prepare(view, &lights).unwrap();
    let mut strategy = Everything::new(gpu).unwrap();
    let options = LightingOptions { kinds: lights.kinds(), suns, ..LightingOptions::default() };
    let lighting = Lighting::new(&renderer, &strategy, mode, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let frame = renderer.frame(view, &lights);
    assign::Assignment::prepare(&mut strategy, gpu, &frame).unwrap();
    record_before_lighting(&renderer, mode, &mut strategy, &frame, &mut passes);
    lighting.record(&renderer, view, &strategy, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap();
    (GBufferSamples::read(&renderer, view).unwrap(), image)
}
