//! How HG divides its work: the words of a tile's mask, and the tiles that one part of a light takes.

use bytemuck::{Pod, Zeroable};

use crate::froxels::FroxelsUniform;

/// Lanes that share a light: `LANES` of `hybrid_scatter.wesl`.
pub(super) const LANES: u32 = 32;
/// Rounds of loops over tiles and slices that a lane takes for one light, at most.
const ROUNDS: u32 = 4096;

/// The division as shaders read it: `struct HybridParts` of `hybrid_parts.wesl`. 8 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct HybridParts {
    /// Words of a tile's mask, which has one bit per slice.
    pub mask_words: u32,
    /// Tiles of a light's outline that one part takes.
    pub tiles_per_part: u32,
}

impl HybridParts {
    /// The division for `froxels`, which have 1 to 1,024 slices.
    pub(super) fn new(froxels: &FroxelsUniform) -> Self {
        let slices = froxels.counts[2];
        Self { mask_words: slices.div_ceil(32), tiles_per_part: LANES * (ROUNDS / slices) }
    }

    /// Parts that share the tiles of a light, 1 to 129: enough that no lane loops for long.
    pub(super) fn part_count(self, froxels: &FroxelsUniform) -> u32 {
        froxels.tile_count().div_ceil(self.tiles_per_part)
    }
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
            let froxels =
                FroxelsUniform::new(size.parse().unwrap(), crate::Slices::default(), &view, None)
                    .unwrap();
            let parts = HybridParts::new(&froxels);
            let count = parts.part_count(&froxels);
            assert!((1..=129).contains(&count), "{size}: {count} parts");
            assert!(count * parts.tiles_per_part >= froxels.tile_count(), "{size}: tiles are left");
            assert!(parts.tiles_per_part / LANES * froxels.counts[2] <= ROUNDS, "{size}");
        }
    }
}
