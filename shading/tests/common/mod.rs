//! A small scene with one of everything that the pipeline draws.

pub(crate) mod areas;
pub(crate) mod evaluate;
pub(crate) mod quads;

use assign::{Gpu, Light, LightShape, Sun, Suns, View};
use glam::{Affine2, Mat4, Vec2, Vec3, Vec4};
use scenes::{
    Aabb, CameraPath, Encoding, Image, Instance, Material, Mesh, Model, Pose, Scene, TextureRef,
    Vertex,
};

/// This machine's adapter. Tests of GPU work fail if there is none.
pub(crate) fn gpu() -> Gpu {
    Gpu::open(None).expect("an adapter: scripts/test installs the software one")
}

/// A quad of side 2 in the plane z = 0, facing +z.
fn quad(material: u32) -> Mesh {
    let corner = |x: f32, y: f32| Vertex {
        position: [x, y, 0.0],
        normal: [0.0, 0.0, 1.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv: [0.5 + 0.5 * x, 0.5 - 0.5 * y],
    };
    Mesh {
        name: format!("quad {material}"),
        vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        indices: vec![0, 1, 2, 0, 2, 3],
        colors: Vec::new(),
        material,
        bounds: Aabb::new(Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)),
    }
}

fn image(name: &str, encoding: Encoding, texel: fn(u32, u32) -> [u8; 4]) -> Image {
    let size = 16;
    Image {
        name: name.into(),
        width: size,
        height: size,
        rgba: (0..size * size).flat_map(|i| texel(i % size, i / size)).collect(),
        encoding,
    }
}

/// The materials: plain, textured with everything, alpha-masked, double-sided metal.
fn materials() -> Vec<Material> {
    let texture = |image| Some(TextureRef::new(image));
    let mut moved = TextureRef::new(0);
    moved.uv_transform = Affine2::from_scale_angle_translation(Vec2::splat(2.0), 0.3, Vec2::X);
    vec![
        Material {
            name: "plain".into(),
            base_color: Vec4::new(0.8, 0.7, 0.6, 1.0),
            metallic: 0.0,
            roughness: 0.9,
            ..Material::default()
        },
        Material {
            name: "textured".into(),
            base_color_texture: Some(moved),
            metallic_roughness_texture: texture(1),
            normal_texture: texture(2),
            emissive_texture: texture(0),
            emissive: Vec3::splat(0.02),
            ..Material::default()
        },
        Material {
            name: "mask".into(),
            metallic: 0.0,
            alpha_cutoff: Some(0.5),
            base_color_texture: texture(3),
            ..Material::default()
        },
        Material {
            name: "metal".into(),
            base_color: Vec4::new(1.0, 0.8, 0.4, 1.0),
            metallic: 1.0,
            roughness: 0.25,
            double_sided: true,
            ..Material::default()
        },
    ]
}

/// A floor, a textured wall, a mask before it, a mirrored and sheared metal sheet.
pub(crate) fn showcase() -> Scene {
    let place = |name: &str, object_to_world| Model {
        name: name.into(),
        bounds_object: quad(0).bounds,
        object_to_world,
    };
    let floor =
        Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2) * Mat4::from_scale(Vec3::splat(4.0));
    let wall =
        Mat4::from_translation(Vec3::new(0.0, 2.0, -4.0)) * Mat4::from_scale(Vec3::splat(4.0));
    let mask = Mat4::from_translation(Vec3::new(-1.5, 1.0, -1.0));
    let mut sheet = Mat4::from_translation(Vec3::new(1.5, 1.0, -1.5))
        * Mat4::from_rotation_y(0.6)
        * Mat4::from_scale(Vec3::new(-0.8, 1.0, 0.5));
    sheet.y_axis.x += 0.3;
    let scene_box = Aabb::new(Vec3::new(-4.0, 0.0, -4.0), Vec3::new(4.0, 6.0, 4.0));
    Scene {
        name: "showcase".into(),
        meshes: (0..4).map(quad).collect(),
        materials: materials(),
        images: vec![
            image("checker", Encoding::Srgb, |x, y| {
                if (x / 4 + y / 4) % 2 == 0 { [230, 180, 120, 255] } else { [60, 80, 140, 255] }
            }),
            image("metallic-roughness", Encoding::Linear, |x, _| [0, 60 + 10 * x as u8, 128, 255]),
            image("normal", Encoding::Linear, |x, y| {
                [108 + (x % 4) as u8 * 10, 108 + (y % 4) as u8 * 10, 240, 255]
            }),
            image("holes", Encoding::Srgb, |x, y| {
                [90, 160, 90, if (x / 2 + y / 2) % 2 == 0 { 255 } else { 0 }]
            }),
        ],
        instances: (0..4).map(|ix| Instance { mesh: ix, model: ix }).collect(),
        models: vec![
            place("floor", floor),
            place("wall", wall),
            place("mask", mask),
            place("sheet", sheet),
        ],
        lights: Vec::new(),
        open_lights: Vec::new(),
        light_animation: None,
        suns: Vec::new(),
        cameras: Vec::new(),
        view_camera: 0,
        origin: glam::DVec3::ZERO,
        path: CameraPath::still(Pose::new(Vec3::new(0.0, 2.0, 5.0), Vec3::new(0.0, 1.2, 0.0))),
        bounds: scene_box,
        core_bounds: scene_box,
        warnings: Vec::new(),
    }
}

/// The showcase's camera.
pub(crate) fn view(size: [u32; 2]) -> View {
    View::look_at(Vec3::new(0.0, 2.0, 5.0), Vec3::new(0.0, 1.2, 0.0), 1.0, 0.1, size)
}

/// The showcase's camera with an oblique near plane that cuts through the room.
#[allow(dead_code, reason = "some tests need no oblique view")]
pub(crate) fn oblique(size: [u32; 2]) -> View {
    let normal = Vec3::new(0.3, -0.2, -1.0);
    view(size).with_near_plane(normal.extend(-normal.dot(Vec3::new(0.0, 1.2, 2.6))))
}

/// Lights in the showcase, every third one a spot, every sixth a virtual point light.
pub(crate) fn lights(count: u32) -> Vec<Light> {
    (0..count)
        .map(|i| {
            let f = i as f32;
            let position = Vec3::new(
                (f * 1.7).sin() * 3.0,
                0.2 + (f * 0.61).fract() * 3.0,
                (f * 2.3).cos() * 3.0,
            );
            let color = Vec3::new(0.5 + 0.5 * f.sin(), 0.5 + 0.5 * (f * 1.3).cos(), 0.6);
            let mut light = Light::point(position, 0.8 + (f * 0.37).fract() * 2.0, color);
            if i % 3 == 2 {
                light.shape = LightShape::Spot {
                    direction: Vec3::new((f * 0.9).cos(), -1.0, (f * 0.7).sin()).normalize(),
                    inner_angle: 0.2,
                    outer_angle: 0.4 + 0.1 * (f % 12.0),
                };
            }
            if i % 6 == 4 {
                let normal = Vec3::new(f.sin(), (f * 1.1).cos(), (f * 0.7).sin()).normalize();
                light.shape = LightShape::Vpl { normal, min_distance_m: 0.1 * (f % 5.0) };
            }
            light
        })
        .collect()
}

/// Two suns over the showcase, from the front and from the side.
pub(crate) fn suns() -> Suns {
    let sun = |direction: Vec3, irradiance| Sun { direction: direction.normalize(), irradiance };
    let suns = [
        sun(Vec3::new(-0.3, -1.0, -0.6), Vec3::new(0.9, 0.8, 0.6)),
        sun(Vec3::new(1.0, -0.4, 0.1), Vec3::new(0.1, 0.1, 0.3)),
    ];
    Suns::new(&suns).expect("two sound suns")
}
