//! How the view frustum is cut into clusters.

use std::{fmt, str::FromStr};

use assign::{AssignError, Projection, View};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::Normals;

/// The size of clusters: pixels of a tile, and the number of depth slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClusterSize {
    /// Width and height of a tile, pixels.
    pub tile_px: [u32; 2],
    /// Depth slices.
    pub slices: u32,
}

/// More groups than this, clusters times bins of normals, are refused: their records alone would take 128 MiB.
const MAX_GROUPS: u64 = 1 << 24;

impl ClusterSize {
    /// Checks each field.
    pub fn check(&self) -> Result<(), AssignError> {
        let fail = |field: &str, value: u32, accepted: &str| {
            Err(AssignError::Parameter {
                field: format!("cluster {field}"),
                value: value.to_string(),
                accepted: accepted.into(),
            })
        };
        if let Some(&value) = self.tile_px.iter().find(|t| !(1..=16_384).contains(*t)) {
            return fail("tile size", value, "1 to 16384 pixels");
        }
        if !(1..=1024).contains(&self.slices) {
            return fail("slice count", self.slices, "1 to 1024");
        }
        Ok(())
    }
}

impl fmt::Display for ClusterSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.tile_px[0], self.tile_px[1], self.slices)
    }
}

impl FromStr for ClusterSize {
    type Err = AssignError;

    /// Reads `WIDTHxHEIGHTxSLICES`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let fail = || AssignError::Parameter {
            field: "cluster size".into(),
            value: text.into(),
            accepted: "WIDTHxHEIGHTxSLICES, tile pixels and slice count, such as 64x64x24".into(),
        };
        let numbers: Vec<u32> = text
            .split('x')
            .map(|part| part.parse().map_err(|_| fail()))
            .collect::<Result<_, _>>()?;
        let [width, height, slices] = numbers[..] else {
            return Err(fail());
        };
        let size = Self { tile_px: [width, height], slices };
        size.check()?;
        Ok(size)
    }
}

/// Slices end this many times farther than they begin, 40 octaves; the last one takes the rest.
/// The shader's depth slack is derived for no more.
const MAX_DEPTH_RATIO: f32 = (1_u64 << 40) as f32;

/// What the shaders know of the clusters: `struct Clusters`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ClustersUniform {
    /// Clusters along x, y and depth.
    pub counts: [u32; 3],
    /// Slices per octave of depth (exponential) or per metre (even).
    pub slices_per_unit: f32,
    /// Pixels of a tile.
    pub tile_px: [u32; 2],
    /// Upper left pixel of the viewport.
    pub origin_px: [u32; 2],
    /// View depth at which slice 0 begins, metres.
    pub first_m: f32,
    /// View depth of the near plane, metres.
    pub near_m: f32,
    /// Greatest view depth of a sample, metres, or [`UNBOUNDED`]: the far plane, as shading
    /// rebuilds it.
    pub far_m: f32,
    /// 1 where slices grow exponentially.
    pub exponential: u32,
    /// 1 where lists are made for the surfaces in the depth buffer alone.
    pub surfaces_only: u32,
    /// Cells along an edge of a face of the cube of normals; 0: normals are not told apart.
    pub bin_side: u32,
    /// The number of the [`SpecularCut`](crate::SpecularCut): a radiance, or an angle in radians.
    pub specular_limit: f32,
    /// Pads to 64 bytes.
    pub padding: u32,
}

/// The far end of a view without a far plane: `bounds_frustum.wesl`, `UNBOUNDED`.
pub const UNBOUNDED: f32 = 3.4e38;

impl ClustersUniform {
    /// Cuts `view` into clusters.
    ///
    /// Each cluster has a group for every bin of `normals`.
    ///
    /// Slices run from the near to the far plane, exponentially in a perspective view (Enhuber
    /// 2019, equation 3.3), evenly in an orthographic one. In a perspective view they end at the
    /// farthest point that a light reaches (`light_bounds`) where the far plane lies behind it, and
    /// the last slice goes on to the far plane or to infinity ([`View::slices_end_m`]).
    pub fn new(
        size: ClusterSize,
        normals: Normals,
        view: &View,
        light_bounds: Option<(Vec3, Vec3)>,
    ) -> Result<Self, AssignError> {
        let viewport = [view.viewport.width, view.viewport.height];
        let counts = [
            viewport[0].div_ceil(size.tile_px[0]),
            viewport[1].div_ceil(size.tile_px[1]),
            size.slices,
        ];
        let bins = u64::from(normals.bins());
        let total = counts.iter().map(|&n| u64::from(n)).product::<u64>() * bins;
        if total > MAX_GROUPS {
            return Err(AssignError::Parameter {
                field: "cluster size".into(),
                value: format!(
                    "{size} at {}x{}: {} clusters of {bins} bins, {total} groups",
                    viewport[0],
                    viewport[1],
                    total / bins
                ),
                accepted: format!(
                    "at most {MAX_GROUPS} groups: larger tiles, fewer slices or bins of normals"
                ),
            });
        }
        let near = view.near_m;
        let exponential = matches!(view.projection, Projection::Perspective { .. });
        let last = match (exponential, view.far_m) {
            (false, Some(far)) => far,
            _ => view.slices_end_m(light_bounds).min(near * MAX_DEPTH_RATIO),
        };
        let span = if exponential { (last / near).log2() } else { last - near };
        Ok(Self {
            counts,
            slices_per_unit: size.slices as f32 / span,
            tile_px: size.tile_px,
            origin_px: [view.viewport.x, view.viewport.y],
            first_m: near,
            near_m: view.nearest_rebuilt_m(),
            far_m: view.farthest_rebuilt_m().unwrap_or(UNBOUNDED),
            exponential: u32::from(exponential),
            surfaces_only: 0,
            bin_side: normals.side(),
            specular_limit: 0.0,
            padding: 0,
        })
    }

    /// Number of clusters times bins of normals.
    pub fn group_count(&self) -> u32 {
        let bins = (6 * self.bin_side * self.bin_side).max(1);
        self.counts.iter().product::<u32>() * bins
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_parse_and_print_alike() {
        let size: ClusterSize = "64x32x24".parse().unwrap();
        assert_eq!(size.to_string(), "64x32x24");
        for bad in ["", "64", "64x64", "0x64x24", "64x64x0", "axbxc", "64x64x24x2"] {
            let error = bad.parse::<ClusterSize>().unwrap_err().to_string();
            assert!(error.contains("must be"), "{bad}: {error}");
        }
    }

    #[test]
    fn slices_span_near_to_far() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [130, 64]);
        view.far_m = Some(512.0);
        let size = "64x64x20".parse().unwrap();
        let clusters = ClustersUniform::new(size, Normals::None, &view, None).unwrap();
        assert_eq!(clusters.counts, [3, 1, 20]);
        // Ten octaves, two slices each.
        assert_eq!(clusters.slices_per_unit, 2.0);
    }

    #[test]
    fn an_infinite_view_is_sliced_to_the_farthest_light() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [64, 64]);
        let bounds = Some((Vec3::new(-1.0, -1.0, -16.0), Vec3::ONE));
        let size = "64x64x8".parse().unwrap();
        let clusters = ClustersUniform::new(size, Normals::None, &view, bounds).unwrap();
        assert_eq!(clusters.slices_per_unit, 2.0);
        assert_eq!(clusters.far_m, UNBOUNDED);
        // Lights behind the camera leave one octave.
        let behind = Some((Vec3::new(-1.0, -1.0, 2.0), Vec3::splat(9.0)));
        let clusters = ClustersUniform::new(size, Normals::None, &view, behind).unwrap();
        assert_eq!(clusters.slices_per_unit, 8.0);
    }

    #[test]
    fn slices_end_with_the_lights_where_the_far_plane_lies_behind_them() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [64, 64]);
        view.far_m = Some(1_024.0);
        let size = "64x64x8".parse().unwrap();
        let per_octave = |view: &View, bounds| {
            ClustersUniform::new(size, Normals::None, view, Some(bounds)).unwrap().slices_per_unit
        };
        // Four octaves to the farthest light, as without a far plane.
        let bounds = (Vec3::new(-1.0, -1.0, -16.0), Vec3::ONE);
        assert_eq!(per_octave(&view, bounds), 2.0);
        assert_eq!(per_octave(&View { far_m: None, ..view }, bounds), 2.0);
        // The far plane is nearer than the lights end: two octaves.
        assert_eq!(per_octave(&View { far_m: Some(4.0), ..view }, bounds), 4.0);
        // The last slice goes on to the far plane.
        let clusters = ClustersUniform::new(size, Normals::None, &view, Some(bounds)).unwrap();
        assert!((1_023.0..1_025.0).contains(&clusters.far_m), "{clusters:?}");
    }

    #[test]
    fn the_last_slice_ends_where_shading_rebuilds_the_far_plane() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.001, [64, 64]);
        view.far_m = Some(1_000.0);
        view.depth = assign::DepthMapping::Standard;
        let size = "64x64x8".parse().unwrap();
        let clusters = ClustersUniform::new(size, Normals::None, &view, None).unwrap();
        assert!((1_048.5..1_049.0).contains(&clusters.far_m), "{clusters:?}");
        // Too far for f32 to tell from infinity.
        view.far_m = Some(1e6);
        let clusters = ClustersUniform::new(size, Normals::None, &view, None).unwrap();
        assert_eq!(clusters.far_m, UNBOUNDED);
    }

    #[test]
    fn too_many_clusters_are_refused() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [16_384, 16_384]);
        let groups = |size: &str, normals| {
            ClustersUniform::new(size.parse().unwrap(), normals, &view, None)
                .map(|clusters| clusters.group_count())
        };
        assert!(groups("1x1x1", Normals::None).is_err());
        assert_eq!(groups("16x16x8", Normals::None).unwrap(), 1 << 23);
        let error = groups("16x16x8", Normals::Bins(6)).unwrap_err().to_string();
        assert!(error.contains("8388608 clusters of 6 bins, 50331648 groups"), "{error}");
        assert_eq!(groups("128x128x8", Normals::Bins(54)).unwrap(), 54 << 17);
    }
}
