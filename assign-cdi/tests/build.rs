//! Deep images against the geometry, and each way to build them against the others.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::Gpu;
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, DeepImagesSnapshot, Directions, Raster, Spread,
    Storage,
};
use glam::{UVec2, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::{Scene, distance, frame, room, settled, unit};

const SINGLE: Build = Build::SinglePass { oversampling: 1, raster: Raster::Compute };
const DRAWN: Build = Build::SinglePass { oversampling: 1, raster: Raster::Fragment };
const BRUTE: Build = Build::PerDirection { coverage: Coverage::Centres, at_once: 3 };
const TOUCHED: Build = Build::PerDirection { coverage: Coverage::Conservative, at_once: 32 };

fn settings(build: Build, storage: Storage) -> DeepImageSettings {
    DeepImageSettings {
        directions: Directions::new(Spread::Squares, 4, 8).unwrap(),
        size_px: 32,
        build,
        storage,
        ..Default::default()
    }
}

fn pixels(settings: &DeepImageSettings) -> impl Iterator<Item = (u32, UVec2)> {
    let size = settings.size_px;
    let all = move |d| (0..size * size).map(move |ix| (d, UVec2::new(ix % size, ix / size)));
    (0..settings.directions.count()).flat_map(all)
}

fn sorted(list: &[f32]) -> Vec<f32> {
    let mut list = list.to_vec();
    list.sort_unstable_by(f32::total_cmp);
    list
}

fn lists_of(snapshot: &DeepImagesSnapshot, settings: &DeepImageSettings) -> Vec<Vec<f32>> {
    pixels(settings).map(|(d, at)| snapshot.list(d, at).unwrap().to_vec()).collect()
}

/// Lists of a build, settled and without overflow.
fn lists(gpu: &Gpu, scene: &Scene, settings: DeepImageSettings) -> Vec<Vec<f32>> {
    let snapshot = settled(gpu, settings, scene).snapshot(gpu).unwrap();
    assert_eq!(snapshot.counters.is_overflowed, 0, "{settings:?}");
    assert_eq!(snapshot.counters.rejected_count, 0, "{settings:?}");
    let lists = lists_of(&snapshot, &settings);
    assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), snapshot.fragment_count());
    assert_eq!(snapshot.fragment_count(), snapshot.counters.fragment_count as usize);
    if settings.storage == Storage::Arrays {
        assert!(lists.iter().all(|list| list.is_sorted()), "{settings:?}");
        let longest = lists.iter().map(Vec::len).max().unwrap();
        assert_eq!(longest, snapshot.counters.longest as usize);
    }
    lists
}

/// Share of lists that are the same to within `by_m`.
fn alike(a: &[Vec<f32>], b: &[Vec<f32>], by_m: f32) -> f64 {
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
    // As many samples as cells of the triangles' largest shadows on the axes.
    let cell = f64::from(images.space().cell_m);
    let shadow = |[a, b, c]: [Vec3; 3]| {
        f64::from((b - a).cross(c - a).abs().max_element()) * 0.5 / (cell * cell)
    };
    let expected: f64 = scene.triangles.iter().map(|corners| shadow(*corners)).sum();
    let share = f64::from(counters.sample_count) / expected;
    assert!((0.97..1.03).contains(&share), "{share} of {expected}");
    // Every fragment is where its pixel's prism meets a triangle, give or take half a millimetre.
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
            assert!(near, "{direction} {pixel} {depth}");
        }
    }
}

#[test]
fn rasterisers_take_the_same_samples() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(2, 6, 100));
    let computed = lists(&gpu, &scene, settings(SINGLE, Storage::Arrays));
    let drawn = lists(&gpu, &scene, settings(DRAWN, Storage::Arrays));
    let counts = [&computed, &drawn].map(|all| all.iter().map(Vec::len).sum::<usize>() as f64);
    assert!((counts[0] / counts[1] - 1.0).abs() < 0.005, "{counts:?}");
    // Rasterisers may round corners to 1/256 of a cell, here of half a metre.
    let share = alike(&computed, &drawn, 0.005);
    assert!(share > 0.99, "{share} alike");
    // A check that tells scenes apart.
    let other = Scene::new(&gpu, room(3, 6, 100));
    let other = lists(&gpu, &other, settings(DRAWN, Storage::Arrays));
    let share = alike(&computed, &other, 0.005);
    assert!(share < 0.9, "{share} alike");
}

#[test]
fn linked_lists_hold_what_arrays_hold() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(4, 5, 50));
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        let arrays = lists(&gpu, &scene, settings(build, Storage::Arrays));
        let linked = lists(&gpu, &scene, settings(build, Storage::LinkedLists));
        let linked: Vec<Vec<f32>> = linked.iter().map(|list| sorted(list)).collect();
        // The kernels differ, and may round differently at the borders of pixels.
        assert!(alike(&arrays, &linked, 1e-4) > 0.999, "{build:?}");
        let counts = [&arrays, &linked].map(|all| all.iter().map(Vec::len).sum::<usize>());
        assert!(counts[0].abs_diff(counts[1]) * 1000 <= counts[0], "{build:?} {counts:?}");
    }
}

#[test]
fn one_direction_at_a_time_or_many() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(5, 5, 50));
    let of = |coverage, at_once| {
        lists(&gpu, &scene, settings(Build::PerDirection { coverage, at_once }, Storage::Arrays))
    };
    for coverage in [Coverage::Centres, Coverage::Conservative] {
        assert!(of(coverage, 1) == of(coverage, 32), "{coverage:?}");
        assert!(of(coverage, 1) == of(coverage, 5), "{coverage:?}");
    }
}

/// Rays along the directions, against all triangles: depths of the hits of each.
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
fn rays_through_centres_hit_what_is_stored() {
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
    assert!(f64::from(same) > 0.995 * f64::from(tried), "{same} of {tried}");
}

/// Share of hits of random rays that have a fragment in the ray's pixel within the stated distance.
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
    assert!(hits > 4000, "{hits}");
    f64::from(stored) / f64::from(hits)
}

#[test]
fn conservative_images_hold_every_hit() {
    let gpu = Gpu::open(None).unwrap();
    assert_eq!(share_of_hits_stored(&gpu, TOUCHED), 1.0);
    // Small triangles between the pixels' centres are missing.
    assert!(share_of_hits_stored(&gpu, BRUTE) < 0.999);
}

#[test]
fn finer_samples_leave_fewer_holes() {
    let gpu = Gpu::open(None).unwrap();
    let of = |oversampling| {
        let raster = Raster::Compute;
        share_of_hits_stored(&gpu, Build::SinglePass { oversampling, raster })
    };
    let (coarse, fine) = (of(1), of(2));
    assert!(coarse > 0.7 && coarse < fine && fine > 0.95, "{coarse} {fine}");
}

#[test]
fn what_does_not_fit_is_said_and_grows() {
    let gpu = Gpu::open(None).unwrap();
    // Many layers: more samples than are guessed.
    let mut triangles = Vec::new();
    for layer in 0..90 {
        let z = layer as f32 * 0.04;
        let at = |x: f32, y: f32| Vec3::new(x, y, z);
        triangles.push([at(-9.0, -9.0), at(9.0, -9.0), at(9.0, 9.0)]);
        triangles.push([at(-9.0, -9.0), at(9.0, 9.0), at(-9.0, 9.0)]);
    }
    let scene = Scene::new(&gpu, triangles);
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        for storage in [Storage::Arrays, Storage::LinkedLists] {
            let mut images = DeepImages::new(&gpu, settings(build, storage)).unwrap();
            frame(&gpu, &mut images, &scene);
            let first = images.snapshot(&gpu).unwrap().counters;
            assert_eq!(first.is_overflowed, 1, "{build:?} {storage:?} {first:?}");
            frame(&gpu, &mut images, &scene);
            let second = images.snapshot(&gpu).unwrap().counters;
            assert_eq!(second.is_overflowed, 0, "{build:?} {storage:?} {second:?}");
            assert!(second.fragment_count >= first.fragment_count);
            assert_eq!(images.stats().map(|stats| stats.is_overflowed), Some(1));
            // What is never to fit stays overflowed, and nothing fails.
            let tight = DeepImageSettings { most_fragments: 1000, ..settings(build, storage) };
            let tight = settled(&gpu, tight, &scene);
            assert_eq!(tight.snapshot(&gpu).unwrap().counters.is_overflowed, 1);
        }
    }
}

#[test]
fn longer_lists_than_are_sorted_say_nothing_until_they_are() {
    let gpu = Gpu::open(None).unwrap();
    // Eight thousand layers behind each other.
    let layer = |ix: u32| {
        let z = ix as f32 * 0.001;
        [Vec3::new(-1.0, -1.0, z), Vec3::new(9.0, -1.0, z), Vec3::new(-1.0, 9.0, z)]
    };
    let scene = Scene::new(&gpu, (0..8000).map(layer).collect());
    let settings = DeepImageSettings {
        directions: Directions::new(Spread::StacksAndSlices, 1, 1).unwrap(),
        size_px: 4,
        ..settings(SINGLE, Storage::Arrays)
    };
    let mut images = DeepImages::new(&gpu, settings).unwrap();
    frame(&gpu, &mut images, &scene);
    assert_eq!(images.is_complete(), None);
    let mut seen = Vec::new();
    for _ in 0..4 {
        frame(&gpu, &mut images, &scene);
        seen.extend(images.is_complete());
    }
    // Samples that overflow, then lists that are too long to be sorted, then all is well.
    assert_eq!(seen.first(), Some(&false), "{seen:?}");
    assert_eq!(seen.last(), Some(&true), "{seen:?}");
    let snapshot = images.snapshot(&gpu).unwrap();
    assert!(snapshot.counters.longest > 2048, "{:?}", snapshot.counters);
    assert!(lists_of(&snapshot, &settings).iter().all(|list| list.is_sorted()));
}

#[test]
fn triangles_outside_are_counted() {
    let gpu = Gpu::open(None).unwrap();
    let mut triangles = room(9, 2, 5);
    let scene = Scene::new(&gpu, triangles.clone());
    let good = scene.input().bounds_world;
    triangles.insert(3, [Vec3::splat(f32::NAN), Vec3::ZERO, Vec3::X]);
    triangles.insert(9, [Vec3::splat(1e4), Vec3::ZERO, Vec3::X]);
    triangles.insert(12, [Vec3::ZERO, Vec3::new(1.0, f32::INFINITY, 1.0), Vec3::X]);
    let odd = Scene::new(&gpu, triangles);
    for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
        let settings = settings(build, Storage::Arrays);
        let clean = lists(&gpu, &scene, settings);
        let mut images = DeepImages::new(&gpu, settings).unwrap();
        let mut input = odd.input();
        input.bounds_world = good;
        for _ in 0..2 {
            images.prepare(&gpu, &input).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            images.record(&mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            gpu.wait().unwrap();
        }
        let snapshot = images.snapshot(&gpu).unwrap();
        assert!(lists_of(&snapshot, &settings) == clean, "{build:?}");
        if build != DRAWN {
            assert_eq!(snapshot.counters.rejected_count, 3, "{build:?}");
        }
    }
}

#[test]
fn empty_and_flat_scenes() {
    let gpu = Gpu::open(None).unwrap();
    let flat = [Vec3::ZERO, Vec3::X, Vec3::X * 0.5];
    for triangles in [vec![], vec![flat], vec![[Vec3::ONE; 3]]] {
        let scene = Scene::new(&gpu, triangles);
        for build in [SINGLE, DRAWN, BRUTE, TOUCHED] {
            let settings = settings(build, Storage::Arrays);
            let mut images = DeepImages::new(&gpu, settings).unwrap();
            let mut input = scene.input();
            if input.count == 0 {
                input.bounds_world = (Vec3::ZERO, Vec3::ZERO);
            }
            images.prepare(&gpu, &input).unwrap();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            images.record(&mut assign::EncoderPasses { encoder: &mut encoder });
            gpu.queue.submit([encoder.finish()]);
            let snapshot = images.snapshot(&gpu).unwrap();
            assert_eq!(snapshot.counters.is_overflowed, 0);
            let is_empty = snapshot.fragment_count() == 0;
            // A line and a point touch pixels, and cover none.
            assert_eq!(is_empty, build != TOUCHED || input.count == 0, "{build:?}");
        }
    }
}

#[test]
fn faulty_input_is_named() {
    let gpu = Gpu::noop().unwrap();
    let refused = |change: &dyn Fn(&mut DeepImageSettings)| {
        let mut settings = settings(SINGLE, Storage::Arrays);
        change(&mut settings);
        DeepImages::new(&gpu, settings).unwrap_err().to_string()
    };
    assert_eq!(refused(&|s| s.size_px = 0), "size_px is 0: it must be 1 to 1024");
    assert_eq!(refused(&|s| s.size_px = 1025), "size_px is 1025: it must be 1 to 1024");
    let raster = Raster::Compute;
    let finer = |s: &mut DeepImageSettings| {
        s.build = Build::SinglePass { oversampling: 33, raster };
    };
    assert_eq!(refused(&finer), "oversampling is 33: it must be 1 to 32");
    let none = |s: &mut DeepImageSettings| {
        s.build = Build::PerDirection { coverage: Coverage::Centres, at_once: 0 };
    };
    assert_eq!(refused(&none), "at_once is 0: it must be 1 to 32");
    assert!(refused(&|s| s.most_fragments = 0).starts_with("most_fragments is 0"));
    let large = |s: &mut DeepImageSettings| {
        s.size_px = 1024;
        s.directions = Directions::new(Spread::Squares, 32, 32).unwrap();
    };
    assert!(refused(&large).starts_with("directions x size_px^2 is 1073741824"));

    let mut images = DeepImages::new(&gpu, settings(SINGLE, Storage::Arrays)).unwrap();
    let positions = gpu.storage("positions", 36).unwrap();
    let mut input = assign_cdi::Triangles {
        positions: &positions,
        count: 2,
        bounds_world: (Vec3::ZERO, Vec3::ONE),
    };
    let message = images.prepare(&gpu, &input).unwrap_err().to_string();
    assert_eq!(message, "positions is 36: it must be at least 72 bytes for 2 triangles");
    input.count = 1;
    for corner in [-Vec3::ONE, Vec3::splat(2e9), Vec3::new(0.0, f32::NAN, 0.0), Vec3::INFINITY] {
        input.bounds_world.1 = corner;
        let message = images.prepare(&gpu, &input).unwrap_err().to_string();
        assert!(message.starts_with("bounds_world is"), "{corner} {message}");
    }
    let _ = unit(&mut Pcg64Mcg::seed_from_u64(1));
}
