//! Linearly transformed cosines against the BRDF's true integral.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use glam::{DMat3, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use shading::ltc::{Entry, Integrals, Table, integrate, ltc_integral};

/// A rectangle seen from a surface, both drawn at random.
struct Case {
    rectangle: [DVec3; 4],
    roughness: f64,
    cos_view: f64,
    truth: Integrals,
}

fn on_sphere(rng: &mut Pcg64Mcg) -> DVec3 {
    let z = rng.random_range(-1.0..1.0_f64);
    let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let across = (1.0 - z * z).sqrt();
    DVec3::new(across * cos, across * sin, z)
}

/// Roughness and cosine of the view are uniform in 0.1 to 1. The rectangle's centre lies at a
/// distance of 1 to 3, within 30 degrees of the mirror direction and above the horizon; half its
/// sides are log-uniform in 0.1 to 1 and it is turned in any way, but never edge-on. Parts may lie
/// below the horizon.
fn draw(rng: &mut Pcg64Mcg) -> Case {
    let roughness = rng.random_range(0.1..1.0);
    let cos_view = rng.random_range(0.1..1.0_f64);
    let to_eye = DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view);
    let mirror = DVec3::new(-to_eye.x, 0.0, cos_view);
    let direction = loop {
        let direction = on_sphere(rng);
        if direction.dot(mirror) > 30_f64.to_radians().cos() && direction.z > 0.0 {
            break direction;
        }
    };
    let normal = loop {
        let normal = on_sphere(rng);
        if normal.dot(direction).abs() > 0.1 {
            break normal;
        }
    };
    let center = direction * rng.random_range(1.0..3.0);
    let x = normal.cross(on_sphere(rng)).normalize();
    let mut half_side = || 10_f64.powf(rng.random_range(-1.0..0.0));
    let (x, y) = (x * half_side(), normal.cross(x) * half_side());
    let rectangle = [center - x - y, center + x - y, center + x + y, center - x + y];
    let truth = integrate(&rectangle, to_eye, roughness, 1e-3).value;
    Case { rectangle, roughness, cos_view, truth }
}

/// Quantiles of an error, ascending.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

#[test]
fn the_median_error_near_the_mirror_direction_is_that_of_the_published_fit() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let table = Table::ggx().unwrap();
    let start = std::time::Instant::now();
    let cases: Vec<Case> = (0..1500).map(|_| draw(&mut rng)).collect();
    eprintln!("truth {:?}", start.elapsed());
    let error = |case: &Case| {
        let entry = table.look_up(case.roughness, case.cos_view);
        let found = ltc_integral(&entry.inverse(), &case.rectangle) * f64::from(entry.integrals[0]);
        found / case.truth.specular - 1.0
    };
    let report = |name: &str, cases: &[&Case]| {
    let signed: Vec<f64> = cases.iter().map(|c| error(c)).collect();
    let bias = signed.iter().sum::<f64>() / signed.len() as f64;
    let mut sorted: Vec<f64> = signed.iter().map(|error| error.abs()).collect();
    sorted.sort_by(f64::total_cmp);
    println!(
        "{name} {} median {:.4}, bias {bias:+.4}, p95 {:.4}", cases.len(),
        quantile(&sorted, 0.5),
        quantile(&sorted, 0.95)
    );
    };
    report("all", &cases.iter().collect::<Vec<_>>());
    for r in 0..3 { let lo=0.1+0.3*r as f64; report(&format!("rough {lo}"), &cases.iter().filter(|c| c.roughness>=lo&&c.roughness<lo+0.3).collect::<Vec<_>>()); }
    for r in 0..3 { let lo=0.1+0.3*r as f64; report(&format!("cos {lo}"), &cases.iter().filter(|c| c.cos_view>=lo&&c.cos_view<lo+0.3).collect::<Vec<_>>()); }
    report("bright", &cases.iter().filter(|c| c.truth.specular>0.01).collect::<Vec<_>>());
}
