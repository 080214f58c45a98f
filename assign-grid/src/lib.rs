//! Grid light assignment: a box in world space cut into cells.
//!
//! # Idea
//!
//! Cells stand still in the world, whatever the camera does (Enhuber 2019, section 3.3). A view
//! sample belongs to the cell it lies in.
//!
//! | id | box that is cut into cells |
//! |---|---|
//! | `G` | around the lights' positions, as in the paper |
//! | `G/…/supports` | around the lights' supports: larger by a range on each side |
//! | `G/…/surfaces` | around the lights' supports, cut to the box around the scene's surfaces |
//!
//! A sample outside the box belongs to the nearest cell. Cells at the border therefore reach outwards
//! to the end of the lights' supports. A point light's centre lies in the box of the positions, so this
//! adds no light to their lists: the cells are exactly the paper's.
//!
//! # Phases
//!
//! 1. `cull`: one workgroup per cell tests lights against the cell's box, which is exact for point
//!    lights, and writes its list. Nothing else: neither depth nor view is read.
//!
//! # Cost
//!
//! `cull` grows with cells times lights, and with neither pixels nor view. Memory is 8 bytes a
//! cell and 4 bytes a listed light.
//!
//! Figures, ms, of 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`): G/20x20x20/supports
//! takes 0.171 to assign and 0.257 to shade lists of 49.8 lights a sample; through the hierarchy it
//! takes 0.046 to assign. Its box has 3.1 times the volume of that of the positions.
//!
//! # Where it fails
//!
//! Cells that nobody sees are culled as well. Cells are as large far away as they are near, so a
//! large scene has either cells that hold hundreds of lights before the camera's nose, or millions
//! of cells. One light far away makes all cells large, and so does one light of great range where the
//! box is that of the supports: take the box of the surfaces. Lights that all lie near one plane, such
//! as the lamps of a ceiling, make a flat box of positions: nearly all samples lie outside it, in the
//! first and the last layer, and the layers between hold almost none (`G/.../supports` cuts a box of some
//! height). Where the box has no height at all, `G` makes one layer. The best count of cells is another for
//! each scene.

mod cells;
mod grid;

pub use cells::{CellCounts, CellsUniform};
pub use grid::{GRID_WESL, Grid, GridBox};
