//! The lists of a record.

use serde::{Deserialize, Serialize};

use shading::HiddenPairs;

use super::{MissedPair, Operations, Untested};

/// The lists of a record, and their missed lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ListFigures {
    /// Groups that the strategy divides the view into.
    pub groups: u64,
    /// Groups with at least one light in their list.
    pub occupied_groups: u64,
    /// Entries of all lists together.
    #[serde(alias = "list_entries")]
    pub entries: u64,
    /// Entries of the longest list.
    #[serde(alias = "longest_list")]
    pub longest: u64,
    /// Groups that fell back to all lights because their list did not fit.
    pub overflowed_groups: u64,
    /// Number of groups that samples read, per bin of list length: 0, 1, 2 to 3, 4 to 7 and so on. Empty if
    /// lists were not checked.
    #[serde(default, alias = "histogram")]
    pub lengths_read: Vec<u64>,
    /// Number of all groups, read or not, in the same bins. Empty if lists were not checked.
    #[serde(default, alias = "all_groups")]
    pub lengths_all: Vec<u64>,
    /// GPU memory of groups and lists, bytes.
    #[serde(alias = "lists_bytes")]
    pub list_bytes: u64,
    /// GPU memory of everything that assignment needs, bytes: lists, marks, bounds, pools, the
    /// hierarchy over the lights, and images that the renderer draws only for this method. `null` in older
    /// results and for methods without lists.
    #[serde(default, alias = "memory_bytes")]
    pub assignment_bytes: Option<u64>,
    /// View samples: pixels that show a surface, and samples of layers; 0 if lists were not checked.
    pub samples: u64,
    /// Of these, fragments of transparent surfaces and particles, and froxels of fog; absent without layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer_samples: Option<u64>,
    /// Mean number of lights in the list that a sample reads.
    #[serde(default)]
    pub listed_per_sample: Option<f64>,
    /// Mean number of lights whose range reaches a sample: the length of a perfect list.
    #[serde(default)]
    pub contributing_per_sample: Option<f64>,
    /// (light, sample) pairs within range that are missing from the sample's list. Above 0 the image is
    /// wrong.
    #[serde(default)]
    pub missed_pairs: Option<u64>,
    /// Pairs that lists leave out because shadow maps hide the light; absent for methods without `/occ`, and if lists were
    /// not checked. They are no missed pairs: the maps decide what the image shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hidden: Option<HiddenFigures>,
    /// The first missed pair, by pixel and then by light; absent if none is missed, and in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_missed: Option<MissedPair>,
    /// (light, sample) pairs within range that were checked.
    #[serde(default)]
    pub checked_pairs: Option<u64>,
    /// Why the run tested nothing: its view shows no surface, or no light reaches a visible surface. `null` if
    /// it was tested, and in older results.
    #[serde(default)]
    pub untested: Option<Untested>,
    /// Light operations, if they were counted.
    #[serde(default)]
    pub operations: Option<Operations>,
}

/// (light, sample) pairs within range that lists leave out because shadow maps hide the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HiddenFigures {
    /// All of them.
    pub removed_pairs: u64,
    /// Of these, pairs of lights without an area to which an exact ray is free and that add something. The image of no
    /// culling has their shadow too.
    pub seen_pairs: u64,
    /// Of these, pairs of area lights of which exact rays see a part that adds something.
    pub seen_area_pairs: u64,
}

impl From<HiddenPairs> for HiddenFigures {
    fn from(HiddenPairs { removed, seen, seen_areas }: HiddenPairs) -> Self {
        Self { removed_pairs: removed, seen_pairs: seen, seen_area_pairs: seen_areas }
    }
}
