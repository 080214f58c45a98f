//! Lengths of the lists that samples read, per pixel and per group.

use assign::{ALL_LIGHTS, ListsSnapshot};
use shading::Samples;

/// Lengths of lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ListLengths {
    /// Lights in the list of each pixel's group, rows from the top; `None` without a surface.
    pub per_pixel: Vec<Option<u32>>,
    /// The number of groups that samples read, per bin of list length: see [`bin_of`]. If each sample reads a list of
    /// its own, each is counted.
    pub histogram: Vec<u64>,
    /// The number of all groups per bin, read or not. A group without samples counts as empty, although a look-up
    /// there would read all lights.
    pub all_groups: Vec<u64>,
}

/// The bin of a list's length: 0 for none, then 1, 2 to 3, 4 to 7 and so on, each twice as wide.
pub fn bin_of(lights: u32) -> usize {
    (u32::BITS - lights.leading_zeros()) as usize
}

impl ListLengths {
    /// Counts a frame's lists, of an image of so many pixels. `per_pixel` and `histogram` count only lists that
    /// a sample reads. Other records may be an earlier frame's, so `all_groups` is only right if the camera has
    /// not moved since the lists were made.
    pub fn add(&mut self, samples: &Samples, lists: &ListsSnapshot, pixels: usize) {
        let length = |group: u32| lists.list(group).map_or(0, |list| list.count);
        self.per_pixel.resize(pixels, None);
        for (&pixel, &group) in samples.pixels.iter().zip(&samples.groups) {
            if let Some(place) = self.per_pixel.get_mut(pixel as usize) {
                *place = Some(length(group));
            }
        }
        let mut is_read = vec![false; lists.lists.len()];
        for group in samples.groups.iter().filter(|&&group| group != ALL_LIGHTS) {
            if let Some(is_read) = is_read.get_mut(*group as usize + 1) {
                *is_read = true;
            }
        }
        let read = lists.lists.iter().zip(is_read).filter(|(_, is_read)| *is_read);
        count_in(&mut self.histogram, read.map(|(list, _)| list.count));
        // The first record lists all lights. So do groups that hold no sample, besides those that overflowed.
        let groups = 0..lists.lists.len().saturating_sub(1) as u32;
        let mut overflowed = lists.counters.overflowed_groups;
        let all = groups.map(|group| {
            if lists.is_all_lights(group) {
                let is_read = overflowed > 0;
                overflowed = overflowed.saturating_sub(1);
                return if is_read { length(group) } else { 0 };
            }
            length(group)
        });
        count_in(&mut self.all_groups, all);
    }
}

impl ListLengths {
    /// The length of the longest list that a pixel reads.
    pub fn longest(&self) -> u32 {
        self.per_pixel.iter().flatten().copied().max().unwrap_or(0)
    }
}

/// Counts lengths in their bins.
fn count_in(bins: &mut Vec<u64>, lengths: impl Iterator<Item = u32>) {
    for bin in lengths.map(bin_of) {
        if bins.len() <= bin {
            bins.resize(bin + 1, 0);
        }
        bins[bin] += 1;
    }
}

#[cfg(test)]
mod tests {
    use assign::{Counters, LightList};

    use super::*;

    #[test]
    fn each_bin_is_twice_as_wide_as_the_last() {
        assert_eq!([0, 1, 2, 3, 4, 7, 8].map(bin_of), [0, 1, 2, 2, 3, 3, 4]);
        assert_eq!(bin_of(u32::MAX), 32);
    }

    #[test]
    fn each_group_counts_once_and_every_pixel_counts() {
        let list = |first, count| LightList { first, count };
        let lists = ListsSnapshot {
            // The last two groups have all lights: one overflowed, and one holds no sample.
            lists: vec![list(0, 9), list(9, 0), list(9, 3), list(12, 77), list(0, 9), list(0, 9)],
            entries: Vec::new(),
            counters: Counters { overflowed_groups: 1, ..Counters::default() },
        };
        let samples = Samples {
            positions: vec![[0.0; 3]; 4],
            normals: vec![[0.0; 3]; 4],
            groups: vec![1, 0, 1, ALL_LIGHTS],
            pixels: vec![0, 2, 3, 4],
        };
        let mut lengths = ListLengths::default();
        lengths.add(&samples, &lists, 5);
        assert_eq!(lengths.per_pixel, [Some(3), None, Some(0), Some(3), Some(9)]);
        // No sample reads group 2, and the record of all lights is no group.
        assert_eq!(lengths.histogram, [1, 0, 1]);
        // Group 2 counts among all groups; the record of all lights does not.
        assert_eq!(lengths.all_groups, [2, 0, 1, 0, 1, 0, 0, 1]);
    }
}
