//! How long the lists are that the frame's samples read: per pixel, and per group.

use assign::{ALL_LIGHTS, ListsSnapshot};
use shading::Samples;

/// Lengths of lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ListLengths {
    /// Lights in the list of each pixel's group, rows from the top; `None` without a surface.
    pub per_pixel: Vec<Option<u32>>,
    /// Groups that some sample reads, by the length of their list: see [`bin_of`].
    pub histogram: Vec<u64>,
}

/// The bin of a list's length: 0 for none, then 1, 2 to 3, 4 to 7 and so on, each twice as wide.
pub fn bin_of(lights: u32) -> usize {
    (u32::BITS - lights.leading_zeros()) as usize
}

impl ListLengths {
    /// Counts a frame's lists. Only those that a sample reads: the records of others may be an
    /// earlier frame's.
    pub fn new(samples: &Samples, lists: &ListsSnapshot, pixels: usize) -> Self {
        let length = |group: u32| lists.list(group).map_or(0, |list| list.count);
        let mut per_pixel = vec![None; pixels];
        for (&pixel, &group) in samples.pixels.iter().zip(&samples.groups) {
            if let Some(place) = per_pixel.get_mut(pixel as usize) {
                *place = Some(length(group));
            }
        }
        let mut groups = samples.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        let mut histogram = Vec::new();
        for group in groups.into_iter().filter(|&group| group != ALL_LIGHTS) {
            let bin = bin_of(length(group));
            if histogram.len() <= bin {
                histogram.resize(bin + 1, 0);
            }
            histogram[bin] += 1;
        }
        Self { per_pixel, histogram }
    }
}

#[cfg(test)]
mod tests {
    use assign::{Counters, LightList};

    use super::*;

    #[test]
    fn bins_double() {
        assert_eq!([0, 1, 2, 3, 4, 7, 8].map(bin_of), [0, 1, 2, 2, 3, 3, 4]);
        assert_eq!(bin_of(u32::MAX), 32);
    }

    #[test]
    fn groups_are_counted_once_and_pixels_each() {
        let list = |count| LightList { first: 0, count };
        let lists = ListsSnapshot {
            lists: vec![list(9), list(0), list(3), list(77)],
            entries: Vec::new(),
            counters: Counters::default(),
        };
        let samples = Samples {
            positions: vec![[0.0; 3]; 4],
            normals: vec![[0.0; 3]; 4],
            groups: vec![1, 0, 1, ALL_LIGHTS],
            pixels: vec![0, 2, 3, 4],
        };
        let lengths = ListLengths::new(&samples, &lists, 5);
        assert_eq!(lengths.per_pixel, [Some(3), None, Some(0), Some(3), Some(9)]);
        // Group 2 is read by no sample, and all lights are no group.
        assert_eq!(lengths.histogram, [1, 0, 1]);
    }
}
