//! What rays from a sample to an emitter hit.

use assign::{Emitter, Outline};
use glam::{DVec3, Vec3};

use crate::ltc::disc_of_sphere;

/// An emitter seen from a sample at the origin, world axes.
pub(super) struct Silhouette<'a> {
    emitter: &'a Emitter,
    /// Vector to the emitter's middle, metres.
    center: DVec3,
    /// Normal of a flat emitter, of any length. Half axes and [`Emitter::normal`] are rounded.
    normal: DVec3,
}

/// A rectangle: its middle, and its half axes at right angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover {
    pub(super) center: DVec3,
    pub(super) x: DVec3,
    pub(super) y: DVec3,
}

impl<'a> Silhouette<'a> {
    pub(super) fn new(emitter: &'a Emitter, center: DVec3) -> Self {
        let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
        let vertices = emitter.vertices().iter().map(|v| v.as_dvec3());
        let next = vertices.clone().cycle().skip(1);
        let normal = match emitter.outline() {
            Outline::Rectangle | Outline::Polygon => {
                vertices.zip(next).map(|(a, b)| a.cross(b)).sum()
            }
            Outline::Disc | Outline::Sphere | Outline::Line => x.cross(y),
        };
        Self { emitter, center, normal }
    }

    /// A rectangle that all rays to the emitter cross. The sample lies outside the emitter.
    pub(super) fn cover(&self) -> Cover {
        let [x, y] = self.emitter.half_axes().map(Vec3::as_dvec3);
        let radius = self.radius();
        let over_sphere = |center| {
            let disc = disc_of_sphere(center, radius);
            Cover { center: disc.center, x: disc.x, y: disc.y }
        };
        match self.emitter.outline() {
            Outline::Rectangle | Outline::Polygon | Outline::Disc => {
                Cover { center: self.center, x, y }
            }
            Outline::Sphere => over_sphere(self.center),
            Outline::Line => {
                let along = x.normalize_or(DVec3::Z);
                let across = self.center - along * along.dot(self.center);
                let distance = across.length();
                // Nothing but the near end is visible along the axis.
                if distance <= radius {
                    let side = if along.dot(self.center) > 0.0 { -x } else { x };
                    return over_sphere(self.center + side);
                }
                // The plane through the lines where two planes through the sample touch the tube.
                let sine = radius / distance;
                let cosine = (1.0 - sine * sine).sqrt();
                let end = |side: f64| {
                    let place = along.dot(self.center + x * side);
                    let root = (distance * distance + place * place - radius * radius).max(0.0);
                    place + side * radius * root.sqrt() / distance
                };
                let (low, high) = (end(-1.0), end(1.0));
                Cover {
                    center: across * (cosine * cosine) + along * (0.5 * (low + high)),
                    x: along * (0.5 * (high - low)),
                    y: along.cross(across).normalize_or_zero() * (radius * cosine),
                }
            }
        }
    }

    /// Whether the direction to a place hits the emitter.
    pub(super) fn is_hit(&self, place: DVec3) -> bool {
        match self.emitter.outline() {
            Outline::Rectangle | Outline::Polygon => {
                // The ray must pass all edges on the same side. This test needs no tolerance, however
                // large or far the emitter is.
                let count = self.emitter.vertices().len();
                let turn =
                    |ix: usize| self.vertex(ix).cross(self.vertex((ix + 1) % count)).dot(place);
                (0..count).all(|ix| turn(ix) >= 0.0) || (0..count).all(|ix| turn(ix) <= 0.0)
            }
            _ => self.point_along(place).is_some(),
        }
    }

    /// The point of the emitter that the ray to a place hits first, seen from the sample.
    pub(super) fn point_along(&self, place: DVec3) -> Option<DVec3> {
        match self.emitter.outline() {
            Outline::Rectangle | Outline::Polygon => {
                let along = self.normal.dot(self.vertex(0)) / self.normal.dot(place);
                (along > 0.0 && self.is_hit(place)).then(|| place * along)
            }
            Outline::Disc => {
                let along = self.normal.dot(self.center) / self.normal.dot(place);
                let point = place * along;
                let is_hit = along > 0.0 && point.distance(self.center) <= self.radius();
                is_hit.then_some(point)
            }
            Outline::Sphere | Outline::Line => {
                let direction = place.normalize_or_zero();
                self.distance_along(direction).map(|distance| direction * distance)
            }
        }
    }

    /// The distance at which a ray of a unit direction enters a sphere or a line.
    fn distance_along(&self, direction: DVec3) -> Option<f64> {
        let radius = self.radius();
        let enters = |center: DVec3| {
            let along = direction.dot(center);
            let off = (center - direction * along).length_squared();
            let root = radius * radius - off;
            (along > 0.0 && root >= 0.0).then(|| along - root.sqrt())
        };
        let x = self.emitter.half_axes()[0].as_dvec3();
        let mut found = vec![enters(self.center - x), enters(self.center + x)];
        if self.emitter.outline() == Outline::Line {
            // The side of the tube, where the ray enters it between the ends.
            let axis = x.normalize_or(DVec3::Z);
            let flat = |v: DVec3| v - axis * axis.dot(v);
            let (ray, middle) = (flat(direction), flat(self.center));
            let slope = ray.length_squared();
            let along = ray.dot(middle);
            let root = along * along - slope * (middle.length_squared() - radius * radius);
            if slope > 0.0 && root >= 0.0 && along > 0.0 {
                let distance = (along - root.sqrt()) / slope;
                let place = axis.dot(direction * distance - self.center);
                found.push((place.abs() <= x.length()).then_some(distance));
            }
        }
        found.into_iter().flatten().min_by(f64::total_cmp)
    }

    fn radius(&self) -> f64 {
        f64::from(self.emitter.radius_m())
    }

    /// Vector from the sample to a vertex.
    fn vertex(&self, ix: usize) -> DVec3 {
        self.emitter.vertices()[ix].as_dvec3() + self.center
    }
}
