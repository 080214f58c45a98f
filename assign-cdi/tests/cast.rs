//! Rays through deep images against rays among triangles.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::{EncoderPasses, Gpu, Shader, entry, storage_entry};
use assign_cdi::{
    Combine, DeepImageSettings, DeepImages, Directions, Primary, RAY_CAST_WESL, RandomRanges,
    RangeCaster, RangePoints, RangeRule, Spread, Storage, Threads,
};
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{Mat3, Vec3, Vec4};
use rand::SeedableRng;
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

/// Median and mean error of rays that hit in truth, metres, and the footprint. A ray that hits
/// nothing in the images counts as 10 m off: the room's size.
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
fn rays_along_stored_directions_are_exact_to_a_pixel() {
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
    // A pixel that is not the ray's.
    let wrong = RAY_CAST_WESL.replace("vec2u(at))", "vec2u(at) ^ vec2u(7u))");
    assert_ne!(wrong, RAY_CAST_WESL);
    let wrong = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &wrong));
    assert!(wrong.median_m > 2.0 * all.median_m, "{} m", wrong.median_m);
    assert!(wrong.median_m > 0.5 * all.footprint_m, "{} m", wrong.median_m);
    // The opposite way.
    let wrong = RAY_CAST_WESL.replace("sign > 0.0", "sign < 0.0");
    assert_ne!(wrong, RAY_CAST_WESL);
    let wrong = errors(&scene, &images, &rays, &cast_with(&gpu, &images, &rays, &wrong));
    assert!(wrong.mean_m > 2.0 * all.mean_m, "{} m", wrong.mean_m);
}

/// Errors of rays from surfaces, with given directions and pixels.
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
        let of = |count, size| errors_of(&gpu, &scene, &rays, settings(count, size, spread));
        let (full, few, coarse) = (of(169, 64), of(8, 64), of(169, 16));
        assert!(full.median_m < full.footprint_m, "{spread:?} {} m", full.median_m);
        assert!(few.median_m > 2.0 * full.median_m, "{spread:?} {} m", few.median_m);
        assert!(coarse.median_m > 2.0 * full.median_m, "{spread:?} {} m", coarse.median_m);
        assert!(few.mean_m > 1.3 * full.mean_m, "{spread:?} {} m", few.mean_m);
        assert!(coarse.mean_m > 1.3 * full.mean_m, "{spread:?} {} m", coarse.mean_m);
    }
}

#[test]
fn the_origins_surface_is_passed_over() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(13, 0, 0));
    let images = settled(&gpu, settings(64, 64, Spread::Squares), &scene);
    let mut rays = rays_from_surfaces(&scene.triangles, 1000, 14);
    // Away from the room's edges, a hit within two pixels' widths is the origin's own wall.
    rays.retain(|ray| true_length(&scene.triangles, ray).is_some_and(|length| length > 2.0));
    let is_early = |length: &&f32| (0.0..2.0 * images.space().footprint_m).contains(*length);
    let share =
        |lengths: &[f32]| lengths.iter().filter(is_early).count() as f64 / lengths.len() as f64;
    let kept = share(&cast(&gpu, &images, &rays));
    let unguarded = RAY_CAST_WESL.replace("PIXEL_REACH * tilt", "-9.0 * tilt");
    assert_ne!(unguarded, RAY_CAST_WESL);
    let unguarded = share(&cast_with(&gpu, &images, &rays, &unguarded));
    assert!(kept < 0.01, "{kept}");
    assert!(unguarded > 0.1, "{unguarded}");
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
    let of = |settings| cast(&gpu, &settled(&gpu, settings, &scene), &rays);
    let lengths = of(arrays);
    let linked = of(linked);
    let differing = lengths.iter().zip(&linked).filter(|(a, b)| (*a - *b).abs() > 1e-4).count();
    // The kernels differ, and may round differently at the borders of pixels.
    assert!(differing <= 4, "{differing} of 2000");
    assert!(lengths.iter().filter(|length| **length > 0.0).count() > 1000);
}

#[test]
fn images_that_overflowed_say_nothing() {
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
    // Whatever they are, the kernel of ranges drops them.
    let ranges = ranges_of(&gpu, &images, &rays, RangeRule::default());
    assert_eq!(ranges[0], f32::MAX);
    assert_eq!(ranges[1], f32::MAX);
    assert_eq!(ranges[2], f32::MAX);
    assert_eq!(ranges[3], f32::MAX);
}

/// Ranges of rays' origins; their directions are the primary ones.
fn ranges_of(gpu: &Gpu, images: &DeepImages, rays: &[Ray], rule: RangeRule) -> Vec<f32> {
    let words = |of: fn(&Ray) -> Vec3| -> Vec<Vec4> {
        rays.iter().map(|ray| of(ray).extend(7.0)).collect()
    };
    let (positions, normals) = (words(|ray| ray.origin), words(|ray| ray.normal));
    let (positions, normals) = (upload(gpu, &positions), upload(gpu, &normals));
    let primaries = upload(gpu, &words(|ray| ray.direction));
    let ranges_m = upload(gpu, &vec![-7.0_f32; rays.len()]);
    let mut caster = RangeCaster::new(gpu, images, rule).unwrap();
    let points = RangePoints {
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
    pod_collect_to_vec(&gpu.read(&ranges_m, rays.len() as u64 * 4).unwrap())
}

#[test]
fn ranges_are_the_mean_or_the_longest_of_their_rays() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(20, 8, 50));
    let images = settled(&gpu, settings(64, 32, Spread::Squares), &scene);
    let mut points = rays_from_surfaces(&scene.triangles, 700, 21);
    let mut rng = Pcg64Mcg::seed_from_u64(22);
    for point in &mut points {
        // Around a normal along an axis, rays would lie on the borders between directions.
        point.normal = (point.normal + 0.2 * unit(&mut rng)).normalize();
    }
    for rays in [1, 6, 16] {
        for (combine, primary) in [
            (Combine::Average, Primary::Normal),
            (Combine::Maximum, Primary::Normal),
            (Combine::Average, Primary::Given),
        ] {
            let rule = RangeRule { rays, combine, primary, ..RangeRule::default() };
            let ranges = ranges_of(&gpu, &images, &points, rule);
            let by_ray = RangeRule { threads: Threads::Rays, ..rule };
            let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-3;
            let differing = ranges
                .iter()
                .zip(&ranges_of(&gpu, &images, &points, by_ray))
                .filter(|pair| differs(*pair))
                .count();
            // Rounding may take a ray to another pixel.
            assert!(differing <= 7, "{rule:?}: {differing}");
            let expected = expected_ranges(&gpu, &images, &points, rule);
            let differing = ranges.iter().zip(&expected).filter(|pair| differs(*pair)).count();
            assert!(differing <= 14, "{rule:?}: {differing}");
        }
    }
}

/// Ranges from single rays, combined here.
fn expected_ranges(gpu: &Gpu, images: &DeepImages, points: &[Ray], rule: RangeRule) -> Vec<f32> {
    let rays: Vec<Ray> = points
        .iter()
        .flat_map(|point| {
            let axis = match rule.primary {
                Primary::Normal => point.normal,
                Primary::Given => point.direction,
            };
            let (right, up) = axis.any_orthonormal_pair();
            let turn = Mat3::from_cols(right, up, axis);
            (0..rule.rays).map(move |ix| Ray { direction: turn * rule.ray(ix), ..*point })
        })
        .collect();
    cast(gpu, images, &rays)
        .chunks(rule.rays as usize)
        .map(|lengths| {
            let hits: Vec<f32> = lengths.iter().copied().filter(|m| *m >= 0.0).collect();
            match rule.combine {
                _ if hits.is_empty() => f32::MAX,
                Combine::Average => hits.iter().sum::<f32>() / hits.len() as f32,
                Combine::Maximum => hits.iter().copied().fold(0.0, f32::max),
            }
        })
        .collect()
}

#[test]
fn points_without_hits_are_infinite() {
    let gpu = Gpu::open(None).unwrap();
    let floor = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let scene = Scene::new(&gpu, vec![floor]);
    let images = settled(&gpu, settings(16, 32, Spread::Squares), &scene);
    let at = Vec3::new(0.3, 0.3, 0.0);
    let up = Ray { origin: at, direction: Vec3::Z, normal: Vec3::Z };
    assert_eq!(ranges_of(&gpu, &images, &[up], RangeRule::default()), [f32::MAX]);
    // From above, the floor is met.
    let down = Ray { origin: at + 0.5 * Vec3::Z, direction: -Vec3::Z, normal: -Vec3::Z };
    let rule = RangeRule { rays: 1, ..RangeRule::default() };
    let range = ranges_of(&gpu, &images, &[down], rule)[0];
    assert!((0.4..0.6).contains(&range), "{range}");
}

#[test]
fn rays_of_a_rule_lie_evenly_on_its_cone() {
    let rule = RangeRule::default();
    for ix in 1..6 {
        assert!((rule.ray(ix).z - 0.5).abs() < 1e-6);
        assert!((rule.ray(ix).length() - 1.0).abs() < 1e-6);
        let next = rule.ray(1 + ix % 5);
        assert!((rule.ray(ix).dot(next) - rule.ray(1).dot(rule.ray(2))).abs() < 1e-6);
    }
    assert_eq!(rule.ray(0), Vec3::Z);
    let refused = |rule: RangeRule| rule.check().unwrap_err().to_string();
    assert_eq!(refused(RangeRule { rays: 17, ..rule }), "rays is 17: it must be 1 to 16");
    assert!(refused(RangeRule { cone_angle: f32::NAN, ..rule }).starts_with("cone_angle is NaN"));
}

#[test]
fn random_ranges_are_uniform_and_repeat() {
    let gpu = Gpu::open(None).unwrap();
    let count = 20_000;
    let ranges_m = gpu.storage("ranges", u64::from(count) * 4).unwrap();
    let mut random = RandomRanges::new(&gpu).unwrap();
    let mut draw = |seed| -> Vec<f32> {
        random.prepare(&gpu, &ranges_m, count, (2.0, 6.0), seed).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        random.record(&mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        pod_collect_to_vec(&gpu.read(&ranges_m, u64::from(count) * 4).unwrap())
    };
    let drawn = draw(1);
    assert!(drawn == draw(1));
    assert!(drawn != draw(2));
    assert!(drawn.iter().all(|range| (2.0..=6.0).contains(range)));
    for tenth in 0..10 {
        let low = 2.0 + 0.4 * tenth as f32;
        let share = drawn.iter().filter(|r| (low..low + 0.4).contains(*r)).count();
        // 2000 in each, give or take five standard deviations.
        assert!((1788..2212).contains(&share), "{tenth}: {share}");
    }
    let error = random.prepare(&gpu, &ranges_m, count, (3.0, 2.0), 1).unwrap_err().to_string();
    assert!(error.starts_with("bounds of random ranges is 3 to 2"), "{error}");
}

#[test]
fn ranges_without_what_they_need_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let of = |count| DeepImages::new(&gpu, settings(count, 32, Spread::Squares)).unwrap();
    let (mut images, mut others) = (of(16), of(32));
    let mut caster = RangeCaster::new(&gpu, &images, RangeRule::default()).unwrap();
    let record = |caster: &RangeCaster, images: &DeepImages| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let recorded = caster.record(images, &mut EncoderPasses { encoder: &mut encoder });
        recorded.map_err(|e| e.to_string())
    };
    assert!(record(&caster, &images).unwrap_err().contains("prepared points"));
    let buffer = gpu.storage("points", 160).unwrap();
    let mut points = RangePoints {
        positions: &buffer,
        normals: &buffer,
        primaries: None,
        count: 11,
        ranges_m: &buffer,
    };
    let message = caster.prepare(&gpu, &points).unwrap_err().to_string();
    assert_eq!(message, "positions is 160 bytes: it must be at least 176 for 11 points");
    points.count = 10;
    let ranges_m = gpu.storage("ranges", 40).unwrap();
    points.ranges_m = &ranges_m;
    caster.prepare(&gpu, &points).unwrap();
    assert!(record(&caster, &images).unwrap_err().contains("prepared deep images"));
    let scene = Scene::new(&gpu, room(1, 0, 0));
    images.prepare(&gpu, &scene.input()).unwrap();
    others.prepare(&gpu, &scene.input()).unwrap();
    assert_eq!(record(&caster, &images), Ok(()));
    assert!(record(&caster, &others).unwrap_err().starts_with("settings of deep images is"));
    let given = RangeRule { primary: Primary::Given, ..RangeRule::default() };
    let mut given = RangeCaster::new(&gpu, &images, given).unwrap();
    let message = given.prepare(&gpu, &points).unwrap_err().to_string();
    assert!(message.starts_with("primaries is none"), "{message}");
}

/// The shader finds the directions that Rust finds, but for rounding at the borders of cells.
#[test]
fn shader_and_rust_find_the_same_directions() {
    let gpu = Gpu::open(None).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(23);
    let rays: Vec<Ray> = (0..5000)
        .map(|_| Ray { origin: MIDDLE, direction: unit(&mut rng), normal: Vec3::ZERO })
        .collect();
    let scene = Scene::new(&gpu, room(24, 0, 0));
    // In place of a length, the direction's index and sign.
    let body = "let nearest = nearest_direction(direction);";
    let tell = format!(
        "{body}\n  if nearest.ix >= 0u {{ return (f32(nearest.ix) + 1.0) * nearest.sign; }}"
    );
    let told = RAY_CAST_WESL.replace(body, &tell);
    assert_ne!(told, RAY_CAST_WESL);
    for spread in [Spread::StacksAndSlices, Spread::Squares] {
        for count in [8, 32, 169] {
            let settings = settings(count, 8, spread);
            let images = settled(&gpu, settings, &scene);
            let found = cast_with(&gpu, &images, &rays, &told);
            let differing = rays.iter().zip(found).filter(|(ray, found)| {
                let (ix, is_reversed) = settings.directions.nearest(ray.direction);
                *found != (ix as f32 + 1.0) * if is_reversed { -1.0 } else { 1.0 }
            });
            let differing = differing.count();
            assert!(differing <= 25, "{spread:?} {count}: {differing} of 5000");
        }
    }
}
