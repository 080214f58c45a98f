//! Emitters: rectangles, convex polygons and discs, which are flat; spheres and lines, which are not.
//!
//! A flat emitter lies in a plane through its light's position. Its light reaches the points that are
//! closer to the emitter than the light's range; if the emitter is one-sided, only those in front
//! of its plane. So the support is the outline extended by a ball, or by the front half of a ball.
//! Along any axis it extends as far as the outline plus a ball, or plus a cone of half angle π/2
//! around the normal. Culling therefore reuses its code for spots.
//!
//! A sphere is a point, and a line is a segment, each extended by a ball of its radius (`curved.rs`).

mod check;
mod curved;

use glam::{DVec3, Mat3, Vec3};

use crate::light_fault::LightFault;

/// The most vertices of a polygon.
pub const MAX_VERTICES: usize = 10;

/// How far vertices may lie off their plane, and how far corners may turn the wrong way, as a share
/// of the emitter's size.
const FLATNESS: f32 = 1e-4;

/// The shape of an emitter's outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outline {
    /// Four right angles.
    Rectangle,
    /// 3 to [`MAX_VERTICES`] vertices, convex.
    Polygon,
    /// A circle.
    Disc,
    /// A ball around the light's position.
    Sphere,
    /// A tube with round ends: all points within its radius of a segment.
    Line,
}

impl Outline {
    /// Whether it has no vertices: a disc, a sphere or a line.
    pub fn is_curved(self) -> bool {
        matches!(self, Self::Disc | Self::Sphere | Self::Line)
    }
}

/// An emitter. It emits the same radiance from every point of its surface, in every direction. Its vertices are
/// relative to its light's position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    outline: Outline,
    count: u8,
    /// Relative to the light's position, metres, counter-clockwise seen from the front.
    vertices: [Vec3; MAX_VERTICES],
    half_x: Vec3,
    half_y: Vec3,
    /// Radius of a disc, a sphere or a line, metres; 0 for other outlines.
    radius_m: f32,
    /// Whether a flat emitter emits from its back as well. Spheres and lines emit outwards, whatever it says.
    pub two_sided: bool,
    /// Where the window of the diffuse term reaches 0, as a share of the light's range, above 0 and
    /// at most 1. The specular term extends to the full range (Swarbrick 2025, section 3.4).
    pub diffuse_share: f32,
}

impl Emitter {
    /// A one-sided rectangle from its half axes, metres, at right angles; it emits towards
    /// `half_x` x `half_y`.
    pub fn rectangle(half_x: Vec3, half_y: Vec3) -> Self {
        let mut vertices = [Vec3::ZERO; MAX_VERTICES];
        vertices[..4].copy_from_slice(&[
            -half_x - half_y,
            half_x - half_y,
            half_x + half_y,
            half_y - half_x,
        ]);
        Self {
            outline: Outline::Rectangle,
            count: 4,
            vertices,
            half_x,
            half_y,
            radius_m: 0.0,
            two_sided: false,
            diffuse_share: 1.0,
        }
    }

    /// An emitter from its record: half axes, radius, and vertices relative to the light's position.
    /// `None` if there are too many vertices.
    pub(crate) fn from_parts(
        outline: Outline,
        [half_x, half_y]: [Vec3; 2],
        radius_m: f32,
        corners: &[Vec3],
    ) -> Option<Self> {
        let mut vertices = [Vec3::ZERO; MAX_VERTICES];
        vertices.get_mut(..corners.len())?.copy_from_slice(corners);
        let count = corners.len() as u8;
        let two_sided = false;
        Some(Self {
            outline,
            count,
            vertices,
            half_x,
            half_y,
            radius_m,
            two_sided,
            diffuse_share: 1.0,
        })
    }

    /// Makes a one-sided convex polygon from its vertices: world space, metres, counter-clockwise
    /// seen from the front. Returns it with the light's position, the centre of the smallest
    /// rectangle around it.
    ///
    /// # Errors
    ///
    /// [`LightFault::OutOfRange`] if there are fewer than 3 or more than [`MAX_VERTICES`] vertices,
    /// or if a vertex lies off the plane of the others by more than 1e-4 of their size. A vertex
    /// that is closer to the plane is moved into it. [`Light::check`](crate::Light::check) finds
    /// all other faults.
    pub fn polygon(vertices_world: &[Vec3]) -> Result<(Self, Vec3), LightFault> {
        let count = vertices_world.len();
        if !(3..=MAX_VERTICES).contains(&count) {
            return Err(LightFault::OutOfRange {
                field: "polygon vertex count",
                value: count as f32,
                accepted: "3 to 10",
            });
        }
        let (center, half_x, half_y) = smallest_rectangle(vertices_world);
        let normal = half_x.as_dvec3().cross(half_y.as_dvec3()).normalize_or_zero();
        let size = half_x.length() + half_y.length();
        let mut vertices = [Vec3::ZERO; MAX_VERTICES];
        for (vertex, world) in vertices.iter_mut().zip(vertices_world) {
            let offset = world.as_dvec3() - center.as_dvec3();
            let off_plane = normal.dot(offset);
            let value = (off_plane.abs() / f64::from(size)) as f32;
            if value > FLATNESS {
                let field = "polygon vertex off its plane over size";
                return Err(LightFault::OutOfRange { field, value, accepted: "at most 1e-4" });
            }
            // Culling bounds the rectangle, so it would lose a part outside the rectangle's plane.
            *vertex = (offset - normal * off_plane).as_vec3();
        }
        let outline = Outline::Polygon;
        let count = count as u8;
        let rectangle = Self::rectangle(half_x, half_y);
        let emitter = Self { outline, count, vertices, ..rectangle };
        Ok((emitter, center))
    }

    /// The same emitter, emitting from both sides if it is flat.
    #[must_use]
    pub fn two_sided(self) -> Self {
        Self { two_sided: true, ..self }
    }

    /// The same emitter, with diffuse light up to a share of the range.
    #[must_use]
    pub fn with_diffuse_share(self, diffuse_share: f32) -> Self {
        Self { diffuse_share, ..self }
    }

    /// The same emitter, `factor` times as large.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            vertices: self.vertices.map(|v| v * factor),
            half_x: self.half_x * factor,
            half_y: self.half_y * factor,
            radius_m: self.radius_m * factor,
            ..self
        }
    }

    /// The same emitter, rotated about its light's position.
    #[must_use]
    pub fn turned(self, rotation: &Mat3) -> Self {
        let [x, y] = self.half_axes().map(|axis| *rotation * axis);
        if self.outline == Outline::Rectangle {
            let Self { two_sided, diffuse_share, .. } = self;
            return Self { two_sided, diffuse_share, ..Self::rectangle(x, y) };
        }
        if self.is_solid() {
            return Self { half_x: x, ..self };
        }
        // Rotated vertices are rounded, and the rectangle must still hold them.
        let [half_x, half_y] = [x, y].map(|axis| axis * (1.0 + 8.0 * f32::EPSILON));
        Self { vertices: self.vertices.map(|v| *rotation * v), half_x, half_y, ..self }
    }

    /// Its outline.
    pub fn outline(&self) -> Outline {
        self.outline
    }

    /// Vertices relative to the light's position, metres, counter-clockwise seen from the front.
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices[..usize::from(self.count)]
    }

    /// Half axes of the rectangle, or of the smallest rectangle around the polygon or the disc, metres. A
    /// line's first one leads from its middle to the middle of an end; all others of spheres and lines are zero.
    pub fn half_axes(&self) -> [Vec3; 2] {
        [self.half_x, self.half_y]
    }

    /// Unit normal of the front; zero for spheres, for lines and for an emitter without area.
    pub fn normal(&self) -> Vec3 {
        (self.area_vector() / self.area_vector().length().max(f64::MIN_POSITIVE)).as_vec3()
    }

    /// Area of one side, square metres; of a sphere or a line, the largest area of its outline as seen from
    /// far away.
    pub fn area(&self) -> f32 {
        let area_m2 = match self.outline {
            Outline::Sphere | Outline::Line => self.outline_area(),
            Outline::Rectangle | Outline::Polygon | Outline::Disc => self.area_vector().length(),
        };
        area_m2 as f32
    }

    /// Radius of a sphere around the light's position that holds the emitter, metres.
    pub fn radius(&self) -> f32 {
        if self.outline.is_curved() {
            return self.farthest_m().next_up();
        }
        self.vertices().iter().map(|v| v.length()).fold(0.0, f32::max).next_up()
    }

    /// The point of the emitter closest to `offset`, both relative to the light's position.
    pub fn closest(&self, offset: DVec3) -> DVec3 {
        if self.outline.is_curved() {
            return self.closest_curved(offset);
        }
        let normal = self.area_vector().normalize_or_zero();
        let on_plane = offset - normal * normal.dot(offset - self.vertices[0].as_dvec3());
        if self.edges().all(|(a, b)| normal.dot((b - a).cross(on_plane - a)) >= 0.0) {
            return on_plane;
        }
        let on_edges = self.edges().map(|(a, b)| {
            let edge = b - a;
            let along = edge.dot(offset - a) / edge.length_squared().max(f64::MIN_POSITIVE);
            a + edge * along.clamp(0.0, 1.0)
        });
        let nearer = |a: DVec3, b: DVec3| {
            if b.distance_squared(offset) < a.distance_squared(offset) { b } else { a }
        };
        on_edges.reduce(nearer).unwrap_or_default()
    }

    /// How far `offset` lies in front of the emitter's plane, metres. The distance has no sign if
    /// the emitter is two-sided. For a sphere or a line, it is the distance to its surface, negative inside.
    pub fn in_front(&self, offset: DVec3) -> f64 {
        if self.is_solid() {
            return self.outside(offset);
        }
        let along = self.area_vector().normalize_or_zero().dot(offset);
        if self.two_sided { along.abs() } else { along }
    }

    fn edges(&self) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
        let next = |ix: usize| self.vertices[(ix + 1) % usize::from(self.count)];
        let vertices = self.vertices().iter().enumerate();
        vertices.map(move |(ix, v)| (v.as_dvec3(), next(ix).as_dvec3()))
    }

    /// Half the sum of the edges' cross products: a vector along the normal, whose length is the
    /// area.
    fn area_vector(&self) -> DVec3 {
        if self.outline.is_curved() {
            return self.curved_area_vector();
        }
        0.5 * self.edges().map(|(a, b)| a.cross(b)).sum::<DVec3>()
    }
}

/// The rectangle of least area around a convex polygon, in its plane. One of its sides lies along
/// an edge. Returns centre and half axes; their cross product points along the polygon's normal.
fn smallest_rectangle(vertices: &[Vec3]) -> (Vec3, Vec3, Vec3) {
    let count = vertices.len();
    let origin = vertices[0].as_dvec3();
    let local: Vec<DVec3> = vertices.iter().map(|v| v.as_dvec3() - origin).collect();
    let edges = (0..count).map(|ix| (local[ix], local[(ix + 1) % count]));
    let normal = edges.clone().map(|(a, b)| a.cross(b)).sum::<DVec3>().normalize_or(DVec3::Y);
    let along = |(a, b): (DVec3, DVec3)| {
        let x = (b - a).reject_from(normal).normalize_or(normal.any_orthonormal_vector());
        let y = normal.cross(x);
        let range = |axis: DVec3| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            local.iter().map(|v| axis.dot(*v)).fold(ends, |e, t| (e.0.min(t), e.1.max(t)))
        };
        let ((x0, x1), (y0, y1)) = (range(x), range(y));
        let center = origin + 0.5 * (x * (x0 + x1) + y * (y0 + y1));
        (center, 0.5 * (x1 - x0) * x, 0.5 * (y1 - y0) * y)
    };
    let area = |r: &(DVec3, DVec3, DVec3)| r.1.length() * r.2.length();
    let best = edges.map(along).min_by(|a, b| area(a).total_cmp(&area(b)));
    let (center, x, y) = best.unwrap_or((origin, DVec3::X, DVec3::Y));
    // Rounded outwards: the rectangle holds the polygon.
    let grown = 1.0 + 4.0 * f64::from(f32::EPSILON);
    let slack = (origin.abs().max_element() + x.length() + y.length()) * f64::from(f32::EPSILON);
    let longer = |axis: DVec3| (axis * grown + axis.normalize_or_zero() * slack).as_vec3();
    (center.as_vec3(), longer(x), longer(y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hexagon() -> (Emitter, Vec3) {
        let vertices: Vec<Vec3> = (0..6)
            .map(|ix| {
                let angle = std::f32::consts::TAU * ix as f32 / 6.0;
                Vec3::new(5.0 + 2.0 * angle.cos(), 1.0, 7.0 - 2.0 * angle.sin())
            })
            .collect();
        Emitter::polygon(&vertices).unwrap()
    }

    #[test]
    fn a_rectangle_emits_towards_the_cross_product_of_its_axes() {
        let emitter = Emitter::rectangle(Vec3::X, 2.0 * Vec3::Y);
        emitter.check().unwrap();
        assert_eq!((emitter.normal(), emitter.area()), (Vec3::Z, 8.0));
        assert_eq!(emitter.in_front(DVec3::NEG_Z), -1.0);
        assert_eq!(emitter.two_sided().in_front(DVec3::NEG_Z), 1.0);
    }

    #[test]
    fn a_polygon_lies_in_its_rectangle_around_the_middle() {
        let (emitter, center) = hexagon();
        emitter.check().unwrap();
        assert!(center.distance(Vec3::new(5.0, 1.0, 7.0)) < 1e-5, "{center}");
        assert!((emitter.normal() - Vec3::Y).length() < 1e-6, "{}", emitter.normal());
        assert!((emitter.area() - 6.0 * 3.0_f32.sqrt()).abs() < 1e-4);
        for v in emitter.vertices() {
            for axis in emitter.half_axes() {
                assert!(v.dot(axis).abs() <= axis.length_squared());
            }
        }
    }

    #[test]
    fn vertices_slightly_off_their_plane_are_moved_into_it() {
        let bent = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 1e-4), Vec3::Y];
        let (emitter, _) = Emitter::polygon(&bent).unwrap();
        let [x, y] = emitter.half_axes();
        let normal = x.cross(y).normalize();
        assert!(emitter.vertices().iter().all(|v| normal.dot(*v).abs() < 1e-6));
        emitter.check().unwrap();
    }

    #[test]
    fn the_closest_point_is_on_the_face_an_edge_or_a_corner() {
        let emitter = Emitter::rectangle(Vec3::X, 2.0 * Vec3::Y);
        let closest = |x, y, z| emitter.closest(DVec3::new(x, y, z)).to_array();
        assert_eq!(closest(0.5, 1.5, 3.0), [0.5, 1.5, 0.0]);
        assert_eq!(closest(4.0, 1.5, 3.0), [1.0, 1.5, 0.0]);
        assert_eq!(closest(-4.0, 9.0, -3.0), [-1.0, 2.0, 0.0]);
    }
}
