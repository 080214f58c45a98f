//! Tiled light assignment: tiles of pixels, each with one list of lights, or with two.
//!
//! # Idea
//!
//! A tile is a rectangle of pixels; every view sample lies in exactly one (Olsson and Assarsson
//! 2011; Enhuber 2019, section 3.1).
//!
//! | id | bounds of a tile |
//! |---|---|
//! | `T-I` | its whole frustum, from the near to the far plane (implicit) |
//! | `T-E` | its frustum between the nearest and the farthest sample in it (explicit) |
//! | `T-E1` | the same, found by the pass that culls |
//! | `HalfZ` | as T-E, cut in the middle: two groups (Thomas 2015) |
//! | `ModifiedHalfZ` | both halves, each shrunk to the samples in it (Thomas 2015) |
//! | `T-25D` | as T-E, without those of 32 depth slices that hold no sample (Harada 2012, "2.5D culling") |
//!
//! # Phases
//!
//! 1. `bounds` (all but T-I and T-E1) gives each tile one workgroup, which reads the tile's depths and reduces them to a
//!    range in workgroup memory. It needs no global atomics. A tile without samples gets an empty range.
//!    ModifiedHalfZ and T-25D read the depths a second time, once the range is known.
//!    In T-E1, the workgroup that culls the tile does the same before it culls (Andersson 2009).
//! 2. `cull` gives each group one workgroup, which tests lights against its frustum and writes its list.
//!
//! # Cost
//!
//! `cull` grows with tiles times lights, `bounds` with pixels. Memory per tile is 8 bytes for T-I and T-E1, 16 for T-E, 20
//! for T-25D and 32 for both halves, and 4 bytes per listed light: the least of all strategies in screen space.
//!
//! Measured for 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25; `results/h200-all/sponza-1.6.json`,
//! whose command is in `results/README.md`):
//!
//! | strategy | assign, ms | shade, ms | lights listed per sample |
//! |---|---|---|---|
//! | T-I/28x28 | 0.114 | 0.622 | 141 |
//! | T-E/28x28 | 0.126 | 0.154 | 22.4 |
//!
//! # Where it fails
//!
//! - T-E lists every light between the nearest and the farthest sample of a tile. At a depth discontinuity, such
//!   as a fence in front of a far wall, these include all lights in the gap between, which reach no sample. T-I
//!   also lists the lights beyond the wall.
//! - HalfZ and ModifiedHalfZ help at such a discontinuity: a sample reads only the lights of its own half, and
//!   ModifiedHalfZ leaves the gap out. They gain nothing where a tile shows one surface, and little where it
//!   shows three. Here each half has a workgroup of its own, which tests all lights. The talk's sample code
//!   tests a light's sides once for both halves, so its culling costs less than ours.
//! - T-25D leaves out lights in any number of gaps, but the samples of a tile still share one list, which holds
//!   the lights of all its surfaces. A slice is a 32nd of the range of depths: where a near fence stands before
//!   a far wall, slices are long.
//! - T-E1 saves a pass, but cannot make only some lists again (`/touched`), because it finds the bounds of all tiles
//!   each time.
//! - Smaller tiles do not help at a discontinuity. The longest lists are at silhouettes, where tiles of any size see both
//!   depths.
//!
//! T-I serves look-ups at any depth. The others serve opaque surfaces and, if the renderer asks for it, what lies in
//! front of them: transparent surfaces and particles. Their tiles then begin at the near plane, and end where they
//! end otherwise. They refuse look-ups at any depth, such as those of fog. All but T-E1 also serve fragments of several
//! samples per pixel: a look-up outside its tile's range reads all lights. No buffer keeps the ranges of T-E1, so it
//! serves only look-ups that lie inside them.

mod tile_bounds;
mod tile_wesl;
mod tiled;
mod tiles;

pub use tile_bounds::bounds_source;
pub use tile_wesl::tile_wesl;
pub use tiled::Tiled;
pub use tiles::{TileDepths, TileSize, TilesUniform};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
