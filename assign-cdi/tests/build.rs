//! Compares deep images with the geometry, and each way to build them with the others.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod builds;
mod scene;

use assign::Gpu;
use assign_cdi::{Build, Coverage, DeepImages, Raster, Storage};
use builds::{BRUTE, DRAWN, SINGLE, TOUCHED, lists, pixels, settings};
use glam::Vec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::{Scene, distance, room, settled};

fn sorted(list: &[f32]) -> Vec<f32> {
    let mut list = list.to_vec();
    list.sort_unstable_by(f32::total_cmp);
    list
}

/// Share of pairs of lists that differ by less than `by_m`.
fn equal_share(a: &[Vec<f32>], b: &[Vec<f32>], by_m: f32) -> f64 {
    let same = |(a, b): (&Vec<f32>, &Vec<f32>)| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < by_m)
    };
    a.iter().zip(b).filter(|pair| same(*pair)).count() as f64 / a.len() as f64
}

#[test]
fn samples_lie_on_triangles_and_cover_them() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(1, 5, 60));
    let settings = settings(SINGLE, Storage::Arrays);
    let images = settled(&gpu, settings, &scene);
    let snapshot = images.snapshot(&gpu).unwrap();
    let counters = snapshot.counters;
    assert_eq!(counters.sample_count * settings.directions.count(), counters.fragment_count);
    // There are as many samples as cells in the triangles' shadows along their dominant axes.
    let cell = f64::from(images.space().cell_m);
    let shadow = |[a, b, c]: [Vec3; 3]| {
        f64::from((b - a).cross(c - a).abs().max_element()) * 0.5 / (cell * cell)
    };
    let expected: f64 = scene.triangles.iter().map(|corners| shadow(*corners)).sum();
    let share = f64::from(counters.sample_count) / expected;
    assert!((0.97..1.03).contains(&share), "{share} of {expected} samples");
    // Every fragment lies where its pixel's prism meets a triangle, within half a millimetre.
    let all = pixels(&settings).step_by(97);
    for (direction, pixel) in all {
        for &depth in snapshot.list(direction, pixel).unwrap() {
            let at = pixel.as_vec2() + 0.5;
            let footprint = images.space().footprint_m;
            let axes = settings.directions.frame(direction);
            let place = (at * footprint).extend(depth) - images.space().radius_m;
            let point = axes * place + Vec3::from(images.space().centre_world);
            let near = scene.triangles.iter().any(|[a, b, c]| {
                let normal = (b - a).cross(c - a).normalize();
                let image_normal = axes.transpose() * normal;
                let reach = 0.7072 * footprint * image_normal.truncate().length();
                (point - a).dot(normal).abs() < reach + 5e-4
            });
            assert!(near, "direction {direction}, pixel {pixel}: no triangle at depth {depth}");
        }
    }
}

#[test]
fn compute_and_rasteriser_take_the_same_samples() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(2, 6, 100));
    let computed = lists(&gpu, &scene, settings(SINGLE, Storage::Arrays));
    let drawn = lists(&gpu, &scene, settings(DRAWN, Storage::Arrays));
    let counts = [&computed, &drawn].map(|all| all.iter().map(Vec::len).sum::<usize>() as f64);
    assert!((counts[0] / counts[1] - 1.0).abs() < 0.005, "{counts:?}");
    // Rasterisers may round corners to 1/256 of a cell, which is half a metre wide here.
    let share = equal_share(&computed, &drawn, 0.005);
    assert!(share > 0.99, "{share} of the lists are equal");
    // Negative control: another scene differs.
    let other = Scene::new(&gpu, room(3, 6, 100));
    let other = lists(&gpu, &other, settings(DRAWN, Storage::Arrays));
    let share = equal_share(&computed, &other, 0.005);
    assert!(share < 0.9, "{share} of the lists are equal");
}

#[test]
fn linked_lists_hold_what_arrays_hold() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(4, 5, 50));
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        let arrays = lists(&gpu, &scene, settings(build, Storage::Arrays));
        let linked = lists(&gpu, &scene, settings(build, Storage::LinkedLists));
        let linked: Vec<Vec<f32>> = linked.iter().map(|list| sorted(list)).collect();
        // The kernels differ, so they may round differently at the borders of pixels.
        assert!(equal_share(&arrays, &linked, 1e-4) > 0.999, "{build:?}");
        let counts = [&arrays, &linked].map(|all| all.iter().map(Vec::len).sum::<usize>());
        assert!(counts[0].abs_diff(counts[1]) * 1000 <= counts[0], "{build:?} {counts:?}");
    }
}

#[test]
fn directions_per_dispatch_do_not_change_lists() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(5, 5, 50));
    let lists_with = |coverage, at_once| {
        lists(&gpu, &scene, settings(Build::PerDirection { coverage, at_once }, Storage::Arrays))
    };
    for coverage in [Coverage::Centres, Coverage::Conservative] {
        assert!(lists_with(coverage, 1) == lists_with(coverage, 32), "{coverage:?}");
        assert!(lists_with(coverage, 1) == lists_with(coverage, 5), "{coverage:?}");
    }
}

/// Depth and triangle of every hit of a ray along a stored direction, by a test against all triangles.
fn true_depths(
    images: &DeepImages,
    scene: &Scene,
    direction: u32,
    at: glam::Vec2,
) -> Vec<(f64, usize)> {
    let axes = images.settings().directions.frame(direction);
    let from_centre = (at * images.space().footprint_m).extend(0.0) - images.space().radius_m;
    let origin = (axes * from_centre + Vec3::from(images.space().centre_world)).as_dvec3();
    let ahead = axes.z_axis.as_dvec3();
    let hit = |(ix, corners)| distance(corners, origin, ahead).map(|depth| (depth, ix));
    scene.triangles.iter().enumerate().filter_map(hit).collect()
}

#[test]
fn rays_through_pixel_centres_hit_the_stored_depths() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(6, 6, 100));
    let settings = settings(BRUTE, Storage::Arrays);
    let images = settled(&gpu, settings, &scene);
    let snapshot = images.snapshot(&gpu).unwrap();
    let (mut same, mut tried) = (0, 0);
    for (direction, pixel) in pixels(&settings).step_by(7) {
        let mut depths = true_depths(&images, &scene, direction, pixel.as_vec2() + 0.5);
        depths.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let list = snapshot.list(direction, pixel).unwrap();
        let is_same = list.len() == depths.len()
            && list.iter().zip(&depths).all(|(a, (b, _))| (f64::from(*a) - b).abs() < 2e-3);
        same += u32::from(is_same);
        tried += 1;
    }
    assert!(f64::from(same) > 0.995 * f64::from(tried), "{same} of {tried} lists are the ray's");
}

/// Share of hits of random rays that have a fragment in the ray's pixel within the documented distance.
fn share_of_hits_stored(gpu: &Gpu, build: Build) -> f64 {
    let scene = Scene::new(gpu, room(7, 6, 300));
    let settings = settings(build, Storage::Arrays);
    let images = settled(gpu, settings, &scene);
    let snapshot = images.snapshot(gpu).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(8);
    let (mut stored, mut hits) = (0_u32, 0_u32);
    for _ in 0..4000 {
        let direction = rng.random_range(0..settings.directions.count());
        let at = glam::Vec2::from([0; 2].map(|_| rng.random_range(3.0_f32..29.0)));
        let axes = settings.directions.frame(direction);
        for (depth, ix) in true_depths(&images, &scene, direction, at) {
            let [a, b, c] = scene.triangles[ix].map(|corner| axes.transpose() * corner);
            let normal = (b - a).cross(c - a);
            let slope = normal.truncate().length() / normal.z.abs();
            let bound = 0.708 * slope * images.space().footprint_m + 1e-3;
            let list = snapshot.list(direction, at.as_uvec2()).unwrap();
            let is_near = |&d: &f32| (f64::from(d) - depth).abs() <= f64::from(bound);
            stored += u32::from(list.iter().any(is_near));
            hits += 1;
        }
    }
    assert!(hits > 4000, "only {hits} hits");
    f64::from(stored) / f64::from(hits)
}

#[test]
fn conservative_images_hold_every_hit() {
    let gpu = Gpu::open(None).unwrap();
    assert_eq!(share_of_hits_stored(&gpu, TOUCHED), 1.0);
    // Without conservative coverage, small triangles between pixel centres are missing.
    assert!(share_of_hits_stored(&gpu, BRUTE) < 0.999);
}

#[test]
fn finer_samples_leave_fewer_holes() {
    let gpu = Gpu::open(None).unwrap();
    let share = |oversampling| {
        let raster = Raster::Compute;
        share_of_hits_stored(&gpu, Build::SinglePass { oversampling, raster })
    };
    let (coarse, fine) = (share(1), share(2));
    assert!(
        coarse > 0.7 && coarse < fine && fine > 0.95,
        "share of hits stored: {coarse} with 1 sample per pixel width, {fine} with 2"
    );
}
