//! Groups of clusters that are split by normals: their number, and the bins as shaders read them.

use assign::{AssignError, Viewport};
use bytemuck::{Pod, Zeroable};

use crate::{
    Normals, SpecularCut,
    froxels::{FROXELS_BINDING, FroxelSize, FroxelsUniform, MAX_GROUPS},
};

/// Binding of the uniform of bins: `normal_bins.wesl`. The marks are between it and the froxels.
pub(crate) const BINS_BINDING: u32 = FROXELS_BINDING + 2;

/// The bins as shaders read them: `struct NormalBins` of `normal_bins.wesl`. 8 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct NormalBinsUniform {
    /// Cells along an edge of a face of the cube. 0: one bin takes all normals.
    pub side: u32,
    /// Limit of the [`SpecularCut`]: a radiance, or the half angle of a lobe in radians.
    pub specular_limit: f32,
}

impl NormalBinsUniform {
    /// The bins of clusters that are split by `normals`, with the limit of `cut`.
    pub fn new(normals: Normals, cut: SpecularCut) -> Self {
        Self { side: normals.side(), specular_limit: cut.limit() }
    }
}

/// Number of groups: clusters times bins of normals. An error if there are more than `MAX_GROUPS`.
pub(crate) fn group_count(
    size: FroxelSize,
    froxels: &FroxelsUniform,
    normals: Normals,
    viewport: Viewport,
) -> Result<u32, AssignError> {
    let (clusters, bins) = (froxels.froxel_count(), normals.bins());
    let groups = u64::from(clusters) * u64::from(bins);
    if groups > MAX_GROUPS {
        let Viewport { width, height, .. } = viewport;
        return Err(AssignError::Parameter {
            field: "froxel size".into(),
            value: format!(
                "{size} at {width}x{height} pixels, {clusters} clusters of {bins} bins, {groups} groups"
            ),
            accepted: format!(
                "at most {MAX_GROUPS} groups: use larger tiles, fewer slices or fewer bins of normals"
            ),
        });
    }
    Ok(clusters * bins)
}

#[cfg(test)]
mod tests {
    use assign::View;
    use glam::Vec3;

    use super::*;

    #[test]
    fn too_many_groups_are_refused() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [16_384, 16_384]);
        let groups = |size: &str, normals| {
            let size = size.parse().unwrap();
            let froxels = FroxelsUniform::new(size, crate::Slices::default(), &view, None).unwrap();
            group_count(size, &froxels, normals, view.viewport)
        };
        assert_eq!(groups("16x16x8", Normals::None).unwrap(), 1 << 23);
        let error = groups("16x16x8", Normals::Bins(6)).unwrap_err().to_string();
        assert!(
            error.contains(
                "16x16x8 at 16384x16384 pixels, 8388608 clusters of 6 bins, 50331648 groups"
            ),
            "{error}"
        );
        assert_eq!(groups("128x128x8", Normals::Bins(54)).unwrap(), 54 << 17);
    }
}
