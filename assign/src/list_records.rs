//! The records of light lists: what the GPU writes, and their copy on the CPU.

use bytemuck::{Pod, Zeroable};

/// Entry flag: the light's diffuse term may reach the group.
pub const ENTRY_DIFFUSE: u32 = 1 << 30;
/// Entry flag: the light's specular term may reach the group.
pub const ENTRY_SPECULAR: u32 = 1 << 31;
/// Mask of an entry's low bits, which hold the light's index.
pub const ENTRY_LIGHT: u32 = ENTRY_DIFFUSE - 1;
/// Both terms of a light.
pub(crate) const ALL_TERMS: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;
/// The value that `group_of` returns for a sample outside all groups. Its list holds all lights.
pub const ALL_LIGHTS: u32 = u32::MAX;

/// A light list: `count` entries from `first`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct LightList {
    /// Index of its first entry.
    pub first: u32,
    /// Number of its entries.
    pub count: u32,
}

/// The counters that the GPU writes behind the last record. `reserve.wesl` names their places.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Counters {
    /// Words taken from the pool, plus the words of lists that no longer fitted.
    pub cursor: u32,
    /// Requested entries, low 32 bits.
    pub requested_low: u32,
    /// Requested entries, high 32 bits.
    pub requested_high: u32,
    /// Groups that fell back to all lights.
    pub overflowed_groups: u32,
    /// Groups with at least one light.
    pub occupied_groups: u32,
    /// Entries of the longest requested list.
    pub longest: u32,
}

impl Counters {
    /// Entries that all groups requested together.
    pub fn requested(&self) -> u64 {
        u64::from(self.requested_high) << 32 | u64::from(self.requested_low)
    }
}

/// The culling kernel's parameters: `struct Cull` of `reserve.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullUniform {
    /// Number of lights.
    pub light_count: u32,
    /// Number of groups.
    pub group_count: u32,
    /// First entry of the pool.
    pub pool_first: u32,
    /// Entries in the pool.
    pub pool_capacity: u32,
    /// 1 if the reserved entries could exceed 32 bits.
    pub guard_cursor: u32,
    /// The most lights of a list. Later lights are dropped.
    pub list_cap: u32,
    /// Place of the first light node of level 2.
    pub first_parent: u32,
    /// Place of the first light node of level 3.
    pub first_grandparent: u32,
    /// Words of a group's bit mask with its summary; 0 for lists.
    pub mask_stride: u32,
    /// Words of the summary.
    pub mask_summary: u32,
}

/// Lists copied to the CPU. Bit masks are copied as the lists that they stand for. Words of trees stay between the
/// lists, which do not point to them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListsSnapshot {
    /// Record 0 (all lights), then one record per group.
    pub lists: Vec<LightList>,
    /// All entries, and the words of trees.
    pub entries: Vec<u32>,
    /// The counters of the last frame.
    pub counters: Counters,
}

impl ListsSnapshot {
    /// The record of a group, [`ALL_LIGHTS`] included; `None` if there is no such group.
    pub fn list(&self, group: u32) -> Option<LightList> {
        self.lists.get(group.wrapping_add(1) as usize).copied()
    }

    /// Whether a group has the list of all lights: its list did not fit, or it holds no sample.
    pub fn is_all_lights(&self, group: u32) -> bool {
        let all = self.list(ALL_LIGHTS).filter(|all| all.count > 0);
        all.is_some_and(|all| {
            self.list(group).is_some_and(|list| list.count > 0 && list.first == all.first)
        })
    }

    /// The entries of a group; `None` if the group or its entries lie outside the buffers.
    pub fn entries_of(&self, group: u32) -> Option<&[u32]> {
        let list = self.list(group)?;
        let first = list.first as usize;
        self.entries.get(first..first.checked_add(list.count as usize)?)
    }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use super::*;

    #[test]
    fn kernels_count_where_the_cpu_reads() {
        let shader = include_str!("shaders/reserve.wesl");
        for (name, offset) in [
            ("CURSOR", offset_of!(Counters, cursor)),
            ("REQUESTED_LOW", offset_of!(Counters, requested_low)),
            ("REQUESTED_HIGH", offset_of!(Counters, requested_high)),
            ("OVERFLOWED_GROUPS", offset_of!(Counters, overflowed_groups)),
            ("OCCUPIED_GROUPS", offset_of!(Counters, occupied_groups)),
            ("LONGEST", offset_of!(Counters, longest)),
        ] {
            let line = format!("const {name}: u32 = {}u;", offset / 4);
            assert!(shader.contains(&line), "reserve.wesl lacks `{line}`");
        }
    }
}
