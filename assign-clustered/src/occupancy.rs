//! Which clusters get a list.

use assign::AssignError;

use crate::{Slices, froxels::FroxelSize};

/// Which clusters get a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Occupancy {
    /// All clusters.
    Dense,
    /// Only those that hold a sample. Workgroups read blocks of the image, and merge what they find.
    Sparse,
    /// Only those that hold a sample. One workgroup per tile reads the tile, and keeps what it finds in a place per
    /// slice. Tiles have sides of at most [`MAX_TILE_PX`](Self::MAX_TILE_PX), and at most
    /// [`MAX_SLICES`](Self::MAX_SLICES) slices.
    DepthAware,
}

impl Occupancy {
    /// The longest side of a tile that one workgroup reads, pixels.
    pub const MAX_TILE_PX: u32 = 1024;
    /// The most slices that one workgroup has places for: `SLICES_MAX` of `gather_tiles.wesl`.
    pub const MAX_SLICES: u32 = 128;

    /// Whether only clusters that hold a sample get a list.
    pub fn is_sparse(self) -> bool {
        self != Self::Dense
    }

    /// Checks that it can find the clusters of a size.
    pub(crate) fn check(self, size: FroxelSize, slices: Slices) -> Result<(), AssignError> {
        let fail = |field: &str, value: u32, accepted: String| {
            Err(AssignError::Parameter { field: field.into(), value: value.to_string(), accepted })
        };
        if self != Self::DepthAware {
            return Ok(());
        }
        if slices.is_cascaded() {
            return Err(AssignError::Unsupported {
                strategy: "DA-I and DA-E".into(),
                asked: "cascades".into(),
                reason: "one workgroup reads one tile, and cascades join tiles".into(),
            });
        }
        if let Some(&side) = size.tile_px.iter().find(|side| **side > Self::MAX_TILE_PX) {
            let accepted =
                format!("1 to {} pixels, as one workgroup reads a tile", Self::MAX_TILE_PX);
            return fail("froxel tile size", side, accepted);
        }
        if size.slices > Self::MAX_SLICES {
            let accepted = format!("1 to {}, as one workgroup keeps all", Self::MAX_SLICES);
            return fail("froxel slice count", size.slices, accepted);
        }
        Ok(())
    }
}
