//! Bends a level loop so that it climbs, sinks and weaves through the space around it.
//!
//! A level loop shows a scene from one height only. It never looks over a parapet, and it crosses
//! few of the edges where near and far surfaces meet. Four steps change that:
//!
//! 1. The level loop comes from [`fit`](crate::fit). It is known to keep clear of all triangles.
//! 2. A wave raises the knots of its first half and lowers those of its second half, within the
//!    free space above and below each knot.
//! 3. A faster wave pushes the knots outwards, between the columns or houses beside the loop, within
//!    the free space in that direction.
//! 4. Wherever the spline comes closer to a triangle than the margin, the knots that shape it move
//!    back towards the level loop. This repeats until the whole spline is clear.
//!
//! Both waves are zero at the first knot, so the path starts where the level loop does.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use rayon::prelude::*;

use crate::{Aabb, bvh::TriangleBvh, path::catmull_rom};

/// The largest shares of the free space above, below and beside a knot by which it moves.
const ABOVE: f32 = 0.7;
const BELOW: f32 = 0.7;
const BESIDE: f32 = 0.75;

/// The most that a knot rises, as a share of the core's height. A camera high above a town would
/// see only roofs.
const MOST_RISE: f32 = 0.35;

/// The most that a knot is pushed outwards, as a share of the core's diagonal.
const MOST_PUSH: f32 = 0.25;

/// How often the loop is pushed outwards.
const WEAVES: f32 = 6.0;

/// The factor by which a knot's way shrinks each time it moves back.
const BACK: f32 = 0.75;

/// Below this share of its way, a knot returns to the level loop.
const LEAST_SHARE: f32 = 0.08;

/// The most by which the shares of neighbouring knots differ, so that the loop stays smooth.
const SLOPE: f32 = 0.34;

/// The most steps back. `BACK` to that power is far below `LEAST_SHARE`.
const ROUNDS: usize = 24;

/// A stretch between two knots that needs more sample points than this counts as blocked.
const MOST_POINTS: f32 = 1024.0;

/// Where a camera may be.
pub(crate) struct Room<'a> {
    /// The scene's triangles.
    pub(crate) bvh: &'a TriangleBvh,
    /// The box in which the camera stays.
    pub(crate) core: Aabb,
    /// The least distance to any triangle, metres.
    pub(crate) margin_m: f32,
}

impl Room<'_> {
    /// Whether a camera may be at a point.
    pub(crate) fn is_free(&self, at: Vec3) -> bool {
        self.is_free_by(at, self.margin_m)
    }

    fn is_free_by(&self, at: Vec3, margin_m: f32) -> bool {
        self.core.contains(at) && self.bvh.clearance(at, margin_m) >= margin_m
    }

    /// The eyes of the bent loop, one for each knot of the level one. If there is no room for a
    /// loop, all knots stay at the same place.
    pub(crate) fn bend(&self, level: &[Vec3]) -> Vec<Vec3> {
        if level.windows(2).all(|pair| pair[0] == pair[1]) {
            return level.to_vec();
        }
        let count = level.len();
        let middle = level.iter().copied().sum::<Vec3>() / count.max(1) as f32;
        let wished: Vec<Vec3> = level
            .par_iter()
            .enumerate()
            .map(|(ix, at)| self.wish(*at, middle, ix as f32 / count as f32))
            .collect();
        let mut shares = vec![1.0_f32; count];
        for _ in 0..ROUNDS {
            let eyes = blend(level, &wished, &shares);
            let blocked: Vec<usize> =
                (0..count).into_par_iter().filter(|ix| !self.is_clear(&eyes, *ix)).collect();
            let mut moved = false;
            for segment in blocked {
                // The first of the four knots that shape a segment lies one knot before it.
                for offset in 0..4 {
                    let knot = (segment + count + offset - 1) % count;
                    moved |= shares[knot] > 0.0;
                    shares[knot] *= BACK;
                    if shares[knot] < LEAST_SHARE {
                        shares[knot] = 0.0;
                    }
                }
            }
            if !moved {
                return eyes;
            }
            smooth(&mut shares);
        }
        level.to_vec()
    }

    /// Where a knot of the level loop would go if the way were free.
    fn wish(&self, at: Vec3, middle: Vec3, turn: f32) -> Vec3 {
        let wave = (TAU * turn).sin().powi(2);
        let lift = if turn < 0.5 {
            let most = MOST_RISE * self.core.size().y;
            (ABOVE * self.free_m(at, Vec3::Y)).min(most) * wave
        } else {
            -BELOW * self.free_m(at, Vec3::NEG_Y) * wave
        };
        let raised = at + Vec3::Y * lift;
        let outwards = Vec3::new(at.x - middle.x, 0.0, at.z - middle.z).normalize_or_zero();
        if outwards == Vec3::ZERO {
            return raised;
        }
        let most = MOST_PUSH * self.core.diagonal();
        let push = (BESIDE * self.free_m(raised, outwards)).min(most);
        raised + outwards * (push * (PI * WEAVES * turn).sin().powi(2))
    }

    /// How far a camera can go from a point along a unit direction, metres.
    fn free_m(&self, at: Vec3, direction: Vec3) -> f32 {
        let to_edge = |axis: usize| match direction[axis] {
            step if step > 0.0 => (self.core.max[axis] - at[axis]) / step,
            step if step < 0.0 => (self.core.min[axis] - at[axis]) / step,
            _ => f32::INFINITY,
        };
        let edge = to_edge(0).min(to_edge(1)).min(to_edge(2)).max(0.0);
        let hit = self.bvh.cast(at, direction, edge).map_or(edge, |hit| hit.distance_m);
        (hit - 1.5 * self.margin_m).max(0.0)
    }

    /// Whether the spline from knot `ix` to the next is known to be clear. A tenth of the margin is
    /// reserved for the difference between the level loop and the spline through its knots.
    fn is_clear(&self, eyes: &[Vec3], ix: usize) -> bool {
        let count = eyes.len();
        let knot = |offset: usize| eyes[(ix + count + offset - 1) % count];
        let (p, q, r, s) = (knot(0), knot(1), knot(2), knot(3));
        let points = (2.0 * q.distance(r) / self.margin_m.max(1e-12)).max(4.0);
        if points > MOST_POINTS {
            return false;
        }
        let points = points as u32;
        (0..points).all(|step| {
            let at = catmull_rom(p, q, r, s, step as f32 / points as f32);
            self.is_free_by(at, 0.9 * self.margin_m)
        })
    }
}

/// Knots at a share of their way from the level loop to their goal.
fn blend(level: &[Vec3], wished: &[Vec3], shares: &[f32]) -> Vec<Vec3> {
    let ends = level.iter().zip(wished);
    ends.zip(shares).map(|((from, to), share)| from.lerp(*to, *share)).collect()
}

/// Lowers shares until neighbours differ by at most [`SLOPE`].
fn smooth(shares: &mut [f32]) {
    let count = shares.len();
    // Go around twice in both directions, because a limit may pass the end of the list.
    for step in 0..2 * count {
        let (here, next) = (step % count, (step + 1) % count);
        shares[next] = shares[next].min(shares[here] + SLOPE);
    }
    for step in (0..2 * count).rev() {
        let (here, next) = (step % count, (step + 1) % count);
        shares[here] = shares[here].min(shares[next] + SLOPE);
    }
}

#[cfg(test)]
mod tests;
