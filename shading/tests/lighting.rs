//! Tests the shaders' lighting function against the f64 reference, on this machine's adapter.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{Light, LightBuffer, LightShape};
use glam::{DVec3, Vec3};
use shading::AreaModel;
use shading::reference::{Surface, light_contribution};

use common::evaluate::{Query, evaluate};

/// Directions that cover the sphere evenly (a Fibonacci spiral).
fn direction(i: usize, count: usize) -> Vec3 {
    let z = 1.0 - 2.0 * (i as f32 + 0.5) / count as f32;
    let angle = i as f32 * 2.399_963;
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * angle.cos(), r * angle.sin(), z)
}

/// The same queries, with lights skipped at or under a weight.
fn leaving_out(queries: &[Query], exit_weight: f32) -> Vec<Query> {
    let mut queries = queries.to_vec();
    queries.iter_mut().for_each(|query| query[3][3] = exit_weight);
    queries
}

fn bits(answers: &[[f32; 4]]) -> Vec<[u32; 4]> {
    answers.iter().map(|answer| answer.map(f32::to_bits)).collect()
}

fn queries(lights: &[Light], count: usize) -> Vec<Query> {
    (0..count)
        .map(|i| {
            let light = i % lights.len();
            let share = (i as f32 * 0.618_034).fract() * 1.1;
            let position =
                lights[light].position + direction(i, count) * lights[light].range_m * share;
            let normal = direction((i * 7) % count, count);
            // Half of the eyes look at the front.
            let to_eye = direction((i * 13) % count, count);
            let to_eye = if i % 2 == 0 && to_eye.dot(normal) < 0.0 { -to_eye } else { to_eye };
            let roughness = (i as f32 * 0.137).fract();
            let metallic = (i as f32 * 0.731).fract();
            [
                position.extend(f32::from_bits(light as u32)).to_array(),
                to_eye.extend(roughness).to_array(),
                normal.extend(metallic).to_array(),
                [0.9, 0.5, 0.1, 0.0],
            ]
        })
        .collect()
}

fn expected(lights: &[Light], query: &Query) -> DVec3 {
    let xyz = |v: [f32; 4]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
    let surface = Surface {
        base_color: xyz(query[3]),
        metallic: f64::from(query[2][3]),
        normal: xyz(query[2]),
        roughness: f64::from(query[1][3]),
        dielectric: Default::default(),
    };
    let light = &lights[query[0][3].to_bits() as usize];
    light_contribution(light, xyz(query[0]), &surface, xyz(query[1]))
}

/// The accepted error of f32. GGX's peak amplifies the rounding of the half vector by 1 / alpha,
/// which is up to 500.
fn relative_error(query: &Query) -> f64 {
    let alpha = f64::from(query[1][3].max(0.045)).powi(2);
    2e-4 + 8.0 * f64::from(f32::EPSILON) / alpha
}

#[test]
fn shaders_agree_with_the_reference() {
    let gpu = common::gpu();
    for kinds in ["points", "points and spots"] {
        let mut lights = common::lights(48);
        if kinds == "points" {
            lights.retain(|light| light.kind() == assign::LightKind::Point);
        }
        let buffer = LightBuffer::new(&gpu, &lights).unwrap();
        let queries = queries(&lights, 20_000);
        let answers = evaluate(&gpu, &buffer, &queries, AreaModel::default());
        let mut lit = 0;
        for (query, answer) in queries.iter().zip(&answers) {
            let expected = expected(&lights, query);
            for (a, e) in answer.iter().zip(expected.to_array()) {
                let tolerance = relative_error(query) * e.abs() + 2e-6;
                assert!(
                    (f64::from(*a) - e).abs() <= tolerance,
                    "{kinds}: {a}, expected {e}, {query:?}"
                );
            }
            lit += usize::from(expected.x > 1e-4);
        }
        // Skipping nothing changes no bit. A greater weight skips lights that add something.
        let at = |exit_weight| {
            bits(&evaluate(
                &gpu,
                &buffer,
                &leaving_out(&queries, exit_weight),
                AreaModel::default(),
            ))
        };
        assert_eq!(at(-1.0), bits(&answers), "{kinds}");
        assert_ne!(at(0.1), bits(&answers), "{kinds}");
        assert!(lit > 2_000, "{kinds}: only {lit} of 20000 samples are lit");
    }
}

#[test]
fn lights_on_a_surface_and_out_of_range_give_finite_light() {
    let gpu = common::gpu();
    let lights = [
        Light::point(Vec3::ZERO, 1.0, Vec3::ONE),
        Light::point(Vec3::ZERO, 1e-4, Vec3::splat(1e9)),
        Light::point(Vec3::ZERO, 1e8, Vec3::splat(1e9)),
    ];
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let mut queries = Vec::new();
    for light in 0..3_u32 {
        for position in [[0.0; 3], [1e-20, 0.0, 0.0], [0.0, 1.0, 0.0], [1e6, 0.0, 0.0], [-1e-3; 3]]
        {
            for roughness in [0.0, 1.0] {
                let [x, y, z] = position;
                queries.push([
                    [x, y, z, f32::from_bits(light)],
                    [0.0, 1.0, 0.0, roughness],
                    [0.0, 1.0, 0.0, 1.0],
                    [1.0, 1.0, 1.0, 0.0],
                ]);
            }
        }
    }
    let all = leaving_out(&queries, -1.0);
    let answers = [
        evaluate(&gpu, &buffer, &queries, AreaModel::default()),
        evaluate(&gpu, &buffer, &all, AreaModel::default()),
    ];
    assert_eq!(bits(&answers[0]), bits(&answers[1]));
    let mut lit = 0;
    for (query, answer) in queries.iter().zip(&answers[0]) {
        assert!(answer.iter().all(|v| v.is_finite() && *v >= 0.0), "{query:?}: {answer:?}");
        lit += usize::from(answer[0] > 0.0);
    }
    // The light of 1e8 m straight above lights both of its samples.
    assert!(lit >= 2, "{lit} of {}: {answers:?}", queries.len());
}

/// Spots of every width over a white wall, sampled on and off the axis. Inside the inner cone they
/// are as bright as a point light.
#[test]
fn narrow_spots_are_as_bright_as_points_inside_their_inner_cone() {
    const DISTANCE_M: f32 = 100.0;
    let gpu = common::gpu();
    let wall = |x: f32, light: usize| -> Query {
        let at = [x, 0.0, 0.0, f32::from_bits(light as u32)];
        [at, [0.0, 0.0, 1.0, 0.8], [0.0, 0.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0]]
    };
    let mut lights = Vec::new();
    let mut queries = Vec::new();
    for degrees in [0.02_f32, 0.05, 0.25, 1.0, 5.0, 30.0, 60.0, 89.0] {
        for inner_share in [0.0, 0.5, 0.97, 1.0] {
            let outer_angle = degrees.to_radians();
            let inner_angle = inner_share * outer_angle;
            let point = Light::point(Vec3::Z * DISTANCE_M, 1e6, Vec3::splat(1e6));
            let shape = LightShape::Spot { direction: Vec3::NEG_Z, inner_angle, outer_angle };
            lights.extend([point, Light { shape, ..point }]);
            for share in [0.0, 0.3, 0.6, 0.96, 0.985, 0.995, 1.005] {
                let x = (share * outer_angle).tan() * DISTANCE_M;
                queries.extend([wall(x, lights.len() - 2), wall(x, lights.len() - 1)]);
            }
        }
    }
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    assert_eq!(buffer.rejected(), []);
    let answers = evaluate(&gpu, &buffer, &queries, AreaModel::default());
    for (query, answer) in queries.chunks(2).zip(answers.chunks(2)) {
        let spot = &lights[query[1][0][3].to_bits() as usize];
        let LightShape::Spot { inner_angle, outer_angle, .. } = spot.shape else {
            panic!("{spot:?}")
        };
        let angle = (f64::from(query[1][0][0]) / f64::from(DISTANCE_M)).atan();
        let [inner, outer] = [inner_angle, outer_angle].map(f64::from);
        // KHR_lights_punctual, in f64.
        let ramp = if angle < inner {
            1.0
        } else if angle > outer {
            0.0
        } else {
            ((angle.cos() - outer.cos()) / (inner.cos() - outer.cos())).powi(2)
        };
        let share = f64::from(answer[1][0]) / f64::from(answer[0][0]);
        assert!((share - ramp).abs() < 0.01, "{share}, expected {ramp}, at {angle} of {spot:?}");
        let reference = expected(&lights, &query[1]).x / expected(&lights, &query[0]).x;
        assert!(
            (reference - ramp).abs() < 1e-6,
            "{reference}, expected {ramp}, at {angle} of {spot:?}"
        );
    }
}
