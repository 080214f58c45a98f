//! Compares rays through deep images with rays against all triangles.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::Gpu;
use assign_cdi::{DeepImageSettings, DeepImages, RAY_CAST_WESL, RangeRule, Spread, Storage};
use glam::Vec3;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scene::{
    Scene, frame,
    rays::{MIDDLE, Ray, cast, cast_with, ranges_of, rays_from_surfaces, settings, true_length},
    room, settled, unit,
};

/// The length of rays through images that overflowed: `UNKNOWN` of `ray_cast.wesl`.
const UNKNOWN: f32 = -2.0;

/// Median and mean error of the rays that truly hit, and the footprint, metres. A ray that hits nothing in the
/// images counts as 10 m off, the size of the room.
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
fn rays_along_stored_directions_are_off_by_less_than_a_pixel() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(10, 8, 0));
    let settings = settings(32, 64, Spread::StacksAndSlices);
    let images = settled(&gpu, settings, &scene);
    let mut rng = Pcg64Mcg::seed_from_u64(11);
    let rays: Vec<Ray> = (0..2000)
        .map(|ix| {
            let direction = settings.directions.direction(ix % 32);
            let sign = if ix % 64 < 32 { 1.0 } else { -1.0 };
            let origin = MIDDLE + unit(&mut rng) * 2.0;
            Ray { origin, direction: sign * direction, normal: Vec3::ZERO }
        })
        .collect();
    let all = errors(&scene, &images, &rays, &cast(&gpu, &images, &rays));
    assert!(all.median_m < 0.5 * all.footprint_m, "{} m", all.median_m);
    // Negative control: rays read the list of another pixel.
    let wrong = RAY_CAST_WESL.replace("vec2u(at))", "vec2u(at) ^ vec2u(7u))");
    assert_ne!(wrong, RAY_CAST_WESL);
    let wrong = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &wrong));
    assert!(wrong.median_m > 2.0 * all.median_m, "{} m", wrong.median_m);
    assert!(wrong.median_m > 0.5 * all.footprint_m, "{} m", wrong.median_m);
    // Negative control: rays run the opposite way.
    let wrong = RAY_CAST_WESL.replace("sign > 0.0", "sign < 0.0");
    assert_ne!(wrong, RAY_CAST_WESL);
    let wrong = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &wrong));
    assert!(wrong.mean_m > 2.0 * all.mean_m, "{} m", wrong.mean_m);
}

/// Errors of rays from surfaces through images of these settings.
fn errors_of(gpu: &Gpu, scene: &Scene, rays: &[Ray], settings: DeepImageSettings) -> Errors {
    let images = settled(gpu, settings, scene);
    errors(scene, &images, rays, &cast(gpu, &images, rays))
}

#[test]
fn errors_fall_with_directions_and_pixels() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(11, 12, 100));
    let rays = rays_from_surfaces(&scene.triangles, 2000, 12);
    for spread in [Spread::StacksAndSlices, Spread::Squares] {
        let errors_with =
            |count, size| errors_of(&gpu, &scene, &rays, settings(count, size, spread));
        let full = errors_with(169, 64);
        let (few, coarse) = (errors_with(8, 64), errors_with(169, 16));
        assert!(full.median_m < full.footprint_m, "{spread:?} {} m", full.median_m);
        assert!(few.median_m > 2.0 * full.median_m, "{spread:?} {} m", few.median_m);
        assert!(coarse.median_m > 2.0 * full.median_m, "{spread:?} {} m", coarse.median_m);
        assert!(few.mean_m > 1.3 * full.mean_m, "{spread:?} {} m", few.mean_m);
        assert!(coarse.mean_m > 1.3 * full.mean_m, "{spread:?} {} m", coarse.mean_m);
    }
}

#[test]
fn a_second_look_up_halves_the_median_error() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(15, 12, 0));
    let rays = rays_from_surfaces(&scene.triangles, 2000, 16);
    let twice = RAY_CAST_WESL
        .replace("fn cast_ray(", "fn cast_once(")
        .replace("= cast_ray(", "= cast_once(")
        .replace("fn cast_corrected_ray(", "fn cast_ray(");
    for storage in [Storage::Arrays, Storage::LinkedLists] {
        let settings = DeepImageSettings { storage, ..settings(32, 128, Spread::Squares) };
        let images = settled(&gpu, settings, &scene);
        let once = errors(&scene, &images, &rays, &cast(&gpu, &images, &rays));
        let twice = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &twice));
        let (a, b) = (once.median_m, twice.median_m);
        assert!(b < 0.5 * a, "{storage:?}: {a} m, corrected {b} m");
        assert!(twice.mean_m < once.mean_m, "{storage:?}");
    }
}

#[test]
fn rays_skip_the_surface_of_their_origin() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(13, 0, 0));
    let images = settled(&gpu, settings(64, 64, Spread::Squares), &scene);
    let mut rays = rays_from_surfaces(&scene.triangles, 1000, 14);
    // Away from the room's edges, a hit within two pixel widths is the origin's own wall.
    rays.retain(|ray| true_length(&scene.triangles, ray).is_some_and(|length| length > 2.0));
    let is_early = |length: &&f32| (0.0..2.0 * images.space().footprint_m).contains(*length);
    let share =
        |lengths: &[f32]| lengths.iter().filter(is_early).count() as f64 / lengths.len() as f64;
    let kept = share(&cast(&gpu, &images, &rays));
    let unguarded = RAY_CAST_WESL.replace("PIXEL_REACH * tilt", "-9.0 * tilt");
    assert_ne!(unguarded, RAY_CAST_WESL);
    let unguarded = share(&cast_with(&gpu, &images, &rays, &unguarded));
    assert!(kept < 0.01, "{kept} of the rays hit their own wall");
    assert!(unguarded > 0.1, "without the guard only {unguarded} of the rays hit their own wall");
    // Rays into the surface hit nothing.
    let into: Vec<Ray> = rays.iter().map(|ray| Ray { direction: -ray.normal, ..*ray }).collect();
    assert!(cast(&gpu, &images, &into).iter().all(|length| *length == -1.0));
}

#[test]
fn linked_lists_give_the_same_lengths() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(15, 8, 50));
    let rays = rays_from_surfaces(&scene.triangles, 2000, 16);
    let arrays = settings(32, 32, Spread::Squares);
    let linked = DeepImageSettings { storage: Storage::LinkedLists, ..arrays };
    let [lengths, linked] =
        [arrays, linked].map(|settings| cast(&gpu, &settled(&gpu, settings, &scene), &rays));
    let differing = lengths.iter().zip(&linked).filter(|(a, b)| (*a - *b).abs() > 1e-4).count();
    // The kernels differ, so they may round differently at the borders of pixels.
    assert!(differing <= 4, "{differing} of 2000 rays differ");
    assert!(lengths.iter().filter(|length| **length > 0.0).count() > 1000);
}

#[test]
fn rays_through_images_that_overflowed_are_unknown() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(17, 3, 0));
    let rays = rays_from_surfaces(&scene.triangles, 100, 18);
    for storage in [Storage::Arrays, Storage::LinkedLists] {
        let settings = DeepImageSettings {
            storage,
            most_fragments: 2000,
            ..settings(16, 32, Spread::Squares)
        };
        let mut images = DeepImages::new(&gpu, settings).unwrap();
        frame(&gpu, &mut images, &scene);
        assert!(cast(&gpu, &images, &rays).iter().all(|length| *length == UNKNOWN));
        let ranges = ranges_of(&gpu, &images, &rays, RangeRule::default());
        assert!(ranges.iter().all(|range| *range == f32::MAX));
    }
}

#[test]
fn odd_rays_hit_nothing() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(19, 3, 0));
    let images = settled(&gpu, settings(16, 32, Spread::StacksAndSlices), &scene);
    let nan = Vec3::splat(f32::NAN);
    let outside = Vec3::splat(1e3);
    let ray = |origin, direction, normal| Ray { origin, direction, normal };
    let rays = [
        ray(nan, Vec3::Z, Vec3::Z),
        ray(MIDDLE, Vec3::Z, nan),
        ray(outside, Vec3::Z, Vec3::Z),
        ray(Vec3::INFINITY, Vec3::Z, Vec3::Z),
        ray(MIDDLE, nan, Vec3::Z),
        ray(MIDDLE, Vec3::ZERO, Vec3::Z),
    ];
    let lengths = cast(&gpu, &images, &rays);
    assert!(lengths[..4].iter().all(|length| *length == -1.0), "{lengths:?}");
    // The kernel of ranges ignores such rays.
    let ranges = ranges_of(&gpu, &images, &rays, RangeRule::default());
    assert_eq!(ranges[0], f32::MAX);
    assert_eq!(ranges[1], f32::MAX);
    assert_eq!(ranges[2], f32::MAX);
    assert_eq!(ranges[3], f32::MAX);
}

/// The shader and Rust find the same directions, except for rounding at the borders of cells.
#[test]
fn shader_and_rust_find_the_same_directions() {
    let gpu = Gpu::open(None).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(23);
    let rays: Vec<Ray> = (0..5000)
        .map(|_| Ray { origin: MIDDLE, direction: unit(&mut rng), normal: Vec3::ZERO })
        .collect();
    let scene = Scene::new(&gpu, room(24, 0, 0));
    // The changed shader returns the direction's index and sign instead of a length.
    let body = "let nearest = nearest_direction(direction);";
    let replacement = format!(
        "{body}\n  if nearest.ix >= 0u {{ return (f32(nearest.ix) + 1.0) * nearest.sign; }}"
    );
    let changed = RAY_CAST_WESL.replace(body, &replacement);
    assert_ne!(changed, RAY_CAST_WESL);
    for spread in [Spread::StacksAndSlices, Spread::Squares] {
        for count in [8, 32, 169] {
            let settings = settings(count, 8, spread);
            let images = settled(&gpu, settings, &scene);
            let found = cast_with(&gpu, &images, &rays, &changed);
            let differing = rays.iter().zip(found).filter(|(ray, found)| {
                let (ix, is_reversed) = settings.directions.nearest(ray.direction);
                *found != (ix as f32 + 1.0) * if is_reversed { -1.0 } else { 1.0 }
            });
            let differing = differing.count();
            assert!(differing <= 25, "{spread:?}, {count} directions: {differing} of 5000 differ");
        }
    }
}
