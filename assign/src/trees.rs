//! Storage of a group's lights as a list with a tree of depths: each sample skips the lights that lie before or
//! behind it.
//!
//! A tile that holds a near wall and a far one lists the lights of both, and those between them. Clusters cut the
//! tile by depth, and make a list for each part. A depth tree keeps the one list of the tile, and stores which view
//! depths each light reaches. A sample then reads only the lights that reach its own depth. So trees are the
//! hybrid of tiles and clusters: they have the few groups of tiles, and lists as short as those of clusters with
//! very thin slices.
//!
//! This follows O'Donnell and Chajdas 2017, "Tiled Light Trees", I3D, with one difference. Their trees sort the
//! lights of a tile by depth. That would return the lights of a sample in another order, so the last bits of its
//! sum would change. Here, the list stays in ascending light index, and a run is 8 lights that follow each
//! other in the list. The renderer orders lights by Morton code or by a hierarchy, so lights of one run lie close
//! together, and their depths do too.
//!
//! # Phases
//!
//! 1. The culling kernel makes the group's list as it does for every strategy (`cull.wesl`). It reserves the words
//!    of the tree together with the entries.
//! 2. The same workgroup computes the interval of view depths that each listed light reaches: one lane per light,
//!    then one lane per run, which joins the intervals of its 8 lights (`tree.wesl`).
//! 3. Shading looks at the interval of a run. If the sample lies outside, it skips all 8 lights. Otherwise it tests
//!    the interval of each light (`look_up_tree.wesl`).
//!
//! # Layout
//!
//! The tree stands before its list, backwards. Its places then depend only on where the list begins. A run takes
//! 9 words: first the interval of the run, then those of its 8 lights:
//!
//! - `entries[first - 1 - 9 r]` is the interval of run `r`,
//! - `entries[first - 2 - i - i / 8]` is the interval of entry `i`.
//!
//! A word holds two 16-bit codes of depths: the nearest one in its low half, the farthest one in its high half. A code
//! is 5 bits of the exponent and 11 bits of the mantissa of a depth from 2^-12 m to 2^20 m (`tree_depths.wesl`).
//! Other depths get the first or the last code. A greater depth never has a smaller code. So a sample that lies
//! in an interval also lies in the interval of the codes: rounding only makes intervals longer, by 0.05 %.
//!
//! Worked example: a list of 10 lights reserves 10 + 2 words for its tree and 10 for its entries. If the pool gives
//! it place 100, the list begins at 112. Run 0 is at 111, and the intervals of its lights are at 110, 109, ..., 103.
//! Run 1 is at 102, and the intervals of lights 8 and 9 are at 101 and 100.
//!
//! Record 0 lists all lights and has no tree. A list that does not fit into the pool reads record 0, and so all
//! lights.
//!
//! # Cost
//!
//! - Memory: 2.125 words per entry in place of one.
//! - Culling: a group computes one depth interval per light of its list, and has two more barriers.
//! - Shading: a sample reads n / 8 intervals of runs, and 8 more for each run that it does not skip.
//!
//! In the atrium with 500 lights at 320x180, a sample evaluates 3.3 lights in place of 17.6 with `T-I/28x28`, 3.2 in
//! place of 10.6 with `T-E/28x28`, and 3.3 in place of 5.6 with `SC-E/48x48x40/bvh`. The lists take 1.8 to 2 times
//! the bytes.
//!
//! # Where it fails
//!
//! - Lists of clusters are already cut by depth and short. Their trees skip less, and cost as much per light.
//! - Pixels of one subgroup that lie at different depths skip different lights, and wait for each other.
//! - If the lights are in no order, the 8 lights of a run lie anywhere, and runs are rarely skipped. Single lights still
//!   are.
//! - Intervals hold for the view and the lights of the frame that made them. So trees refuse to be used in later
//!   frames (`/reuse`, `/keep`, `/touched`).

/// Lights of a run: `RUN` of `tree_depths.wesl`.
pub(crate) const RUN: u64 = 8;

/// The most words of so many lists with their trees, if they have so many entries together. Every list may have
/// one run that is not full.
pub(crate) const fn pool_words(entries: u64, lists: u64) -> u64 {
    2 * entries + entries / RUN + lists
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Words of one list with its tree.
    fn words(entries: u64) -> u64 {
        2 * entries + entries.div_ceil(RUN)
    }

    #[test]
    fn the_worked_example() {
        assert_eq!(words(10), 22);
        let first = 100 + words(10) - 10;
        let places = |entry: u64| first - 2 - entry - entry / RUN;
        assert_eq!([0, 1, 7, 8, 9].map(places), [110, 109, 103, 101, 100]);
        assert_eq!([0, 1].map(|run| first - 1 - 9 * run), [111, 102]);
    }

    #[test]
    fn the_pool_has_room_for_all_trees() {
        for lengths in [&[][..], &[1], &[8, 8], &[1, 1, 1], &[7, 9, 1000, 3], &[15; 100]] {
            let needed: u64 = lengths.iter().map(|&length| words(length)).sum();
            let most = pool_words(lengths.iter().sum(), lengths.len() as u64);
            assert!(needed <= most && most <= needed + 2 * lengths.len() as u64, "{lengths:?}");
        }
    }
}
