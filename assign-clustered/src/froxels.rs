//! The froxel grid: screen tiles cut into depth slices. Clusters and hybrid lighting share it.

use std::{fmt, str::FromStr};

use assign::{AssignError, FIRST_STRATEGY_BINDING, Frame, Projection, View, intersect::UNBOUNDED};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::Slices;

/// The size of froxels: pixels of a tile, and the number of depth slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FroxelSize {
    /// Width and height of a tile, pixels.
    pub tile_px: [u32; 2],
    /// Depth slices.
    pub slices: u32,
}

/// Binding of the grid's uniform: `froxels.wesl`.
pub(crate) const FROXELS_BINDING: u32 = FIRST_STRATEGY_BINDING;

/// The most groups of a strategy. Their records alone would take 128 MiB.
pub(crate) const MAX_GROUPS: u64 = 1 << 24;

impl FroxelSize {
    /// Checks each field.
    pub fn check(&self) -> Result<(), AssignError> {
        let fail = |field: &str, value: u32, accepted: &str| {
            Err(AssignError::Parameter {
                field: format!("froxel {field}"),
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

impl fmt::Display for FroxelSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.tile_px[0], self.tile_px[1], self.slices)
    }
}

impl FromStr for FroxelSize {
    type Err = AssignError;

    /// Reads `WIDTHxHEIGHTxSLICES`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let fail = || AssignError::Parameter {
            field: "froxel size".into(),
            value: text.into(),
            accepted:
                "WIDTHxHEIGHTxSLICES, the pixels of a tile and the number of depth slices, such as \
                       64x64x40"
                    .into(),
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

/// Slices end at most this many times farther away than they begin: 40 octaves. The last slice takes the
/// rest. `DEPTH_SLACK` of `froxels.wesl` is derived for no more.
const MAX_DEPTH_RATIO: f32 = (1_u64 << 40) as f32;

/// The grid as shaders read it: `struct Froxels` of `froxels.wesl`. 128 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FroxelsUniform {
    /// Froxels along x, y and depth.
    pub counts: [u32; 3],
    /// Slices per octave of depth (exponential) or per metre (even).
    pub slices_per_unit: f32,
    /// Width and height of a tile, pixels.
    pub tile_px: [u32; 2],
    /// Upper left pixel of the viewport.
    pub origin_px: [u32; 2],
    /// View depth at which the regular slices begin, metres.
    pub first_m: f32,
    /// Least view depth of a sample, metres: the near plane, as shading rebuilds it.
    pub near_m: f32,
    /// Greatest view depth of a sample, metres: the far plane, as shading rebuilds it, or [`UNBOUNDED`].
    pub far_m: f32,
    /// 1: slices grow exponentially with depth. 0: all are equally deep.
    pub exponential: u32,
    /// 1: lists serve only the surfaces in the depth buffer. 0: lists serve any depth.
    pub surfaces_only: u32,
    /// Slices before the one that begins at `first_m`: 1 if the first slice is of its own depth, else 0.
    pub own_slices: f32,
    /// Cascades in use; 0 if all tiles have one size.
    pub cascade_count: u32,
    /// Out to how many of its ranges a light is listed for its specular term, at most.
    pub specular_reach: f32,
    /// Of each cascade, near to far: its first cluster, its tiles along x and y, its first slice. Those not in use
    /// begin after the last cluster and the last slice.
    pub cascades: [[u32; 4]; Slices::MAX_CASCADES as usize],
}

impl FroxelsUniform {
    /// Cuts `view` into froxels; lists serve any depth.
    ///
    /// Slices run from the near to the far plane. In a perspective view they grow with depth as `slices` says; in an
    /// orthographic view they are equally deep. A first slice of its own depth must end between the near plane and
    /// half the depth at which slices end, and must not be the only one, or slices are exponential.
    ///
    /// If the far plane of a perspective view lies beyond every light, slices end at the farthest point that a
    /// light reaches, which is a corner of `light_bounds`. The last slice then continues to the far plane or
    /// to infinity ([`View::slices_end_m`]).
    pub fn new(
        size: FroxelSize,
        slices: Slices,
        view: &View,
        light_bounds: Option<(Vec3, Vec3)>,
    ) -> Result<Self, AssignError> {
        let [width, height] = [view.viewport.width, view.viewport.height];
        let counts =
            [width.div_ceil(size.tile_px[0]), height.div_ceil(size.tile_px[1]), size.slices];
        let (cascade_count, cascades, total) = cut_cascades(counts, slices);
        if total > MAX_GROUPS {
            return Err(AssignError::Parameter {
                field: "froxel size".into(),
                value: format!("{size} at {width}x{height} pixels, {total} froxels"),
                accepted: format!("at most {MAX_GROUPS} froxels: use larger tiles or fewer slices"),
            });
        }
        let near = view.near_m;
        let perspective = matches!(view.projection, Projection::Perspective { .. });
        let last = match (perspective, view.far_m) {
            (false, Some(far)) => far,
            _ => view.slices_end_m(light_bounds).min(near * MAX_DEPTH_RATIO),
        };
        let exponential = perspective && slices != Slices::Even;
        let (first_m, own) = match slices {
            // The others need an octave at least, as `View::slices_end_m` leaves: samples must not meet all slices.
            Slices::Near(end_m)
                if exponential && size.slices > 1 && end_m > near && 2.0 * end_m <= last =>
            {
                (end_m, 1)
            }
            _ => (near, 0),
        };
        let span = if exponential { (last / first_m).log2() } else { last - first_m };
        Ok(Self {
            counts,
            slices_per_unit: (size.slices - own) as f32 / span,
            tile_px: size.tile_px,
            origin_px: [view.viewport.x, view.viewport.y],
            first_m,
            near_m: view.nearest_rebuilt_m(),
            far_m: view.farthest_rebuilt_m().unwrap_or(UNBOUNDED),
            exponential: u32::from(exponential),
            surfaces_only: 0,
            own_slices: own as f32,
            cascade_count,
            specular_reach: 1.0,
            cascades,
        })
    }

    /// Extends the ends of the view to all samples of a frame. `strategy` is the strategy's id.
    ///
    /// # Errors
    ///
    /// Those of [`Frame::extends_past_planes`].
    pub(crate) fn serve(&mut self, frame: &Frame<'_>, strategy: &str) -> Result<(), AssignError> {
        if frame.extends_past_planes(strategy)? {
            (self.near_m, self.far_m) = (0.0, UNBOUNDED);
        }
        Ok(())
    }

    /// Number of froxels.
    pub fn froxel_count(&self) -> u32 {
        let end = |[first, x, y, first_slice]: [u32; 4], end_slice: u32| {
            first + x * y * (end_slice - first_slice)
        };
        match self.cascade_count as usize {
            0 => self.counts.iter().product(),
            count => end(self.cascades[count - 1], self.counts[2]),
        }
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> u32 {
        self.counts[0] * self.counts[1]
    }
}

/// The number of cascades, where each begins, and the number of froxels. `counts` are those of the grid.
fn cut_cascades(counts: [u32; 3], slices: Slices) -> (u32, [[u32; 4]; 4], u64) {
    let [x, y, slice_count] = counts;
    let Slices::Cascaded(count) = slices else {
        let total = counts.iter().map(|&n| u64::from(n)).product();
        return (0, [[u32::MAX, 1, 1, u32::MAX]; 4], total);
    };
    let mut cascades = [[u32::MAX, 1, 1, u32::MAX]; 4];
    let mut total = 0_u64;
    let first_slice = |cascade: u32| slice_count * cascade / count;
    for (cascade, known) in (0..count).zip(&mut cascades) {
        let tiles = [x, y].map(|tiles| tiles.div_ceil(1 << (count - 1 - cascade)));
        *known = [total.min(u32::MAX.into()) as u32, tiles[0], tiles[1], first_slice(cascade)];
        let slices = first_slice(cascade + 1) - first_slice(cascade);
        total += u64::from(tiles[0]) * u64::from(tiles[1]) * u64::from(slices);
    }
    (count, cascades, total)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXPONENTIAL: Slices = Slices::Exponential;

    #[test]
    fn sizes_print_as_they_parse() {
        let size: FroxelSize = "64x32x24".parse().unwrap();
        assert_eq!(size.to_string(), "64x32x24");
        for bad in ["", "64", "64x64", "0x64x24", "64x64x0", "64x64x1025", "axbxc", "64x64x24x2"] {
            let error = bad.parse::<FroxelSize>().unwrap_err().to_string();
            assert!(error.contains("must be"), "{bad}: {error}");
        }
    }

    #[test]
    fn slices_span_near_to_far() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [130, 64]);
        view.far_m = Some(512.0);
        let size = "64x64x20".parse().unwrap();
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, None).unwrap();
        assert_eq!(froxels.counts, [3, 1, 20]);
        // Ten octaves, two slices each.
        assert_eq!(froxels.slices_per_unit, 2.0);
    }

    #[test]
    fn a_first_slice_of_its_own_depth_leaves_the_others_to_the_rest() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [64, 64]);
        view.far_m = Some(64.0);
        let size = "64x64x9".parse().unwrap();
        let cut = |slices| FroxelsUniform::new(size, slices, &view, None).unwrap();
        // Four octaves, two slices each.
        let near = cut(Slices::Near(4.0));
        assert_eq!((near.first_m, near.slices_per_unit, near.own_slices), (4.0, 2.0, 1.0));
        let even = cut(Slices::Even);
        assert_eq!((even.exponential, even.own_slices), (0, 0.0));
        assert_eq!(even.slices_per_unit, 9.0 / 63.5);
        // It would end before the near plane, or leave less than an octave to the others.
        assert_eq!(cut(Slices::Near(32.0)).own_slices, 1.0);
        for outside in [0.4, 32.1, 64.0] {
            assert_eq!(cut(Slices::Near(outside)), cut(EXPONENTIAL));
        }
    }

    #[test]
    fn an_infinite_view_is_sliced_to_the_farthest_light() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [64, 64]);
        let bounds = Some((Vec3::new(-1.0, -1.0, -16.0), Vec3::ONE));
        let size = "64x64x8".parse().unwrap();
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, bounds).unwrap();
        assert_eq!(froxels.slices_per_unit, 2.0);
        assert_eq!(froxels.far_m, UNBOUNDED);
        // With all lights behind the camera, slices span one octave.
        let behind = Some((Vec3::new(-1.0, -1.0, 2.0), Vec3::splat(9.0)));
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, behind).unwrap();
        assert_eq!(froxels.slices_per_unit, 8.0);
    }

    #[test]
    fn slices_end_with_the_lights_if_the_far_plane_lies_beyond_them() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [64, 64]);
        view.far_m = Some(1_024.0);
        let size = "64x64x8".parse().unwrap();
        let per_octave = |view: &View, bounds| {
            FroxelsUniform::new(size, EXPONENTIAL, view, Some(bounds)).unwrap().slices_per_unit
        };
        // Four octaves to the farthest light, as without a far plane.
        let bounds = (Vec3::new(-1.0, -1.0, -16.0), Vec3::ONE);
        assert_eq!(per_octave(&view, bounds), 2.0);
        assert_eq!(per_octave(&View { far_m: None, ..view }, bounds), 2.0);
        // The far plane is nearer than the farthest light: two octaves.
        assert_eq!(per_octave(&View { far_m: Some(4.0), ..view }, bounds), 4.0);
        // The last slice continues to the far plane.
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, Some(bounds)).unwrap();
        assert!((1_023.0..1_025.0).contains(&froxels.far_m), "{froxels:?}");
    }

    #[test]
    fn the_last_slice_ends_where_shading_rebuilds_the_far_plane() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.001, [64, 64]);
        view.far_m = Some(1_000.0);
        view.depth = assign::DepthMapping::Standard;
        let size = "64x64x8".parse().unwrap();
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, None).unwrap();
        assert!((1_048.5..1_049.0).contains(&froxels.far_m), "{froxels:?}");
        // f32 cannot tell this far plane from infinity.
        view.far_m = Some(1e6);
        let froxels = FroxelsUniform::new(size, EXPONENTIAL, &view, None).unwrap();
        assert_eq!(froxels.far_m, UNBOUNDED);
    }

    #[test]
    fn too_many_froxels_are_refused() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [16_384, 16_384]);
        let count = |size: &str| {
            FroxelsUniform::new(size.parse().unwrap(), EXPONENTIAL, &view, None)
                .map(|grid| grid.froxel_count())
        };
        assert_eq!(count("16x16x16").unwrap(), 1 << 24);
        let error = count("16x16x17").unwrap_err().to_string();
        assert!(error.contains("16x16x17 at 16384x16384 pixels, 17825792 froxels"), "{error}");
        assert!(count("1x1x1").is_err());
    }
}
