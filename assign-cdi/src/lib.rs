//! Compound deep images: how far a virtual point light reaches, by rays cast through lists of
//! depths; and a grid of light lists for the many small lights that come of it.
//!
//! # Idea
//!
//! A deep image keeps all depths of a pixel, not the nearest alone. A compound deep image is one for
//! each of many directions over the hemisphere (Archer, Leach, Knowles 2019): a ray through the scene
//! is then the list of one pixel.

mod hybrid_cells;
mod hybrid_grid;
mod hybrid_passes;
mod kernel;
mod prefix_sum;
mod sort;
mod sort_network;

pub use hybrid_cells::{CellSize, CellsUniform};
pub use hybrid_grid::{HYBRID_WESL, HybridGrid};
pub use hybrid_passes::HybridShader;
pub use prefix_sum::PrefixSum;
pub use sort::{ListRanges, ListSort, SortInput, SortUniform, SortWork};
