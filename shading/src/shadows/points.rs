//! The points of an emitter from which shadow maps are drawn.

mod curved;

use assign::{Emitter, Outline};
use curved::curved_point;
use glam::{DVec3, Vec3};

/// A point of an emitter, and its share of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LightPoint {
    /// Relative to the light's position, metres.
    pub(super) offset: DVec3,
    /// The area of the light that it stands for, relative to those of the light's other points.
    pub(super) weight: u32,
}

impl LightPoint {
    /// The only point of a light that has one position.
    pub(super) const MIDDLE: Self = Self { offset: DVec3::ZERO, weight: 1 };
}

/// `count` points of an emitter, one of [`MAP_COUNTS`](crate::MAP_COUNTS) or [`RAY_COUNTS`](crate::RAY_COUNTS).
///
/// A rectangle's points are the corners of its quads: 4 of the whole, and 9, 25, 81 or 289 after one to four
/// subdivisions of every quad (Dobetsberger 2025, section 6.1). 16 are the corners of three by three quads. A quad's irradiance is the mean over its corners, and a
/// rectangle's is the sum over its quads. So a point has the weight of the quads that share it: 1 at a corner, 2 on an
/// edge, 4 inside. This is the trapezoidal rule. The equal weights of equation 6.2 would give the outline too much.
///
/// A polygon has no quads. Its points are those of a Hammersley set, mapped to equal areas, with equal weights. Those of
/// discs, spheres and lines have equal weights, too.
pub(super) fn points_of(emitter: &Emitter, count: u32) -> Vec<LightPoint> {
    match (count, emitter.outline()) {
        (0 | 1, Outline::Rectangle) => vec![LightPoint::MIDDLE],
        (_, Outline::Rectangle) => corners_of_quads(emitter, count.isqrt()),
        (_, Outline::Polygon) => (0..count.max(1))
            .map(|ix| LightPoint { offset: polygon_point(emitter, ix, count.max(1)), weight: 1 })
            .collect(),
        (_, Outline::Disc | Outline::Sphere | Outline::Line) => (0..count.max(1))
            .map(|ix| LightPoint { offset: curved_point(emitter, ix, count), weight: 1 })
            .collect(),
    }
}

/// A grid of `side` x `side` points from corner to corner.
fn corners_of_quads(emitter: &Emitter, side: u32) -> Vec<LightPoint> {
    let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
    let last = side - 1;
    let place = |ix: u32| 2.0 * f64::from(ix) / f64::from(last) - 1.0;
    let weight = |ix: u32| if ix == 0 || ix == last { 1 } else { 2 };
    (0..side * side)
        .map(|ix| {
            let (i, j) = (ix % side, ix / side);
            LightPoint { offset: x * place(i) + y * place(j), weight: weight(i) * weight(j) }
        })
        .collect()
}

/// Point `ix` of a Hammersley set of `count`, in a polygon.
fn polygon_point(emitter: &Emitter, ix: u32, count: u32) -> DVec3 {
    let vertices: Vec<DVec3> = emitter.vertices().iter().map(|v| v.as_dvec3()).collect();
    let triangles: Vec<[DVec3; 3]> =
        (2..vertices.len()).map(|i| [vertices[0], vertices[i - 1], vertices[i]]).collect();
    let area = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).length();
    let total: f64 = triangles.iter().map(area).sum();
    // The first coordinate chooses a triangle by area; what is left of it is a coordinate inside.
    let mut left = (f64::from(ix) + 0.5) / f64::from(count) * total;
    let t = f64::from(ix.reverse_bits()) / 4_294_967_296.0 + 0.5 / f64::from(count);
    for (place, triangle) in triangles.iter().enumerate() {
        let size = area(triangle);
        if left <= size || place + 1 == triangles.len() {
            let [a, b, c] = *triangle;
            let from_a = (left / size.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0).sqrt();
            return a + (b - a) * from_a + (c - b) * (from_a * t.min(1.0));
        }
        left -= size;
    }
    DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RAY_COUNTS;

    #[test]
    fn a_rectangle_gets_the_corners_of_its_quads() {
        let emitter = Emitter::rectangle(Vec3::X * 2.0, Vec3::Y);
        for count in RAY_COUNTS.into_iter().skip(1) {
            let points = points_of(&emitter, count);
            assert_eq!(points.len() as u32, count);
            // Every quad counts four corners.
            let quads = (count.isqrt() - 1).pow(2);
            assert_eq!(points.iter().map(|p| p.weight).sum::<u32>(), 4 * quads);
            for corner in emitter.vertices() {
                let near = |p: &&LightPoint| p.offset.distance(corner.as_dvec3()) < 1e-12;
                let found = points.iter().find(near).map(|p| p.weight);
                assert_eq!(found, Some(1), "{corner} of {count}");
            }
            let middle = points.iter().find(|p| p.offset == DVec3::ZERO).map(|p| p.weight);
            assert_eq!(middle, (count.isqrt() % 2 == 1).then_some(4));
        }
        assert_eq!(points_of(&emitter, 1), [LightPoint::MIDDLE]);
    }

    #[test]
    fn points_of_a_polygon_lie_inside_and_spread_evenly() {
        // A triangle and a square beside it: 1 / 3 of the area lies at negative x.
        let corners = [(-1.0, 0.0), (0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)];
        let corners = corners.map(|(x, y)| Vec3::new(x, y, 0.0));
        let (emitter, position) = Emitter::polygon(&corners).unwrap();
        for count in RAY_COUNTS {
            let points = points_of(&emitter, count);
            assert_eq!(points.len() as u32, count);
            for point in &points {
                assert!(emitter.closest(point.offset).distance(point.offset) < 1e-6, "{point:?}");
            }
            let left =
                points.iter().filter(|p| p.offset.x + f64::from(position.x) < 0.0).count() as f64;
            let share = left / f64::from(count);
            let most = 0.5 / f64::from(count).sqrt();
            assert!((share - 1.0 / 3.0).abs() < most, "{count}: {share}");
            let mean = points.iter().map(|p| p.offset.y).sum::<f64>() / f64::from(count)
                + f64::from(position.y);
            assert!(mean.abs() < most, "{count}: {mean}");
        }
    }
}
