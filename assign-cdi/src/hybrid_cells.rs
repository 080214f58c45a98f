//! How the view is cut into the cells of the hybrid-lighting grid.

use std::{fmt, str::FromStr};

use assign::{AssignError, Projection, View};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// The size of cells: pixels of a tile, and the number of depth slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellSize {
    /// Width and height of a tile, pixels.
    pub tile_px: [u32; 2],
    /// Depth slices.
    pub slices: u32,
}

/// More cells than this are refused: their records alone would take 128 MiB.
const MAX_CELLS: u64 = 1 << 24;

/// Most rounds of loops over tiles and slices that a lane takes for one light, about.
const ROUNDS: u32 = 4096;

/// Lanes that share a light: `LANES` of `hybrid_scatter.wesl`.
const LANES: u32 = 32;

impl CellSize {
    /// Checks each field.
    pub fn check(&self) -> Result<(), AssignError> {
        let fail = |field: &str, value: u32, accepted: &str| {
            Err(AssignError::Parameter {
                field: format!("cell {field}"),
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

impl fmt::Display for CellSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.tile_px[0], self.tile_px[1], self.slices)
    }
}

impl FromStr for CellSize {
    type Err = AssignError;

    /// Reads `WIDTHxHEIGHTxSLICES`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let fail = || AssignError::Parameter {
            field: "cell size".into(),
            value: text.into(),
            accepted: "WIDTHxHEIGHTxSLICES, tile pixels and slice count, such as 48x48x40".into(),
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

/// What the shaders know of the cells: `struct Cells` of `hybrid_cells.wesl`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CellsUniform {
    /// Cells along x, y and depth.
    pub counts: [u32; 3],
    /// Slices per octave of depth (exponential) or per metre (even).
    pub slices_per_unit: f32,
    /// Pixels of a tile.
    pub tile_px: [u32; 2],
    /// Upper left pixel of the viewport.
    pub origin_px: [u32; 2],
    /// View depth at which slice 0 begins, metres.
    pub first_m: f32,
    /// Least view depth of a sample, metres: the near plane, as shading rebuilds it.
    pub near_m: f32,
    /// 1 where slices grow exponentially.
    pub exponential: u32,
    /// 1 where lists are made for the surfaces in the depth buffer alone.
    pub surfaces_only: u32,
    /// Words of a tile's mask, which has a bit a slice.
    pub mask_words: u32,
    /// Tiles of a light's outline that one group of lanes takes.
    pub tiles_per_part: u32,
    /// Pads to 64 bytes.
    pub padding: [u32; 2],
}

impl CellsUniform {
    /// Cuts `view` into cells.
    ///
    /// Slices run from the near to the far plane, exponentially in a perspective view, evenly in an
    /// orthographic one. In a perspective view they end at the farthest point that a light reaches
    /// (`light_bounds`) where the far plane lies behind it, and the last slice goes on to the far
    /// plane or to infinity ([`View::slices_end_m`]).
    pub fn new(
        size: CellSize,
        view: &View,
        light_bounds: Option<(Vec3, Vec3)>,
    ) -> Result<Self, AssignError> {
        let [width, height] = [view.viewport.width, view.viewport.height];
        let counts =
            [width.div_ceil(size.tile_px[0]), height.div_ceil(size.tile_px[1]), size.slices];
        let total = counts.iter().map(|&n| u64::from(n)).product::<u64>();
        if total > MAX_CELLS {
            return Err(AssignError::Parameter {
                field: "cell size".into(),
                value: format!("{size} at {width}x{height}: {total} cells"),
                accepted: format!("at most {MAX_CELLS} cells: larger tiles or fewer slices"),
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
            exponential: u32::from(exponential),
            surfaces_only: 1,
            mask_words: size.slices.div_ceil(32),
            tiles_per_part: LANES * (ROUNDS / size.slices),
            padding: [0; 2],
        })
    }

    /// Number of cells.
    pub fn cell_count(&self) -> u32 {
        self.counts.iter().product()
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> u32 {
        self.counts[0] * self.counts[1]
    }

    /// Groups of lanes that share the tiles of a light, 1 to 129: so many that none of them loops for
    /// long.
    pub fn part_count(&self) -> u32 {
        self.tile_count().div_ceil(self.tiles_per_part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_parse_and_print_alike() {
        let size: CellSize = "64x32x24".parse().unwrap();
        assert_eq!(size.to_string(), "64x32x24");
        for bad in ["", "64", "64x64", "0x64x24", "64x64x0", "64x64x1025", "axbxc", "64x64x24x2"] {
            let error = bad.parse::<CellSize>().unwrap_err().to_string();
            assert!(error.contains("must be"), "{bad}: {error}");
        }
    }

    #[test]
    fn slices_span_near_to_far() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [130, 64]);
        view.far_m = Some(512.0);
        let cells = CellsUniform::new("64x64x20".parse().unwrap(), &view, None).unwrap();
        assert_eq!(cells.counts, [3, 1, 20]);
        // Ten octaves, two slices each.
        assert_eq!(cells.slices_per_unit, 2.0);
        assert_eq!((cells.cell_count(), cells.part_count(), cells.mask_words), (60, 1, 1));
    }

    #[test]
    fn an_infinite_view_is_sliced_to_the_farthest_light() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [64, 64]);
        let size = "64x64x8".parse().unwrap();
        let bounds = Some((Vec3::new(-1.0, -1.0, -16.0), Vec3::ONE));
        assert_eq!(CellsUniform::new(size, &view, bounds).unwrap().slices_per_unit, 2.0);
        // Lights behind the camera leave one octave.
        let behind = Some((Vec3::new(-1.0, -1.0, 2.0), Vec3::splat(9.0)));
        assert_eq!(CellsUniform::new(size, &view, behind).unwrap().slices_per_unit, 8.0);
        // A far plane behind all lights takes no slices from them.
        let bounded = View { far_m: Some(1_024.0), ..view };
        assert_eq!(CellsUniform::new(size, &bounded, bounds).unwrap().slices_per_unit, 2.0);
    }

    #[test]
    fn no_lane_loops_for_long() {
        for (size, target) in [("1x1x1", 4096), ("1x1x1024", 128), ("48x48x40", 8192)] {
            let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [target; 2]);
            let cells = CellsUniform::new(size.parse().unwrap(), &view, None).unwrap();
            assert!(cells.part_count() <= 129, "{size}: {} parts", cells.part_count());
            assert!(cells.tiles_per_part / LANES * cells.counts[2] <= ROUNDS, "{size}");
        }
    }

    #[test]
    fn too_many_cells_are_refused() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 1.0, [16_384, 16_384]);
        let cells = |size: &str| {
            CellsUniform::new(size.parse().unwrap(), &view, None).map(|cells| cells.cell_count())
        };
        assert_eq!(cells("16x16x16").unwrap(), 1 << 24);
        let error = cells("16x16x17").unwrap_err().to_string();
        assert!(error.contains("16x16x17 at 16384x16384: 17825792 cells"), "{error}");
    }
}
