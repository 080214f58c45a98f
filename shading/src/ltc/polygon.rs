//! The integral of a cosine, and of a linearly transformed one, over a polygon.
//!
//! The integral of `cos / pi` over a spherical polygon is a sum over its edges (Lambert 1760; Baum
//! et al. 1989, equation 1). Each edge adds `1 / 2 pi` times the angle that it spans, times the z
//! of the unit vector perpendicular to its ends. Three measures keep the sum precise, also in
//! single precision:
//!
//! - An edge that spans more than a right angle is split at its point closest to the origin
//!   (Dobetsberger 2025, section 5.4.4). Each part then spans less than a right angle, so no cross
//!   product of opposite directions vanishes.
//! - The rest of the angle, `angle / sin(angle) - 1`, is a polynomial of `1 - cos(angle)`, which
//!   follows from the distance of the ends. This needs no inverse cosine and loses no digits at
//!   small angles.
//! - The cross products of a small polygon cancel. The first vertex is subtracted from every other
//!   one. This leaves the sum unchanged, and nothing cancels.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

/// `angle / sin(angle) - 1` over `t = 1 - cos(angle)`, as a polynomial of t in 0..1, lowest power
/// first. It is interpolated at Chebyshev's points; times t, the error is at most 5.9e-8.
const ANGLE_EXCESS: [f64; 9] = [
    0.333_333_363_655,
    0.133_328_435_801,
    0.057_271_483_233,
    0.024_114_098_876,
    0.017_840_922_714,
    -0.011_612_073_188,
    0.028_214_588_355,
    -0.019_945_957_286,
    0.008_251_405_882,
];

/// Form factor of a polygon, 0 to 1: the integral of `cos / pi` over the part of it above the
/// horizon. Vertices are in the shading frame, in order around the polygon.
pub fn cosine_integral(vertices: &[DVec3]) -> f64 {
    edge_sum(&clip(vertices))
}

/// The share of the lobe of a linearly transformed cosine that a polygon covers, 0 to 1, for the
/// inverse of the lobe's matrix. It is exactly 0 below the horizon.
pub fn ltc_integral(inverse: &DMat3, vertices: &[DVec3]) -> f64 {
    // Clip at the surface's horizon first, then at the cosine's own, which is tilted with the lobe.
    let above: Vec<DVec3> = clip(vertices).into_iter().map(|vertex| *inverse * vertex).collect();
    edge_sum(&clip(&above))
}

/// The share of a lobe above the surface's horizon, for the inverse of its matrix M.
///
/// M^-1 maps the upper half-space to one around the third row of M, which is along (-c, 0, a). A
/// half-space at an angle t to the cosine's own covers `(1 + cos t) / 2` of it.
pub(super) fn share_above_horizon(inverse: &DMat3) -> f64 {
    let (a, c) = (inverse.x_axis.x, inverse.x_axis.z);
    0.5 + 0.5 * a / a.hypot(c)
}

/// The part of a polygon in `z > 0` (Sutherland and Hodgman 1974). A convex polygon gains at most
/// one vertex.
pub(super) fn clip(vertices: &[DVec3]) -> Vec<DVec3> {
    clip_at(vertices, DVec3::Z)
}

/// The part of a polygon in the half-space that a normal points into.
pub(super) fn clip_at(vertices: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(vertices.len() + 1);
    let Some(&last) = vertices.last() else { return kept };
    let (mut from, mut from_height) = (last, last.dot(normal));
    for &to in vertices {
        let to_height = to.dot(normal);
        // A vertex in the plane counts as outside, so nothing remains of a polygon that only
        // touches the plane.
        if (from_height > 0.0) != (to_height > 0.0) {
            let crossing = from + (to - from) * (from_height / (from_height - to_height));
            kept.push(crossing - normal * crossing.dot(normal));
        }
        if to_height > 0.0 {
            kept.push(to);
        }
        (from, from_height) = (to, to_height);
    }
    kept
}

/// The unsigned sum over the edges of a polygon above the horizon.
fn edge_sum(vertices: &[DVec3]) -> f64 {
    let (Some(&first), Some(&last)) = (vertices.first(), vertices.last()) else { return 0.0 };
    let base = first.normalize_or_zero();
    let mut sum = 0.0;
    let (mut from, mut from_unit) = (last, last.normalize_or_zero());
    for &to in vertices {
        let to_unit = to.normalize_or_zero();
        if from_unit.dot(to_unit) < 0.0 {
            let middle = closest_to_origin(from, to).normalize_or_zero();
            sum += edge(base, from_unit, middle) + edge(base, middle, to_unit);
        } else {
            sum += edge(base, from_unit, to_unit);
        }
        (from, from_unit) = (to, to_unit);
    }
    (sum / TAU).abs().clamp(0.0, 1.0)
}

/// The point closest to the origin on a segment whose ends span an obtuse angle there. It lies
/// between the ends.
fn closest_to_origin(from: DVec3, to: DVec3) -> DVec3 {
    let along = to - from;
    from - along * (from.dot(along) / along.length_squared())
}

/// An edge's part of the sum. Its unit ends span at most a right angle.
fn edge(base: DVec3, from: DVec3, to: DVec3) -> f64 {
    let t = 0.5 * (to - from).length_squared();
    let excess = t * ANGLE_EXCESS.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient);
    cross_z(from - base, to - base) + excess * cross_z(from, to)
}

fn cross_z(a: DVec3, b: DVec3) -> f64 {
    a.x * b.y - a.y * b.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ltc::{SphericalRectangle, integrate};

    /// A rectangle around `center`, spanned by half its edges.
    fn rectangle(center: DVec3, x: DVec3, y: DVec3) -> [DVec3; 4] {
        [center - x - y, center + x - y, center + x + y, center - x + y]
    }

    fn stretched() -> DMat3 {
        let lobe = DMat3::from_cols(
            DVec3::new(0.2, 0.0, -0.1),
            DVec3::new(0.0, 0.1, 0.0),
            DVec3::new(-0.5, 0.0, 0.8),
        );
        lobe.inverse()
    }

    #[test]
    fn a_square_overhead_has_the_form_factor_of_the_textbooks() {
        // Howell's catalogue, configuration B-3: a corner above the point, with sides a and b at
        // height 1.
        let (a, b) = (0.7_f64, 2.5_f64);
        let corner = |x, y| DVec3::new(x, y, 1.0);
        let square = [corner(0.0, 0.0), corner(a, 0.0), corner(a, b), corner(0.0, b)];
        let side = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        let expected = (side(a, b) + side(b, a)) / TAU;
        assert!((cosine_integral(&square) - expected).abs() < 1e-8);
        // Far away, its digits do not cancel.
        let far = rectangle(DVec3::splat(1e6), DVec3::X * 0.5, DVec3::Y * 0.5);
        assert!((cosine_integral(&far) * 9e12 * std::f64::consts::PI - 1.0).abs() < 1e-8);
    }

    #[test]
    fn the_angle_is_precise_to_single_precision() {
        for step in 1..=1000 {
            let angle = f64::from(step) / 1000.0 * std::f64::consts::FRAC_PI_2;
            let sum = edge(DVec3::ZERO, DVec3::X, DVec3::new(angle.cos(), angle.sin(), 0.0));
            assert!((sum - angle).abs() < 6e-8, "{angle}: {sum}");
        }
    }

    #[test]
    fn a_whole_hemisphere_gives_one_for_every_lobe() {
        // The lobe's own horizon equals the surface's here, so nothing of it is cut off.
        let wide = rectangle(DVec3::Z * 1e-9, DVec3::X, DVec3::Y);
        assert!((cosine_integral(&wide) - 1.0).abs() < 1e-6);
        let scaled = DMat3::from_diagonal(DVec3::new(3.0, 1.0, 0.5));
        assert!((ltc_integral(&scaled, &wide) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn nothing_comes_from_below_the_horizon() {
        for vertices in [
            rectangle(DVec3::new(-0.5, 0.0, -0.2), DVec3::X, DVec3::Y),
            rectangle(DVec3::new(-0.5, 0.0, -1.0), DVec3::Z, DVec3::Y),
            rectangle(DVec3::ZERO, DVec3::X, DVec3::Y),
        ] {
            assert_eq!(cosine_integral(&vertices), 0.0);
            assert_eq!(ltc_integral(&stretched(), &vertices), 0.0);
        }
        // Half of it lies above: the same as only the upper half.
        let half = rectangle(DVec3::new(-1.0, 0.2, 0.0), DVec3::Z, DVec3::Y);
        let upper = rectangle(DVec3::new(-1.0, 0.2, 0.5), DVec3::Z * 0.5, DVec3::Y);
        let difference = ltc_integral(&stretched(), &half) - ltc_integral(&stretched(), &upper);
        assert!(difference.abs() < 1e-12, "{difference}");
        assert!(ltc_integral(&stretched(), &half) > 0.01);
    }

    #[test]
    fn winding_start_and_degenerate_vertices_do_not_matter() {
        let vertices = rectangle(DVec3::new(-1.0, 0.2, 0.3), DVec3::Z, DVec3::Y);
        let whole = ltc_integral(&stretched(), &vertices);
        let mut turned = vertices;
        turned.rotate_left(1);
        turned.reverse();
        assert!((ltc_integral(&stretched(), &turned) - whole).abs() < 1e-12);
        for degenerate in [&vertices[..0], &vertices[..1], &vertices[..2], &[DVec3::ZERO; 5]] {
            assert_eq!(ltc_integral(&stretched(), degenerate), 0.0);
        }
        let odd = [DVec3::NAN, DVec3::new(1.0, 0.0, 1.0), DVec3::INFINITY, DVec3::ONE];
        assert!((0.0..=1.0).contains(&cosine_integral(&odd)));
    }

    #[test]
    fn a_long_light_close_by_is_the_sum_of_its_hundred_squares() {
        // 4 m by 4 cm, 5 cm away: both long edges span nearly half the sphere. The point moves
        // along them.
        for step in 0..200 {
            let center = DVec3::new(f64::from(step) * 0.005 - 0.5, 0.0, 0.05);
            let (x, y) = (DVec3::X, DVec3::new(0.0, 0.6, 0.8));
            let long = rectangle(center, 2.0 * x, 0.02 * y);
            let squares = (0..100).map(|square| {
                let offset = (f64::from(square) - 49.5) * 0.04 * x;
                ltc_integral(&stretched(), &rectangle(center + offset, 0.02 * x, 0.02 * y))
            });
            let (whole, parts) = (ltc_integral(&stretched(), &long), squares.sum::<f64>());
            assert!((whole - parts).abs() < 1e-7 && whole > 1e-3, "{step}: {whole}, {parts}");
        }
    }

    #[test]
    fn ltc_integral_matches_the_integral_of_the_transformed_density() {
        // Compare with the midpoint rule, over a rectangle across the horizon and across the lobe's
        // own.
        let inverse = stretched();
        let (corner, x, y) = (DVec3::new(-2.0, -0.3, -0.5), DVec3::X * 4.0, DVec3::Z * 2.0);
        let rectangle = SphericalRectangle::new(corner, x, y).unwrap();
        let side = 1000;
        let at = |step: u32| (f64::from(step) + 0.5) / f64::from(side);
        let density = |direction: DVec3| {
            let cosine = inverse * direction;
            let is_above = direction.z > 0.0 && cosine.z > 0.0;
            let value = cosine.z * inverse.determinant() / cosine.length_squared().powi(2);
            if is_above { value / std::f64::consts::PI } else { 0.0 }
        };
        let places = (0..side * side).map(|ix| rectangle.direction(at(ix % side), at(ix / side)));
        let sum: f64 = places.map(density).sum();
        let sampled = sum * rectangle.solid_angle() / f64::from(side * side);
        let closed = ltc_integral(&inverse, &[corner, corner + x, corner + x + y, corner + y]);
        assert!((closed / sampled - 1.0).abs() < 1e-5 && closed > 0.05, "{closed} {sampled}");
    }

    #[test]
    fn cosine_integral_matches_quadrature() {
        let vertices = rectangle(DVec3::new(0.3, 0.2, 0.4), DVec3::X, DVec3::new(0.0, 0.5, 0.5));
        let truth = integrate(&vertices, DVec3::Z, 0.5, 1e-6);
        let closed = cosine_integral(&vertices);
        assert!((closed - truth.value.diffuse).abs() < 1e-6, "{closed} {truth:?}");
    }
}
