//! The integral of a cosine, and of a linearly transformed one, over an ellipse: discs, and spheres as the discs that
//! cover them (Heitz and Hill 2017, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines").
//!
//! A linear map turns an ellipse into another one. From the shaded point, an ellipse is an elliptical cone. It has two
//! planes of symmetry, so the integral of directions over it points along its axis. With `L1` and `L2`, the tangents of
//! the cone's half angles, its length over pi is `L1 L2 / sqrt((1 + L1^2) (1 + L2^2))`. Both are exact.
//!
//! The horizon cuts the cone. As published, the part above it is that of a circular cone with the same axis and the same
//! integral. It is exact for a sphere under a cosine. Its form factor has a closed form ([`cap_integral`], after Snyder
//! 1996), which the paper reads from a table.
//!
//! # Two departures
//!
//! **The axis.** The paper finds orthogonal axes of the ellipse first and then the roots of a cubic. Here, the cone's
//! dual matrix `D = X X' + Y Y' - C C'` of the centre C and of two conjugate radii X and Y gives the same cubic without
//! the axes. Its one negative eigenvalue `-m` belongs to the cone's axis. Laguerre's method finds it from above, and
//! loses no digits where the ellipse is small and far away.
//!
//! **The surface's horizon.** The paper does not clip at it. So light from below the surface would reach a specular
//! lobe, and would end abruptly where the emitter sets.
//!
//! - A disc fades while the last 15 % of its height set. There, the error of its specular share becomes 0.32 of the light
//!   instead of 0.43, and 0.056 instead of 0.057 over all discs that the horizon cuts.
//! - A sphere that the horizon cuts is also integrated as the ellipse that has the area, the centroid and the second
//!   moments of the part above. The smaller of the two results counts. The error becomes 0.027 of the light instead of
//!   0.057, and 0.11 instead of 0.58 where the middle is far below.
//!
//! These are errors against polygons that are clipped at both horizons, over seeded discs and spheres and table entries.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

/// An ellipse: all points `center + u x + v y` with `u^2 + v^2 <= 1`. `x` and `y` are conjugate radii, which need not be
/// at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Its centre, in the shading frame.
    pub center: DVec3,
    /// A radius.
    pub x: DVec3,
    /// The radius that is conjugate to `x`.
    pub y: DVec3,
}

/// The share of an ellipse's half height over which it fades while it sets.
const FADE: f64 = 0.3;

/// Steps of Laguerre's method, which triples the number of digits with each.
const STEPS: u32 = 5;

impl Ellipse {
    /// The integral of directions over the ellipse, over pi: a vector along the axis of its cone. Its z is the form
    /// factor of an ellipse that is above the horizon.
    pub fn vector_integral(&self) -> DVec3 {
        let Self { center, x, y } = *self;
        let [cc, xx, yy] = [center, x, y].map(DVec3::length_squared);
        let scale = cc + xx + yy;
        if !(scale > 0.0 && scale.is_finite()) {
            return DVec3::ZERO;
        }
        let unit = scale.sqrt().recip();
        let [c, x, y] = [center, x, y].map(|v| v * unit);
        // The characteristic polynomial of D at -m, as m^3 + trace m^2 + minors m - volume^2.
        let trace = (xx + yy - cc) / scale;
        let minors =
            x.cross(y).length_squared() - x.cross(c).length_squared() - y.cross(c).length_squared();
        let volume = c.dot(x.cross(y));
        let volume_2 = volume * volume;
        // No root is larger.
        let mut m = cc / scale;
        for _ in 0..STEPS {
            let value = ((m + trace) * m + minors) * m - volume_2;
            let slope = (3.0 * m + 2.0 * trace) * m + minors;
            let curve = 6.0 * m + 2.0 * trace;
            let root = (4.0 * slope * slope - 6.0 * value * curve).max(0.0).sqrt();
            let step = 3.0 * value / (slope + root);
            m = if step > 0.0 { (m - step).max(0.0) } else { m };
        }
        // (m + l1) (m + l2) for the other eigenvalues, whose product is the volume's square over m.
        let others = m * (2.0 * m + trace) + volume_2 / m.max(1e-300);
        let length = (volume_2 / (m * others).max(1e-300)).sqrt().min(1.0);
        // D + m has rank 2; its adjugate maps every vector to the axis.
        let row = |k: usize| {
            let mut row = x * x[k] + y * y[k] - c * c[k];
            row[k] += m;
            row
        };
        let [a, b, d] = [row(0), row(1), row(2)];
        let axis = b.cross(d) * c.x + d.cross(a) * c.y + a.cross(b) * c.z;
        length * axis.normalize_or_zero()
    }

    /// The factor of an ellipse that sets: 1 if at least 15 % of its height is above the horizon, 0 if nothing is.
    fn risen(&self) -> f64 {
        let slope = self.x.z.hypot(self.y.z);
        // Also if a number is not a number.
        let is_above = self.center.z > -slope;
        if !is_above {
            return 0.0;
        }
        if self.center.z >= slope {
            return 1.0;
        }
        let above = ((self.center.z / slope + 1.0) / FADE).clamp(0.0, 1.0);
        above * above * (3.0 - 2.0 * above)
    }

    /// The ellipse of the area, the centroid and the second moments of the part above the horizon; `None` if next to
    /// nothing is above.
    fn above_horizon(&self) -> Option<Self> {
        let slope = self.x.z.hypot(self.y.z);
        if self.center.z >= slope {
            return (self.center.z > 0.0).then_some(*self);
        }
        // Also if a number is not a number.
        let rise = 1.0 + self.center.z / slope;
        let is_risen = rise > 0.0;
        if !is_risen {
            return None;
        }
        // The radius along which it rises, and the one along which it does not.
        let (cos, sin) = (self.x.z / slope, self.y.z / slope);
        let (up, level) = (self.x * cos + self.y * sin, self.y * cos - self.x * sin);
        let (middle, along, across) = segment(rise);
        Some(Self {
            center: self.center + up * middle,
            x: up * (2.0 * along.max(0.0).sqrt()),
            y: level * (2.0 * across.max(0.0).sqrt()),
        })
    }

    fn moved(&self, inverse: &DMat3) -> Self {
        Self { center: *inverse * self.center, x: *inverse * self.x, y: *inverse * self.y }
    }

    /// The form factor of the part above its own horizon.
    fn form_factor(&self) -> f64 {
        let integral = self.vector_integral();
        let length = integral.length();
        if length == 0.0 { 0.0 } else { cap_integral(length, integral.z / length) }
    }
}

/// Centroid along the axis and variances along and across it of the segment of a unit circle that is `rise` high.
fn segment(rise: f64) -> (f64, f64, f64) {
    if rise < 0.05 {
        // A parabola's: the differences below lose all digits of single precision.
        return (1.0 - 0.6 * rise, 12.0 / 175.0 * rise * rise, 0.4 * rise);
    }
    let t = rise - 1.0;
    let root = (1.0 - t * t).max(0.0).sqrt();
    let angle = root.atan2(-t);
    let area = angle + t * root;
    let double = -2.0 * t * root;
    let quadruple = 2.0 * double * (2.0 * t * t - 1.0);
    let middle = root.powi(3) / (1.5 * area);
    let along = (0.25 * angle - quadruple / 16.0) / area - middle * middle;
    (middle, along, (0.375 * angle - 0.25 * double + quadruple / 32.0) / (1.5 * area))
}

/// Form factor of an ellipse, 0 to 1: the integral of `cos / pi` over the part of it above the horizon. It is exactly 0
/// below the horizon.
pub fn ellipse_integral(ellipse: &Ellipse) -> f64 {
    ellipse.form_factor() * ellipse.risen()
}

/// Form factor of a sphere, 0 to 1, seen from outside.
pub fn sphere_integral(center: DVec3, radius: f64) -> f64 {
    let distance = center.length().max(1e-300);
    cap_integral((radius / distance).powi(2), center.z / distance)
}

/// The share of the lobe of a linearly transformed cosine that an ellipse covers, 0 to 1, for the inverse of the lobe's
/// matrix. It is exactly 0 below the horizon.
pub fn ltc_ellipse_integral(inverse: &DMat3, ellipse: &Ellipse) -> f64 {
    let risen = ellipse.risen();
    if risen == 0.0 { 0.0 } else { risen * ellipse.moved(inverse).form_factor() }
}

/// The share of the lobe of a linearly transformed cosine that a sphere covers, 0 to 1, seen from outside.
pub fn ltc_sphere_integral(inverse: &DMat3, center: DVec3, radius: f64) -> f64 {
    let disc = disc_of_sphere(center, radius);
    let Some(above) = disc.above_horizon() else { return 0.0 };
    let share = disc.moved(inverse).form_factor();
    if above == disc { share } else { share.min(above.moved(inverse).form_factor()) }
}

/// Form factor of a circular cone above the horizon, 0 to 1. `share` is the squared sine of its half angle, which is
/// its form factor if its axis is the normal; `cos` is the cosine between its axis and the normal.
pub fn cap_integral(share: f64, cos: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    let sine = share.sqrt();
    if cos >= sine {
        return share * cos;
    }
    if cos <= -sine {
        return 0.0;
    }
    // Where the horizon cuts the cone: the cosine over the sine.
    let cut = cos / sine;
    let level = (1.0 - cut * cut).max(0.0).sqrt();
    let kept = (1.0 - share).max(0.0).sqrt();
    let slanted = share * cos * level.atan2(-kept * cut);
    let edge = level * sine;
    // atan(edge / kept) - kept edge. Both are nearly equal for a small cone.
    let steep = edge / kept.max(1e-300);
    let rest = if steep > 0.5 {
        edge.atan2(kept) - kept * edge
    } else {
        steep * share - atan_deficit(steep)
    };
    ((slanted + rest) / PI).clamp(0.0, share)
}

/// `t - atan(t)` for t of 0 to 0.5, from its series. The first term that is left out is below 2e-8 of the sum.
fn atan_deficit(t: f64) -> f64 {
    let t_2 = t * t;
    let mut sum = 0.0;
    for n in (3..=21).rev().step_by(2) {
        sum = 1.0 / f64::from(n) - t_2 * sum;
    }
    t * t_2 * sum
}

/// The disc that covers a sphere around `center` as seen from the origin, which lies outside.
pub(crate) fn disc_of_sphere(center: DVec3, radius: f64) -> Ellipse {
    let axis = center.normalize_or(DVec3::Z);
    let x = axis.any_orthonormal_vector();
    let sine = (radius / center.length().max(1e-300)).min(1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    Ellipse { center: center * cosine, x: x * radius, y: axis.cross(x) * radius }
}

/// A polygon that covers the same directions as a circular cone, to one part in a million: its corners lie alternately
/// outside, and the areas are equal.
pub(crate) fn cone_polygon(center: DVec3, x: DVec3, y: DVec3) -> Vec<DVec3> {
    const SIDES: u32 = 48;
    let step = 2.0 * PI / f64::from(SIDES);
    let grown = (step / step.sin()).sqrt();
    let corner = |ix: u32| {
        let (sin, cos) = (step * f64::from(ix)).sin_cos();
        center + (x * cos + y * sin) * grown
    };
    (0..SIDES).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ltc::{Table, cosine_integral, integrate, ltc_integral};

    fn close(a: f64, b: f64, relative: f64) -> bool {
        (a - b).abs() <= relative * b.abs() + 1e-9
    }

    #[test]
    fn a_disc_overhead_has_the_form_factor_of_the_textbooks() {
        // Howell's catalogue, configuration B-12: r^2 / (h^2 + r^2).
        for (radius, height) in [(1.0, 1.0), (0.001, 2.0), (50.0, 0.3), (1.0, 1e-3)] {
            let disc =
                Ellipse { center: DVec3::Z * height, x: DVec3::X * radius, y: DVec3::Y * radius };
            let expected = radius * radius / (height * height + radius * radius);
            let found = ellipse_integral(&disc);
            assert!(close(found, expected, 1e-9), "{radius}, {height}: {found}, {expected}");
        }
        // A disc beside the point, whose plane is parallel to the point's normal.
        let center = DVec3::new(1.0, 0.0, 2.0);
        let disc = Ellipse { center, x: DVec3::Y * 0.5, y: DVec3::Z * 0.5 };
        let found = ellipse_integral(&disc);
        let polygon = cosine_integral(&cone_polygon(disc.center, disc.x, disc.y));
        assert!(close(found, polygon, 1e-5), "{found}, {polygon}");
    }

    /// Snyder's form factor against quadrature, across the horizon and for every size.
    #[test]
    fn a_sphere_has_its_exact_form_factor() {
        for share in [1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999] {
            let sine: f64 = f64::sqrt(share);
            for step in -8..=8 {
                let cos = (f64::from(step) / 8.0 * 1.2 * sine).clamp(-1.0, 1.0);
                let center = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let disc = disc_of_sphere(center, sine);
                let expected = cosine_integral(&cone_polygon(disc.center, disc.x, disc.y));
                let found = cap_integral(share, cos);
                assert!(close(found, expected, 2e-3), "{share}, {cos}: {found}, {expected}");
                assert!(close(sphere_integral(center, sine), found, 1e-7), "{share}, {cos}");
            }
        }
        assert!(
            close(cap_integral(1.0, 0.0), 0.5, 1e-9) && close(cap_integral(1.0, -1.0), 0.0, 0.0)
        );
    }

    fn turned(ix: u32) -> Ellipse {
        let at = |by: f64| (f64::from(ix) * by).fract() * 2.0 - 1.0;
        let v = |a, b, c| DVec3::new(at(a), at(b), at(c));
        let normal = v(0.618, 0.755, 0.570).normalize_or(DVec3::Z);
        let x = normal.any_orthonormal_vector() * 0.8;
        let center = v(0.414, 0.732, 0.236) * 2.0;
        Ellipse { center, x, y: normal.cross(x) * (0.3 + 0.7 * at(0.87).abs()) }
    }

    #[test]
    fn the_vector_integral_is_exact_above_the_horizon() {
        let mut above = 0;
        for ix in 0..400 {
            let ellipse = turned(ix);
            let is_above = ellipse.center.z > ellipse.x.z.hypot(ellipse.y.z) + 0.01;
            if !is_above || ellipse.center.dot(ellipse.x.cross(ellipse.y)).abs() < 0.05 {
                continue;
            }
            above += 1;
            let Ellipse { center, x, y } = ellipse;
            let expected = cosine_integral(&cone_polygon(center, x, y));
            let found = ellipse.vector_integral().z;
            assert!(close(found, expected, 1e-4), "{ellipse:?}: {found}, {expected}");
            // Other conjugate radii are the same ellipse.
            let same = Ellipse { center, x: x * 0.6 + y * 0.8, y: y * 0.6 - x * 0.8 };
            assert!(close(same.vector_integral().z, found, 1e-9));
        }
        assert!(above > 60, "{above}");
    }

    #[test]
    fn an_ellipse_fades_while_it_sets() {
        let disc = |z| Ellipse { center: DVec3::new(0.0, 2.0, z), x: DVec3::X, y: DVec3::Z };
        let heights: Vec<f64> = (0..=100).map(|ix| -1.01 + 0.01 * f64::from(ix)).collect();
        let shares: Vec<f64> = heights.iter().map(|z| ellipse_integral(&disc(*z))).collect();
        assert!(shares[0] == 0.0 && shares[1] < 1e-12, "{shares:?}");
        assert!(shares.windows(2).all(|two| two[0] <= two[1] && two[1] < two[0] + 0.01));
    }

    /// The transformed integral is near that of a polygon of the same area, and 0 below the horizon.
    #[test]
    fn a_lobe_sees_an_ellipse_as_it_sees_a_polygon() {
        let table = Table::ggx().unwrap();
        let (mut sum, mut off, mut set) = (0.0, 0.0, 0);
        for ix in 0..600 {
            let ellipse = turned(ix);
            let Ellipse { center, x, y } = ellipse;
            let place = f64::from(ix % 10) / 10.0;
            let inverse = table
                .look_up(0.2 + 0.8 * place, 0.1 + 0.9 * (f64::from(ix) * 0.7).fract())
                .inverse();
            let expected = ltc_integral(&inverse, &cone_polygon(center, x, y));
            let found = ltc_ellipse_integral(&inverse, &ellipse);
            assert!((0.0..=1.0).contains(&found), "{found}");
            let is_set = center.z <= -x.z.hypot(y.z);
            assert!(!is_set || (found == 0.0 && expected == 0.0), "{ellipse:?}: {found}");
            set += u32::from(is_set);
            (sum, off) = (sum + expected, off + (found - expected).abs());
        }
        assert!(off < 0.06 * sum && sum > 10.0 && set > 50, "{off} of {sum}, {set} below");
    }

    /// As [`a_lobe_sees_an_ellipse_as_it_sees_a_polygon`], for spheres that the horizon cuts.
    #[test]
    fn a_lobe_sees_the_part_of_a_sphere_above_the_horizon() {
        let table = Table::ggx().unwrap();
        let (mut sum, mut off, mut published) = (0.0, 0.0, 0.0);
        for ix in 0..600 {
            let place = f64::from(ix % 10) / 10.0;
            let center = turned(ix).center.with_z(1.2 * place - 0.6).normalize();
            let disc = disc_of_sphere(center, 0.6);
            let view = 0.05 + 0.9 * (f64::from(ix) * 0.7).fract();
            let inverse = table.look_up(0.2 + 0.8 * (f64::from(ix) * 0.3).fract(), view).inverse();
            let expected = ltc_integral(&inverse, &cone_polygon(disc.center, disc.x, disc.y));
            let found = ltc_sphere_integral(&inverse, center, 0.6);
            (sum, off) = (sum + expected, off + (found - expected).abs());
            published += (disc.moved(&inverse).form_factor() - expected).abs();
        }
        println!("off by {:.4}, as published {:.4}", off / sum, published / sum);
        assert!(off < 0.06 * sum && off < 0.7 * published, "{off}, {published} of {sum}");
    }

    #[test]
    fn truth_of_a_disc_is_that_of_its_polygon() {
        let disc =
            Ellipse { center: DVec3::new(0.3, 0.2, 1.0), x: DVec3::X * 0.5, y: DVec3::Y * 0.5 };
        let polygon = cone_polygon(disc.center, disc.x, disc.y);
        let found = integrate(&polygon, DVec3::new(0.6, 0.0, 0.8), 0.5, 1e-6).value.diffuse;
        assert!(close(found, ellipse_integral(&disc), 1e-6), "{found}");
    }

    #[test]
    fn odd_ellipses_give_finite_shares() {
        let zero = Ellipse { center: DVec3::ZERO, x: DVec3::ZERO, y: DVec3::ZERO };
        let flat = Ellipse { center: DVec3::X, x: DVec3::X, y: DVec3::Y };
        let nan = Ellipse { center: DVec3::NAN, x: DVec3::X, y: DVec3::Y };
        let thin = Ellipse { center: DVec3::Z, x: DVec3::X, y: DVec3::ZERO };
        for ellipse in [zero, flat, nan, thin] {
            let share = ellipse_integral(&ellipse);
            assert!((0.0..=1.0).contains(&share), "{ellipse:?}: {share}");
        }
    }
}
