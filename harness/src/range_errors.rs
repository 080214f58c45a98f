//! Errors of the lengths of rays through deep images, against exact rays.

use assign::{EncoderPasses, Gpu};
use assign_cdi::{DeepImages, Primary, RangeCaster, RangePoints, RangeRule};
use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use scenes::CameraPath;
use shading::traced::TracedScene;

use crate::{error::HarnessError, results::RangeErrors};

/// Steps between two quantiles that are stored: every 20th of the rays.
const QUANTILES: usize = 20;

/// The distance from the surface at which exact rays start, as a share of a footprint.
const OFFSET: f64 = 1e-4;

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// World space, metres.
    pub position: Vec3,
    /// Of unit length, on the side from which the point is seen.
    pub normal: Vec3,
}

/// Places along the path from which rays look for points.
const PLACES: u32 = 16;

/// Points on surfaces that rays from the path meet, in directions drawn evenly over the sphere. Fewer than
/// `count` if most rays meet nothing.
pub fn seen_points(
    scene: &TracedScene<'_>,
    path: &CameraPath,
    count: usize,
    seed: u64,
) -> Vec<SurfacePoint> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut direction = || {
        let z = 2.0 * rng.random::<f64>() - 1.0;
        let (sin, cos) = (std::f64::consts::TAU * rng.random::<f64>()).sin_cos();
        let radius = (1.0 - z * z).max(0.0).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    };
    // Some rays meet nothing but sky.
    let rays: Vec<(DVec3, DVec3)> = (0..2 * count)
        .map(|ix| (path.pose(ix as u32 % PLACES, PLACES).eye.as_dvec3(), direction()))
        .collect();
    let met = |(eye, direction): &(DVec3, DVec3)| {
        let (distance, normal) = scene.surface(*eye, *direction)?;
        let position = (*eye + *direction * distance).as_vec3();
        Some(SurfacePoint { position, normal: normal.as_vec3().normalize() })
    };
    let all: Vec<SurfacePoint> = rays.par_iter().filter_map(met).collect();
    all.into_iter().take(count).collect()
}

/// Casts the rays of `rule` from points, through built deep images and exactly.
///
/// # Errors
///
/// The device fails.
pub fn range_errors(
    gpu: &Gpu,
    images: &DeepImages,
    scene: &TracedScene<'_>,
    points: &[SurfacePoint],
    rule: RangeRule,
) -> Result<RangeErrors, HarnessError> {
    let footprint_m = f64::from(images.space().footprint_m);
    // Each ray by itself: a point and a primary direction a ray.
    let single = RangeRule { rays: 1, primary: Primary::Given, ..rule };
    let all: Vec<(SurfacePoint, Vec3)> = points
        .iter()
        .flat_map(|point| (0..rule.rays).map(|ray| (*point, turned(rule.ray(ray), point.normal))))
        .collect();
    let found = lengths(gpu, images, single, &all)?;
    let exact: Vec<Option<f64>> = all
        .par_iter()
        .map(|(point, direction)| {
            let normal = point.normal.as_dvec3();
            let origin = point.position.as_dvec3() + normal * (OFFSET * footprint_m);
            scene.distance_m(origin, direction.as_dvec3().normalize())
        })
        .collect();
    let mut errors = Vec::new();
    let mut result = RangeErrors {
        rays: all.len() as u64,
        histogram: vec![0; RangeErrors::BINS.len() + 1],
        ..RangeErrors::default()
    };
    for (found, exact) in found.iter().zip(&exact) {
        let (Some(found), Some(exact)) = (found, exact) else {
            result.agree += u64::from(found.is_none() && exact.is_none());
            result.lost += u64::from(found.is_none() && exact.is_some());
            result.invented += u64::from(found.is_some() && exact.is_none());
            continue;
        };
        result.agree += 1;
        let error = (found - exact) / footprint_m;
        result.too_near += u64::from(error < -1.0);
        result.too_far += u64::from(error > 1.0);
        let bin = RangeErrors::BINS.iter().position(|high| error.abs() < *high);
        result.histogram[bin.unwrap_or(RangeErrors::BINS.len())] += 1;
        errors.push(error.abs());
    }
    errors.sort_by(f64::total_cmp);
    if let Some(last) = errors.len().checked_sub(1) {
        let at = |step: usize| errors[step * last / QUANTILES];
        result.error_quantiles = (0..=QUANTILES).map(at).collect();
    }
    let rays = rule.rays as usize;
    let mut ranges: Vec<f64> = found
        .chunks(rays)
        .zip(exact.chunks(rays))
        .filter_map(|(found, exact)| Some((mean(found)? - mean(exact)?).abs() / footprint_m))
        .collect();
    ranges.sort_by(f64::total_cmp);
    result.median_range_error = ranges.get(ranges.len() / 2).copied().unwrap_or(f64::NAN);
    Ok(result)
}

/// The mean of the rays that met something.
fn mean(lengths: &[Option<f64>]) -> Option<f64> {
    let met: Vec<f64> = lengths.iter().copied().flatten().collect();
    (!met.is_empty()).then(|| met.iter().sum::<f64>() / met.len() as f64)
}

/// A direction around +z turned to a normal, as the kernel turns it.
fn turned(local: Vec3, normal: Vec3) -> Vec3 {
    let (right, up) = normal.any_orthonormal_pair();
    right * local.x + up * local.y + normal * local.z
}

/// Lengths of rays through deep images, metres.
fn lengths(
    gpu: &Gpu,
    images: &DeepImages,
    rule: RangeRule,
    rays: &[(SurfacePoint, Vec3)],
) -> Result<Vec<Option<f64>>, HarnessError> {
    if rays.is_empty() {
        return Ok(Vec::new());
    }
    let upload = |label: &str, of: &dyn Fn(&(SurfacePoint, Vec3)) -> Vec3| {
        let data: Vec<[f32; 4]> = rays.iter().map(|ray| of(ray).extend(0.0).to_array()).collect();
        let buffer = gpu.storage(label, data.len() as u64 * 16)?;
        gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&data));
        Ok::<_, HarnessError>(buffer)
    };
    let ranges_m = gpu.storage("lengths of rays", rays.len() as u64 * 4)?;
    let mut caster = RangeCaster::new(gpu, images, rule)?;
    caster.prepare(
        gpu,
        &RangePoints {
            positions: &upload("points of rays", &|(point, _)| point.position)?,
            normals: &upload("normals of rays", &|(point, _)| point.normal)?,
            primaries: Some(&upload("directions of rays", &|(_, direction)| *direction)?),
            light_world: None,
            count: rays.len() as u32,
            ranges_m: &ranges_m,
        },
    )?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    caster.record(images, &mut EncoderPasses { encoder: &mut encoder })?;
    gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read(&ranges_m, rays.len() as u64 * 4)?;
    let lengths: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
    let finite = |length: f32| (length < f32::MAX).then_some(f64::from(length));
    Ok(lengths.into_iter().map(finite).collect())
}
