//! Compound deep images: how far a virtual point light reaches, by rays cast through lists of
//! depths; and a grid of light lists for the many small lights that come of it.
//!
//! # Idea
//!
//! A deep image keeps all depths of a pixel, not the nearest alone. A compound deep image is one for
//! each of many directions over the hemisphere (Archer, Leach, Knowles 2019): a ray through the scene
//! is then the list of one pixel.

mod build_kernels;
mod deep_buffers;
mod deep_images;
mod deep_settings;
mod directions;
mod hybrid_cells;
mod hybrid_grid;
mod hybrid_passes;
mod image_space;
mod kernel;
mod prefix_sum;
mod random_ranges;
mod ranges;
mod snapshot;
mod sort;
mod sort_network;
mod vpl;

pub use build_kernels::{ROOTS, build_shader};
pub use deep_buffers::DeepImageCounters;
pub use deep_images::{DeepImages, DispatchSizes, RAY_CAST_WESL, StageUniform};
pub use deep_settings::{Build, Coverage, DeepImageSettings, MAX_FRAGMENTS, Raster, Storage};
pub use directions::{Directions, MAX_DIRECTIONS, Spread};
pub use hybrid_cells::{CellSize, CellsUniform};
pub use hybrid_grid::{HYBRID_WESL, HybridGrid};
pub use hybrid_passes::HybridShader;
pub use image_space::{ImagesUniform, Triangles};
pub use prefix_sum::PrefixSum;
pub use random_ranges::{RandomRanges, RandomUniform};
pub use ranges::{Combine, MAX_RAYS, Primary, RangeCaster, RangePoints, RangeRule, RangesUniform, Threads};
pub use snapshot::DeepImagesSnapshot;
pub use sort::{ListRanges, ListSort, SortInput, SortUniform, SortWork};
pub use vpl::{KeepUniform, Large, MAX_RSM_SIDE, Rsm, RsmUniform, VplBuffer, VplCounts, VplSettings, choose_shader, keep_shader};
