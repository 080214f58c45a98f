//! The truth: integrates the BRDF itself over a polygon by adaptive quadrature.
//!
//! The polygon is clipped to the horizon and cut along the axes, so that no piece spans more than a
//! right angle. Each piece is divided into triangles around a vertex. Radon's rule of seven points
//! (exact to degree 5) integrates over the flat chord of a triangle of unit vectors, with each
//! point projected to the sphere.
//!
//! Triangles are split in four. First, each is split until it is no larger than the width of the
//! lobe or than its distance from the lobe's peak, so that no peak is missed. Then the triangle of
//! the largest error is split, until the sum of all errors is small.
//!
//! The error of a triangle is the change made by its last split, divided among the four parts.
//! Where the integrand is smooth, the actual error is far smaller.

use std::{cmp::Ordering, collections::BinaryHeap, f64::consts::PI};

use glam::DVec3;

use super::{
    integrals::Integrals,
    lobe::Lobe,
    polygon::{clip, clip_at},
};

/// The most triangles. It bounds the time; tests never reach it.
const MAX_TRIANGLES: usize = 400_000;
/// The relative error of an integral below this is computed as if it had this value.
const SMALLEST: f64 = 1e-9;

/// The result of a quadrature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The integrals.
    pub value: Integrals,
    /// Absolute bounds of their errors.
    pub error: Integrals,
    /// The number of triangles into which the polygon was cut.
    pub triangles: usize,
}

/// Integrates the BRDF of a perceptual roughness, seen from the unit direction `to_eye`, over the
/// part of a convex polygon above the horizon. Vertices are in the shading frame, in order.
///
/// Each error is at most `tolerance` times its integral, or times 1e-9 if that is larger. A
/// tolerance below 1e-10 counts as 1e-10.
pub fn integrate(vertices: &[DVec3], to_eye: DVec3, roughness: f64, tolerance: f64) -> Estimate {
    let integrand = Integrand::new(Lobe::new(roughness, to_eye));
    let tolerance = tolerance.max(1e-10);
    let mut triangles = BinaryHeap::new();
    let mut sum =
        Estimate { value: Integrals::default(), error: Integrals::default(), triangles: 0 };
    for piece in quadrants(vertices) {
        for pair in piece[1..].windows(2) {
            let corners = [piece[0], pair[0], pair[1]].map(DVec3::normalize_or_zero);
            refine(&integrand, corners, 0, &mut triangles);
        }
    }
    for triangle in &triangles {
        sum.value = sum.value.plus(triangle.value);
        sum.error = sum.error.plus(triangle.error);
    }
    let is_wanted = |sum: &Estimate| {
        let relative = sum.error.map(sum.value, |error, value| error / value.max(SMALLEST));
        relative.largest() > tolerance
    };
    while is_wanted(&sum) && triangles.len() < MAX_TRIANGLES {
        let Some(worst) = triangles.pop() else { break };
        let parts = split(&integrand, &worst);
        sum.value = sum.value.map(worst.value, |a, b| a - b);
        sum.error = sum.error.map(worst.error, |a, b| a - b);
        for part in parts {
            sum.value = sum.value.plus(part.value);
            sum.error = sum.error.plus(part.error);
            triangles.push(part.ranked(&sum.value));
        }
    }
    sum.triangles = triangles.len();
    sum
}

/// The parts of a polygon above the horizon in each quadrant of the surface.
fn quadrants(vertices: &[DVec3]) -> impl Iterator<Item = Vec<DVec3>> {
    let above = clip(vertices);
    let quarters = [DVec3::X, DVec3::NEG_X].into_iter().flat_map(move |x| {
        let half = clip_at(&above, x);
        [DVec3::Y, DVec3::NEG_Y].map(|y| clip_at(&half, y))
    });
    quarters.filter(|piece| piece.len() >= 3)
}

/// A triangle of unit vectors, ordered by the share of its error.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [DVec3; 3],
    value: Integrals,
    error: Integrals,
    rank: f64,
}

impl Triangle {
    fn ranked(self, sum: &Integrals) -> Self {
        let rank = self.error.map(*sum, |error, sum| error / sum.max(SMALLEST)).largest();
        Self { rank, ..self }
    }
}

impl PartialEq for Triangle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Triangle {}

impl PartialOrd for Triangle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Triangle {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank.total_cmp(&other.rank)
    }
}

/// The integrand, and the direction of its peak.
struct Integrand {
    lobe: Lobe,
    peak: DVec3,
    width: f64,
}

impl Integrand {
    fn new(lobe: Lobe) -> Self {
        let peak = DVec3::new(-lobe.to_eye.x, -lobe.to_eye.y, lobe.to_eye.z);
        // Half vectors spread by alpha. Light directions spread by twice that, foreshortened across
        // the plane of incidence.
        let width = 2.0 * lobe.alpha() * lobe.cos_view().max(0.05);
        Self { lobe, peak, width }
    }

    fn at(&self, to_light: DVec3) -> Integrals {
        let (specular, schlick) = self.lobe.evaluate(to_light);
        let diffuse = to_light.z.max(0.0) / PI;
        Integrals {
            specular,
            specular_fresnel: specular * schlick,
            diffuse,
            diffuse_fresnel: diffuse * schlick,
        }
    }

    /// Radon's rule over the chord of a triangle.
    fn over(&self, [a, b, c]: [DVec3; 3]) -> Integrals {
        let root = 15_f64.sqrt();
        let volume = a.dot(b.cross(c)).abs();
        let mut sum = Integrals::default();
        let mut add = |weight: f64, u: f64, v: f64| {
            let point = a * (1.0 - u - v) + b * u + c * v;
            let length = point.length();
            // Solid angle of the chord's area there.
            let weight = 0.5 * weight * volume / length.powi(3).max(1e-300);
            sum = sum.map(self.at(point / length.max(1e-300)), |sum, value| sum + weight * value);
        };
        add(0.225, 1.0 / 3.0, 1.0 / 3.0);
        for sign in [-1.0, 1.0] {
            let near = (6.0 + sign * root) / 21.0;
            let weight = (155.0 + sign * root) / 1200.0;
            add(weight, near, near);
            add(weight, 1.0 - 2.0 * near, near);
            add(weight, near, 1.0 - 2.0 * near);
        }
        sum
    }
}

/// Splits a triangle until none is larger than the lobe's width or its distance from the peak.
fn refine(
    integrand: &Integrand,
    corners: [DVec3; 3],
    depth: u32,
    found: &mut BinaryHeap<Triangle>,
) {
    let [a, b, c] = corners;
    let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let center = (a + b + c).normalize_or_zero();
    let distance = center.distance(integrand.peak);
    // A direction that is not a number has no peak, and ends the search at once.
    let is_wider = size > 0.5 * integrand.width;
    let is_near = size > 0.5 * (integrand.width + distance - size);
    if is_wider && is_near && depth < 24 {
        for part in parts(corners) {
            refine(integrand, part, depth + 1, found);
        }
    } else {
        let value = integrand.over(corners);
        let whole = Triangle { corners, value, error: value, rank: 0.0 };
        found.extend(split(integrand, &whole).map(|part| part.ranked(&Integrals::default())));
    }
}

fn parts([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    let (ab, bc, ca) =
        ((a + b).normalize_or_zero(), (b + c).normalize_or_zero(), (c + a).normalize_or_zero());
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// The four parts of a triangle. The error of each is a quarter of the change.
fn split(integrand: &Integrand, whole: &Triangle) -> [Triangle; 4] {
    let split = parts(whole.corners).map(|corners| (corners, integrand.over(corners)));
    let sum = split.iter().fold(Integrals::default(), |sum, (_, value)| sum.plus(*value));
    let error = sum.map(whole.value, |after, before| 0.25 * (after - before).abs());
    split.map(|(corners, value)| Triangle { corners, value, error, rank: 0.0 })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::ltc::SphericalRectangle;

    fn to_eye(cos: f64) -> DVec3 {
        DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
    }

    /// A midpoint rule over the area-preserving map of a rectangle.
    fn by_samples(corner: DVec3, x: DVec3, y: DVec3, lobe: &Lobe, side: u32) -> Integrals {
        let integrand = Integrand::new(*lobe);
        let rectangle = SphericalRectangle::new(corner, x, y).unwrap();
        let weight = rectangle.solid_angle() / f64::from(side * side);
        let mut sum = Integrals::default();
        for i in 0..side {
            for j in 0..side {
                let at = |step: u32| (f64::from(step) + 0.5) / f64::from(side);
                let direction = rectangle.direction(at(i), at(j));
                sum = sum.map(integrand.at(direction), |sum, value| sum + weight * value);
            }
        }
        sum
    }

    #[test]
    fn quadrature_matches_samples_of_the_area_preserving_map() {
        // Beside the peak and across it, across the horizon, and at a grazing view.
        for (corner, x, y, cos_view, roughness) in [
            (DVec3::new(-1.5, -0.5, 1.0), DVec3::X, DVec3::Y, 0.7, 0.3),
            (DVec3::new(-1.5, -0.5, -0.5), DVec3::Z, DVec3::Y, 0.2, 0.5),
            (DVec3::new(-1.5, 0.1, -0.5), DVec3::Z, DVec3::Y, 0.02, 0.3),
            (DVec3::new(-0.1, -0.1, 1.0), DVec3::X * 0.2, DVec3::Y * 0.2, 1.0, 0.1),
        ] {
            let polygon = [corner, corner + x, corner + x + y, corner + y];
            let found = integrate(&polygon, to_eye(cos_view), roughness, 1e-5);
            let lobe = Lobe::new(roughness, to_eye(cos_view));
            let sampled = by_samples(corner, x, y, &lobe, 600);
            let off = found.value.map(sampled, |a, b| (a - b).abs() / b);
            assert!(
                off.largest() < 2e-3,
                "{cos_view}, {roughness}: {found:?}, sampled {sampled:?}"
            );
        }
    }

    #[test]
    fn errors_bound_the_change_of_a_finer_quadrature() {
        let polygon = [[-3.0, -1.0], [1.0, -2.0], [2.0, 1.0], [-1.0, 2.0]];
        for height in [0.1, 1.0] {
            let polygon = polygon.map(|[x, y]| DVec3::new(x, y, height + 0.03 * x));
            for roughness in [0.0, 0.045, 0.1, 0.3, 1.0] {
                for cos_view in [0.01, 0.3, 1.0] {
                    let coarse = integrate(&polygon, to_eye(cos_view), roughness, 1e-3);
                    let fine = integrate(&polygon, to_eye(cos_view), roughness, 1e-8);
                    let off = coarse.value.map(fine.value, |a, b| (a - b).abs());
                    let excess = off.map(coarse.error, |off, error| off - error);
                    assert!(
                        excess.largest() < 1e-9,
                        "{roughness}, {cos_view}: {coarse:?} {fine:?}"
                    );
                    let allowed = fine
                        .error
                        .map(fine.value, |error, value| error - 1.01e-8 * value.max(SMALLEST));
                    assert!(allowed.largest() <= 0.0, "{roughness}, {cos_view}: {fine:?}");
                }
            }
        }
    }

    #[test]
    fn no_peak_is_missed() {
        // The reflection of a mirror, a tenth of a degree wide, anywhere in the sky.
        let sky = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x, y, 1e-9));
        for step in 0..400 {
            let turn = f64::from(step);
            let cos = 0.3 + 0.7 * (turn + 0.5) / 400.0;
            let sin = (1.0 - cos * cos).sqrt();
            let to_eye = DVec3::new(sin * turn.cos(), sin * turn.sin(), cos);
            let found = integrate(&sky, to_eye, 0.0, 0.05);
            assert!((found.value.specular - 1.0).abs() < 0.01, "{step}: {found:?}");
        }
    }

    #[test]
    fn the_whole_hemisphere_is_reflected_by_a_smooth_mirror() {
        let sky = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x, y, 1e-9));
        let found = integrate(&sky, to_eye(0.8), 0.045, 1e-4);
        assert!((found.value.specular - 1.0).abs() < 1e-3, "{found:?}");
        assert!((found.value.diffuse - 1.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn nothing_comes_from_below_the_horizon() {
        let below = [[0.0, 0.0], [1.0, 0.0], [0.0, TAU]].map(|[x, y]| DVec3::new(x, y, -0.1));
        let found = integrate(&below, to_eye(0.5), 0.3, 1e-3);
        assert_eq!((found.value, found.triangles), (Integrals::default(), 0));
        assert_eq!(integrate(&[], to_eye(0.5), 0.3, 1e-3).value, Integrals::default());
    }

    #[test]
    fn nan_inputs_end_at_once() {
        let above =
            [DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.2, 1.0), DVec3::new(0.1, 1.0, 1.0)];
        let odd = [
            (DVec3::NAN, 0.0),
            (DVec3::ZERO, 0.0),
            (DVec3::INFINITY, 1.0),
            (to_eye(0.5), f64::NAN),
        ];
        for (to_eye, roughness) in odd {
            assert!(integrate(&above, to_eye, roughness, 1e-3).triangles < 10_000);
        }
        assert!(integrate(&[DVec3::NAN; 4], to_eye(0.5), 0.3, 1e-3).triangles < 10_000);
    }
}
