//! What the passes of HG write, and how many workgroups they take.

use assign::{AssignError, Frame, Gpu, LightLists, LiveGroups, kernel};
use bytemuck::bytes_of;

use super::parts::HybridParts;
use crate::froxels::FroxelsUniform;

/// Cells that a workgroup of `clear` and of `reserve_lists` takes at once: `LANES` of `hybrid_reserve.wesl`.
const CELLS_AT_ONCE: u32 = 256;
/// Lights that a workgroup of `scatter` takes at once: `WORKGROUP / LANES` of `hybrid_scatter.wesl`.
const LIGHTS_AT_ONCE: u32 = 4;
/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `hybrid_occupancy.wesl`.
const BLOCK_PX: u32 = 32;

/// Buffers between the passes.
#[derive(Debug)]
pub(super) struct Buffers {
    /// [`HybridParts`], a uniform.
    pub(super) parts: wgpu::Buffer,
    /// One bit per slice of a tile: it holds samples.
    pub(super) masks: wgpu::Buffer,
    /// One word per cell: its count, then its next place.
    pub(super) cursors: wgpu::Buffer,
    /// The lists before they are sorted.
    pub(super) unsorted: wgpu::Buffer,
    /// The cells whose lists are sorted.
    pub(super) live: LiveGroups,
}

impl Buffers {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        Ok(Self {
            parts: gpu.uniform("hybrid parts", size_of::<HybridParts>() as u64),
            masks: gpu.storage("cell masks", 0)?,
            cursors: gpu.storage("cell cursors", 0)?,
            unsorted: gpu.storage("unsorted entries", 0)?,
            live: LiveGroups::new(gpu)?,
        })
    }

    /// Uploads `parts`, and grows the buffers to what the cells and the lists need.
    pub(super) fn grow(
        &mut self,
        gpu: &Gpu,
        froxels: &FroxelsUniform,
        parts: HybridParts,
        lists: &mut LightLists,
    ) -> Result<(), AssignError> {
        lists.writes_mut().write(&self.parts, 0, bytes_of(&parts))?;
        let masks = u64::from(froxels.tile_count()) * u64::from(parts.mask_words) * 4;
        let cursors = u64::from(froxels.froxel_count()) * 4;
        for (buffer, label, bytes) in [
            (&mut self.masks, "cell masks", masks),
            (&mut self.cursors, "cell cursors", cursors),
            (&mut self.unsorted, "unsorted entries", lists.entries().size()),
        ] {
            if buffer.size() < bytes {
                *buffer = gpu.storage(label, bytes)?;
            }
        }
        self.live.prepare(gpu, froxels.froxel_count())?;
        Ok(())
    }

    pub(super) fn bytes(&self) -> u64 {
        let cells = self.masks.size() + self.cursors.size() + self.live.bytes();
        self.parts.size() + cells + self.unsorted.size()
    }
}

/// Workgroups of each dispatch of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sizes {
    pub(super) clear: u32,
    pub(super) blocks: [u32; 2],
    pub(super) scatter: [u32; 2],
    pub(super) reserve: u32,
}

impl Sizes {
    pub(super) fn new(
        frame: &Frame<'_>,
        froxels: &FroxelsUniform,
        parts: HybridParts,
        buffers: &Buffers,
    ) -> Self {
        // `clear` clears whole buffers, which may have grown for a larger view.
        let words = buffers.cursors.size().max(buffers.masks.size()) / 4;
        let lights = kernel::workgroups(frame.lights.count().into(), LIGHTS_AT_ONCE);
        let viewport = frame.view.viewport;
        Self {
            clear: kernel::workgroups(words, CELLS_AT_ONCE),
            blocks: [viewport.width.div_ceil(BLOCK_PX), viewport.height.div_ceil(BLOCK_PX)],
            scatter: [lights, parts.part_count(froxels)],
            reserve: kernel::workgroups(froxels.froxel_count().into(), CELLS_AT_ONCE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hybrid::parts::LANES;

    /// The shader divides a light among parts and lanes with the same numbers.
    #[test]
    fn shaders_have_the_same_constants() {
        let has = |source: &str, name: &str, value: u32| {
            let line = format!("const {name}: u32 = {value}u;");
            assert!(source.contains(&line), "the shader lacks `{line}`");
        };
        let scatter = include_str!("../shaders/hybrid_scatter.wesl");
        has(scatter, "LANES", LANES);
        has(scatter, "WORKGROUP", LANES * LIGHTS_AT_ONCE);
        has(include_str!("../shaders/hybrid_reserve.wesl"), "LANES", CELLS_AT_ONCE);
        has(include_str!("../shaders/hybrid_occupancy.wesl"), "BLOCK_PX", BLOCK_PX);
    }
}
