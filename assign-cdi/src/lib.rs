//! Compound deep images: how far a virtual point light reaches, found by rays through lists of depths.
//!
//! # Idea
//!
//! A deep image keeps all depths of a pixel, not only the nearest. A compound deep image is a set of deep
//! images, one for each of many directions over the hemisphere (Archer, Leach, Knowles 2019). A ray through
//! the scene then reads the list of one pixel: that of the direction nearest to its own.
//!
//! # Phases
//!
//! [`DeepImages`] builds the images of a frame:
//!
//! 1. `cdi-samples` visits the geometry once. It samples each triangle on a grid across the triangle's dominant
//!    axis, whose cells are as wide as the images' pixels.
//! 2. `cdi-count` projects each sample along each direction, and adds 1 to the count of the pixel it meets.
//! 3. `cdi-scan` sums the counts to the offsets at which the pixels' lists begin ([`PrefixSum`]).
//! 4. `cdi-fill` projects again as in phase 2, and writes the depths.
//! 5. `cdi-sort` sorts each list ([`ListSort`]).
//!
//! [`RangeCaster`] then casts rays from points on surfaces, in the pass `cdi-ranges`. A ray picks the direction
//! nearest to its own and the pixel of its origin, and takes the first depth beyond the origin.
//!
//! Shadows ask less and more: whether a surface lies between two points. `package::segment` tells, and changes the pixel on
//! the way, so that it ends at its second point. [`DeepImages::settle`] builds images that stay, and
//! [`DeepImages::ray_buffers`] hands them to a renderer's own bind group.
//!
//! Two other ways to build and to store are there for comparison: [`Build::PerDirection`] and
//! [`Storage::LinkedLists`].
//!
//! [`VplBuffer`] makes virtual point lights (VPLs) from the G-buffer of a spot's view ([`Rsm`]; a distant narrow
//! spot stands for a sun). Its passes are `rsm-mips` and `vpl-choose` before the rays, and `vpl-keep` after them.
//!
//! # Use
//!
//! Before a frame, call:
//!
//! 1. `vpls.prepare(gpu, &rsm)`
//! 2. `images.prepare(gpu, &triangles)`
//! 3. `caster.prepare(gpu, &points)`; positions, normals and `ranges_m` of the points are buffers of `vpls`, and
//!    their count is [`VplBuffer::capacity`].
//!
//! In the frame, after the map is drawn, call `vpls.record_choose`, `images.record`, `caster.record` and
//! `vpls.record_keep`. The lights are then in [`VplBuffer::spheres`] and the buffers next to it.
//! [`VplBuffer::gpu_lights`] hands them to a [`LightBuffer`](assign::LightBuffer): call `update_from_gpu` with them
//! before the frame, and `record` after `vpls.record_keep`. No light crosses to the CPU.
//!
//! Two settings matter: set [`VplSettings::large`] to [`Large::Discard`], which drops lights whose rays meet
//! nothing, and [`VplSettings::min_distance_m`] to about a hundredth of the scene's size. The uniforms, kernels
//! and sorts that are exported as well serve tests of layouts.
//!
//! Worked example: a floor at height 0 and a table top at 1 m lie in a sphere of radius 2 m around height 0.5 m,
//! seen along +z. The near end is at height -1.5 m, so a pixel that holds both has the depths `[1.5, 2.5]`. A ray
//! upwards from the floor starts at depth 1.5; the next depth is 2.5, so the ray is 1 m long. A ray downwards from
//! the table's underside starts at 2.5 and steps backwards through the list. It meets 1.5, so it is 1 m long too.
//!
//! # Cost
//!
//! With `s` samples, `d` directions and `p` pixels per image:
//!
//! - memory: `s d` fragments, and `p d` offsets and counts, of 4 bytes each;
//! - time to build: one visit to the triangles, and two passes over `s d` fragments (count and fill);
//! - a ray reads the frame of one direction, two offsets, and its list up to the hit.
//!
//! # Where it fails
//!
//! - A ray takes the direction at the middle of its cell. That is 6 degrees off on average with 13 stacks of 13
//!   slices, 4.6 degrees with [`Spread::Squares`], and at most [`Directions::max_angle`].
//! - A ray takes the list of its origin's pixel, whose centre is up to 0.71 pixels aside.
//! - Measured effect of both: 4000 rays up to 60 degrees from their surface's normal, in this crate's test room of
//!   10 x 6 x 8 m, with 169 directions and 64 x 64 pixels of 22 cm. Lengths are off by 15 cm in the median and by
//!   62 cm on average; with squares, 13 cm and 56 cm. The averages are due to rays that pass an edge on the wrong
//!   side.
//! - Rays skip surfaces nearer than about `0.71 tan(angle)` pixels, because they may be the origin's own surface
//!   (`ray_cast.wesl`). So corners, and thin things close by, are missed.
//! - A triangle smaller than a cell of the grid is missed if it covers no cell's centre. A finer grid or
//!   [`Coverage::Conservative`] finds it.
//! - If images do not fit their buffers, their header says so, and every range is infinite until the buffers have
//!   grown: two frames later at most. [`Large::Clamp`] then keeps all VPLs of such a frame at the largest range.
//!   [`Large::Discard`] keeps none, so the frame has no indirect light.

mod build_kernels;
mod deep_buffers;
mod deep_images;
mod deep_settings;
mod directions;
mod image_space;
mod kernel;
mod linked_node;
mod prefix_sum;
mod random_ranges;
mod ranges;
mod snapshot;
mod sort;
mod sort_network;
mod stages;
mod vpl;

pub use build_kernels::{BUILD_ROOTS, build_shader};
pub use deep_buffers::DeepImageCounters;
pub use deep_images::{DeepImages, RAY_CAST_WESL, RayBuffers};
pub use deep_settings::{Build, Coverage, DeepImageSettings, MAX_FRAGMENTS, Raster, Storage};
pub use directions::{Directions, MAX_DIRECTIONS, Spread};
pub use image_space::{ImagesUniform, Triangles};
pub use linked_node::LinkedNode;
pub use prefix_sum::{PrefixSum, ScanUniform};
pub use random_ranges::{RandomRanges, RandomUniform};
pub use ranges::{Combine, MAX_RAYS, Primary, RangeCaster, RangePoints, RangeRule, RangesUniform};
pub use snapshot::DeepImagesSnapshot;
pub use sort::{ListSort, RoundUniform, SortInput, SortUniform, SortWork};
pub use stages::{DispatchSizes, PlanUniform, StageUniform};
pub use vpl::{
    KeepUniform, Large, MAX_RSM_SIDE, Rsm, RsmUniform, VplBuffer, VplCounts, VplSettings,
    choose_shader, keep_shader, lambertian_albedo,
};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
