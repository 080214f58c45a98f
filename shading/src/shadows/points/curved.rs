//! The points of discs, spheres and lines from which shadow maps are drawn, with equal weights.
//!
//! A disc's points spread evenly over it. The points of a sphere and a line serve samples on all sides. So they lie
//! inside, as densely as their outline is evenly filled from wherever they are seen: of a sphere, the share within the
//! radius r of 1 is `2 / pi (asin r - r sqrt(1 - r^2))`, and of a tube's cross-section `1 - sqrt(1 - r^2)` (Abel's
//! transform of a constant). A line's round ends have no points of their own.

use std::f64::consts::PI;

use assign::{Emitter, Outline};
use glam::{DVec3, Vec3};

/// The golden angle, radians: points at its multiples spread evenly around a circle.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// Point `ix` of `count`, relative to the light's position, metres.
pub(super) fn curved_point(emitter: &Emitter, ix: u32, count: u32) -> DVec3 {
    let radius = f64::from(emitter.radius_m());
    // One point represents the whole emitter best from its middle.
    if count <= 1 {
        return DVec3::ZERO;
    }
    let first = (f64::from(ix) + 0.5) / f64::from(count);
    let second = f64::from(ix.reverse_bits()) / 4_294_967_296.0 + 0.5 / f64::from(count);
    let (sin, cos) = (GOLDEN * f64::from(ix)).sin_cos();
    let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
    match emitter.outline() {
        Outline::Disc => {
            let [x, y] = [x, y].map(DVec3::normalize_or_zero);
            (x * cos + y * sin) * (radius * first.sqrt())
        }
        Outline::Line => {
            let z = x.normalize_or(DVec3::Z);
            let across = z.any_orthonormal_vector();
            let off = (1.0 - (1.0 - second.min(1.0)).powi(2)).sqrt();
            x * (2.0 * first - 1.0) + (across * cos + z.cross(across) * sin) * (radius * off)
        }
        _ => {
            let height = 1.0 - 2.0 * first;
            let level = (1.0 - height * height).max(0.0).sqrt();
            DVec3::new(level * cos, level * sin, height) * (radius * radius_of_share(second))
        }
    }
}

/// The radius within which a share of a ball's points lies, 0 to 1, by bisection.
fn radius_of_share(share: f64) -> f64 {
    let within = |r: f64| 2.0 / PI * (r.asin() - r * (1.0 - r * r).max(0.0).sqrt());
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if within(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MAP_COUNTS;

    /// Seen from any side, the outline is evenly filled: the mean squared distance from its middle is that of an even
    /// circle, half of the squared radius, or of an even segment, a third.
    #[test]
    fn points_fill_the_outline_evenly_from_all_sides() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        for (emitter, plane_share) in [
            (Emitter::disc(axis, 2.0), None),
            (Emitter::sphere(2.0), Some(0.5)),
            (Emitter::line(3.0 * axis, 0.5), None),
        ] {
            for count in MAP_COUNTS {
                let points: Vec<DVec3> =
                    (0..count).map(|ix| curved_point(&emitter, ix, count)).collect();
                for point in &points {
                    assert!(emitter.closest(*point).distance(*point) < 1e-6, "{point}");
                }
                if count < 81 {
                    continue;
                }
                let mean = points.iter().sum::<DVec3>() / f64::from(count);
                assert!(mean.length() < 0.1, "{emitter:?}, {count}: {mean}");
                for side in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.6, 0.8, 0.0)] {
                    let across = |p: &DVec3| p.reject_from_normalized(side).length_squared();
                    let spread = points.iter().map(across).sum::<f64>() / f64::from(count);
                    let spread = spread / f64::from(emitter.radius_m()).powi(2);
                    if let Some(expected) = plane_share {
                        assert!((spread - expected).abs() < 0.06, "{count} from {side}: {spread}");
                    }
                }
            }
        }
        // Across a tube, an even segment.
        let line = Emitter::line(3.0 * Vec3::Z, 0.5);
        let off = |ix| curved_point(&line, ix, 289).x.powi(2);
        let spread = (0..289).map(off).sum::<f64>() / 289.0 / 0.25;
        assert!((spread - 1.0 / 3.0).abs() < 0.03, "{spread}");
    }
}
