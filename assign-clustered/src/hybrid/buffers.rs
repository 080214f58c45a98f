//! What the passes of HG write, and how many workgroups they take.

use assign::{AssignError, Frame, Gpu, LightLists, LiveGroups};

use crate::froxels::FroxelsUniform;

/// The most workgroups along one axis of a dispatch. Each takes more items if there are more.
const MAX_DISPATCH: u32 = 65_535;
/// Cells that a workgroup of `clear` and of `reserve_lists` takes at once: `LANES` of `hybrid_reserve.wesl`.
const CELLS_AT_ONCE: u32 = 256;
/// Lights that a workgroup of `scatter` takes at once: `WORKGROUP / LANES` of `hybrid_scatter.wesl`.
const LIGHTS_AT_ONCE: u32 = 4;
/// Lanes that share a light: `LANES` of `hybrid_scatter.wesl`.
const LANES: u32 = 32;
/// Rounds of loops over tiles and slices that a lane takes for one light, at most: `ROUNDS` of
/// `hybrid_scatter.wesl`.
const ROUNDS: u32 = 4096;
/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `hybrid_occupancy.wesl`.
const BLOCK_PX: u32 = 32;

/// Buffers between the passes.
#[derive(Debug)]
pub(super) struct Buffers {
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
            masks: gpu.storage("cell masks", 0)?,
            cursors: gpu.storage("cell cursors", 0)?,
            unsorted: gpu.storage("unsorted entries", 0)?,
            live: LiveGroups::new(gpu)?,
        })
    }

    /// Grows the buffers to what the cells and the lists need.
    pub(super) fn grow(
        &mut self,
        gpu: &Gpu,
        froxels: &FroxelsUniform,
        lists: &LightLists,
    ) -> Result<(), AssignError> {
        let mask_words = froxels.counts[2].div_ceil(32);
        let masks = u64::from(froxels.tile_count()) * u64::from(mask_words) * 4;
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
        self.masks.size() + self.cursors.size() + self.unsorted.size() + self.live.bytes()
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
    pub(super) fn new(frame: &Frame<'_>, froxels: &FroxelsUniform, buffers: &Buffers) -> Self {
        // `clear` clears whole buffers, which may have grown for a larger view.
        let words = (buffers.cursors.size().max(buffers.masks.size()) / 4) as u32;
        let workgroups = |items: u32, at_once: u32| items.div_ceil(at_once).min(MAX_DISPATCH);
        let viewport = frame.view.viewport;
        Self {
            clear: workgroups(words, CELLS_AT_ONCE),
            blocks: [viewport.width.div_ceil(BLOCK_PX), viewport.height.div_ceil(BLOCK_PX)],
            scatter: [workgroups(frame.lights.count(), LIGHTS_AT_ONCE), part_count(froxels)],
            reserve: workgroups(froxels.froxel_count(), CELLS_AT_ONCE),
        }
    }
}

/// Tiles of a light's outline that one part takes: `tiles_per_part` of `hybrid_scatter.wesl`.
fn tiles_per_part(froxels: &FroxelsUniform) -> u32 {
    LANES * (ROUNDS / froxels.counts[2])
}

/// Parts that share the tiles of a light, 1 to 129: enough that no lane loops for long.
fn part_count(froxels: &FroxelsUniform) -> u32 {
    froxels.tile_count().div_ceil(tiles_per_part(froxels))
}

#[cfg(test)]
mod tests {
    use assign::View;
    use glam::Vec3;

    use super::*;

    #[test]
    fn no_lane_loops_for_long() {
        for (size, target) in [("1x1x1", 4096), ("1x1x1024", 128), ("48x48x40", 8192)] {
            let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [target; 2]);
            let froxels = FroxelsUniform::new(size.parse().unwrap(), &view, None).unwrap();
            let parts = part_count(&froxels);
            assert!((1..=129).contains(&parts), "{size}: {parts} parts");
            assert!(tiles_per_part(&froxels) / LANES * froxels.counts[2] <= ROUNDS, "{size}");
        }
    }

    /// The shader divides a light among parts and lanes with the same numbers.
    #[test]
    fn shaders_have_the_same_constants() {
        let has = |source: &str, name: &str, value: u32| {
            let line = format!("const {name}: u32 = {value}u;");
            assert!(source.contains(&line), "the shader lacks `{line}`");
        };
        let scatter = include_str!("../shaders/hybrid_scatter.wesl");
        has(scatter, "LANES", LANES);
        has(scatter, "ROUNDS", ROUNDS);
        has(scatter, "WORKGROUP", LANES * LIGHTS_AT_ONCE);
        has(include_str!("../shaders/hybrid_reserve.wesl"), "LANES", CELLS_AT_ONCE);
        has(include_str!("../shaders/hybrid_occupancy.wesl"), "BLOCK_PX", BLOCK_PX);
    }
}
