//! A scene to cast rays in, true hits by brute force, and frames of deep images.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
#![allow(dead_code, reason = "each test uses a part")]

pub(crate) mod rays;

use assign::{EncoderPasses, Gpu};
use assign_cdi::{DeepImageSettings, DeepImages, Triangles};
use glam::{DVec3, Mat3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub(crate) type Corners = [Vec3; 3];

/// A room of 10 x 6 x 8 m with boxes in it and small loose triangles in the air.
pub(crate) fn room(seed: u64, boxes: u32, loose: u32) -> Vec<Corners> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let half = Vec3::new(5.0, 3.0, 4.0);
    let mut triangles = cuboid(Vec3::new(1.0, 2.0, 3.0), half, Mat3::IDENTITY);
    let mut at = |scale: f32| {
        Vec3::from_array([0; 3].map(|_| rng.random_range(-1.0_f32..1.0))) * scale * half
            + Vec3::new(1.0, 2.0, 3.0)
    };
    for ix in 0..boxes {
        let turn = Mat3::from_rotation_y(ix as f32) * Mat3::from_rotation_x(0.3 * ix as f32);
        let size = Vec3::new(0.3, 0.5, 0.2) * (1.0 + (ix % 3) as f32);
        triangles.extend(cuboid(at(0.6), size, turn));
    }
    for _ in 0..loose {
        let a = at(0.9);
        triangles.push([a, a + 0.05 * (at(1.0) - a), a + 0.05 * (at(1.0) - a)]);
    }
    triangles
}

fn cuboid(centre: Vec3, half: Vec3, turn: Mat3) -> Vec<Corners> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut at = Vec3::ZERO;
                at[axis] = side * half[axis];
                at[(axis + 1) % 3] = u * half[(axis + 1) % 3];
                at[(axis + 2) % 3] = v * half[(axis + 2) % 3];
                centre + turn * at
            };
            let [a, b, c, d] =
                [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

pub(crate) fn bounds(triangles: &[Corners]) -> (Vec3, Vec3) {
    let all = || triangles.iter().flatten();
    (
        all().fold(Vec3::INFINITY, |low, at| low.min(*at)),
        all().fold(Vec3::NEG_INFINITY, |high, at| high.max(*at)),
    )
}

/// Distance from a ray's origin to a triangle, if the ray hits it at more than 0.
pub(crate) fn distance(corners: &Corners, origin: DVec3, direction: DVec3) -> Option<f64> {
    let [a, b, c] = corners.map(|at| at.as_dvec3() - origin);
    let normal = (b - a).cross(c - a);
    let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|across| direction.dot(across));
    let is_inside = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
    let at = normal.dot(a) / normal.dot(direction);
    (is_inside && at > 0.0).then_some(at)
}

pub(crate) fn unit(rng: &mut Pcg64Mcg) -> Vec3 {
    loop {
        let at = Vec3::from_array([0; 3].map(|_| rng.random_range(-1.0..1.0)));
        if (0.01..1.0).contains(&at.length()) {
            return at.normalize();
        }
    }
}

/// A random point on the triangles, and the normal on the side of `towards`.
pub(crate) fn surface(rng: &mut Pcg64Mcg, triangles: &[Corners], towards: Vec3) -> (Vec3, Vec3) {
    let [a, b, c] = triangles[rng.random_range(0..triangles.len())];
    let (mut u, mut v) = (rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let at: Vec3 = a + u * (b - a) + v * (c - a);
    let normal = (b - a).cross(c - a).normalize();
    (at, if normal.dot(towards - at) < 0.0 { -normal } else { normal })
}

pub(crate) struct Scene {
    pub(crate) triangles: Vec<Corners>,
    pub(crate) positions: wgpu::Buffer,
}

impl Scene {
    pub(crate) fn new(gpu: &Gpu, triangles: Vec<Corners>) -> Self {
        let positions = gpu.storage("positions", triangles.len() as u64 * 36).unwrap();
        gpu.queue.write_buffer(&positions, 0, bytemuck::cast_slice(&triangles));
        Self { triangles, positions }
    }

    pub(crate) fn input(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            count: self.triangles.len() as u32,
            bounds_world: bounds(&self.triangles),
        }
    }
}

pub(crate) fn frame(gpu: &Gpu, images: &mut DeepImages, scene: &Scene) {
    images.prepare(gpu, &scene.input()).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    images.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    gpu.wait().unwrap();
}

/// Deep images after two frames, when buffers have grown to their size.
pub(crate) fn settled(gpu: &Gpu, settings: DeepImageSettings, scene: &Scene) -> DeepImages {
    let mut images = DeepImages::new(gpu, settings).unwrap();
    frame(gpu, &mut images, scene);
    frame(gpu, &mut images, scene);
    images
}
