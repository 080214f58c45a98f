//! Cuts a box into cells.

use std::{fmt, str::FromStr};

use assign::AssignError;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Cells along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellCounts(pub [u32; 3]);

/// The WESL module of G: `group_of` and `group_bounds`.
pub const GRID_WESL: &str = include_str!("shaders/grid.wesl");

/// The most cells. Their records take 128 MiB.
const MAX_CELLS: u64 = 1 << 24;

impl CellCounts {
    /// Checks each field.
    pub fn check(&self) -> Result<(), AssignError> {
        let fail = |value: String, accepted: String| {
            Err(AssignError::Parameter { field: "cell count".into(), value, accepted })
        };
        if let Some(value) = self.0.iter().find(|n| !(1..=1024).contains(*n)) {
            return fail(value.to_string(), "1 to 1024 along each axis".into());
        }
        let total = self.0.iter().map(|&n| u64::from(n)).product::<u64>();
        if total > MAX_CELLS {
            return fail(format!("{self}: {total} cells"), format!("at most {MAX_CELLS} cells"));
        }
        Ok(())
    }
}

impl fmt::Display for CellCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.0[0], self.0[1], self.0[2])
    }
}

impl FromStr for CellCounts {
    type Err = AssignError;

    /// Reads `XxYxZ`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let fail = || AssignError::Parameter {
            field: "cell count".into(),
            value: text.into(),
            accepted: "XxYxZ, cells along each axis, such as 20x20x20".into(),
        };
        let numbers: Vec<u32> = text
            .split('x')
            .map(|part| part.parse().map_err(|_| fail()))
            .collect::<Result<_, _>>()?;
        let [x, y, z] = numbers[..] else {
            return Err(fail());
        };
        let counts = Self([x, y, z]);
        counts.check()?;
        Ok(counts)
    }
}

/// The cells as shaders read them: `struct Cells` of `grid.wesl`. 112 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CellsUniform {
    /// Lowest corner of the first cell, world space, metres.
    pub min_world: [f32; 3],
    /// How much a cell's box extends beyond the cell on each side, metres.
    pub slack_m: f32,
    /// Size of a cell, metres, above 0.
    pub cell_m: [f32; 3],
    /// Pads to 32 bytes.
    pub padding: f32,
    /// Cells along each axis.
    pub counts: [u32; 3],
    /// Pads to 48 bytes.
    pub padding_2: u32,
    /// Lowest corner of the box around all lights' supports, world space, metres. No light reaches a
    /// sample outside it, so any cell serves such a sample.
    pub lights_min: [f32; 3],
    /// Pads to 64 bytes.
    pub padding_3: f32,
    /// Highest corner of the box around all lights' supports.
    pub lights_max: [f32; 3],
    /// Pads to 80 bytes.
    pub padding_4: f32,
    /// Lowest corner of the box that the cells serve, world space, metres. Cells at the border extend to
    /// it. A sample that lights may reach outside this box reads all lights.
    pub reach_min: [f32; 3],
    /// Pads to 96 bytes.
    pub padding_5: f32,
    /// Highest corner of the box that the cells serve.
    pub reach_max: [f32; 3],
    /// Pads to 112 bytes.
    pub padding_6: f32,
}

/// Bound of the rounding of a sample's place among the cells, as a share of the largest coordinate
/// involved. A division is accurate to 2.5 units in the last place. Four operations round to half a
/// unit: the difference before the division, and the product and two sums of a cell's bounds. The
/// bound leaves room.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// The smallest cell, as a share of the largest coordinate. f32 cannot distinguish smaller cells.
const LEAST_CELL: f32 = 32.0 * f32::EPSILON;

impl CellsUniform {
    /// Cuts the box `cut` into cells. `lights` is the box around all lights' supports, `None`
    /// without lights. An axis along which the box has no extent gets one cell, because only the
    /// first and the last of several cells would hold samples. Cells at the border extend to the end of
    /// `lights`, so every sample has a cell.
    ///
    /// `cells_of_box` of `visible.wesl` computes the same on the GPU.
    pub fn new(counts: CellCounts, cut: (Vec3, Vec3), lights: Option<(Vec3, Vec3)>) -> Self {
        let finite = |v: Vec3| v.clamp(Vec3::splat(-1e30), Vec3::splat(1e30));
        let (min, max) = (finite(cut.0.min(cut.1)), finite(cut.1.max(cut.0)));
        let lights = lights.unwrap_or((min, max));
        let magnitude = min.abs().max(max.abs()).max_element().max(f32::MIN_POSITIVE / LEAST_CELL);
        let least = magnitude * LEAST_CELL;
        let size = max - min;
        let counts = [0, 1, 2].map(|axis| if size[axis] < least { 1 } else { counts.0[axis] });
        let parts = Vec3::from_array(counts.map(|n| n as f32));
        let cell = (size / parts).max(Vec3::splat(least));
        Self {
            min_world: min.to_array(),
            slack_m: (magnitude + size.max_element()) * ROUNDING,
            cell_m: cell.to_array(),
            padding: 0.0,
            counts,
            padding_2: 0,
            lights_min: finite(lights.0).to_array(),
            padding_3: 0.0,
            lights_max: finite(lights.1).to_array(),
            padding_4: 0.0,
            reach_min: finite(lights.0).to_array(),
            padding_5: 0.0,
            reach_max: finite(lights.1).to_array(),
            padding_6: 0.0,
        }
    }

    /// The same cells, which extend no further than the box `within`. `slack_m` bounds how far rounding
    /// moves a sample, metres: `within` and the box of the lights are widened by it.
    #[must_use]
    pub fn within(self, within: (Vec3, Vec3), slack_m: f32) -> Self {
        let lights_min = Vec3::from_array(self.lights_min) - slack_m;
        let lights_max = Vec3::from_array(self.lights_max) + slack_m;
        Self {
            lights_min: lights_min.to_array(),
            lights_max: lights_max.to_array(),
            reach_min: lights_min.max(within.0 - slack_m).to_array(),
            reach_max: lights_max.min(within.1 + slack_m).to_array(),
            ..self
        }
    }

    /// Number of cells.
    pub fn group_count(&self) -> u32 {
        self.counts.iter().product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_parse_and_print_alike() {
        let counts: CellCounts = "40x10x20".parse().unwrap();
        assert_eq!(counts.to_string(), "40x10x20");
        for bad in ["", "20", "0x1x1", "1025x1x1", "1024x1024x1024", "axbxc", "1x1x1x1"] {
            let error = bad.parse::<CellCounts>().unwrap_err().to_string();
            assert!(error.contains("must be"), "{bad}: {error}");
        }
    }

    #[test]
    fn any_box_has_cells() {
        let counts = CellCounts([4, 2, 1]);
        let inf = Vec3::INFINITY;
        for (min, max) in [
            (Vec3::ZERO, Vec3::ZERO),
            (Vec3::splat(1e6), Vec3::splat(1e6)),
            (-inf, inf),
            (Vec3::ONE, Vec3::NEG_ONE),
            (Vec3::splat(-1e9), Vec3::splat(1e9)),
        ] {
            let cells = CellsUniform::new(counts, (min, max), None);
            assert!(cells.cell_m.iter().all(|m| m.is_finite() && *m > 0.0), "{cells:?}");
            assert!(cells.slack_m.is_finite(), "{cells:?}");
        }
        let cells = CellsUniform::new(counts, (Vec3::ZERO, Vec3::splat(8.0)), None);
        assert_eq!(cells.cell_m, [2.0, 4.0, 8.0]);
        assert_eq!(cells.group_count(), 8);
    }

    /// Lamps on one ceiling: the box around their positions has no height.
    #[test]
    fn an_axis_without_extent_has_one_cell() {
        let counts = CellCounts([20, 20, 20]);
        let (min, max) = (Vec3::new(0.0, 2.0, 0.0), Vec3::new(8.0, 2.0, 4.0));
        let reach = Vec3::splat(3.0);
        let flat = CellsUniform::new(counts, (min, max), Some((min - reach, max + reach)));
        assert_eq!((flat.counts, flat.group_count()), ([20, 1, 20], 400));
        // Its one layer extends as far down and up as the lamps reach.
        assert_eq!((flat.lights_min[1], flat.lights_max[1]), (-1.0, 5.0));
        let top = max + Vec3::Y * 0.01;
        let thin = CellsUniform::new(counts, (min, top), Some((min - reach, top + reach)));
        assert_eq!(thin.counts, [20; 3]);
    }

    #[test]
    fn cells_end_where_they_are_told_to() {
        let lights = Some((Vec3::ZERO, Vec3::splat(8.0)));
        let cut = (Vec3::ZERO, Vec3::splat(4.0));
        let all = CellsUniform::new(CellCounts([4; 3]), cut, lights);
        assert_eq!((all.reach_min, all.reach_max), ([0.0; 3], [8.0; 3]));
        let some = all.within((Vec3::splat(-9.0), Vec3::splat(4.0)), 0.5);
        assert_eq!((some.reach_min, some.reach_max), ([-0.5; 3], [4.5; 3]));
        assert_eq!((some.lights_min, some.lights_max), ([-0.5; 3], [8.5; 3]));
        assert_eq!((some.cell_m, some.counts), (all.cell_m, all.counts));
    }
}
