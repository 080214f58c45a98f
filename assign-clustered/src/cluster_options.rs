//! What tells one strategy of clusters from another.

use assign::{AssignError, Bounds, CullSettings, GroupShape};

use crate::{Normals, Occupancy, Slices, SpecularCut, froxels::FroxelSize};

/// What tells one strategy of clusters from another.
#[derive(Clone, Copy, Debug)]
pub struct ClusterOptions {
    /// Pixels of a tile, and the number of slices.
    pub size: FroxelSize,
    /// What lights are tested against.
    pub bounds: Bounds,
    /// Which clusters get a list.
    pub occupancy: Occupancy,
    /// How depth is cut into slices.
    pub slices: Slices,
    /// How clusters are split by normals. Only sparse clusters with explicit bounds, SC-E, can be.
    pub normals: Normals,
    /// Which specular light of area lights is left out; also only for SC-E.
    pub cut: SpecularCut,
    /// The settings of the culling driver.
    pub settings: CullSettings,
}

impl ClusterOptions {
    /// Exponential slices, without normals and without a cut.
    pub fn new(
        size: FroxelSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Self {
        let (slices, normals, cut) = (Slices::default(), Normals::None, SpecularCut::None);
        Self { size, bounds, occupancy, slices, normals, cut, settings }
    }

    pub(crate) fn family(&self) -> &'static str {
        match (self.occupancy, self.bounds) {
            (Occupancy::Dense, Bounds::Implicit) => "DC-I",
            (Occupancy::Dense, Bounds::Explicit) => "DC-E",
            (Occupancy::Sparse, Bounds::Implicit) => "SC-I",
            (Occupancy::Sparse, Bounds::Explicit) => "SC-E",
            (Occupancy::DepthAware, Bounds::Implicit) => "DA-I",
            (Occupancy::DepthAware, Bounds::Explicit) => "DA-E",
        }
    }

    pub(crate) fn shape(&self) -> GroupShape {
        match self.bounds {
            Bounds::Implicit => GroupShape::Frustum,
            Bounds::Explicit => GroupShape::Box,
        }
    }

    pub(crate) fn check(&self) -> Result<(), AssignError> {
        let Self { size, bounds, occupancy, slices, normals, cut, .. } = *self;
        size.check()?;
        occupancy.check(size, slices)?;
        slices.check(size.slices)?;
        normals.check()?;
        cut.check(normals)?;
        if slices.is_cascaded() && normals.is_some() {
            return Err(AssignError::Unsupported {
                strategy: self.family().into(),
                asked: "cascades".into(),
                reason: "clusters that are split by normals have tiles of one size".into(),
            });
        }
        let is_plain = !normals.is_some() && cut == SpecularCut::None;
        if is_plain || (bounds, occupancy) == (Bounds::Explicit, Occupancy::Sparse) {
            return Ok(());
        }
        let asked = match normals.is_some() {
            true => format!("{} bins of normals", normals.bins()),
            false => format!("the specular cut {cut:?}"),
        };
        Err(AssignError::Unsupported {
            strategy: self.family().into(),
            asked,
            reason: "only sparse clusters with explicit bounds, SC-E, can be split by normals or leave out \
                     specular light"
                .into(),
        })
    }
}
