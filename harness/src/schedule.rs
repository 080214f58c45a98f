//! The order of timed frames: rounds of all methods. Each round has another order, so that drift affects all
//! methods equally.

use rand::{SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

/// Timed frames if the command line gives no number: on a GPU, and on a software adapter.
pub(crate) const DEFAULT_FRAMES: [u32; 2] = [64, 3];

/// The most rounds of a still camera: more would not improve the confidence interval of the median.
const MAX_ROUNDS: u32 = 16;

/// The number of rounds for that many frames. Few frames give rounds of one frame.
pub fn rounds(frames: u32) -> u32 {
    frames.clamp(1, MAX_ROUNDS)
}

/// The frames of one round, by index.
pub fn frames_of_round(round: u32, rounds: u32, frames: u32) -> std::ops::Range<u32> {
    let first =
        |round: u32| (u64::from(frames) * u64::from(round) / u64::from(rounds.max(1))) as u32;
    first(round)..first(round + 1)
}

/// The orders of the methods, round by round. The same seed gives the same orders.
pub struct Orders {
    rng: Pcg64Mcg,
    order: Vec<usize>,
}

impl Orders {
    /// Orders of `methods` methods.
    pub fn new(methods: usize, seed: u64) -> Self {
        Self { rng: Pcg64Mcg::seed_from_u64(seed), order: (0..methods).collect() }
    }

    /// The next round's order.
    pub fn next_round(&mut self) -> Vec<usize> {
        self.order.shuffle(&mut self.rng);
        self.order.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_hold_every_frame_once() {
        for frames in [1, 3, 16, 17, 64, 100] {
            let rounds = rounds(frames);
            let all: Vec<u32> =
                (0..rounds).flat_map(|round| frames_of_round(round, rounds, frames)).collect();
            assert_eq!(all, (0..frames).collect::<Vec<_>>(), "{frames}");
            let sizes = (0..rounds).map(|round| frames_of_round(round, rounds, frames).len());
            assert!(sizes.clone().max() <= sizes.min().map(|least| least + 1), "{frames}");
        }
    }

    #[test]
    fn every_round_has_every_method_and_orders_differ() {
        let mut orders = Orders::new(5, 7);
        let drawn: Vec<Vec<usize>> = (0..20).map(|_| orders.next_round()).collect();
        for order in &drawn {
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3, 4]);
        }
        assert!(drawn.iter().any(|order| *order != drawn[0]));
        let mut again = Orders::new(5, 7);
        assert!(drawn.iter().all(|order| *order == again.next_round()));
        // Each method leads some round.
        assert!((0..5).all(|method| drawn.iter().any(|order| order[0] == method)));
    }
}
