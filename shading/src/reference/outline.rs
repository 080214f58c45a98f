//! An emitter's outline as a shaded point sees it, in f64.

use assign::{Emitter, Outline};
use glam::{DMat3, DVec3, Vec3};

use crate::ltc::{
    Ellipse, cone_polygon, cosine_integral, disc_of_sphere, ellipse_integral, ltc_ellipse_integral,
    ltc_integral, ltc_sphere_integral, sphere_integral,
};

/// An emitter in the shading frame of a point ([`ltc`](crate::ltc)).
pub(crate) enum SeenOutline {
    /// The vertices of a rectangle or a polygon.
    Polygon(Vec<DVec3>),
    /// A disc.
    Ellipse(Ellipse),
    /// A sphere: its middle and its radius.
    Sphere(DVec3, f64),
    /// A line.
    Line(SeenLine),
}

/// A line, as a quad and what its round ends add to it.
///
/// From the point, two planes touch the tube along its whole length. They touch it along the long sides of the quad,
/// whose other sides are across the ends. Each end adds a part of a circle: half of it if the tube is far away or seen
/// from the side. Along its axis, only the near end is visible. So the weights of the ends depend on the angle between
/// the planes.
pub(crate) struct SeenLine {
    /// The middles of the two ends.
    ends: [DVec3; 2],
    radius: f64,
    /// Unit normals of the two planes, towards the point; `None` if the point lies within the tube's radius of its axis.
    planes: Option<[DVec3; 2]>,
}

impl SeenOutline {
    /// The outline of an emitter. `to_position` leads from the light's position to the point, in world space, which
    /// `frame` turns into the shading frame.
    pub(crate) fn new(emitter: &Emitter, to_position: DVec3, frame: &DMat3) -> Self {
        let [x, y] = emitter.half_axes().map(|axis| *frame * axis.as_dvec3());
        let center = *frame * -to_position;
        let radius = f64::from(emitter.radius_m());
        match emitter.outline() {
            Outline::Rectangle | Outline::Polygon => {
                let vertex = |v: &Vec3| *frame * (v.as_dvec3() - to_position);
                Self::Polygon(emitter.vertices().iter().map(vertex).collect())
            }
            Outline::Disc => {
                // The half axes are rounded outwards.
                let [x, y] = [x, y].map(|axis| axis.normalize_or_zero() * radius);
                Self::Ellipse(Ellipse { center, x, y })
            }
            Outline::Sphere => Self::Sphere(center, radius),
            Outline::Line => Self::Line(SeenLine::new([center - x, center + x], radius)),
        }
    }

    /// The vertices of a polygon that covers the same directions, to one part in a million.
    pub(crate) fn polygon(&self) -> Vec<DVec3> {
        match self {
            Self::Polygon(vertices) => vertices.clone(),
            Self::Ellipse(ellipse) => cone_polygon(ellipse.center, ellipse.x, ellipse.y),
            Self::Sphere(center, radius) => {
                let Ellipse { center, x, y } = disc_of_sphere(*center, *radius);
                cone_polygon(center, x, y)
            }
            Self::Line(line) => line.polygon(),
        }
    }

    /// The form factor of the part above the horizon, by its closed form.
    pub(crate) fn form_factor(&self) -> f64 {
        match self {
            Self::Polygon(vertices) => cosine_integral(vertices),
            Self::Ellipse(ellipse) => ellipse_integral(ellipse),
            Self::Sphere(center, radius) => sphere_integral(*center, *radius),
            Self::Line(line) => line.integral(cosine_integral, sphere_integral),
        }
    }

    /// The share of a lobe that it covers, for the inverse of the lobe's matrix.
    pub(crate) fn lobe_share(&self, inverse: &DMat3) -> f64 {
        match self {
            Self::Polygon(vertices) => ltc_integral(inverse, vertices),
            Self::Ellipse(ellipse) => ltc_ellipse_integral(inverse, ellipse),
            Self::Sphere(center, radius) => ltc_sphere_integral(inverse, *center, *radius),
            Self::Line(line) => line.integral(
                |quad| ltc_integral(inverse, quad),
                |end, radius| ltc_sphere_integral(inverse, end, radius),
            ),
        }
    }
}

impl SeenLine {
    fn new(ends: [DVec3; 2], radius: f64) -> Self {
        let along = (ends[1] - ends[0]).normalize_or_zero();
        let across = ends[0] - along * along.dot(ends[0]);
        let distance = across.length();
        let planes = (distance > radius).then(|| {
            let towards = -across / distance;
            let beside = along.cross(towards);
            let cos = radius / distance;
            let sin = (1.0 - cos * cos).sqrt();
            [towards * cos + beside * sin, towards * cos - beside * sin]
        });
        Self { ends, radius, planes }
    }

    /// The end that is closer to the point.
    fn near_end(&self) -> DVec3 {
        let [a, b] = self.ends;
        if b.length_squared() < a.length_squared() { b } else { a }
    }

    /// A sum of integrals over its quad and over its ends.
    fn integral(
        &self,
        over_quad: impl Fn(&[DVec3]) -> f64,
        over_end: impl Fn(DVec3, f64) -> f64,
    ) -> f64 {
        let Some([left, right]) = self.planes.map(|planes| planes.map(|n| n * self.radius)) else {
            return over_end(self.near_end(), self.radius);
        };
        let [a, b] = self.ends;
        let weights = self.end_weights();
        let ends = [a, b].map(|end| over_end(end, self.radius));
        let quad = over_quad(&[a + left, b + left, b + right, a + right]);
        (quad + weights[0] * ends[0] + weights[1] * ends[1]).min(1.0)
    }

    /// The parts of the two ends' circles that lie outside the quad.
    fn end_weights(&self) -> [f64; 2] {
        let Some([left, right]) = self.planes else { return [0.5; 2] };
        // Half the angle between the planes' normals, as a share of a right angle.
        let open = 0.5 * (left - right).length();
        let open = open.min(1.0).asin() / std::f64::consts::FRAC_PI_2;
        // Where the point lies along the line, -1 to 1.
        let [a, b] = self.ends;
        let half = 0.5 * (b - a);
        let place = (-0.5 * (a + b)).dot(half) / half.length_squared().max(f64::MIN_POSITIVE);
        let near = 0.5 * place.clamp(-1.0, 1.0) * (1.0 - open);
        [0.5 - near, 0.5 + near]
    }

    fn polygon(&self) -> Vec<DVec3> {
        let Some(planes) = self.planes else {
            let Ellipse { center, x, y } = disc_of_sphere(self.near_end(), self.radius);
            return cone_polygon(center, x, y);
        };
        let [a, b] = self.ends;
        let along = b - a;
        let mut outline = self.arc(a, -along, planes);
        outline.extend(self.arc(b, along, [planes[1], planes[0]]));
        outline
    }

    /// The outline of an end, from one plane to the other on the side that `outwards` points to.
    fn arc(&self, end: DVec3, outwards: DVec3, [from, to]: [DVec3; 2]) -> Vec<DVec3> {
        const SIDES: u32 = 32;
        let radius = self.radius;
        let away = end.normalize_or_zero();
        let share = (radius / end.length().max(1e-300)).min(1.0);
        // The sphere's outline is a circle around `center`.
        let center = end - away * (share * radius);
        let out = outwards.reject_from_normalized(away).normalize_or_zero();
        let size = radius * (1.0 - share * share).sqrt();
        let side = (from - to).normalize_or_zero();
        let rise = |plane: DVec3| end + plane * radius - center;
        let most = rise(from).dot(side).atan2(rise(from).dot(out));
        let step = 2.0 * most / f64::from(SIDES);
        let grown = (step / step.sin()).sqrt();
        let corner = |ix: u32| {
            let (sin, cos) = (most - step * f64::from(ix)).sin_cos();
            let grown = if ix == 0 || ix == SIDES { 1.0 } else { grown };
            center + (out * cos + side * sin) * (size * grown)
        };
        (0..=SIDES).map(corner).collect()
    }
}
