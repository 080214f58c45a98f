//! Light assignment by froxels: screen tiles cut into depth slices.
//!
//! # Idea
//!
//! A froxel is a tile of pixels and a slice of view depth; every view sample lies in exactly one. In a
//! perspective view slices grow exponentially with depth, unless [`Slices`] says otherwise, so froxels stay
//! about as deep as they are wide (Olsson et al. 2012; Enhuber 2019, section 3.2). A cluster is a froxel with
//! a list of lights.
//!
//! | id | which clusters get a list | bounds of a cluster |
//! |---|---|---|
//! | `DC-I` | all (dense) | its whole frustum (implicit) |
//! | `DC-E` | all (dense) | the world-space box around the samples in it (explicit) |
//! | `SC-I` | those that hold a sample (sparse) | its whole frustum |
//! | `SC-E` | those that hold a sample (sparse) | the box around the samples |
//! | `DA-I` | as SC-I, found tile by tile (depth-aware) | its whole frustum |
//! | `DA-E` | as SC-E, found tile by tile (depth-aware) | the box around the samples |
//!
//! [`ZBins`], `ZB`, has a bit mask per tile and one per slice in place of a list per froxel; `z_bins.rs` describes
//! it.
//!
//! [`HybridGrid`], `HG`, shares the froxels but works from the other side: lights add themselves to the froxels
//! that they touch, by compute lanes or by the rasteriser (`/raster`). `hybrid/mod.rs` describes it. The rest of this page is about clusters.
//!
//! # Phases
//!
//! 1. `bounds` (all but DC-I) reads the depth buffer once. In DC-E, SC-I and SC-E, each workgroup reads 32 x 32 pixels, and collects
//!    their clusters and the boxes around their samples in a hash table in workgroup memory. Then it merges the
//!    table into global memory, with one set of atomics per cluster and block. The first workgroup to meet a
//!    cluster appends it to the live clusters. In DA-I and DA-E, each workgroup reads one tile, and has a place for
//!    each slice in workgroup memory; nothing is merged (after the unique clusters per tile of Olsson et al. 2012).
//! 2. `cull` gives each cluster one workgroup: every cluster, or only the live ones. It tests lights against
//!    the cluster's frustum (by default HS and SAT-N) or box (NP), and writes the cluster's list.
//!
//! Worked example: a view's samples lie in clusters 2, 5 and 6 of clusters 0 to 7. Dense strategies cull all
//! eight clusters. Sparse ones append `[5, 2, 6]`, in any order, and cull three. The other clusters hold
//! no samples. Their lists are those of all lights, in case that shading looks them up all the same.
//!
//! # Cascades
//!
//! Near the camera, a tile covers little of the world; far away, it covers much. `/cascades3` cuts the slices into
//! three cascades. The farthest has tiles of the grid's size. In each nearer cascade, tiles are twice as wide and
//! twice as high, so near clusters are fewer and hold more samples each (Billeter 2015; Enhuber 2019, section 2.2).
//! In the original, each cascade also has its own number of slices. Here, all cascades have about the same number.
//!
//! # Normals
//!
//! SC-E can also split clusters by shading normals ([`Normals`]; `SC-E/48x48x40/n6`; Swarbrick 2025, sections
//! 3.4 and 4.2). A group is then a cluster and a bin of normals, and only groups that hold samples get a list.
//! A bin is a cell of a face of the cube around the unit sphere.
//!
//! - `bounds` also reads the normals and keeps a box around the normals of each group.
//! - `cull` also leaves out lights that lie below the horizon of every normal in the cone around that box
//!   (`facing.wesl`). This loses nothing, because such lights add exactly nothing.
//!
//! A specular threshold (`/s0.001`) leaves out the specular term of area lights whose upper bound over the group
//! stays below it (`gloss.wesl`). `bounds` then also keeps the range of roughness and the greatest reflectance
//! at normal incidence. This is lossy: it drops up to the threshold per light.
//!
//! Two more cuts are Swarbrick's own; they are baselines, and lossy too ([`SpecularCut`]):
//!
//! - `/n54/cone45` applies to lights whose diffuse term does not reach the group. It keeps such a light only if a
//!   bin's normals mirror the light's middle to the eye, within a lobe of 45 degrees (`reflected.wesl`).
//! - `/dif` lists a light only if its diffuse term reaches the group. Shading then draws the specular term of a
//!   listed light out to the light's full range.
//!
//! # Specular reach
//!
//! Polished surfaces show lights far beyond the range at which diffuse light is negligible, so culling by range cuts
//! highlights off (Watrous 2024, figure 3a). `/reach8` lists points and spots for their specular term out to up to 8
//! ranges ([`ClusterOptions::reach`]). It is the survey's own idea, a summary of materials per cluster:
//!
//! - `bounds` also reads normals, roughness and base colour. From each sample it computes how far a specular term
//!   reaches there ([`assign::specular_reach`] derives it), and keeps the greatest reach of each cluster: one number.
//! - `cull` lists a light for both terms where its range reaches the cluster, and only for the specular term out to the
//!   cluster's reach. Through the hierarchy, boxes grow by as much.
//!
//! Shading with the same reach shows the image of no culling with it, in every bit: a sample's reach depends on its own
//! material and its angle to the eye, and its cluster's reach is no shorter. Shading without it shows the image of no
//! culling without it, from longer lists. Area lights keep their ranges.
//!
//! # Cost
//!
//! `bounds` grows with pixels. `cull` grows with lights times clusters that get a list.
//!
//! | memory | bytes |
//! |---|---|
//! | per cluster | 8 |
//! | more per cluster, explicit bounds | 28 |
//! | more per cluster, sparse with implicit bounds | 8, or 4 for DA-I |
//! | more per cluster, with a specular reach | 4 |
//! | per cluster and bin, with normals, whether it holds samples or not | 60 |
//! | per cluster and bin, with a specular threshold | 72 |
//! | per listed light | 4 |
//!
//! With 54 bins, 48x48x40 has 1.99 million groups at 1920x1080, which take 119 MB.
//!
//! Measured for 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25; `results/h200-all/sponza-1.6.json`,
//! whose command is in `results/README.md`):
//!
//! | strategy | assign, ms | shade, ms |
//! |---|---|---|
//! | DC-I/128x128x64 | 0.322 | 0.182 |
//! | DC-E/64x64x40 | 0.085 | 0.138 |
//! | SC-I/48x48x40 | 0.107 | 0.153 |
//! | SC-E/48x48x40 | 0.094 | 0.132 |
//! | SC-E/48x48x40/bvh | 0.054 | 0.132 |
//!
//! # Where it fails
//!
//! - Dense strategies also cull empty clusters, and most of a dense grid shows no surface.
//! - Implicit bounds are loose for slices far away, which are deep, and for large tiles, whose clusters are wide.
//!   Such clusters list lights that reach no visible sample.
//! - DA-I and DA-E have one workgroup per tile: large tiles leave processors idle, and small ones leave lanes idle.
//!   Tiles have sides of at most 1,024 pixels, and at most 128 slices.
//! - A near plane much closer than the first surface spends slices on nothing: the octaves to cover grow with
//!   `log(far / near)`.
//! - With normals, surfaces of many directions make many groups. Each is culled on its own, and neighbouring
//!   pixels read different lists. If lights rise above most horizons, normals save nothing.
//! - A surface whose depth equals the cleared depth cannot be told from background. Its samples get all lights.
//!
//! DC-I serves look-ups at any depth, including transparent layers and volumes. The others serve the opaque surfaces in
//! the depth buffer, with one or several samples per pixel, and what lies in front of them. A sample in a cluster without
//! samples, or outside the box of its cluster, reads all lights. So hand over the depths of layers
//! ([`Frame::layer_depths`](assign::Frame::layer_depths)), which become part of the bounds; DA-I and DA-E do not read
//! them. All refuse look-ups at any depth, and with normals all but those at opaque surfaces.

mod cluster_options;
mod cluster_wesl;
mod clustered;
mod froxels;
mod gather;
mod hybrid;
mod normal_bins;
mod normals;
mod occupancy;
mod slices;
mod specular_cut;
mod z_bins;

pub use cluster_options::ClusterOptions;
pub use cluster_wesl::{
    BINS_WESL, EXPLICIT_CASCADES_WESL, EXPLICIT_WESL, GLOSSY_BINS_WESL, IMPLICIT_CASCADES_WESL,
    IMPLICIT_WESL, POLISHED_CASCADES_WESL, POLISHED_WESL,
};
pub use clustered::Clustered;
pub use froxels::{FroxelSize, FroxelsUniform};
pub use gather::{gather_source, marks_words};
pub use hybrid::{HYBRID_WESL, HybridGrid, HybridParts, HybridShader, Scatter};
pub use normal_bins::NormalBinsUniform;
pub use normals::Normals;
pub use occupancy::Occupancy;
pub use slices::Slices;
pub use specular_cut::{PAPERS_LOBE_DEGREES, SpecularCut};
pub use z_bins::{Z_BINS_WESL, ZBins};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
