//! The spherical rectangle that a planar rectangle covers, and an area-preserving map onto it
//! (Ureña, Fajardo and King 2013).

use std::f64::consts::TAU;

use glam::DVec3;

/// A rectangle seen from the origin.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// Extent along x and y, and negative distance of the plane, in the rectangle's own frame.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    /// z components of the normals of the planes through the origin and the edges along x.
    b0: f64,
    b1: f64,
    k: f64,
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle of a corner and two edges at right angles; `None` if it has no area or the
    /// origin lies in its plane.
    pub fn new(corner: DVec3, edge_x: DVec3, edge_y: DVec3) -> Option<Self> {
        let (x, y) = (edge_x.try_normalize()?, edge_y.try_normalize()?);
        let mut z = x.cross(y);
        let mut z0 = corner.dot(z);
        if z0 > 0.0 {
            (z, z0) = (-z, -z0);
        }
        let (x0, y0) = (corner.dot(x), corner.dot(y));
        let (x1, y1) = (x0 + edge_x.length(), y0 + edge_y.length());
        // Normals of the planes through the origin and the edges, in the rectangle's frame. Those
        // of the edges along x have no x component; the other two have no y component.
        let z_of = |offset: f64, sign: f64| sign * offset / (offset * offset + z0 * z0).sqrt();
        let (n0, n1, n2, n3) = (z_of(y0, -1.0), z_of(x1, 1.0), z_of(y1, 1.0), z_of(x0, -1.0));
        // Interior angles (section 3, equation 3).
        let angle = |a: f64, b: f64| (-a * b).clamp(-1.0, 1.0).acos();
        let (g0, g1, g2, g3) = (angle(n0, n1), angle(n1, n2), angle(n2, n3), angle(n3, n0));
        let k = TAU - g2 - g3;
        let solid_angle = g0 + g1 - k;
        let sound = z0 < 0.0 && solid_angle > 0.0 && solid_angle.is_finite();
        sound.then_some(Self { x, y, z, x0, x1, y0, y1, z0, b0: n0, b1: n2, k, solid_angle })
    }

    /// Its solid angle, steradians.
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The unit direction of a point of the unit square. Equal areas map to equal solid angles.
    pub fn direction(&self, u: f64, v: f64) -> DVec3 {
        // The x coordinate before which the area is a share u of the whole (equations 5 to 8).
        let angle = u * self.solid_angle + self.k;
        let fu = (angle.cos() * self.b0 - self.b1) / angle.sin();
        let cu = (1.0 / (fu * fu + self.b0 * self.b0).sqrt()).copysign(fu).clamp(-1.0, 1.0);
        let x = -(cu * self.z0) / (1.0 - cu * cu).max(1e-300).sqrt();
        let x = x.clamp(self.x0, self.x1);
        // Along the cut at that x, height over distance is uniform (equations 9 and 10).
        let d = (x * x + self.z0 * self.z0).sqrt();
        let h0 = self.y0 / (d * d + self.y0 * self.y0).sqrt();
        let h1 = self.y1 / (d * d + self.y1 * self.y1).sqrt();
        let h = h0 + v * (h1 - h0);
        let rest = 1.0 - h * h;
        let y = if rest > 1e-12 { h * d / rest.sqrt() } else { self.y1 };
        (x * self.x + y * self.y + self.z0 * self.z).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn examples() -> [SphericalRectangle; 3] {
        let tilted = DVec3::new(0.0, 0.6, 0.8);
        [
            SphericalRectangle::new(DVec3::new(-1.0, -1.0, 1.0), DVec3::X * 2.0, DVec3::Y * 2.0),
            SphericalRectangle::new(DVec3::new(0.5, -0.2, -0.3), DVec3::X * 4.0, tilted * 0.1),
            SphericalRectangle::new(DVec3::new(-3.0, 2.0, 0.1), tilted * 5.0, DVec3::X * 6.0),
        ]
        .map(Option::unwrap)
    }

    #[test]
    fn a_face_of_a_cube_is_a_sixth_of_the_sphere() {
        let [face, ..] = examples();
        assert!((face.solid_angle() - 2.0 * TAU / 6.0).abs() < 1e-12);
    }

    #[test]
    fn small_squares_map_to_equal_solid_angles() {
        // The area of an image is that of the parallelogram of its differences.
        let step = 1e-4;
        for rectangle in examples() {
            for i in 0..20 {
                for j in 0..20 {
                    let (u, v) = ((f64::from(i) + 0.5) / 20.0, (f64::from(j) + 0.5) / 20.0);
                    let du = rectangle.direction(u + step, v) - rectangle.direction(u - step, v);
                    let dv = rectangle.direction(u, v + step) - rectangle.direction(u, v - step);
                    let density = du.cross(dv).length() / (4.0 * step * step);
                    let ratio = density / rectangle.solid_angle();
                    assert!((ratio - 1.0).abs() < 1e-4, "{rectangle:?} at {u}, {v}: {ratio}");
                }
            }
        }
    }

    #[test]
    fn corners_map_to_corners() {
        let corner = DVec3::new(0.5, -0.2, -0.3);
        let (x, y) = (DVec3::X * 4.0, DVec3::new(0.0, 0.06, 0.08));
        let rectangle = SphericalRectangle::new(corner, x, y).unwrap();
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let expected = (corner + u * x + v * y).normalize();
            assert!((rectangle.direction(u, v) - expected).length() < 1e-9, "{u}, {v}");
        }
    }

    #[test]
    fn an_invisible_rectangle_is_none() {
        assert!(SphericalRectangle::new(DVec3::X, DVec3::Y, DVec3::X).is_none());
        assert!(SphericalRectangle::new(DVec3::Z, DVec3::ZERO, DVec3::X).is_none());
        assert!(SphericalRectangle::new(DVec3::NAN, DVec3::Y, DVec3::X).is_none());
    }
}
