//! What tells one strategy of clusters from another.

use assign::{AssignError, Bounds, CullSettings, Facing, GroupShape, check_specular_reach};

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
    /// Out to how many of its ranges a point or a spot is listed for its specular term, at most, on polished surfaces:
    /// 1 to [`MAX_SPECULAR_REACH`](assign::MAX_SPECULAR_REACH). `None`: lists end at the range. Only for SC-E without
    /// bins of normals and without a cut.
    pub reach: Option<f32>,
    /// The settings of the culling driver.
    pub settings: CullSettings,
}

impl ClusterOptions {
    /// Exponential slices, without normals, without a cut, and lists that end at the lights' ranges.
    pub fn new(
        size: FroxelSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Self {
        let (slices, normals, cut) = (Slices::default(), Normals::None, SpecularCut::None);
        Self { size, bounds, occupancy, slices, normals, cut, reach: None, settings }
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

    /// What the kernel must know of the surfaces of groups.
    pub(crate) fn facing(&self) -> Facing {
        match self.reach {
            Some(_) => Facing::SpecularReach,
            None => self.cut.facing(self.normals),
        }
    }

    /// Whether the pass `bounds` reads normals.
    pub(crate) fn reads_normals(&self) -> bool {
        self.normals.is_some() || self.reach.is_some()
    }

    /// Whether the pass `bounds` reads base colours.
    pub(crate) fn reads_materials(&self) -> bool {
        self.cut.is_glossy() || self.reach.is_some()
    }

    pub(crate) fn check(&self) -> Result<(), AssignError> {
        let Self { size, bounds, occupancy, slices, normals, cut, reach, .. } = *self;
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
        let is_of_normals = normals.is_some() || cut != SpecularCut::None;
        if let Some(most) = reach {
            check_specular_reach(most)?;
            if is_of_normals {
                return Err(AssignError::Unsupported {
                    strategy: self.family().into(),
                    asked: format!("a specular reach of {most} ranges"),
                    reason: "clusters that are split by normals or leave out specular light end at the lights' ranges"
                        .into(),
                });
            }
        }
        let is_plain = !is_of_normals && reach.is_none();
        if is_plain || (bounds, occupancy) == (Bounds::Explicit, Occupancy::Sparse) {
            return Ok(());
        }
        let asked = match (normals, reach) {
            (Normals::Bins(bins), _) => format!("{bins} bins of normals"),
            (Normals::None, Some(most)) => format!("a specular reach of {most} ranges"),
            (Normals::None, None) => format!("the specular cut {cut:?}"),
        };
        Err(AssignError::Unsupported {
            strategy: self.family().into(),
            asked,
            reason: "only sparse clusters with explicit bounds, SC-E, can be split by normals, leave out \
                     specular light or list lights beyond their range"
                .into(),
        })
    }
}
