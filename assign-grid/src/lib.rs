//! Light assignment to cells of the world: G, a grid, and HC, hashed cells.
//!
//! # Idea
//!
//! Cells are boxes along the world's axes. A view sample belongs to the cell that contains it, and each cell has
//! a list of the lights that reach it.
//!
//! **G** cuts a box into cells of equal size (Enhuber 2019, section 3.3).
//!
//! | id | box that is cut into cells |
//! |---|---|
//! | `G` | around the lights' positions, as in the paper |
//! | `G/…/supports` | around the lights' supports: larger by a range on each side |
//! | `G/…/surfaces` | around the lights' supports, cut to the box around the scene's surfaces |
//! | `G/…/frustum` | around the lights' supports, cut to the box around the view's frustum |
//! | `G/…/visible` | around the lights' supports, cut to the box around the visible samples |
//!
//! With the first three, cells are fixed in the world, whatever the camera does. The last two are from the
//! outlook of the same paper. They spend no cells on what the camera does not see, but their cells move with it.
//!
//! A sample outside the box belongs to the nearest cell. With the first three boxes, cells at the border extend
//! outwards to the end of the lights' supports. With the box of the positions this adds no point light to any
//! list, because every light's centre lies in the box. These cells are exactly the paper's. With the last two
//! boxes, cells end with the box, so lists at the border hold no lights from outside the view. A sample outside the
//! box reads all lights if any light may reach it. The box holds everything that the view shows, so no visible sample
//! lies outside it.
//!
//! **HC** makes cells that grow with the distance to the eye, and keeps those that hold visible samples in a hash
//! table. Hash tables of the cells of an unbounded grid are from collision detection (Teschner et al. 2003,
//! "Optimized Spatial Hashing for Collision Detection of Deformable Objects"). Cells that grow with their distance
//! to the eye are from path space filtering (Binder et al. 2018, "Fast Path Space Filtering by Jittered Spatial
//! Hashing"). Hashed shading (Tegelaers 2018, in Enhuber 2019, section 2.3) keeps lists of still lights in a linkless
//! octree of the world. HC differs from it: the visible samples fill the table in every frame, and the distance sets the
//! size of cells.
//!
//! `HC/48` has cells whose edge is at most 48 pixels and more than 24. At the distance `d` from the eye,
//!
//! ```text
//! edge = largest power of two up to max(48 p d, d / 126), in metres
//! ```
//!
//! where `p` is the size of a pixel at a distance of 1 m, in metres. In an orthographic view it is `max(48 p, d /
//! 126)`, where `p` is the size of a pixel. The second term keeps places of cells within 9 bits per axis. At
//! 1080p and a field of view of 60 degrees, it is 7.4 pixels. Cells are also wider than the rounding error of a
//! position, so rounding can move a sample into a neighbouring cell, but not across one. An edge that is a power of two makes cell borders free of rounding. The exponent of the edge
//! is the cell's *level*. Level and place, counted from the cell of the eye, make a key of 32 bits.
//!
//! # Phases
//!
//! 1. `bounds` (`G/…/visible`): finds the box around the samples in the depth buffer, then makes the cells. The CPU
//!    waits for nothing.
//! 2. `bounds` (HC): clears the table, then puts each sample's cell into it. A slot holds the whole key, so no two
//!    cells share a slot. Within rounding of a border, a sample puts the cells on both sides into the table, because
//!    shading may round it across.
//! 3. `cull`: one workgroup per cell tests lights against the cell's box and writes the cell's
//!    list. The test is exact for point lights. For HC only filled slots have a workgroup.
//!
//! Shading looks a sample's cell up in the table. If it is not there, the sample reads all lights: slow and right.
//! The table itself says for which eye it was filled. So still lights keep their lists (`/reuse4`) without loss,
//! even if the camera moves.
//!
//! # Cost
//!
//! `cull` grows with cells times lights. For G, pixels and view do not matter to it. Memory is 8 bytes per cell
//! and 4 bytes per listed light. `bounds` grows with pixels. HC has 16 bytes per slot, and 16 slots per
//! square of the screen of the cell's width, at least 4,096: 262 kB for `HC/48` at 1920x1080.
//!
//! Times in ms for 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`):
//! G/20x20x20/supports takes 0.171 to assign and 0.257 to shade, with lists of 49.8 lights per
//! sample. Through the hierarchy it takes 0.046 to assign. The box of the supports has 3.1 times
//! the volume of the box of the positions.
//!
//! Cells of HC are cubes. Clusters are as wide, but their depth is another one. Lights per sample with 500 lights in
//! the atrium at 320x180 pixels, of which 0.96 reach a sample (`lightbench compare --scene atrium --size 320x180
//! --lights 500 --strategies SC-I/16x16x40,SC-I,SC-E,HC/16,HC/48,G,G/frustum,G/visible`):
//!
//! | strategy | listed per sample |
//! |---|---|
//! | HC/16, HC/48 | 2.16, 7.02 |
//! | SC-I/16x16x40, SC-I/48x48x40 | 2.91, 7.22 |
//! | SC-E/48x48x40 | 5.60 |
//! | G/20x20x20, with `/frustum`, with `/visible` | 2.03, 2.21, 1.95 |
//!
//! # Where it fails
//!
//! G:
//!
//! - Cells that no sample lies in are culled as well.
//! - Distant cells are as large as near ones. So a large scene has either millions of cells, or
//!   cells right before the camera that hold hundreds of lights. HC has no such problem.
//! - One distant light makes all cells large. With the box of the supports, so does one light of
//!   great range; use one of the other boxes then.
//! - If all lights lie near one plane, such as lamps on a ceiling, the box of the positions is
//!   flat. Nearly all samples lie outside it, in the first or the last layer, and the layers
//!   between hold almost none. `G/.../supports` cuts a box of some height. If the box has no height
//!   at all, `G` makes one layer.
//! - The best number of cells differs from scene to scene.
//! - A frustum that looks along a diagonal of the world fills a small part of its box. And one visible sample far
//!   away makes the box of the visible samples large.
//!
//! HC:
//!
//! - A slanted surface passes through many cells, and each is culled. Use wider cells where `cull` takes longer than
//!   shading.
//! - Lists are those of whole cells. Boxes around the samples in a cluster, as in SC-E, are smaller than cells.
//! - Where levels meet, cells overlap, and both are culled.
//! - The number of visible cells is not known before the pass `bounds`. If a cell finds no free slot within 64 tries,
//!   its samples read all lights in that frame. Tries without a slot are counted ([`TableUse`]), and the table
//!   doubles a frame or two later. It also grows as soon as more than half of the slots are filled.
//! - Samples more than 2^31 times as far away as the near plane read all lights.

mod cells;
mod grid;
mod grid_box;
mod hash_table;
mod hashed;
mod surface;
mod visible;

pub use cells::{CellCounts, CellsUniform, GRID_WESL};
pub use grid::Grid;
pub use grid_box::GridBox;
pub use hash_table::{HASHED_WESL, HashCellsUniform, TableUse, fill_source};
pub use hashed::HashedCells;
pub use visible::{AskedCells, visible_source};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
