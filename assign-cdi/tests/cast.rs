//! Rays through deep images against rays among triangles.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::{EncoderPasses, Gpu, Shader, entry, storage_entry};
use assign_cdi::{
    Build, Combine, DeepImageSettings, DeepImages, Directions, Primary, RAY_CAST_WESL,
    RandomRanges, Raster, RangeCaster, RangePoints, RangeRule, Spread, Storage, Threads,
};
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{Mat3, Vec3, Vec4};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::{Corners, Scene, distance, frame, room, settled, surface, unit};

/// The room's centre.
const MIDDLE: Vec3 = Vec3::new(1.0, 2.0, 3.0);
const UNKNOWN: f32 = -2.0;

#[derive(Clone, Copy)]
struct Ray {
    origin: Vec3,
    direction: Vec3,
    normal: Vec3,
}

/// Lengths of rays, by a kernel of the test's own around the given module of ray casting.
fn cast_with(gpu: &Gpu, images: &DeepImages, rays: &[Ray], ray_cast: &str) -> Vec<f32> {
    let shader = DeepImages::mount(images.settings(), Shader::new(3), 0)
        .module("package::ray_cast", ray_cast.to_owned())
        .module("package::cast", include_str!("scene/cast.wesl"));
    let module = shader.create(&gpu.device, "package::cast").unwrap();
    let stages = wgpu::ShaderStages::COMPUTE;
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[storage_entry(0, stages, true), storage_entry(1, stages, false)],
    });
    let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(images.layout()), Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("cast_rays"),
        compilation_options: Default::default(),
        cache: None,
    });
    let words: Vec<Vec4> = rays
        .iter()
        .flat_map(|ray| [ray.origin, ray.direction, ray.normal].map(|v| v.extend(0.0)))
        .collect();
    let input = upload(gpu, &words);
    let output = gpu.storage("lengths", rays.len() as u64 * 4).unwrap();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[entry(0, &input), entry(1, &output)],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, images.bind_group().unwrap(), &[]);
        pass.set_bind_group(1, &group, &[]);
        pass.dispatch_workgroups((rays.len() as u32).div_ceil(64), 1, 1);
    }
    gpu.queue.submit([encoder.finish()]);
    pod_collect_to_vec(&gpu.read(&output, rays.len() as u64 * 4).unwrap())
}

fn cast(gpu: &Gpu, images: &DeepImages, rays: &[Ray]) -> Vec<f32> {
    cast_with(gpu, images, rays, RAY_CAST_WESL)
}

fn upload<T: bytemuck::NoUninit>(gpu: &Gpu, words: &[T]) -> wgpu::Buffer {
    let bytes: &[u8] = cast_slice(words);
    let buffer = gpu.storage("words", bytes.len() as u64).unwrap();
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// Length of a ray among triangles, beyond 0.1 mm: of that of its own surface.
fn true_length(triangles: &[Corners], ray: &Ray) -> Option<f32> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let hits = triangles.iter().filter_map(|corners| distance(corners, origin, direction));
    let nearest = hits.filter(|at| *at > 1e-4).fold(f64::INFINITY, f64::min);
    nearest.is_finite().then_some(nearest as f32)
}

/// Rays from surfaces, up to 60 degrees from their normals.
fn rays_from_surfaces(triangles: &[Corners], count: usize, seed: u64) -> Vec<Ray> {
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

fn settings(count: u32, size_px: u32, spread: Spread) -> DeepImageSettings {
    DeepImageSettings {
        directions: Directions::of_count(spread, count).unwrap(),
        size_px,
        ..Default::default()
    }
}

/// Median and mean error of rays that hit, metres, with rays that should hit and do not at the
/// room's size; and the footprint.
struct Errors {
    median_m: f32,
    mean_m: f32,
    footprint_m: f32,
}

fn errors(scene: &Scene, images: &DeepImages, rays: &[Ray], lengths: &[f32]) -> Errors {
    let mut errors: Vec<f32> = rays
        .iter()
        .zip(lengths)
        .filter_map(|(ray, length)| {
            let truth = true_length(&scene.triangles, ray)?;
            Some(if *length < 0.0 { 10.0 } else { (length - truth).abs() })
        })
        .collect();
    errors.sort_unstable_by(f32::total_cmp);
    Errors {
        median_m: errors[errors.len() / 2],
        mean_m: errors.iter().sum::<f32>() / errors.len() as f32,
        footprint_m: images.space().footprint_m,
    }
}

#[test]
#[ignore = "prints what choices were made by"]
fn study() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(11, 12, 100));
    let rays = rays_from_surfaces(&scene.triangles, 4000, 12);
    for spread in [Spread::StacksAndSlices, Spread::Squares] {
        for (count, size) in [(8, 64), (32, 64), (169, 16), (169, 64), (169, 128), (1024, 128)] {
            let images = settled(&gpu, settings(count, size, spread), &scene);
            for reach in ["0.0", "0.25", "0.5", "0.7072", "1.0", "1.5"] {
                let changed = RAY_CAST_WESL
                    .replace("PIXEL_REACH: f32 = 0.7072", &format!("PIXEL_REACH: f32 = {reach}"));
                let e = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &changed));
                println!(
                    "{spread:?} {count} {size} reach {reach}: median {:.3} mean {:.3} footprint {:.3}",
                    e.median_m, e.mean_m, e.footprint_m
                );
            }
        }
    }
    for (oversampling, count) in [(1, 169), (2, 169), (4, 169)] {
        let build = Build::SinglePass { oversampling, raster: Raster::Compute };
        let settings = DeepImageSettings { build, ..settings(count, 64, Spread::Squares) };
        let images = settled(&gpu, settings, &scene);
        let e = errors(&scene, &images, &rays, &cast(&gpu, &images, &rays));
        println!("oversampling {oversampling}: median {:.3} mean {:.3}", e.median_m, e.mean_m);
    }
}
