//! Where the lights that reach a group are kept.

use crate::trees;

/// Where the lights that may reach a group are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// As a list of entries in a pool.
    #[default]
    Lists,
    /// As a bit per light (`masks.rs`).
    Masks,
    /// As a bit per light. The lanes of a subgroup read the union of their words together (`scalar_masks.rs`).
    ScalarMasks,
    /// As a list of entries in a pool, of which the subgroup that reads it leaves out what misses the box around
    /// its samples (Mikkelsen 2016 prunes lists of large tiles for small ones, before shading).
    PrunedLists,
    /// As a list of entries in a pool, and before it a tree of the depths that its lights reach (`trees.rs`).
    Trees,
}

impl Storage {
    /// The segment of an id that names it; `None` for lists.
    pub const fn name(self) -> Option<&'static str> {
        match self {
            Self::Lists => None,
            Self::Masks => Some("mask"),
            Self::ScalarMasks => Some("scalar"),
            Self::PrunedLists => Some("prune"),
            Self::Trees => Some("tree"),
        }
    }

    /// All storages that have a [name](Self::name).
    pub const NAMED: [Self; 4] = [Self::Masks, Self::ScalarMasks, Self::PrunedLists, Self::Trees];

    /// Whether it keeps a bit per light. Such a storage has no entries and no pool.
    pub const fn is_mask(self) -> bool {
        matches!(self, Self::Masks | Self::ScalarMasks)
    }

    /// Whether what it keeps serves later frames too. A tree holds depths in the view of its frame.
    pub const fn serves_later_frames(self) -> bool {
        !matches!(self, Self::Trees)
    }

    /// The most words of the pool that so many lists take, if they have so many entries together.
    pub(crate) const fn pool_words(self, entries: u64, lists: u64) -> u64 {
        match self {
            Self::Trees => trees::pool_words(entries, lists),
            _ => entries,
        }
    }
}
