//! Builds bounding volume hierarchies in bounded time on any triangles.
//!
//! obvhs joins the neighbours whose common box is smallest. Where all choices are equal (coincident
//! triangles, a row of equal posts), it joins one pair per pass. Its time is then quadratic and its
//! tree is as deep as a list. Two steps prevent that:
//!
//! 1. [`DistinctTriangles`] leaves out triangles without area, which no ray hits. Of equal
//!    triangles it keeps one, because rays would hit all of them at the same distance.
//! 2. [`build_hierarchy`] scales copies of the boxes to unit size and grows each by up to 0.2 % at
//!    random, so that hardly any two choices are equal. The tree then gets the true boxes.

use std::{
    hash::{DefaultHasher, Hash, Hasher},
    time::Duration,
};

use glam::{DVec3, Vec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};
use rayon::prelude::*;

/// The most by which a box grows, as a share of its longest side and of the size of all boxes
/// together.
const GROWTH: f64 = 2e-3;
const LEAST_GROWTH: f64 = 1e-6;

/// How much time the build may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildEffort {
    /// A fast build: one triangle per leaf.
    Fast,
    /// A slower build, for many rays.
    Thorough,
}

/// Builds a hierarchy over finite boxes; [`Bvh2::primitive_indices`] index them.
pub fn build_hierarchy(boxes: &[Aabb], effort: BuildEffort) -> Bvh2 {
    let apart = apart(boxes);
    let mut bvh = match effort {
        BuildEffort::Fast => PlocBuilder::with_capacity(apart.len()).build(
            PlocSearchDistance::Minimum,
            &apart,
            (0..apart.len() as u32).collect(),
            SortPrecision::U64,
            0,
        ),
        BuildEffort::Thorough => {
            build_bvh2(&apart, BvhBuildParams::medium_build(), &mut Duration::default())
        }
    };
    for node in &mut bvh.nodes {
        if node.prim_count > 0 {
            let leaf = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            let inside = bvh.primitive_indices[leaf].iter().map(|ix| boxes[*ix as usize]);
            node.set_aabb(inside.fold(Aabb::empty(), |all, one| all.union(&one)));
        }
    }
    bvh.refit_all();
    bvh
}

/// The boxes in the unit cube, each grown a little at random.
fn apart(boxes: &[Aabb]) -> Vec<Aabb> {
    let all = boxes.iter().fold(Aabb::empty(), |all, one| all.union(one));
    let low = Vec3::from(all.min).as_dvec3();
    let longest = (Vec3::from(all.max).as_dvec3() - low).max_element();
    let scale = if longest > 0.0 { longest.recip() } else { 0.0 };
    let place = |(ix, one): (usize, &Aabb)| {
        let min = (Vec3::from(one.min).as_dvec3() - low) * scale;
        let max = (Vec3::from(one.max).as_dvec3() - low) * scale;
        let most = GROWTH * (max - min).max_element() + LEAST_GROWTH;
        let bits = [scramble(2 * ix as u64), scramble(2 * ix as u64 + 1)];
        let grow = |bits: u64| {
            let part = |shift: u32| (bits >> shift & 0x1f_ffff) as f64 / f64::from(1 << 21);
            DVec3::new(part(0), part(21), part(42)) * most
        };
        Aabb::new(Vec3A::from((min - grow(bits[0])).as_vec3()), (max + grow(bits[1])).as_vec3a())
    };
    boxes.par_iter().enumerate().map(place).collect()
}

/// Pseudo-random bits (SplitMix64).
fn scramble(ix: u64) -> u64 {
    let mut bits = ix.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

/// The triangles that rays can hit, without repeats.
#[derive(Clone, Debug, Default)]
pub struct DistinctTriangles {
    /// For each set of equal triangles, the index of the first; ascending.
    pub firsts: Vec<u32>,
    /// For each triangle, the next equal one, or itself if none follows. Empty if no triangle is
    /// repeated.
    next: Vec<u32>,
}

impl DistinctTriangles {
    /// Finds the distinct triangles, each given by its corners. Two are equal if they have the same
    /// corners in the same order. Triangles without area, or with a corner that is not finite, are
    /// left out.
    pub fn find(corners: &[[Vec3; 3]]) -> Self {
        let hashed = |ix: usize| has_area(corners[ix]).then(|| (hash(corners[ix]), ix as u32));
        let mut hashes: Vec<(u64, u32)> =
            (0..corners.len()).into_par_iter().filter_map(hashed).collect();
        hashes.par_sort_unstable();
        let mut distinct = Self::default();
        for run in hashes.chunk_by(|a, b| a.0 == b.0) {
            // Triangles of the same hash that differ stay separate.
            let same = |b: u32| corners[run[0].1 as usize] == corners[b as usize];
            distinct.firsts.push(run[0].1);
            distinct.firsts.extend(run[1..].iter().map(|(_, ix)| *ix).filter(|ix| !same(*ix)));
            let mut last = run[0].1;
            for ix in run[1..].iter().map(|(_, ix)| *ix).filter(|ix| same(*ix)) {
                if distinct.next.is_empty() {
                    distinct.next = (0..corners.len() as u32).collect();
                }
                distinct.next[last as usize] = ix;
                last = ix;
            }
        }
        distinct.firsts.par_sort_unstable();
        distinct
    }

    /// The next triangle that is equal to this one.
    pub fn next(&self, triangle: u32) -> Option<u32> {
        self.next.get(triangle as usize).copied().filter(|next| *next != triangle)
    }
}

fn has_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let across = (b - a).cross(c - a);
    across.is_finite() && across != DVec3::ZERO
}

fn hash(corners: [Vec3; 3]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for corner in corners {
        // 0 and -0 are the same place.
        (corner + 0.0).to_array().map(f32::to_bits).hash(&mut hasher);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;

    fn boxes(count: u32, at: impl Fn(u32) -> (Vec3, Vec3)) -> Vec<Aabb> {
        let place = |ix| {
            let (low, size) = at(ix);
            Aabb::new(low.into(), (low + size).into())
        };
        (0..count).map(place).collect()
    }

    /// Boxes that give obvhs no choice. Without growth, a hundred thousand of them take 8 s and
    /// more.
    #[test]
    fn equal_choices_do_not_make_builds_slow_or_deep() {
        const COUNT: u32 = 100_000;
        let along = |ix: u32| Vec3::new(ix as f32, 0.0, 0.0);
        let cases: [(&str, Vec<Aabb>); 6] = [
            ("coincident", boxes(COUNT, |_| (Vec3::ONE, Vec3::ONE))),
            ("points", boxes(COUNT, |_| (Vec3::ZERO, Vec3::ZERO))),
            ("row", boxes(COUNT, |ix| (along(ix), Vec3::ONE))),
            ("row of pairs", boxes(COUNT, |ix| (along(ix / 2), Vec3::ONE))),
            ("tiny", boxes(COUNT, |_| (Vec3::splat(1e-30), Vec3::splat(1e-30)))),
            ("flat", boxes(COUNT, |ix| (along(ix % 1000) * 1e8, Vec3::new(1e11, 0.0, 1.0)))),
        ];
        for (name, boxes) in cases {
            for effort in [BuildEffort::Fast, BuildEffort::Thorough] {
                let start = Instant::now();
                let bvh = build_hierarchy(&boxes, effort);
                let seconds = start.elapsed().as_secs_f64();
                println!("{name} {effort:?}: {seconds:.2} s, depth {}", bvh.depth(0));
                assert!(bvh.depth(0) < 96, "{name} {effort:?}: depth {}", bvh.depth(0));
                let all = boxes.iter().fold(Aabb::empty(), |all, one| all.union(one));
                assert_eq!(*bvh.nodes[0].aabb(), all, "{name} {effort:?}");
            }
        }
    }

    #[test]
    fn repeats_and_triangles_without_area_are_found() {
        let [a, b, c] = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let flat = [a, b, b * 2.0];
        let odd = [a, b, Vec3::splat(f32::NAN)];
        let corners = [flat, [a, b, c], [a, c, b], odd, [-a, b, c], [b, c, a], [a, b, c]];
        let distinct = DistinctTriangles::find(&corners);
        assert_eq!(distinct.firsts, [1, 2, 5]);
        let chain: Vec<u32> = std::iter::successors(Some(1), |ix| distinct.next(*ix)).collect();
        assert_eq!(chain, [1, 4, 6]);
        assert_eq!(DistinctTriangles::find(&corners[..3]).next(1), None);
        assert!(DistinctTriangles::find(&[]).firsts.is_empty());
    }
}
