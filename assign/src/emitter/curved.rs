//! Discs, spheres and lines: emitters without vertices.
//!
//! A disc is flat and emits as a rectangle does. A sphere and a line are solid: they emit outwards from their whole
//! surface, and a point inside gets no light. A line is a tube with round ends, so that its points are those within its
//! radius of a segment. The distance to it is that to the segment less the radius.

use glam::{DVec3, Vec3};

use super::{Emitter, Outline};

impl Emitter {
    /// A one-sided disc of a radius, metres; it emits towards `normal`, a vector of any length but 0.
    pub fn disc(normal: Vec3, radius_m: f32) -> Self {
        let z = normal.as_dvec3().normalize_or_zero();
        let x = if z == DVec3::ZERO { z } else { z.any_orthonormal_vector() };
        // Rounded outwards: the half axes hold the disc, and culling bounds it by them.
        let size = f64::from(radius_m) * (1.0 + 8.0 * f64::from(f32::EPSILON));
        let [half_x, half_y] = [x, z.cross(x)].map(|axis| (axis * size).as_vec3());
        Self { outline: Outline::Disc, count: 0, radius_m, ..Self::rectangle(half_x, half_y) }
    }

    /// A sphere of a radius, metres. It emits in all directions.
    pub fn sphere(radius_m: f32) -> Self {
        let point = Self::rectangle(Vec3::ZERO, Vec3::ZERO);
        Self { outline: Outline::Sphere, count: 0, radius_m, ..point }
    }

    /// A line: a tube with round ends, from `-half_axis` to `half_axis`, of a radius; metres. It emits in all
    /// directions.
    pub fn line(half_axis: Vec3, radius_m: f32) -> Self {
        let segment = Self::rectangle(half_axis, Vec3::ZERO);
        Self { outline: Outline::Line, count: 0, radius_m, ..segment }
    }

    /// Radius of a disc, a sphere or a line, metres; 0 for other outlines.
    pub fn radius_m(&self) -> f32 {
        self.radius_m
    }

    /// Whether it is a sphere or a line, which have an inside.
    pub fn is_solid(&self) -> bool {
        matches!(self.outline, Outline::Sphere | Outline::Line)
    }

    /// Whether it emits to all sides: a sphere, a line, or a two-sided flat emitter.
    pub fn shines_all_around(&self) -> bool {
        self.two_sided || self.is_solid()
    }

    /// How far the emitter extends from its light's position along a vector, in metres times the vector's length.
    pub fn extent_along(&self, axis: DVec3) -> f64 {
        let radius = f64::from(self.radius_m);
        match self.outline {
            Outline::Rectangle | Outline::Polygon => {
                let heights = self.vertices().iter().map(|v| axis.dot(v.as_dvec3()));
                heights.fold(f64::NEG_INFINITY, f64::max)
            }
            Outline::Disc => {
                let normal = self.area_vector().normalize_or_zero();
                radius * (axis - normal * normal.dot(axis)).length()
            }
            Outline::Sphere | Outline::Line => {
                self.half_x.as_dvec3().dot(axis).abs() + radius * axis.length()
            }
        }
    }

    /// Largest area of a curved outline as seen from far away, square metres.
    pub(super) fn outline_area(&self) -> f64 {
        let radius = f64::from(self.radius_m);
        let circle = std::f64::consts::PI * radius * radius;
        match self.outline {
            Outline::Line => circle + 4.0 * radius * self.half_x.as_dvec3().length(),
            _ => circle,
        }
    }

    /// A disc's area along its normal; zero for a sphere or a line.
    pub(super) fn curved_area_vector(&self) -> DVec3 {
        let [x, y] = self.half_axes().map(Vec3::as_dvec3);
        x.cross(y).normalize_or_zero() * self.outline_area()
    }

    /// Distance of the farthest point of a curved emitter from the light's position, metres.
    pub(super) fn farthest_m(&self) -> f32 {
        match self.outline {
            Outline::Line => (self.half_x.length() + self.radius_m).next_up(),
            _ => self.radius_m,
        }
    }

    /// Distance to the surface of a sphere or a line, metres, negative inside.
    pub(super) fn outside(&self, offset: DVec3) -> f64 {
        offset.distance(self.closest_on_core(offset)) - f64::from(self.radius_m)
    }

    /// The point of a sphere's middle, or of a line's segment, closest to `offset`.
    fn closest_on_core(&self, offset: DVec3) -> DVec3 {
        let half = self.half_x.as_dvec3();
        let along = half.dot(offset) / half.length_squared().max(f64::MIN_POSITIVE);
        half * along.clamp(-1.0, 1.0)
    }

    /// The point of a curved emitter closest to `offset`, which is `offset` itself inside.
    pub(super) fn closest_curved(&self, offset: DVec3) -> DVec3 {
        let radius = f64::from(self.radius_m);
        if self.is_solid() {
            let core = self.closest_on_core(offset);
            return core + (offset - core).clamp_length_max(radius);
        }
        let normal = self.area_vector().normalize_or_zero();
        (offset - normal * normal.dot(offset)).clamp_length_max(radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_the_textbooks() {
        let disc = Emitter::disc(Vec3::new(0.0, 0.0, 3.0), 2.0);
        assert!((disc.area() - 4.0 * std::f32::consts::PI).abs() < 1e-5, "{}", disc.area());
        assert!((disc.normal() - Vec3::Z).length() < 1e-6, "{}", disc.normal());
        assert_eq!(disc.in_front(DVec3::NEG_Z), -1.0);
        let sphere = Emitter::sphere(2.0);
        assert_eq!((sphere.area(), sphere.normal()), (disc.area(), Vec3::ZERO));
        // 4 m between the ends' middles.
        let line = Emitter::line(2.0 * Vec3::X, 0.5);
        assert!((line.area() - (4.0 + 0.25 * std::f32::consts::PI)).abs() < 1e-5);
        assert_eq!(line.in_front(DVec3::new(4.0, 0.0, 0.0)), 1.5);
        assert_eq!(line.in_front(DVec3::new(1.0, 0.2, 0.0)), -0.3);
        assert!((line.radius() - 2.5).abs() < 1e-6);
        for emitter in [disc, sphere, line, disc.scaled(3.0), line.scaled(3.0)] {
            emitter.check().unwrap();
            let turn = glam::Mat3::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.0);
            emitter.turned(&turn).check().unwrap();
            assert_eq!(emitter.turned(&turn).area(), emitter.turned(&turn).area());
        }
    }

    /// No point of the emitter is closer than the closest one, and none extends farther than the extent.
    #[test]
    fn closest_points_and_extents_hold_all_points() {
        let place = |ix: u32, by: f64| (f64::from(ix) * by).fract() * 2.0 - 1.0;
        let unit = |ix: u32| {
            let v = DVec3::new(place(ix, 0.618_03), place(ix, 0.754_88), place(ix, 0.569_84));
            v.normalize_or(DVec3::X)
        };
        let axis = Vec3::new(0.3, -0.5, 0.8);
        for emitter in [Emitter::disc(axis, 0.7), Emitter::sphere(0.7), Emitter::line(axis, 0.2)] {
            let radius = f64::from(emitter.radius_m());
            let normal = emitter.normal().as_dvec3();
            let point = |ix: u32| {
                let off = unit(ix) * radius;
                match emitter.outline() {
                    Outline::Disc => (off - normal * normal.dot(off)).normalize_or_zero() * radius,
                    _ => off + emitter.half_axes()[0].as_dvec3() * place(ix, 0.414_21),
                }
            };
            let points: Vec<DVec3> = (0..2_000).map(point).collect();
            for ix in 0..200 {
                let offset = unit(ix + 7_000) * f64::from(ix + 1) * 0.02;
                let closest = emitter.closest(offset);
                // The closest point is a point of the emitter.
                assert!(emitter.closest(closest).distance(closest) < 1e-7);
                let least = points.iter().map(|p| p.distance(offset)).fold(f64::INFINITY, f64::min);
                let found = closest.distance(offset);
                assert!(found <= least + 1e-7, "{emitter:?}: {found} > {least}");
                let direction = unit(ix + 9_000);
                let most = points.iter().map(|p| p.dot(direction)).fold(f64::MIN, f64::max);
                let extent = emitter.extent_along(direction);
                assert!(
                    most <= extent + 1e-7 && extent < most + 0.1 * f64::from(emitter.radius()),
                    "{most} {extent}"
                );
            }
        }
    }
}
