//! Fits one entry of the table: one roughness and one view.
//!
//! The lobe's matrix is `M = R * [[p, 0, q], [0, s, 0], [0, 0, 1]]`. R's z axis is the mean
//! direction of the light that the BRDF reflects (Heitz et al. 2016, section 3.2). Nelder and
//! Mead's method searches for ln p, ln s and q / p.
//!
//! The objective is the integral of |difference|^3 above the horizon. Half of its sample directions
//! are drawn from the BRDF and half from the lobe; each is divided by the sum of both densities.
//! The lobe is divided by its share above the horizon, as in shading. Samples lie on a fixed grid
//! and move with the lobe, so the objective is smooth and every run finds the same result.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use super::{
    lobe::{Lobe, Masking},
    nelder_mead::minimize,
    polygon::share_above_horizon,
};

/// Grid of the samples on one side of the plane of incidence. The other side mirrors them.
const AROUND: u32 = 16;
const OUTWARDS: u32 = 32;
/// A finer grid for the albedos.
const ALBEDO_SIDE: u32 = 160;
/// First step of the search, and the relative change of the objective at which it ends.
const STEP: f64 = 0.05;
const TOLERANCE: f64 = 1e-7;

/// A fitted lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// M, which transforms a cosine into the lobe.
    pub matrix: DMat3,
    /// A: the integral of D V cos.
    pub albedo: f64,
    /// B: the integral of D V cos (1 - v.h)^5.
    pub fresnel: f64,
    /// The objective at the end.
    pub residual: f64,
    /// ln p, ln s and q / p, from which a neighbour's search may start.
    pub parameters: DVec3,
}

/// Fits a lobe to the BRDF of a perceptual roughness, seen under a cosine of 0 to 1. The search
/// starts from a neighbour's parameters. Where the view is the normal, the lobe is round and
/// upright.
pub fn fit(roughness: f64, cos_view: f64, start: Option<DVec3>) -> Fit {
    fit_masked(Masking::Correlated, roughness, cos_view, start)
}

/// The same for GGX with the given masking.
pub(super) fn fit_masked(
    masking: Masking,
    roughness: f64,
    cos_view: f64,
    start: Option<DVec3>,
) -> Fit {
    let lobe = Lobe::seen_under(roughness, cos_view).masked(masking);
    let seen = Mean::integrate(&lobe);
    let is_round = cos_view >= 1.0;
    let start = start.unwrap_or_else(|| {
        let width = lobe.alpha().ln();
        DVec3::new(width, width, 0.0)
    });
    let samples = samples_of(&lobe);
    // A round lobe has only one parameter. The search changes the others without effect.
    let round = |parameters: DVec3| DVec3::new(parameters.x, parameters.x, 0.0);
    let allowed = |parameters: DVec3| if is_round { round(parameters) } else { parameters };
    let matrix = |parameters: DVec3| matrix_of(seen.direction, allowed(parameters));
    let objective = |parameters| difference(&lobe, seen.albedo, &samples, &matrix(parameters));
    let (found, residual) = minimize(start, STEP, TOLERANCE, objective);
    let parameters = allowed(found);
    let matrix = matrix(parameters);
    Fit { matrix, albedo: seen.albedo, fresnel: seen.fresnel, residual, parameters }
}

fn matrix_of(z: DVec3, parameters: DVec3) -> DMat3 {
    let x = DVec3::new(z.z, 0.0, -z.x);
    let (p, s) = (parameters.x.exp(), parameters.y.exp());
    let frame = DMat3::from_cols(x, DVec3::Y, z);
    frame
        * DMat3::from_cols(
            DVec3::new(p, 0.0, 0.0),
            DVec3::new(0.0, s, 0.0),
            DVec3::new(parameters.z * p, 0.0, 1.0),
        )
}

/// The light that a BRDF reflects from all directions together.
struct Mean {
    albedo: f64,
    fresnel: f64,
    /// Mean direction, unit.
    direction: DVec3,
}

impl Mean {
    fn integrate(lobe: &Lobe) -> Self {
        let (mut albedo, mut fresnel, mut direction) = (0.0, 0.0, DVec3::ZERO);
        for (u, t) in grid(ALBEDO_SIDE / 2, ALBEDO_SIDE) {
            // The grid is finer towards normals at right angles to the view, where the lobe's tail
            // is.
            let (v, spread) = (1.0 - (1.0 - t) * (1.0 - t), 2.0 * (1.0 - t));
            let to_light = lobe.sample(u, v);
            if to_light.z > 0.0 {
                let (value, schlick) = lobe.evaluate(to_light);
                let weight = spread * value / lobe.density(to_light);
                albedo += weight;
                fresnel += weight * schlick;
                direction += weight * to_light;
            }
        }
        let count = f64::from(ALBEDO_SIDE * ALBEDO_SIDE / 2);
        // The lobe is symmetric about the plane of incidence.
        direction.y = 0.0;
        let direction =
            if lobe.to_eye.x > 0.0 { direction.normalize_or(DVec3::Z) } else { DVec3::Z };
        Self { albedo: albedo / count, fresnel: fresnel / count, direction }
    }
}

/// Middles of the cells of a grid over half the unit square, `u` above 1/2.
fn grid(around: u32, outwards: u32) -> impl Iterator<Item = (f64, f64)> {
    (0..around).flat_map(move |i| {
        (0..outwards).map(move |j| {
            let u = 0.5 + 0.5 * (f64::from(i) + 0.5) / f64::from(around);
            (u, (f64::from(j) + 0.5) / f64::from(outwards))
        })
    })
}

/// A direction, with the values that do not change during the search: the BRDF and the density of
/// its samples.
struct Sample {
    to_light: DVec3,
    value: f64,
    density: f64,
}

fn samples_of(lobe: &Lobe) -> Vec<Sample> {
    let sample = |(u, v)| {
        let to_light = lobe.sample(u, v);
        Sample { to_light, value: lobe.evaluate(to_light).0, density: lobe.density(to_light) }
    };
    grid(AROUND, OUTWARDS).map(sample).filter(|sample| sample.density > 0.0).collect()
}

/// The objective: |BRDF - albedo times the lobe's density|^3 over the sum of the densities, above the
/// horizon.
fn difference(lobe: &Lobe, albedo: f64, samples: &[Sample], matrix: &DMat3) -> f64 {
    let inverse = matrix.inverse();
    // Light below the horizon is not seen. The part above it stands for the whole.
    let share = share_above_horizon(&inverse);
    let scale = inverse.determinant().abs() / PI / share;
    let density = |to_light: DVec3| {
        if to_light.z <= 0.0 {
            return 0.0;
        }
        let cosine = inverse * to_light;
        scale * cosine.z.max(0.0) / cosine.length_squared().powi(2)
    };
    let cube = |value: f64, drawn: f64, fitted: f64| {
        let sum = drawn + fitted;
        if sum > 0.0 { (value - albedo * fitted).abs().powi(3) / sum } else { 0.0 }
    };
    let from_brdf: f64 = samples
        .iter()
        .map(|sample| cube(sample.value, sample.density, density(sample.to_light)))
        .sum();
    let from_lobe: f64 = grid(AROUND, OUTWARDS)
        .map(|(u, v)| {
            let (sin, cos) = ((u - 0.5) * TAU).sin_cos();
            let cosine = DVec3::new(v.sqrt() * cos, v.sqrt() * sin, (1.0 - v).sqrt());
            let to_light = (*matrix * cosine).normalize_or_zero();
            let value = lobe.evaluate(to_light).0;
            cube(value, lobe.density(to_light), density(to_light))
        })
        .sum();
    (from_brdf + from_lobe) / f64::from(AROUND * OUTWARDS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ltc::{Entry, Table, TableDifference, integrate};

    /// Roughness and view of texels from smooth to rough and from the normal to grazing.
    const TEXELS: [(usize, usize); 8] =
        [(3, 0), (8, 30), (20, 10), (20, 50), (30, 60), (40, 40), (50, 0), (63, 20)];

    fn place(x: usize, y: usize) -> (f64, f64) {
        let y = y as f64 / 63.0;
        (x as f64 / 63.0, 1.0 - y * y)
    }

    /// The fit of a texel, starting at the normal. At grazing views, several lobes are about
    /// equally good, and the search finds the one nearest to its neighbour's.
    fn fit_like_the_table(x: usize, y: usize) -> Entry {
        let mut last: Option<Fit> = None;
        for step in 0..=y {
            let (roughness, cos_view) = place(x, step);
            last = Some(fit(roughness, cos_view, last.map(|fit| fit.parameters)));
        }
        Entry::new(&last.unwrap())
    }

    #[test]
    fn a_fit_from_scratch_matches_the_committed_entry() {
        use rayon::prelude::*;
        let table = Table::ggx().unwrap();
        TEXELS.into_par_iter().for_each(|(x, y)| {
            let (roughness, cos_view) = place(x, y);
            let found = fit_like_the_table(x, y);
            let committed = table.look_up(roughness, cos_view);
            let TableDifference { integrals, covered } = committed.difference(&found);
            assert!(integrals < 1e-5 && covered < 1e-4, "{x}, {y}: {integrals:e}, {covered:e}");
            // Away from grazing views the lobe determines its matrix.
            for (a, b) in committed.inverse.iter().zip(found.inverse) {
                assert!(y > 40 || (a - b).abs() < 1e-3, "{x}, {y}: {committed:?}, {found:?}");
            }
            let other = table.look_up(roughness - 2e-3, cos_view);
            assert!(other.difference(&found).covered > 1e-4, "{x}, {y}: too coarse to tell");
        });
    }

    #[test]
    fn the_albedos_match_the_integrals_over_the_hemisphere() {
        let sky = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x, y, 1e-9));
        for (x, y) in TEXELS {
            let (roughness, cos_view) = place(x, y);
            let lobe = Lobe::seen_under(roughness, cos_view);
            let seen = Mean::integrate(&lobe);
            let truth = integrate(&sky, lobe.to_eye, roughness, 1e-5).value;
            let off = seen.albedo - truth.specular;
            assert!(off.abs() < 5e-5, "{x}, {y}: error of A {off:e}");
            let off = seen.fresnel - truth.specular_fresnel;
            assert!(off.abs() < 5e-6, "{x}, {y}: error of B {off:e}");
        }
    }

    #[test]
    fn seen_from_the_normal_a_lobe_is_round_and_upright() {
        let Fit { matrix, .. } = fit(0.4, 1.0, None);
        let width = matrix.x_axis.x;
        assert_eq!(matrix, DMat3::from_diagonal(DVec3::new(width, width, 1.0)));
    }
}
