//! Patches of emitters, over which soft filters spread (percentage-closer soft shadows, Fernando 2005).
//!
//! # The idea
//!
//! A map from the middle of a patch shows a surface that hides the middle. It also tells how much of the rest is hidden,
//! because the surface's distance gives the width of the penumbra. Let `R` be the sample as seen from the middle, `u` a point
//! of the patch relative to the middle, across `R`, and `f` the share of the line from the light to the sample at which a
//! blocker stands. The line from the sample to `u` passes the blocker's depth at `R f + u (1 - f)`. The map shows this
//! place in the direction
//!
//! ```text
//! R + u q    with    q = (1 - f) / f = 1 / f - 1
//! ```
//!
//! Fernando's width of a penumbra is the same: size of the light times `(receiver - blocker) / blocker`.
//!
//! 1. *Search.* Directions `R + u q` are looked up for K points `u`, each for another depth. The depths `f` are spread evenly
//!    along the line, from the sample to where the search would reach 45 degrees to the side: `q = |R| / U`, where no `u` is
//!    longer than `U`. So most look-ups are near `R`, because a blocker near the sample hides it only there. A surface found in a direction with `q` is a blocker if it stands nearer to the light than
//!    the sample's plane, and if `1 / f - 1 >= q`. Otherwise it lies beside all lines from the sample to the patch.
//!    Fernando counts these, too.
//! 2. *Width.* The mean `f` of the blockers gives one `q`, at most that of the search. Without a blocker the share is 1.
//! 3. *Filter.* The directions `R + u q` of K points `u` are looked up. The share is the part that is lit.
//!
//! # Offsets
//!
//! A wide filter that compares the sample's own depth shadows a slanted plane by itself, which is mostly hidden by a tuned
//! bias. Here each look-up is that of the point at which its direction meets the sample's plane, or of a point as far as
//! the sample if the plane is farther. So it is a hard look-up of a point on or in front of the plane, however wide the
//! filter is, and the offsets of a single texel hold ([`super`]).
//!
//! # Where it fails
//!
//! All blockers count as one plane at their mean distance. So two of them at different distances have one penumbra, too wide
//! for the nearer and too narrow for the farther. A map from the middle does not see around a blocker: what it hides from
//! the middle alone is unknown. Search and filter have K points, so small blockers far from the sample can be missed, and a
//! penumbra has K + 1 steps. Near a light, blockers beyond 45 degrees are missed. More maps have smaller patches, and all
//! of these errors shrink.

use assign::{Emitter, Light, LightShape, Outline};
use glam::{DMat3, DVec3, Vec3};

use super::{
    face::bits,
    points::{LightPoint, points_of},
};

/// Vectors that a map has for its patch: `pcss.wesl`.
pub(super) const PATCH_VECTORS: usize = 2;

/// How much farther than the sample a search looks for surfaces, at most: it looks 45 degrees to the side.
pub(super) const WIDEST_SEARCH: f64 = std::f64::consts::SQRT_2;

/// The middles of `count` patches of an emitter, one of [`MAP_COUNTS`](crate::MAP_COUNTS), with equal weights. Those of a
/// rectangle are equal rectangles.
pub(super) fn middles_of(emitter: &Emitter, count: u32) -> Vec<LightPoint> {
    if emitter.outline() != Outline::Rectangle {
        return points_of(emitter, count);
    }
    let side = count.isqrt().max(1);
    let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
    let place = |ix: u32| (2.0 * f64::from(ix) + 1.0) / f64::from(side) - 1.0;
    let middle = |ix: u32| x * place(ix % side) + y * place(ix / side);
    (0..side * side).map(|ix| LightPoint { offset: middle(ix), weight: 1 }).collect()
}

/// The half axes of each of `count` patches of a light, along its axes, and the sum of their lengths. Patches of other
/// outlines than rectangles are rectangles of equal areas. That of a sphere faces each sample, and that of a line is a part
/// of its length, whose width faces each sample.
pub(super) fn patch_of(light: &Light, count: u32, axes: DMat3) -> [[u32; 4]; PATCH_VECTORS] {
    let [x, y] = half_axes(light, f64::from(count.max(1))).map(|axis| axes.transpose() * axis);
    let size = x.length() + y.length();
    let vector = |axis: DVec3, last| [bits(axis.x), bits(axis.y), bits(axis.z), last];
    [vector(x, 0), vector(y, bits(size))]
}

fn half_axes(light: &Light, count: f64) -> [DVec3; 2] {
    let LightShape::Area(emitter) = &light.shape else { return [DVec3::ZERO; 2] };
    let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
    match emitter.outline() {
        Outline::Line => [x / count, DVec3::X * f64::from(emitter.radius_m())],
        Outline::Sphere => {
            let half = 0.5 * (f64::from(emitter.area()) / count).sqrt();
            [DVec3::X * half, DVec3::Y * half]
        }
        Outline::Rectangle | Outline::Polygon | Outline::Disc => {
            let whole = 4.0 * x.length() * y.length();
            let share = f64::from(emitter.area()) / whole.max(f64::MIN_POSITIVE);
            [x, y].map(|axis| axis * (share / count).sqrt())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_have_the_area_of_their_emitter() {
        let corners = [(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
        let (triangle, middle) = Emitter::polygon(&corners).unwrap();
        for (emitter, area) in [
            (Emitter::rectangle(Vec3::X * 2.0, Vec3::Y * 0.5), 4.0),
            (triangle, 1.0),
            (Emitter::sphere(0.5), std::f64::consts::PI / 4.0),
        ] {
            for count in [1, 9, 25] {
                let light = Light::area(emitter, middle, 9.0, Vec3::ONE);
                let [x, y] = half_axes(&light, f64::from(count));
                let each = 4.0 * x.length() * y.length();
                assert!((each * f64::from(count) - area).abs() < 1e-5, "{emitter:?}, {count}");
                let middles = middles_of(&emitter, count);
                assert_eq!(middles.len() as u32, count);
                assert!(middles.iter().all(|point| point.weight == 1));
            }
        }
        // Patches of a rectangle touch each other and its sides.
        let middles = middles_of(&Emitter::rectangle(Vec3::X * 2.0, Vec3::Y * 0.5), 4);
        let corner = DVec3::new(-1.0, -0.25, 0.0);
        assert_eq!(middles[0].offset, corner);
        assert_eq!(middles[3].offset, -corner);
        let point = Light::point(Vec3::ZERO, 1.0, Vec3::ONE);
        assert_eq!(patch_of(&point, 1, DMat3::IDENTITY), [[0; 4]; 2]);
    }
}
