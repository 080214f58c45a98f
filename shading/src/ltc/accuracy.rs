//! The accuracy of lobes: their integrals over random rectangles, compared with the BRDF's true
//! integral.

use std::f64::consts::TAU;

use glam::DVec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

use super::{polygon::ltc_integral, quadrature::integrate, table::Entry};

/// Tolerance of the true integrals, relative.
const TOLERANCE: f64 = 1e-3;
/// The largest angle between a rectangle's centre and the mirror direction, by default. The errors
/// depend on it: with a larger angle, more rectangles lie in the lobe's tail.
pub const ACCURACY_DEGREES: f64 = 25.0;

/// A rectangle seen from a surface, and the true integral of the specular lobe over it.
#[derive(Clone, Debug)]
pub struct AccuracyCase {
    /// The rectangle's corners, shading frame.
    pub rectangle: [DVec3; 4],
    /// Perceptual roughness.
    pub roughness: f64,
    /// Cosine of the view.
    pub cos_view: f64,
    /// The integral of D V cos over the rectangle.
    pub specular: f64,
}

/// Relative errors over many cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Median of the unsigned errors.
    pub median: f64,
    /// Mean of the signed errors.
    pub bias: f64,
    /// 95 % of the unsigned errors are below this.
    pub p95: f64,
}

/// Random cases, the same for each seed.
///
/// Roughness and cosine of the view are uniform in 0.1 to 1. A rectangle's centre lies at a
/// distance of 1 to 3, within `degrees` of the mirror direction and above the horizon. Half its
/// sides are log-uniform in 0.1 to 1, and it is turned at random but is not nearly edge-on. Parts
/// of it may lie below the horizon.
pub fn accuracy_cases(count: usize, seed: u64, degrees: f64) -> Vec<AccuracyCase> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut cases: Vec<AccuracyCase> = (0..count).map(|_| draw(&mut rng, degrees)).collect();
    cases.par_iter_mut().for_each(|case| {
        let to_eye = to_eye(case.cos_view);
        let truth = integrate(&case.rectangle, to_eye, case.roughness, TOLERANCE);
        case.specular = truth.value.specular;
    });
    cases
}

impl Accuracy {
    /// The errors of the lobes that `entry` returns for a roughness and a cosine of the view. All
    /// are 0 without cases.
    pub fn measure(cases: &[AccuracyCase], entry: impl Fn(f64, f64) -> Entry) -> Self {
        let error = |case: &AccuracyCase| {
            let entry = entry(case.roughness, case.cos_view);
            let covered = ltc_integral(&entry.inverse(), &case.rectangle);
            covered * entry.specular_albedo(1.0) / case.specular - 1.0
        };
        let mut errors: Vec<f64> = cases.iter().map(error).collect();
        let bias = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        errors.iter_mut().for_each(|error| *error = error.abs());
        errors.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let ix = (errors.len().saturating_sub(1) as f64 * share).round();
            errors.get(ix as usize).copied().unwrap_or_default()
        };
        Self { median: quantile(0.5), bias, p95: quantile(0.95) }
    }
}

fn to_eye(cos_view: f64) -> DVec3 {
    DVec3::new((1.0 - cos_view * cos_view).sqrt(), 0.0, cos_view)
}

/// A case without its true integral.
fn draw(rng: &mut Pcg64Mcg, degrees: f64) -> AccuracyCase {
    let roughness = rng.random_range(0.1..1.0);
    let cos_view = rng.random_range(0.1..1.0);
    let mirror = to_eye(cos_view) * DVec3::new(-1.0, 1.0, 1.0);
    let nearest = degrees.to_radians().cos();
    let direction = draw_until(rng, |at| at.dot(mirror) > nearest && at.z > 0.0);
    let normal = draw_until(rng, |normal| normal.dot(direction).abs() > 0.1);
    let x = draw_until(rng, |x| x.cross(normal).length() > 0.1).cross(normal).normalize();
    let center = direction * rng.random_range(1.0..3.0);
    let mut half_side = || 10_f64.powf(rng.random_range(-1.0..0.0));
    let (x, y) = (x * half_side(), normal.cross(x) * half_side());
    let rectangle = [center - x - y, center + x - y, center + x + y, center - x + y];
    AccuracyCase { rectangle, roughness, cos_view, specular: 0.0 }
}

/// A direction, uniform on the accepted part of the sphere.
fn draw_until(rng: &mut Pcg64Mcg, accepted: impl Fn(DVec3) -> bool) -> DVec3 {
    loop {
        let z: f64 = rng.random_range(-1.0..1.0);
        let (sin, cos) = rng.random_range(0.0..TAU).sin_cos();
        let across = (1.0 - z * z).sqrt();
        let direction = DVec3::new(across * cos, across * sin, z);
        if accepted(direction) {
            return direction;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ltc::{Masking, Polynomial, Table, diffuse_fresnel};

    /// A white furnace: the reflection of a dielectric and of a metal under light from everywhere.
    #[test]
    fn a_white_furnace_reflects_as_the_brdf_does() {
        let sky = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x, y, 1e-9));
        let (table, polynomial) = (Table::load(Masking::Correlated).unwrap(), Polynomial::ggx());
        let mut worst = [0.0_f64; 3];
        // Samples on texels and between them, from below the least roughness on.
        for roughness in [0.02, 0.05, 0.1, 0.1825, 0.2, 0.3, 0.45, 0.6, 0.7, 0.85, 1.0] {
            for cos_view in [0.03, 0.1, 0.3, 0.55, 0.8, 0.98] {
                let truth = integrate(&sky, to_eye(cos_view), roughness, 1e-4).value;
                let off = |entry: &Entry, (albedo, f0): (f64, f64)| {
                    let expected =
                        truth.diffuse_reflected(albedo, f0) + truth.specular_reflected(f0);
                    let specular = entry.specular_albedo(f0) * ltc_integral(&entry.inverse(), &sky);
                    let diffuse = albedo * (1.0 - f0) * (1.0 - diffuse_fresnel(cos_view));
                    ((specular + diffuse) / expected - 1.0).abs()
                };
                let [fitted, smooth] =
                    [table.look_up(roughness, cos_view), polynomial.entry(roughness, cos_view)];
                for (worst, off) in worst.iter_mut().zip([
                    off(&fitted, (1.0, 0.04)),
                    off(&fitted, (0.0, 1.0)),
                    off(&smooth, (0.0, 1.0)),
                ]) {
                    *worst = worst.max(off);
                }
            }
        }
        println!("worst of a dielectric, a metal, and the metal by polynomials: {worst:?}");
        assert!(worst[0] < 0.01 && worst[1] < 0.01 && worst[2] < 0.08, "{worst:?}");
    }
}
