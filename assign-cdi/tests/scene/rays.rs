//! Rays through deep images and among triangles, and ranges of their origins.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
#![allow(dead_code, reason = "each test uses a part")]

use assign::{
    EncoderPasses, Gpu, Shader,
    conformance::{Bound, download, run_kernel},
    kernel::Slot,
};
use assign_cdi::{
    DeepImageSettings, DeepImages, Directions, RAY_CAST_WESL, RangeCaster, RangePoints, RangeRule,
    Spread,
};
use glam::{Vec3, Vec4};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::{Corners, distance, surface, unit};

/// The room's centre.
pub(crate) const MIDDLE: Vec3 = Vec3::new(1.0, 2.0, 3.0);

#[derive(Clone, Copy)]
pub(crate) struct Ray {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    pub(crate) normal: Vec3,
}

/// Lengths of rays. A kernel of this test casts them with the given module of ray casting.
pub(crate) fn cast_with(gpu: &Gpu, images: &DeepImages, rays: &[Ray], ray_cast: &str) -> Vec<f32> {
    let shader = DeepImages::mount(images.settings(), Shader::new(3), 0)
        .module("package::ray_cast", ray_cast.to_owned())
        .module("package::cast", include_str!("cast.wesl"));
    let module = shader.create(gpu, "package::cast").unwrap();
    let words: Vec<Vec4> = rays
        .iter()
        .flat_map(|ray| [ray.origin, ray.direction, ray.normal].map(|v| v.extend(0.0)))
        .collect();
    let input = upload(gpu, &words);
    let output = gpu.storage("lengths", rays.len() as u64 * 4).unwrap();
    let groups = [
        Bound::Group(images.layout(), images.bind_group().unwrap()),
        Bound::Buffers(&[(0, Slot::Read, &input), (1, Slot::Write, &output)]),
    ];
    run_kernel(gpu, &module, "cast_rays", &groups, (rays.len() as u32).div_ceil(64));
    download(gpu, &output, rays.len()).unwrap()
}

pub(crate) fn cast(gpu: &Gpu, images: &DeepImages, rays: &[Ray]) -> Vec<f32> {
    cast_with(gpu, images, rays, RAY_CAST_WESL)
}

pub(crate) fn upload<T: bytemuck::NoUninit>(gpu: &Gpu, words: &[T]) -> wgpu::Buffer {
    assign::conformance::upload(gpu, "words", words).unwrap()
}

/// Length of a ray by a test against all triangles. Hits within 0.1 mm belong to its own surface and do not count.
pub(crate) fn true_length(triangles: &[Corners], ray: &Ray) -> Option<f32> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let hits = triangles.iter().filter_map(|corners| distance(corners, origin, direction));
    let nearest = hits.filter(|at| *at > 1e-4).fold(f64::INFINITY, f64::min);
    nearest.is_finite().then_some(nearest as f32)
}

/// Rays from surfaces, up to 60 degrees from their normals.
pub(crate) fn rays_from_surfaces(triangles: &[Corners], count: usize, seed: u64) -> Vec<Ray> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut rays = Vec::new();
    while rays.len() < count {
        let (origin, normal) = surface(&mut rng, triangles, MIDDLE);
        let direction = unit(&mut rng);
        if direction.dot(normal) > 0.5 {
            rays.push(Ray { origin, direction, normal });
        }
    }
    rays
}

/// Settings with `count` directions, which must be a square number or twice one.
pub(crate) fn settings(count: u32, size_px: u32, spread: Spread) -> DeepImageSettings {
    let stacks = (1..=32).find(|n| count == n * n || count == 2 * n * n).unwrap();
    DeepImageSettings {
        directions: Directions::new(spread, stacks, count / stacks).unwrap(),
        size_px,
        ..Default::default()
    }
}

/// Position of the light that points reflect.
pub(crate) const LIGHT_WORLD: Vec3 = Vec3::new(30.0, 50.0, 20.0);

/// Ranges of the origins of rays. The directions of the rays are the primary directions.
pub(crate) fn ranges_of(gpu: &Gpu, images: &DeepImages, rays: &[Ray], rule: RangeRule) -> Vec<f32> {
    let words = |of: fn(&Ray) -> Vec3| -> Vec<Vec4> {
        rays.iter().map(|ray| of(ray).extend(7.0)).collect()
    };
    let (positions, normals) = (words(|ray| ray.origin), words(|ray| ray.normal));
    let (positions, normals) = (upload(gpu, &positions), upload(gpu, &normals));
    let primaries = upload(gpu, &words(|ray| ray.direction));
    let ranges_m = upload(gpu, &vec![-7.0_f32; rays.len()]);
    let mut caster = RangeCaster::new(gpu, images, rule).unwrap();
    let points = RangePoints {
        light_world: Some(LIGHT_WORLD),
        positions: &positions,
        normals: &normals,
        primaries: Some(&primaries),
        count: rays.len() as u32,
        ranges_m: &ranges_m,
    };
    caster.prepare(gpu, &points).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    caster.record(images, &mut EncoderPasses { encoder: &mut encoder }).unwrap();
    gpu.queue.submit([encoder.finish()]);
    download(gpu, &ranges_m, rays.len()).unwrap()
}
