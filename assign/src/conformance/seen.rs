//! A frame that was drawn and read back: what the strategy stored, and what its look-up returned.

use super::rig::Probe;
use crate::{ALL_LIGHTS, Counters, LightList, ListsSnapshot};

/// A record that no pass writes. Records are filled with it before the first frame.
pub(super) const UNWRITTEN: LightList = LightList { first: u32::MAX, count: u32::MAX };

/// One frame that was drawn and read back.
pub(super) struct Seen {
    pub(super) snapshot: ListsSnapshot,
    pub(super) probes: Vec<Probe>,
    pub(super) group_count: u32,
    pub(super) light_count: u32,
    /// Whether lists may omit lights below a sample's horizon.
    pub(super) knows_normals: bool,
    /// What each sample reads, if samples of one group may read different lights.
    pub(super) per_sample: Option<Box<Seen>>,
}

impl Seen {
    pub(super) fn overflowed(&self) -> bool {
        self.snapshot.counters.overflowed_groups > 0
    }

    /// What samples read: these lists, or those of each sample, each a group of its own.
    pub(super) fn read(&self) -> &Self {
        self.per_sample.as_deref().unwrap_or(self)
    }

    /// Adds what the look-up returned for each sample: the lists, and their entries. `again` are the samples as
    /// the look-up found them that wrote the entries; both look-ups must have found the same.
    pub(super) fn with_read(
        self,
        (lists, entries): (Vec<LightList>, Vec<u32>),
        again: Vec<Probe>,
    ) -> Self {
        let mut snapshot = ListsSnapshot {
            lists: self.snapshot.lists[..1].to_vec(),
            entries: self.snapshot.entries.clone(),
            counters: Counters::default(),
        };
        let held = snapshot.entries.len() as u32;
        snapshot.entries.extend(entries);
        let mut probes = again;
        for ((ix, probe), list) in (0..).zip(&mut probes).zip(&lists) {
            (probe.group, probe.count) = (ix, probe.read);
            snapshot.lists.push(LightList { first: held + list.first, ..*list });
            snapshot.counters.occupied_groups += u32::from(list.count > 0);
            snapshot.counters.longest = snapshot.counters.longest.max(list.count);
            snapshot.counters.requested_low += list.count;
        }
        let group_count = probes.len() as u32;
        let read = Self { snapshot, probes, group_count, per_sample: None, ..self };
        Self { per_sample: Some(Box::new(read)), ..self }
    }

    pub(super) fn list(&self, group: u32) -> Option<LightList> {
        let exists = group == ALL_LIGHTS || group < self.group_count;
        self.snapshot.list(group).filter(|_| exists)
    }

    /// A group's entries; empty if the group or its list does not exist.
    pub(super) fn entries(&self, group: u32) -> &[u32] {
        self.list(group).and_then(|_| self.snapshot.entries_of(group)).unwrap_or_default()
    }

    /// Whether a group fell back to all lights. Lists in the pool never start at entry 0.
    pub(super) fn fell_back(list: LightList) -> bool {
        list.first == 0 && list.count > 0
    }
}
