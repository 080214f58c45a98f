//! The camera's path through the streets.

use glam::{Vec2, Vec3};

use super::land::Land;
use crate::{CameraPath, Pose};

/// Distance between knots, metres.
const STEP_M: f32 = 12.0;

/// How far ahead the camera looks, metres.
const AHEAD_M: f32 = 18.0;

/// Leads from the south end of the main street to the square, and back through other streets. The
/// camera is at eye height, but 8 m higher at the start, above the heads of the people.
pub(super) fn path(land: &Land) -> CameraPath {
    let (first, count) = land.square();
    let (main, last) = (first + count.div_ceil(2), land.blocks);
    let corners: Vec<[u32; 2]> = if count > 1 {
        vec![
            [main, last],
            [main, first + count],
            [first, first + count],
            [first, first - 1],
            [first - 2, first - 1],
            [first - 2, last - 1],
            [first - 1, last - 1],
            [first - 1, last],
        ]
    } else {
        vec![[main, last], [main, first], [last, first], [last, last]]
    };
    let corners: Vec<Vec2> =
        corners.iter().map(|[x, z]| Vec2::new(land.street(*x), land.street(*z))).collect();
    let way = Way { corners };
    let length = way.length();
    let count = (length / STEP_M).round().max(3.0);
    let knot = |i: u32| {
        let along = length * i as f32 / count;
        let from_start = along.min(length - along);
        let lift = 8.0 * (-(from_start / 14.0).powi(2)).exp();
        let stand = |at: f32, height: f32| {
            let p = way.point(at);
            Vec3::new(p.x, land.height(p.x, p.y) + height, p.y)
        };
        (stand(along, 1.75 + lift), stand(along + AHEAD_M, 2.6 + 0.5 * lift))
    };
    let knots: Vec<_> = (0..count as u32).map(knot).collect();
    let start = knots.first().map_or(Pose::new(Vec3::ZERO, Vec3::NEG_Z), |k| Pose::new(k.0, k.1));
    CameraPath::closed_loop(knots, start)
}

/// A closed polygon of streets.
struct Way {
    corners: Vec<Vec2>,
}

impl Way {
    fn sides(&self) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    fn length(&self) -> f32 {
        self.sides().map(|(a, b)| a.distance(b)).sum()
    }

    /// The point at that distance along it from the first corner.
    fn point(&self, along: f32) -> Vec2 {
        let mut left = along.rem_euclid(self.length());
        for (a, b) in self.sides() {
            let side = a.distance(b);
            if left <= side {
                return a.lerp(b, left / side);
            }
            left -= side;
        }
        self.corners[0]
    }
}
