//! The lists of a record.

use serde::{Deserialize, Serialize};

use super::{Operations, Untested};

/// What its lists hold, and whether they hold enough.
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
    /// Groups that fell back to all lights because a list did not fit.
    pub overflowed_groups: u64,
    /// Groups that some sample reads, by the length of their list: none, 1, 2 to 3, 4 to 7 and so
    /// on. Empty where lists were not checked.
    #[serde(default)]
    pub histogram: Vec<u64>,
    /// All groups, read or not, by the length of their list, likewise. Empty where lists were not
    /// checked.
    #[serde(default)]
    pub all_groups: Vec<u64>,
    /// GPU memory of groups and lists, bytes.
    #[serde(alias = "lists_bytes")]
    pub bytes: u64,
    /// GPU memory of everything that assignment needs, bytes: lists, marks, bounds, pools, the
    /// hierarchy over the lights, and images that the renderer draws only for this method. `null` in
    /// older results, and for methods without lists.
    #[serde(default)]
    pub memory_bytes: Option<u64>,
    /// View samples: pixels that show a surface; 0 where lists were not checked.
    pub samples: u64,
    /// Mean number of lights in the list that a sample reads.
    #[serde(default)]
    pub listed_per_sample: Option<f64>,
    /// Mean number of lights whose range reaches a sample: what a perfect list would hold.
    #[serde(default)]
    pub contributing_per_sample: Option<f64>,
    /// (light, sample) pairs within range that the sample's list does not hold: 0, or the image
    /// is wrong.
    #[serde(default)]
    pub missed_pairs: Option<u64>,
    /// (light, sample) pairs within range that were looked up in the lists.
    #[serde(default)]
    pub checked_pairs: Option<u64>,
    /// Why the run certifies nothing: its view shows no surface, or no light reaches what it shows.
    /// `null` where it was tested, and in older results.
    #[serde(default)]
    pub untested: Option<Untested>,
    /// Light operations, where they were counted.
    #[serde(default)]
    pub operations: Option<Operations>,
}
