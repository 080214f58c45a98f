//! Tests every model of area lights against f64, on this machine's adapter.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{Emitter, Light, LightBuffer, LightShape};
use common::areas::{
    asked, curved_lights, direction, error_of, light_of, lights, queries, truth_of,
};
use common::evaluate::{Query, evaluate, evaluate_far};
use glam::Vec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use shading::AreaModel;
use shading::ltc::Table;
use shading::reference::{light_contribution, ltc_contribution};

#[test]
fn linearly_transformed_cosines_match_f64() {
    let gpu = common::gpu();
    for lights in [lights(40), curved_lights(60), [lights(10), curved_lights(10)].concat()] {
        match_f64(&gpu, &lights);
    }
}

fn is_curved(light: &Light) -> bool {
    matches!(&light.shape, LightShape::Area(emitter) if emitter.outline().is_curved())
}

fn match_f64(gpu: &assign::Gpu, lights: &[Light]) {
    let buffer = LightBuffer::new(gpu, lights).unwrap();
    let queries = queries(lights, 6_000);
    let table = Table::ggx().unwrap();
    let answers = evaluate(gpu, &buffer, &queries, AreaModel::LtcTable);
    let (mut lit, mut worst) = (0, 0.0_f64);
    for (query, answer) in queries.iter().zip(&answers) {
        let (position, surface, to_eye) = asked(query);
        let light = &buffer.lights()[light_of(query)];
        let expected = ltc_contribution(&table, light, position, &surface, to_eye);
        let off = (f64::from(answer[0]) - expected.x).abs() / (expected.x.abs() + 1e-3);
        worst = worst.max(off);
        // Of a sphere just above the horizon, single precision loses digits.
        let most = if lights.iter().any(is_curved) { 2e-2 } else { 2e-3 };
        assert!(off < most, "{answer:?}, expected {expected}: {query:?} {light:?}");
        lit += usize::from(expected.x > 1e-4);
    }
    println!("{}: {lit} lit, off by {worst:.1e} at most", gpu.info.name);
    assert!(lit > 1_500, "only {lit} are lit");
}

#[test]
fn each_model_has_its_expected_error() {
    let gpu = common::gpu();
    let lights = lights(40);
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    // Points away from the emitters, and rough enough that the quadrature is fast.
    let mut queries = queries(&lights, 1_500);
    queries.iter_mut().for_each(|query| query[1][3] = 0.2 + 0.8 * query[1][3]);
    let truth = truth_of(&buffer, &queries);
    let error = |model| error_of(&evaluate(&gpu, &buffer, &queries, model), &truth);
    let [point, mrp, table, polynomial] =
        [AreaModel::Point, AreaModel::Mrp, AreaModel::LtcTable, AreaModel::LtcPolynomial]
            .map(error);
    println!("point {point:.4}, MRP {mrp:.4}, table {table:.4}, polynomial {polynomial:.4}");
    assert!(mrp < 0.2 * point && table < 0.3 * mrp, "{point} {mrp} {table}");
    assert!(table < 0.07 && polynomial < 0.08, "{table} {polynomial}");
    assert!(point > 4.0 * table, "{point} {table}");
}

/// The same for discs, spheres and lines, kind by kind.
#[test]
fn each_model_has_its_expected_error_for_curved_emitters() {
    let gpu = common::gpu();
    for kind in 0..3 {
        let lights: Vec<Light> = curved_lights(60).into_iter().skip(kind).step_by(3).collect();
        let buffer = LightBuffer::new(&gpu, &lights).unwrap();
        let mut queries = queries(&lights, 600);
        queries.iter_mut().for_each(|query| query[1][3] = 0.2 + 0.8 * query[1][3]);
        let truth = truth_of(&buffer, &queries);
        let error = |model| error_of(&evaluate(&gpu, &buffer, &queries, model), &truth);
        let [point, mrp, table] =
            [AreaModel::Point, AreaModel::Mrp, AreaModel::LtcTable].map(error);
        let kind = lights[0].kind();
        println!("{kind:?}: point {point:.4}, MRP {mrp:.4}, table {table:.4}");
        assert!(
            table < 0.1 && mrp < 1.3 * point && 2.0 * table < mrp,
            "{kind:?}: {point} {mrp} {table}"
        );
    }
}

/// Points for lights that look small: the smaller the solid angle, the smaller the error, and nothing changes where no
/// light looks that small.
#[test]
fn far_area_lights_are_points_where_the_error_allows() {
    let gpu = common::gpu();
    for lights in [lights(40), curved_lights(60)] {
        let buffer = LightBuffer::new(&gpu, &lights).unwrap();
        let queries = queries(&lights, 4_000);
        let whole = evaluate(&gpu, &buffer, &queries, AreaModel::LtcTable);
        let sum: f64 = whole.iter().map(|answer| f64::from(answer[0])).sum();
        let errors = [1e-9, 0.003, 0.03, 0.3, 3.0].map(|angle| {
            let far = evaluate_far(&gpu, &buffer, &queries, AreaModel::LtcTable, Some(angle));
            let off = |(a, b): (&[f32; 4], &[f32; 4])| f64::from((a[0] - b[0]).abs());
            far.iter().zip(&whole).map(off).sum::<f64>() / sum
        });
        println!("errors by solid angle: {errors:.5?}");
        assert!(errors[0] == 0.0 && errors[1] > 0.0 && errors[2] < 0.01, "{errors:?}");
        assert!(errors.windows(2).all(|two| two[0] < two[1]), "{errors:?}");
    }
}

/// Four times as many independent samples halve the error. Evenly spread samples do better.
#[test]
fn sampling_converges_to_the_truth() {
    sampling_converges(&lights(40), 1_500);
}

#[test]
fn sampling_of_curved_emitters_converges_to_the_truth() {
    sampling_converges(&curved_lights(60), 600);
}

fn sampling_converges(lights: &[Light], count: usize) {
    let gpu = common::gpu();
    let buffer = LightBuffer::new(&gpu, lights).unwrap();
    let mut queries = queries(lights, count);
    queries.iter_mut().for_each(|query| query[1][3] = 0.4 + 0.6 * query[1][3]);
    let truth = truth_of(&buffer, &queries);
    let counts = [4, 16, 64, 256, 1024];
    let errors = counts.map(|samples| {
        let model = AreaModel::MonteCarlo { samples };
        error_of(&evaluate(&gpu, &buffer, &queries, model), &truth)
    });
    println!("{}: samples {counts:?}, errors {errors:.5?}", gpu.info.name);
    assert!(errors.windows(2).all(|pair| pair[1] < 0.8 * pair[0]), "{errors:?}");
    // With 256 times as many samples, the error falls at least to a sixteenth, or to the
    // quadrature's own error.
    assert!(errors[4] < errors[0] / 16.0 && errors[4] < 0.01, "{errors:?}");
}

#[test]
fn no_light_below_the_horizon_behind_the_emitter_or_out_of_range() {
    let gpu = common::gpu();
    let square = Emitter::rectangle(Vec3::X, Vec3::Y);
    let at = |z: f32| Light::area(square, Vec3::new(0.0, 0.0, z), 3.0, Vec3::splat(50.0));
    // The light looks up. A point below is behind it; for a point above with its normal up, the
    // light is below the horizon.
    let lights = [at(-1.0), at(1.0)];
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let query = |light: u32, position: Vec3, normal: Vec3, roughness: f32| -> Query {
        [
            position.extend(f32::from_bits(light)).to_array(),
            (normal + 0.5 * Vec3::X).normalize().extend(roughness).to_array(),
            normal.extend(0.5).to_array(),
            [1.0, 1.0, 1.0, -1.0],
        ]
    };
    let mut dark = Vec::new();
    let mut bright = Vec::new();
    for step in 0..40 {
        let roughness = step as f32 / 39.0;
        let across = Vec3::new(step as f32 * 0.05 - 1.0, 0.3, 0.0);
        // Looking up from above, straight and tilted by less than the height of the light.
        dark.push(query(0, across, Vec3::Z, roughness));
        dark.push(query(0, across, Vec3::new(0.2, 0.0, 1.0).normalize(), roughness));
        // Behind the light.
        dark.push(query(1, across, Vec3::Z, roughness));
        // Beyond the range.
        dark.push(query(0, across + Vec3::Z * 2.1, Vec3::NEG_Z, roughness));
        bright.push(query(0, across, Vec3::NEG_Z, roughness));
    }
    for model in AreaModel::ALL {
        let lit = evaluate(&gpu, &buffer, &bright, model);
        assert!(lit.iter().all(|answer| answer[0] > 1e-3), "{model}");
        for (query, answer) in dark.iter().zip(evaluate(&gpu, &buffer, &dark, model)) {
            assert_eq!(answer[..3], [0.0; 3], "{model}: {query:?}");
        }
    }
}

/// A surface passes along a rectangle of 100 to 1 at a distance of 5 cm. No step may differ from
/// the mean of its neighbours by more than the curvature.
#[test]
fn a_long_light_nearby_gives_no_noise() {
    let gpu = common::gpu();
    let table = Table::ggx().unwrap();
    let lamp = Emitter::rectangle(Vec3::X * 2.0, Vec3::NEG_Y * 0.02);
    let light = Light::area(lamp, Vec3::new(0.0, 0.0, 0.05), 5.0, Vec3::splat(1.0));
    let buffer = LightBuffer::new(&gpu, &[light]).unwrap();
    for roughness in [0.1, 0.3, 0.8] {
        let queries: Vec<Query> = (0..2_000)
            .map(|step| {
                let position = Vec3::new(step as f32 * 1e-3 - 1.0, 0.01, 0.0);
                let to_eye = Vec3::new(0.6, 0.2, 0.75).normalize();
                [
                    position.extend(f32::from_bits(0)).to_array(),
                    to_eye.extend(roughness).to_array(),
                    Vec3::Z.extend(0.0).to_array(),
                    [0.5, 0.5, 0.5, 0.0],
                ]
            })
            .collect();
        for model in [AreaModel::LtcTable, AreaModel::LtcPolynomial] {
            let answers = evaluate(&gpu, &buffer, &queries, model);
            for (query, answer) in queries.iter().zip(&answers) {
                let (position, surface, to_eye) = asked(query);
                let exact = ltc_contribution(&table, &light, position, &surface, to_eye).x;
                let off = (f64::from(answer[0]) / exact - 1.0).abs();
                assert!(model != AreaModel::LtcTable || off < 1e-4, "{off:e} at {position}");
            }
            for three in answers.windows(3) {
                let noise = (three[1][0] / (0.5 * (three[0][0] + three[2][0])) - 1.0).abs();
                assert!(noise < 1e-4, "{model} at roughness {roughness}: {noise:e}");
            }
        }
    }
}

#[test]
fn surfaces_on_edge_on_to_and_inside_emitters_give_finite_light() {
    let gpu = common::gpu();
    let square = Emitter::rectangle(Vec3::X, Vec3::Y).two_sided();
    let lights = [
        Light::area(square, Vec3::ZERO, 2.0, Vec3::splat(1e6)),
        Light::area(square.scaled(1e-4), Vec3::ZERO, 1e-3, Vec3::splat(1e6)),
        Light::area(square.scaled(1e4), Vec3::ZERO, 1e6, Vec3::splat(1e6)),
    ];
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let mut queries = Vec::new();
    for light in 0..3_u32 {
        for position in [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::X * 1.5,
            Vec3::Z * 1e-20,
            Vec3::NEG_Z * 1e-6,
            Vec3::Z * 1e5,
        ] {
            for normal in [Vec3::Z, Vec3::NEG_Z, Vec3::X] {
                for to_eye in [normal, Vec3::Y, -normal] {
                    for roughness in [0.0, 0.5, 1.0] {
                        queries.push([
                            position.extend(f32::from_bits(light)).to_array(),
                            to_eye.extend(roughness).to_array(),
                            normal.extend(1.0).to_array(),
                            [1.0, 1.0, 1.0, -1.0],
                        ]);
                    }
                }
            }
        }
    }
    for model in AreaModel::ALL {
        for (query, answer) in queries.iter().zip(evaluate(&gpu, &buffer, &queries, model)) {
            let sound = answer[..3].iter().all(|x| x.is_finite() && *x >= 0.0);
            assert!(sound, "{model}: {answer:?}, {query:?}");
        }
    }
}

/// Two-sided lights light both sides equally, and two halves of a light add up to the whole.
#[test]
fn both_sides_are_equal_and_parts_add_up() {
    let gpu = common::gpu();
    let lamp = |x: f32, center: f32| {
        let emitter = Emitter::rectangle(Vec3::X * x, Vec3::Y * 0.4).two_sided();
        // Without a window, which would differ between the parts.
        Light::area(emitter, Vec3::X * center, 1e5, Vec3::splat(x))
    };
    let lights = [lamp(1.0, 0.0), lamp(0.5, -0.5), lamp(0.5, 0.5)];
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let query = |light: u32, position: Vec3, normal: Vec3, to_eye: Vec3, roughness: f32| -> Query {
        [
            position.extend(f32::from_bits(light)).to_array(),
            to_eye.normalize().extend(roughness).to_array(),
            normal.extend(0.3).to_array(),
            [0.7, 0.7, 0.7, 0.0],
        ]
    };
    for model in [AreaModel::LtcTable, AreaModel::LtcPolynomial] {
        let mut queries = Vec::new();
        for step in 0..60 {
            let position = Vec3::new(step as f32 * 0.05 - 1.5, 0.2, -0.6);
            let to_eye = Vec3::new(0.5, 0.1, 0.7);
            let roughness = 0.1 + 0.015 * step as f32;
            for light in 0..3 {
                queries.push(query(light, position, Vec3::Z, to_eye, roughness));
            }
            let flip = Vec3::new(1.0, 1.0, -1.0);
            queries.push(query(0, position * flip, Vec3::NEG_Z, to_eye * flip, roughness));
        }
        for answer in evaluate(&gpu, &buffer, &queries, model).chunks(4) {
            let [whole, left, right, mirrored] = [0, 1, 2, 3].map(|i| f64::from(answer[i][0]));
            assert!((left + right - whole).abs() < 1e-3 * whole + 1e-6, "{model}: {answer:?}");
            assert!((mirrored - whole).abs() < 1e-4 * whole + 1e-6, "{model}: {answer:?}");
        }
    }
}

/// A surface in the plane of a light but outside its outline, in any orientation. Rounding moves
/// the light's corners above and below the horizon at random.
#[test]
fn a_light_in_the_surfaces_own_plane_adds_nothing() {
    let gpu = common::gpu();
    let mut rng = Pcg64Mcg::seed_from_u64(9);
    let lights: Vec<Light> = lights(40)
        .into_iter()
        .map(|light| match light.shape {
            LightShape::Area(emitter) => {
                Light { shape: LightShape::Area(emitter.two_sided()), ..light }
            }
            _ => light,
        })
        .collect();
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let queries: Vec<Query> = (0..4_000)
        .map(|ix| {
            let light = &buffer.lights()[ix % 40];
            let LightShape::Area(emitter) = light.shape else { panic!("an area light") };
            let normal = emitter.normal();
            let across = direction(&mut rng).reject_from(normal).normalize();
            let beside = across * emitter.radius() * rng.random_range(1.1..2.0);
            let to_eye = direction(&mut rng);
            let to_eye = if to_eye.dot(normal) < 0.0 { -to_eye } else { to_eye };
            [
                (light.position + beside).extend(f32::from_bits(ix as u32 % 40)).to_array(),
                to_eye.extend(0.2 + 0.8 * rng.random::<f32>()).to_array(),
                normal.extend(0.5).to_array(),
                [1.0, 1.0, 1.0, 0.0],
            ]
        })
        .collect();
    for model in AreaModel::ALL {
        let answers = evaluate(&gpu, &buffer, &queries, model);
        let share = |(query, answer): (&Query, &[f32; 4])| {
            let light = &buffer.lights()[light_of(query)];
            let LightShape::Area(emitter) = light.shape else { panic!("an area light") };
            answer[0] * emitter.area() / light.intensity.x
        };
        let lit = queries.iter().zip(&answers).map(share).filter(|share| *share > 1e-3).count();
        assert_eq!(lit, 0, "{model}: lit by more than a thousandth of the light's radiance");
    }
}

/// With many samples no error remains, whatever the emitter looks like: small, edge-on, long, or
/// near.
#[test]
fn sampling_is_unbiased() {
    let gpu = common::gpu();
    let lights = lights(40);
    let buffer = LightBuffer::new(&gpu, &lights).unwrap();
    let mut queries = queries(&lights, 1_500);
    for query in &mut queries {
        // The surface faces the light, so that no part of it is a sliver above the horizon.
        let [x, y, z, _] = query[0];
        let normal = (buffer.lights()[light_of(query)].position - Vec3::new(x, y, z)).normalize();
        let to_eye = Vec3::new(query[1][0], query[1][1], query[1][2]);
        let to_eye = if to_eye.dot(normal) < 0.0 { -to_eye } else { to_eye };
        query[1] = to_eye.extend(1.0).to_array();
        query[2] = normal.extend(query[2][3]).to_array();
    }
    let answers = evaluate(&gpu, &buffer, &queries, AreaModel::MonteCarlo { samples: 2048 });
    let error = |(query, answer): (&Query, &[f32; 4])| {
        let (position, surface, to_eye) = asked(query);
        let light = &buffer.lights()[light_of(query)];
        let truth = light_contribution(light, position, &surface, to_eye).x;
        (truth > 1e-6).then(|| f64::from(answer[0]) / truth - 1.0)
    };
    let errors: Vec<f64> = queries.iter().zip(&answers).filter_map(error).collect();
    let count = errors.len();
    let bias = errors.iter().sum::<f64>() / count as f64;
    let mut sizes: Vec<f64> = errors.into_iter().map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let at = |share: f64| sizes[((count - 1) as f64 * share) as usize];
    let [median, p95, most] = [0.5, 0.95, 1.0].map(at);
    println!("{count} lit: bias {bias:.1e}, median {median:.1e}, p95 {p95:.1e}, most {most:.1e}");
    assert!(bias.abs() < 5e-4 && p95 < 5e-3 && most < 0.03, "{bias} {p95} {most}");
    assert!(count > 800, "{count}");
}
