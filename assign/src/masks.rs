//! Storage of a group's lights as a bit per light instead of a list of entries.
//!
//! A node holds 64 lights. Each group has a region of the entries' buffer. `lists[g + 1] = (first, count)` points into it:
//!
//! - from `first` on, two words per node: the bits of the lights that may reach the group.
//! - before `first`, backwards, the summary: bit `n % 32` of word `first - 1 - n / 32` says whether node `n`
//!   has any bit set. The words of other nodes are neither written nor read.
//!
//! `count` is the number of set bits. Region 0 has all bits set, and its `count` is the number of lights. So
//! the look-up reads lights in ascending index, as from a list, until it has read `count` of them.
//!
//! Worked example: 70 lights, of which 3 and 66 reach group 0. There are 2 nodes and one word of summary, so
//! regions have 5 words: `entries = [~0, ~0, ~0, ~0, ~0 | 0b11, 1 << 3, 0, 1 << 2, 0]` and
//! `lists = [(1, 70), (6, 2)]`.
//!
//! Tiled renderers that ship use bit masks because their size is known beforehand, no pool can overflow, and
//! masks can be joined: Call of Duty: Infinite Warfare (Drobot 2017, "Improved Culling for Tiled and
//! Clustered Rendering"), Unity's Universal Render Pipeline (Forward+) and Wicked Engine. They make no second pass over the lights, whatever
//! the length of the list.
//!
//! Where it fails: memory grows with groups times lights, not with what reaches the groups: 36,800 clusters and
//! 100,000 lights take 467 MB. A sample reads up to one word of summary per 2,048 lights. An entry has no
//! flags, so both terms of an area light are evaluated wherever one reaches. A mask holds at most 1,048,576
//! lights.

use crate::{AssignError, LightList, light_nodes::NODE_LIGHTS, list_records::ALL_TERMS};

/// Words of summary that a workgroup holds while it culls: `MOST_SUMMARY` of `cull.wesl`.
const MOST_SUMMARY: u32 = 512;

/// The sizes of a region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MaskLayout {
    /// Words of the summary.
    pub(crate) summary: u32,
    /// Words of a region.
    pub(crate) stride: u32,
}

impl MaskLayout {
    /// The regions for a number of lights.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] above 1,048,576 lights.
    pub(crate) fn over(lights: u32) -> Result<Self, AssignError> {
        let nodes = lights.div_ceil(NODE_LIGHTS as u32);
        let summary = nodes.div_ceil(32);
        if summary > MOST_SUMMARY {
            return Err(AssignError::Parameter {
                field: "lights of bit masks".into(),
                value: lights.to_string(),
                accepted: format!("at most {}", MOST_SUMMARY * 32 * NODE_LIGHTS as u32),
            });
        }
        Ok(Self { summary, stride: summary + 2 * nodes })
    }

    /// The lists that the words of `entries` stand for, and their entries. A record that points outside, or has
    /// fewer bits than lights, points outside the entries.
    pub(crate) fn decode(self, records: &[LightList], words: &[u32]) -> (Vec<LightList>, Vec<u32>) {
        let mut entries = Vec::new();
        let decoded = records.iter().enumerate().map(|(ix, record)| {
            if ix > 0 && record.count > 0 && record.first == records[0].first {
                // It shares the mask of all lights, whose lights come first. Its count may be that of all slots.
                return LightList { first: 0, count: records[0].count };
            }
            let begin = u32::try_from(entries.len()).unwrap_or(u32::MAX);
            match self.lights(*record, words) {
                None if record.first == u32::MAX => *record,
                None => LightList { first: u32::MAX, ..*record },
                Some(lights) => {
                    entries.extend(lights.into_iter().map(|light| light | ALL_TERMS));
                    LightList { first: begin, count: record.count }
                }
            }
        });
        let decoded = decoded.collect();
        (decoded, entries)
    }

    /// The lights of a record; `None` if it points outside.
    fn lights(self, record: LightList, words: &[u32]) -> Option<Vec<u32>> {
        let LightList { first, count } = record;
        if count == 0 {
            return Some(Vec::new());
        }
        let begin = first.checked_sub(self.summary)? as usize;
        let region = words.get(begin..begin.checked_add(self.stride as usize)?)?;
        let (summary, nodes) = region.split_at(self.summary as usize);
        let is_set = |node: &usize| summary[summary.len() - 1 - node / 32] >> (node % 32) & 1 == 1;
        let lights = (0..nodes.len() / 2).filter(is_set).flat_map(|node| {
            let bits = u64::from(nodes[2 * node + 1]) << 32 | u64::from(nodes[2 * node]);
            let set = (0..NODE_LIGHTS).filter(move |bit| bits >> bit & 1 == 1);
            set.map(move |bit| (node * NODE_LIGHTS + bit) as u32)
        });
        let lights: Vec<u32> = lights.take(count as usize).collect();
        // Fewer bits than the record says.
        (lights.len() == count as usize).then_some(lights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worked_example() {
        let layout = MaskLayout::over(70).unwrap();
        assert_eq!(layout, MaskLayout { summary: 1, stride: 5 });
        let all = u32::MAX;
        let words = [all, all, all, all, all, 0b11, 1 << 3, 0, 1 << 2, 0];
        let records = [LightList { first: 1, count: 70 }, LightList { first: 6, count: 2 }];
        let (lists, entries) = layout.decode(&records, &words);
        assert_eq!(lists, [LightList { first: 0, count: 70 }, LightList { first: 70, count: 2 }]);
        let every: Vec<u32> = (0..70).chain([3, 66]).map(|light| light | ALL_TERMS).collect();
        assert_eq!(entries, every);
    }

    #[test]
    fn records_without_their_bits_point_outside_and_words_of_other_nodes_are_not_read() {
        let layout = MaskLayout::over(70).unwrap();
        let outside = LightList { first: 7, count: 1 };
        let more_than_bits = LightList { first: 1, count: 3 };
        let empty = LightList::default();
        let words = [0b01, 0b101, 0, 77, 77];
        let records = [outside, more_than_bits, empty, LightList { first: 1, count: 2 }];
        let (lists, entries) = layout.decode(&records, &words);
        let lost = |record| LightList { first: u32::MAX, ..record };
        assert_eq!(lists[..3], [lost(outside), lost(more_than_bits), empty]);
        assert_eq!(entries, [ALL_TERMS, 2 | ALL_TERMS]);
    }

    #[test]
    fn there_is_room_for_a_million_lights() {
        assert_eq!(MaskLayout::over(0).unwrap(), MaskLayout::default());
        assert_eq!(MaskLayout::over(1 << 20).unwrap().summary, 512);
        let error = MaskLayout::over((1 << 20) + 1).unwrap_err().to_string();
        assert!(error.contains("1048577") && error.contains("at most 1048576"), "{error}");
    }
}
