//! Compound deep images: how far a virtual point light reaches, by rays cast through lists of
//! depths; and a grid of light lists for the many small lights that come of it.
//!
//! # Idea
//!
//! A deep image keeps all depths of a pixel, not the nearest alone. A compound deep image is one for
//! each of many directions over the hemisphere (Archer, Leach, Knowles 2019): a ray through the scene
//! is then the list of one pixel.
//!
//! # Phases
//!
//! [`DeepImages`] builds the images of a frame:
//!
//! 1. `cdi-samples`: geometry is visited once. Each triangle is sampled on a grid across its dominant
//!    axis, as fine as the images' pixels.
//! 2. `cdi-count`: each sample is projected along each direction, and its pixel counts one more.
//! 3. `cdi-scan`: [`PrefixSum`] makes of the counts where each pixel's list begins.
//! 4. `cdi-fill`: as 2, but depths are written.
//! 5. `cdi-sort`: [`ListSort`] sorts each list.
//!
//! [`RangeCaster`], pass `cdi-ranges`, casts rays from points on surfaces: it takes the direction next
//! to the ray's, the pixel of the point, and the first depth beyond it. Other ways to build and to
//! store are there to compare with: [`Build::PerDirection`], [`Storage::LinkedLists`].
//!
//! [`VplBuffer`] makes virtual point lights of the G-buffer of a spot's view ([`Rsm`]; far away and
//! narrow, a spot is a sun): passes `rsm-mips` and `vpl-choose` before the rays, `vpl-keep` after them.
//! [`HybridGrid`], HG, is a strategy like any other.
//!
//! # Use
//!
//! Before a frame: `vpls.prepare(gpu, &rsm)`, `images.prepare(gpu, &triangles)` and
//! `caster.prepare(gpu, &points)`, whose positions, normals and `ranges_m` are buffers of `vpls` and whose
//! count is [`VplBuffer::capacity`]. In it, after the map is drawn: `vpls.record_choose`,
//! `images.record`, `caster.record`, `vpls.record_keep`. The lights are then in
//! [`VplBuffer::spheres`] and its neighbours; [`VplBuffer::read`] fetches them for a
//! [`LightBuffer`](assign::LightBuffer). Set [`VplSettings::large`] to [`Large::Discard`], so that lights
//! whose rays meet nothing are left out, and [`VplSettings::min_distance_m`] to about a hundredth of the
//! scene. The uniforms, kernels and sorts that are exported beside these serve tests of layouts.
//!
//! Worked example: a floor at height 0 and a table top at 1 m, in a sphere of radius 2 m around
//! height 0.5 m, seen along +z. The near end is at height -1.5 m, so a pixel that holds both has the
//! depths `[1.5, 2.5]`. A ray upwards from the floor is at depth 1.5; the first depth beyond is 2.5,
//! its length 1 m. A ray downwards from the table's underside steps from the last depth back, and
//! finds 1.5, again 1 m.
//!
//! # Cost
//!
//! With `s` samples, `d` directions and `p` pixels an image: `s d` fragments of 4 bytes and `p d`
//! offsets and counts of 4 bytes each; the time to build is that of visiting the triangles once and of
//! writing `s d` fragments twice. A ray reads one direction's frame, two offsets and its list up to
//! the hit.
//!
//! # Where it fails
//!
//! - A ray takes the direction of its cell, up to [`Directions::max_angle`] off, 6 degrees on average
//!   with 13 stacks of 13 slices and 4.6 with [`Spread::Squares`]; and the pixel's list, up to 0.71
//!   pixels aside. Measured in the room of this crate's tests, 10 x 6 x 8 m, with 4000 rays up to 60
//!   degrees from their surface's normal, 169 directions and 64 x 64 pixels of 22 cm: the length is
//!   15 cm off in the median and 62 cm on average, 13 cm and 56 cm with squares. The average is that
//!   of rays that pass an edge on the other side.
//! - Surfaces nearer than about `0.71 tan(angle)` pixels along a ray are passed over as its origin's own
//!   (`ray_cast.wesl`), so corners and thin things close by are missed.
//! - Triangles smaller than a cell of the grid are missed where they cover no cell's centre; a finer
//!   grid or [`Coverage::Conservative`] finds them.
//! - Images that do not fit their buffers say so: every range is infinite until they have grown, two
//!   frames later at most. Of the VPLs of such a frame [`Large::Clamp`] keeps all, at the largest range,
//!   and [`Large::Discard`] none: the frame has no indirect light.

mod build_kernels;
mod deep_buffers;
mod deep_images;
mod deep_settings;
mod directions;
mod image_space;
mod kernel;
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
pub use deep_images::{DeepImages, RAY_CAST_WESL};
pub use deep_settings::{Build, Coverage, DeepImageSettings, MAX_FRAGMENTS, Raster, Storage};
pub use directions::{Directions, MAX_DIRECTIONS, Spread};
pub use image_space::{ImagesUniform, Triangles};
pub use prefix_sum::{PrefixSum, ScanUniform};
pub use random_ranges::{RandomRanges, RandomUniform};
pub use ranges::{Combine, MAX_RAYS, Primary, RangeCaster, RangePoints, RangeRule, RangesUniform};
pub use snapshot::{DeepImagesSnapshot, LinkedNode};
pub use sort::{ListSort, RoundUniform, SortInput, SortUniform, SortWork};
pub use stages::{DispatchSizes, PlanUniform, StageUniform};
pub use vpl::{
    KeepUniform, Large, MAX_RSM_SIDE, Rsm, RsmUniform, VplBuffer, VplCounts, VplSettings,
    choose_shader, keep_shader, lambertian_albedo,
};
