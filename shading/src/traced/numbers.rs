//! Numbers for sampling: points of Owen-scrambled Sobol sequences.
//!
//! # The idea
//!
//! Independent random points clump and leave gaps, so the error of a mean of n falls like `n^-1/2`.
//! The first n points of a Sobol sequence fill the cube evenly, so the error falls nearly like `1/n`,
//! and faster where the integrand is smooth. Owen's scrambling (1995; by hashes, Burley 2020) shuffles
//! the sequence without changing how evenly it fills the cube: the mean has no bias, and two scrambles
//! are independent.
//!
//! # How the error is known
//!
//! The points of one sequence depend on each other, so their spread says nothing about their mean. An
//! [`Estimate`](super::Estimate) is therefore the mean of [`SEQUENCES`] independently scrambled
//! sequences, and its variance follows from the spread of their means.

use sobol_burley::parts::{hash, owen_scramble_rev, sobol_rev};

/// Independent sequences per estimate: enough to know the error, and few enough to make each long.
pub(super) const SEQUENCES: u32 = 8;

/// A source of random numbers. The same seed gives the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Numbers(u64);

impl Numbers {
    /// The numbers of a seed. Those of different seeds are independent.
    pub fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    /// Independent numbers for one part of the work.
    #[must_use]
    pub fn part(self, part: u64) -> Self {
        Self(mix(self.0 ^ mix(part.wrapping_add(1))))
    }

    /// A point of one of its sequences, at most 65,536 in each.
    pub(super) fn point(self, sequence: u32, index: u32) -> Point {
        let seed = self.part(u64::from(sequence)).0;
        Point { index, order: seed as u32, scramble: (seed >> 32) as u32 }
    }
}

/// A point of a sequence, in up to 256 dimensions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    index: u32,
    /// Shuffles the sequence.
    order: u32,
    scramble: u32,
}

impl Point {
    /// `N` coordinates in 0..1, from a dimension on.
    pub(super) fn at<const N: usize>(&self, first: u32) -> [f64; N] {
        let index = owen_scramble_rev(self.index.reverse_bits(), hash(self.order));
        std::array::from_fn(|ix| {
            let dimension = first + ix as u32;
            let scramble = hash(self.scramble.wrapping_add(dimension.wrapping_mul(0x9e37_79b9)));
            let bits = owen_scramble_rev(sobol_rev(index, dimension), scramble).reverse_bits();
            (f64::from(bits) + 0.5) / 4_294_967_296.0
        })
    }

    /// The same point scrambled in another way. It is as even in the other dimensions, and
    /// independent.
    pub(super) fn scrambled(self, by: u32) -> Self {
        Self { scramble: hash(self.scramble ^ hash(by.wrapping_add(1))), ..self }
    }
}

/// The finaliser of SplitMix64 (Steele et al. 2014).
fn mix(value: u64) -> u64 {
    let value = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sequence_fills_every_cell_once_and_others_are_independent() {
        for sequence in 0..4 {
            // 256 points: one in each cell of 16 x 16, and of 4 x 64, in neighbouring dimensions.
            let points: Vec<[f64; 2]> = (0..256)
                .map(|ix| Numbers::new(5).point(sequence, ix).scrambled(sequence).at(0))
                .collect();
            for (across, along) in [(16, 16), (4, 64), (256, 1)] {
                let cell = |[x, y]: &[f64; 2]| {
                    (x * f64::from(across)) as usize * along + (y * along as f64) as usize
                };
                let mut cells: Vec<usize> = points.iter().map(cell).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..256).collect::<Vec<_>>(), "{across} x {along}");
            }
        }
        // The correlation of two scrambles of one point, over many points, must be 0 within 4
        // standard errors.
        let pairs = (0..4096_u32).map(|ix| {
            let point = Numbers::new(u64::from(ix)).point(0, 3);
            let [[a], [b], [c]] = [point.at(0), point.scrambled(7).at(0), point.at(9)];
            [a - 0.5, b - 0.5, c - 0.5]
        });
        let [ab, ac] = pairs.fold([0.0, 0.0], |[ab, ac], [a, b, c]| [ab + a * b, ac + a * c]);
        let bound = 4.0 / 12.0 * 64.0;
        assert!(f64::abs(ab) < bound && f64::abs(ac) < bound, "{ab} {ac}");
    }
}
