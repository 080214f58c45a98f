//! Tiled light assignment: the screen cut into tiles of pixels.
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
//!
//! # Phases
//!
//! 1. `bounds` (T-E): one workgroup per tile reads the tile's depths and reduces them to a range
//!    in workgroup memory. No global atomic; a tile without samples keeps an empty range.
//! 2. `cull`: one workgroup per tile tests lights against the tile's frustum and writes its list.
//!
//! # Cost
//!
//! `cull` grows with tiles times lights, `bounds` with pixels. Memory is 8 bytes a tile (16 with
//! T-E's depth range) and 4 bytes a listed light: the least of all strategies in screen space.
//!
//! Figures, ms, of 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`): T-I/28x28 0.114
//! to assign and 0.622 to shade lists of 141 lights a sample; T-E/28x28 0.126 and 0.154 with 22.4.
//!
//! # Where it fails
//!
//! A tile's list holds every light between its nearest and its farthest sample. At a depth
//! discontinuity, a fence before a far wall, that is every light in the void between, which no
//! sample meets; T-I lists the lights behind the wall too. Small tiles do not help: the longest
//! lists are at silhouettes, where every tile size sees both depths.
//!
//! T-E serves opaque surfaces alone: look-ups at any depth are refused. T-I serves any depth.

mod tile_bounds;
mod tiled;
mod tiles;

pub use tile_bounds::bounds_source;
pub use tiled::{EXPLICIT_WESL, IMPLICIT_WESL, Tiled};
pub use tiles::{TileSize, TilesUniform, UNBOUNDED};
