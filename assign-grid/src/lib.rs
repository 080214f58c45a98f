//! Grid light assignment: a box in world space cut into cells.
//!
//! # Idea
//!
//! Cells are fixed in the world, whatever the camera does (Enhuber 2019, section 3.3). A view
//! sample belongs to the cell that contains it.
//!
//! | id | box that is cut into cells |
//! |---|---|
//! | `G` | around the lights' positions, as in the paper |
//! | `G/…/supports` | around the lights' supports: larger by a range on each side |
//! | `G/…/surfaces` | around the lights' supports, cut to the box around the scene's surfaces |
//!
//! A sample outside the box belongs to the nearest cell. So cells at the border extend outwards to
//! the end of the lights' supports. With the box of the positions this adds no point light to any
//! list, because every light's centre lies in the box. These cells are exactly the paper's.
//!
//! # Phases
//!
//! 1. `cull`: one workgroup per cell tests lights against the cell's box and writes the cell's
//!    list. The test is exact for point lights. The pass reads neither depth nor view.
//!
//! # Cost
//!
//! `cull` grows with cells times lights. Pixels and view do not matter. Memory is 8 bytes per cell
//! and 4 bytes per listed light.
//!
//! Times in ms for 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`):
//! G/20x20x20/supports takes 0.171 to assign and 0.257 to shade, with lists of 49.8 lights per
//! sample. Through the hierarchy it takes 0.046 to assign. The box of the supports has 3.1 times
//! the volume of the box of the positions.
//!
//! # Where it fails
//!
//! - Cells that no sample lies in are culled as well.
//! - Distant cells are as large as near ones. So a large scene has either millions of cells, or
//!   cells right before the camera that hold hundreds of lights.
//! - One distant light makes all cells large. With the box of the supports, so does one light of
//!   great range; use the box of the surfaces then.
//! - If all lights lie near one plane, such as lamps on a ceiling, the box of the positions is
//!   flat. Nearly all samples lie outside it, in the first or the last layer, and the layers
//!   between hold almost none. `G/.../supports` cuts a box of some height. If the box has no height
//!   at all, `G` makes one layer.
//! - The best number of cells differs from scene to scene.

mod cells;
mod grid;

pub use cells::{CellCounts, CellsUniform};
pub use grid::{GRID_WESL, Grid, GridBox};
