//! The exact geometry in f64: convex hulls, distances, and whether two convex sets overlap.
//!
//! It shares no formula with the code under test. Distances come from triangles, overlaps only from
//! support points (Gilbert, Johnson and Keerthi 1988).

use assign::{Light, LightShape, Outline};
use glam::DVec3;

/// Faces of a hexahedron whose corner index has x in bit 0, y in bit 1, depth in bit 2.
const FACES: [[usize; 4]; 6] =
    [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];

/// A convex hexahedron with plane faces, possibly flat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull(pub(crate) [DVec3; 8]);

impl Hull {
    /// The point of the hull nearest to `p`.
    pub(crate) fn nearest(&self, p: DVec3) -> DVec3 {
        if self.holds(p) {
            return p;
        }
        FACES
            .iter()
            .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]])
            .map(|[a, b, c]| nearest_on_triangle(p, self.0[a], self.0[b], self.0[c]))
            .min_by(|x, y| x.distance_squared(p).total_cmp(&y.distance_squared(p)))
            .unwrap()
    }

    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        self.nearest(p).distance(p)
    }

    /// The corner blend of `weights`, which are normalised.
    pub(crate) fn blend(&self, weights: [f64; 8]) -> DVec3 {
        let sum: f64 = weights.iter().sum();
        self.0.iter().zip(weights).map(|(c, w)| c * (w / sum)).sum()
    }

    fn holds(&self, p: DVec3) -> bool {
        let centroid = self.0.iter().sum::<DVec3>() / 8.0;
        FACES.iter().all(|f| {
            let [a, b, c, d] = f.map(|i| self.0[i]);
            // The normal comes from the diagonals, because a face may have edges of length 0.
            let normal = (c - a).cross(d - b).normalize_or_zero();
            let size = (c - a).length() + (d - b).length();
            let thickness = normal.dot(centroid - a);
            // A flat hull contains nothing; its faces are at distance 0.
            thickness.abs() > 1e-12 * size && normal.dot(p - a) * thickness.signum() >= 0.0
        })
    }

    fn support(&self, direction: DVec3) -> DVec3 {
        *self.0.iter().max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction))).unwrap()
    }
}

/// Ericson 2004, section 5.1.5, by regions.
fn nearest_on_triangle(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        let n = normal.normalize();
        return p - n * n.dot(p - a);
    }
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(|(from, to)| {
            let edge = to - from;
            let length_2 = edge.length_squared();
            let t = if length_2 > 0.0 { edge.dot(p - from) / length_2 } else { 0.0 };
            from + edge * t.clamp(0.0, 1.0)
        })
        .min_by(|x, y| x.distance_squared(p).total_cmp(&y.distance_squared(p)))
        .unwrap()
}

/// A ball cut by a cone of half angle up to π/2, apex at the origin, swept over an outline.
#[derive(Clone, Debug)]
pub(crate) struct Wedge {
    pub(crate) axis: DVec3,
    pub(crate) half_angle: f64,
    pub(crate) range: f64,
    /// Vertices of the outline; empty if the outline is the origin.
    pub(crate) outline: Vec<DVec3>,
}

impl Wedge {
    fn size(&self) -> f64 {
        self.range + self.outline.iter().map(|v| v.length()).fold(0.0, f64::max)
    }

    fn support(&self, direction: DVec3) -> DVec3 {
        let along = |v: &&DVec3| v.dot(direction);
        let vertex = self.outline.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
        vertex.copied().unwrap_or_default() + self.blown_up(direction)
    }

    fn blown_up(&self, direction: DVec3) -> DVec3 {
        let u = direction.normalize_or(DVec3::X);
        let along = self.axis.dot(u);
        let across = u - self.axis * along;
        let angle = across.length().atan2(along);
        if angle <= self.half_angle {
            return u * self.range;
        }
        // Straight behind the apex, any direction across works.
        let out = if across.length() > 1e-9 {
            across.reject_from(self.axis).normalize()
        } else {
            self.axis.any_orthonormal_vector()
        };
        let (sin, cos) = self.half_angle.sin_cos();
        let rim = (self.axis * cos + out * sin) * self.range;
        if rim.dot(u) > 0.0 { rim } else { DVec3::ZERO }
    }
}

/// Convex subsets of a light's support, around the origin. Up to a half angle of π/2 there is one
/// subset, the whole support. Above, the support is the union of all half balls tilted off the
/// axis; these are eight of them, the first tilted towards `towards`.
pub(crate) fn wedges(light: &Light, towards: DVec3) -> Vec<Wedge> {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let range = f64::from(light.range_m);
    let half =
        |axis: DVec3, outline: Vec<DVec3>| Wedge { axis, half_angle: FRAC_PI_2, range, outline };
    let (direction, outer_angle) = match &light.shape {
        LightShape::Point => {
            let axis = towards.normalize_or(DVec3::X);
            return [axis, -axis].map(|axis| half(axis, vec![])).to_vec();
        }
        LightShape::Area(emitter) if emitter.is_solid() => {
            let axis = towards.normalize_or(DVec3::X);
            let end = emitter.half_axes()[0].as_dvec3();
            let range = range + f64::from(emitter.radius_m());
            let outline = vec![-end, end];
            return [axis, -axis]
                .map(|axis| Wedge { axis, half_angle: FRAC_PI_2, range, outline: outline.clone() })
                .to_vec();
        }
        LightShape::Area(emitter) if emitter.outline() == Outline::Disc => {
            let front = emitter.normal().as_dvec3();
            let x = front.any_orthonormal_vector() * f64::from(emitter.radius_m());
            let y = front.cross(x);
            let place = |ix: u32| {
                let (sin, cos) = (TAU * f64::from(ix) / 96.0).sin_cos();
                x * cos + y * sin
            };
            let outline: Vec<DVec3> = (0..96).map(place).collect();
            let sides = if emitter.two_sided { 2 } else { 1 };
            return [front, -front][..sides].iter().map(|n| half(*n, outline.clone())).collect();
        }
        LightShape::Area(emitter) => {
            let outline: Vec<DVec3> = emitter.vertices().iter().map(|v| v.as_dvec3()).collect();
            let front = outline[0] - outline[1];
            let front = (outline[2] - outline[1]).cross(front).normalize();
            let sides = if emitter.two_sided { 2 } else { 1 };
            return [front, -front][..sides].iter().map(|n| half(*n, outline.clone())).collect();
        }
        LightShape::Spot { direction, outer_angle, .. } => (direction, outer_angle),
        LightShape::Vpl { normal, .. } => return vec![half(normal.as_dvec3(), vec![])],
    };
    let axis = direction.as_dvec3().normalize();
    let outer = f64::from(*outer_angle);
    if outer <= FRAC_PI_2 {
        return vec![Wedge { axis, half_angle: outer, range, outline: vec![] }];
    }
    let tilt = outer.min(PI) - FRAC_PI_2;
    let x = (towards - axis * axis.dot(towards)).normalize_or(axis.any_orthonormal_vector());
    let y = axis.cross(x);
    (0..8)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 8.0).sin_cos();
            half(axis * tilt.cos() + (x * cos + y * sin) * tilt.sin(), vec![])
        })
        .collect()
}

/// What the search found out about two convex sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Overlap {
    /// A separating plane was found.
    Apart,
    /// They share this point of the hull, up to `1e-8` of the wedge's size.
    At(DVec3),
    /// The sets are too close to decide.
    Unknown,
}

/// Whether a hull, seen from the light's centre, and a wedge overlap.
pub(crate) fn overlap(hull: &Hull, wedge: &Wedge) -> Overlap {
    let tolerance = 1e-8 * wedge.size();
    let vertex = |direction: DVec3| {
        let (on_hull, on_wedge) = (hull.support(-direction), wedge.support(direction));
        (on_hull - on_wedge, on_hull)
    };
    let mut simplex = vec![vertex(wedge.axis)];
    for _ in 0..128 {
        let (weights, v) = nearest_to_origin(&mut simplex);
        if v.length() <= tolerance {
            return Overlap::At(simplex.iter().zip(weights).map(|(s, w)| s.1 * w).sum());
        }
        let next = vertex(v);
        // The whole difference of the sets lies beyond the plane through `next` normal to `v`.
        let gap = v.dot(next.0) / v.length();
        if gap > tolerance {
            return Overlap::Apart;
        }
        if v.length() - gap <= 1e-14 * v.length() || simplex.iter().any(|s| s.0 == next.0) {
            return Overlap::Unknown;
        }
        simplex.push(next);
    }
    Overlap::Unknown
}

/// The point of the simplex nearest to the origin. Drops the vertices that do not contribute to it.
fn nearest_to_origin(simplex: &mut Vec<(DVec3, DVec3)>) -> (Vec<f64>, DVec3) {
    let count = simplex.len();
    let mut best: Option<(u32, Vec<f64>, DVec3)> = None;
    for subset in 1_u32..1 << count {
        let points: Vec<DVec3> =
            (0..count).filter(|i| subset >> i & 1 == 1).map(|i| simplex[i].0).collect();
        let Some(weights) = affine_nearest(&points) else {
            continue;
        };
        let v: DVec3 = points.iter().zip(&weights).map(|(p, w)| p * *w).sum();
        let better = best.as_ref().is_none_or(|b| v.length_squared() < b.2.length_squared());
        if better && weights.iter().all(|w| *w >= 0.0) {
            best = Some((subset, weights, v));
        }
    }
    let (subset, weights, v) = best.unwrap();
    let mut index = 0;
    simplex.retain(|_| {
        index += 1;
        subset >> (index - 1) & 1 == 1
    });
    (weights, v)
}

/// Barycentric weights of the point nearest to the origin on the affine hull of up to 4 points.
fn affine_nearest(points: &[DVec3]) -> Option<Vec<f64>> {
    use glam::{DMat2, DMat3, DVec2};
    let origin = points[0];
    let edges: Vec<DVec3> = points[1..].iter().map(|p| p - origin).collect();
    let g = |i: usize, j: usize| edges[i].dot(edges[j]);
    let r = |i: usize| -edges[i].dot(origin);
    let rest = match edges.len() {
        0 => vec![],
        1 if g(0, 0) > 0.0 => vec![r(0) / g(0, 0)],
        2 => {
            let m = DMat2::from_cols_array(&[g(0, 0), g(1, 0), g(0, 1), g(1, 1)]);
            let flat = m.determinant() <= 1e-24 * g(0, 0) * g(1, 1);
            (!flat).then(|| (m.inverse() * DVec2::new(r(0), r(1))).to_array().to_vec())?
        }
        3 => {
            // The edges span space, so the solution is the origin itself.
            let m = DMat3::from_cols(edges[0], edges[1], edges[2]);
            let volume = edges.iter().map(|e| e.length()).product::<f64>();
            let flat = m.determinant().abs() <= 1e-12 * volume;
            (!flat).then(|| (m.inverse() * -origin).to_array().to_vec())?
        }
        _ => return None,
    };
    let first = 1.0 - rest.iter().sum::<f64>();
    Some([vec![first], rest].concat())
}

mod tests {
    use super::*;

    fn cube() -> Hull {
        Hull(std::array::from_fn(|i| {
            DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64)
        }))
    }

    #[test]
    fn distance_to_face_edge_corner_and_inside() {
        assert_eq!(cube().distance(DVec3::new(0.3, 0.4, 3.0)), 2.0);
        assert_eq!(cube().distance(DVec3::new(0.3, 4.0, 5.0)), 5.0);
        assert_eq!(cube().distance(DVec3::new(3.0, 3.0, -1.0)), 3.0);
        assert_eq!(cube().distance(DVec3::splat(0.5)), 0.0);
    }

    #[test]
    fn overlap_of_a_wedge_and_a_cube() {
        let apart_by = |x: f64, axis: DVec3, half_angle: f64, range: f64| {
            let hull = Hull(cube().0.map(|c| c + DVec3::new(x, -0.5, -0.5)));
            overlap(&hull, &Wedge { axis, half_angle, range, outline: vec![] })
        };
        assert!(matches!(apart_by(1.0, DVec3::X, 0.1, 1.001), Overlap::At(_)));
        assert_eq!(apart_by(1.0, DVec3::X, 0.1, 0.999), Overlap::Apart);
        assert_eq!(apart_by(1.0, DVec3::NEG_X, 0.1, 9.0), Overlap::Apart);
        assert_eq!(apart_by(1.0, DVec3::Y, 0.7, 9.0), Overlap::Apart);
        assert!(matches!(apart_by(1.0, DVec3::Y, 1.2, 9.0), Overlap::At(_)));
        assert!(matches!(apart_by(-0.5, DVec3::Y, 0.2, 0.01), Overlap::At(_)));
    }
}
