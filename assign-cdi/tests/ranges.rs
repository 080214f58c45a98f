//! Ranges of points: from rays, and at random.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod scene;

use assign::{EncoderPasses, Gpu};
use assign_cdi::{
    Combine, DeepImages, Primary, RandomRanges, RangeCaster, RangePoints, RangeRule, Spread,
};
use bytemuck::pod_collect_to_vec;
use glam::{Mat3, Vec3};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scene::{
    Scene,
    rays::{LIGHT_WORLD, Ray, cast, ranges_of, rays_from_surfaces, settings},
    room, settled, unit,
};

#[test]
fn ranges_are_the_mean_or_the_longest_of_their_rays() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(20, 8, 50));
    let images = settled(&gpu, settings(64, 32, Spread::Squares), &scene);
    let mut points = rays_from_surfaces(&scene.triangles, 700, 21);
    let mut rng = Pcg64Mcg::seed_from_u64(22);
    for point in &mut points {
        // Around a normal along an axis, rays would lie on the borders between cells of directions.
        point.normal = (point.normal + 0.2 * unit(&mut rng)).normalize();
    }
    for rays in [1, 6, 16] {
        for (combine, primary) in [
            (Combine::Average, Primary::Normal),
            (Combine::Maximum, Primary::Normal),
            (Combine::Average, Primary::Given),
            (Combine::Average, Primary::Reflected),
        ] {
            let rule = RangeRule { rays, combine, primary, ..RangeRule::default() };
            let ranges = ranges_of(&gpu, &images, &points, rule);
            let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-3;
            let expected = expected_ranges(&gpu, &images, &points, rule);
            let differing = ranges.iter().zip(&expected).filter(|pair| differs(*pair)).count();
            // Rounding may move a ray to another pixel.
            assert!(differing <= 14, "{rule:?}: {differing} of 700 differ");
        }
    }
}

/// Ranges from single rays, combined on the CPU.
fn expected_ranges(gpu: &Gpu, images: &DeepImages, points: &[Ray], rule: RangeRule) -> Vec<f32> {
    let rays: Vec<Ray> = points
        .iter()
        .flat_map(|point| {
            let axis = match rule.primary {
                Primary::Normal => point.normal,
                Primary::Given => point.direction,
                Primary::Reflected => {
                    (point.origin - LIGHT_WORLD).normalize().reflect(point.normal)
                }
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
    // A ray from above meets the floor.
    let down = Ray { origin: at + 0.5 * Vec3::Z, direction: -Vec3::Z, normal: -Vec3::Z };
    let rule = RangeRule { rays: 1, ..RangeRule::default() };
    let range = ranges_of(&gpu, &images, &[down], rule)[0];
    assert!((0.4..0.6).contains(&range), "{range}");
}

#[test]
fn points_without_a_normal_or_a_primary_direction_cast_no_ray() {
    let gpu = Gpu::open(None).unwrap();
    let scene = Scene::new(&gpu, room(20, 8, 50));
    let images = settled(&gpu, settings(64, 32, Spread::Squares), &scene);
    let points = rays_from_surfaces(&scene.triangles, 100, 23);
    let finite = |points: &[Ray], rule| {
        let ranges = ranges_of(&gpu, &images, points, rule);
        assert_eq!(ranges.len(), points.len());
        ranges.iter().filter(|range| **range != f32::MAX).count()
    };
    for primary in [Primary::Normal, Primary::Reflected, Primary::Given] {
        for is_corrected in [false, true] {
            let rule = RangeRule { primary, is_corrected, ..RangeRule::default() };
            // The light is outside the room. Rays reflected by walls that face away from it leave the room.
            assert!(finite(&points, rule) > 30, "{rule:?}");
            for normal in [Vec3::ZERO, Vec3::NAN] {
                let flat: Vec<Ray> = points.iter().map(|p| Ray { normal, ..*p }).collect();
                assert_eq!(finite(&flat, rule), 0, "{rule:?}, normal {normal}");
            }
        }
    }
    let rule = RangeRule { primary: Primary::Given, ..RangeRule::default() };
    let still: Vec<Ray> = points.iter().map(|p| Ray { direction: Vec3::ZERO, ..*p }).collect();
    assert_eq!(finite(&still, rule), 0);
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
    assert_eq!(refused(RangeRule { rays: 17, ..rule }), "rays per point is 17: it must be 1 to 16");
    assert!(refused(RangeRule { cone_angle: f32::NAN, ..rule }).contains("(cone_angle) is NaN"));
}

#[test]
fn random_ranges_are_uniform_and_repeatable() {
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
        // Each tenth holds 2000, within five standard deviations.
        assert!((1788..2212).contains(&share), "tenth {tenth} holds {share} of 20000");
    }
    let error = random.prepare(&gpu, &ranges_m, count, (3.0, 2.0), 1).unwrap_err().to_string();
    assert!(error.starts_with("bounds of random ranges is 3 to 2"), "{error}");
}

#[test]
fn missing_or_small_buffers_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let make = |count| DeepImages::new(&gpu, settings(count, 32, Spread::Squares)).unwrap();
    let (mut images, mut others) = (make(16), make(32));
    let mut caster = RangeCaster::new(&gpu, &images, RangeRule::default()).unwrap();
    let record = |caster: &RangeCaster, images: &DeepImages| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let recorded = caster.record(images, &mut EncoderPasses { encoder: &mut encoder });
        recorded.map_err(|e| e.to_string())
    };
    assert!(record(&caster, &images).unwrap_err().contains("prepared points"));
    let buffer = gpu.storage("points", 160).unwrap();
    let mut points = RangePoints {
        light_world: None,
        positions: &buffer,
        normals: &buffer,
        primaries: None,
        count: 11,
        ranges_m: &buffer,
    };
    let message = caster.prepare(&gpu, &points).unwrap_err().to_string();
    let expected = "buffer `positions` of the points is 160 bytes: it must be at least 176 bytes for \
                    11 points";
    assert_eq!(message, expected);
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
    assert!(message.contains("(primaries) is missing"), "{message}");
}
