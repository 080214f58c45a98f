//! When the buffers of lists grow.

use bytemuck::cast_slice;

use super::LightLists;
use crate::{AssignError, Gpu, events, list_records::ALL_TERMS, masks::MaskLayout};

/// The most entries with which the pool starts, 64 MiB.
const MAX_GUESS: u64 = 16 << 20;

impl LightLists {
    /// Replaces the entry buffer if all lights or the pool no longer fit.
    pub(super) fn size_entries(
        &mut self,
        gpu: &Gpu,
        light_count: u32,
        group_count: u32,
        asked: u64,
    ) -> Result<bool, AssignError> {
        let room = gpu.max_storage_bytes() / 4;
        let light_capacity = light_count.max(self.light_capacity).next_power_of_two();
        if u64::from(light_capacity) > room {
            return Err(AssignError::TooLarge {
                what: format!("the list of all {light_count} lights"),
                bytes: u64::from(light_capacity) * 4,
                limit: room * 4,
            });
        }
        // A guess until a frame has counted: 16 entries per group, or every (light, group) pair if
        // those are fewer.
        let groups = u64::from(group_count);
        let pairs = groups * u64::from(light_count.min(16));
        let guess = self.storage.pool_words(pairs, groups).min(MAX_GUESS);
        let has = u64::from(self.pool_capacity);
        // A quarter more than requested, so that a moving camera does not grow the pool each frame.
        let grown = if asked > has { asked + asked / 4 } else { has };
        let most = self.most_entries(gpu, light_capacity);
        let wanted = grown.max(guess).min(most) as u32;
        if light_capacity == self.light_capacity && wanted <= self.pool_capacity {
            return Ok(false);
        }
        let all: Vec<u32> = (0..light_capacity).map(|light| light | ALL_TERMS).collect();
        let bytes = (u64::from(light_capacity) + u64::from(wanted)) * 4;
        self.entries = match gpu.storage("light entries", bytes) {
            // Keeps the pool as it is. Lists that do not fit stay all lights.
            Err(AssignError::OutOfMemory { .. }) if light_capacity == self.light_capacity => {
                self.pool_limit = self.pool_capacity;
                return Ok(false);
            }
            other => other?,
        };
        gpu.queue.write_buffer(&self.entries, 0, cast_slice(&all));
        if self.pool_capacity > 0 {
            events::grew("light entries", bytes);
        }
        self.light_capacity = light_capacity;
        self.pool_capacity = wanted;
        Ok(true)
    }

    /// Replaces the buffer of bit masks if they no longer fit.
    pub(super) fn size_masks(
        &mut self,
        gpu: &Gpu,
        lights: u32,
        regions: u64,
    ) -> Result<bool, AssignError> {
        let masks = MaskLayout::over(lights)?;
        let words = u64::from(masks.stride) * regions;
        let most = (gpu.max_storage_bytes() / 4).min(u64::from(u32::MAX));
        if words > most {
            return Err(AssignError::TooLarge {
                what: format!("the bit masks of {lights} lights in {regions} groups"),
                bytes: words * 4,
                limit: most * 4,
            });
        }
        let changed = self.entries.size() < words * 4;
        if changed {
            // A quarter more, so that a growing number of lights does not replace it in each frame.
            self.entries = gpu.storage("light masks", (words + words / 4).min(most) * 4)?;
        }
        self.masks = masks;
        Ok(changed)
    }
}
