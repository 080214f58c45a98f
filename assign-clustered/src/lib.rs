//! Clustered light assignment: screen tiles cut into depth slices.
//!
//! # Idea
//!
//! A cluster is a tile of pixels and a slice of view depth; every view sample lies in exactly
//! one. Slices grow exponentially with depth, so clusters stay about as deep as they are wide
//! (Olsson et al. 2012; Enhuber 2019, section 3.2).
//!
//! | id | which clusters get a list | bounds of a cluster |
//! |---|---|---|
//! | `DC-I` | all (dense) | its whole frustum (implicit) |
//! | `DC-E` | all (dense) | the world-space box around the samples in it (explicit) |
//! | `SC-I` | those that hold a sample (sparse) | its whole frustum |
//! | `SC-E` | those that hold a sample (sparse) | the box around the samples |
//!
//! # Phases
//!
//! 1. `bounds` (all but DC-I): reads the depth buffer once. Each workgroup collects the clusters of
//!    32 x 32 pixels, and the boxes around their samples, in a hash table in workgroup memory, then
//!    merges them into global memory, one set of atomics a cluster and block. The first block to
//!    meet a cluster appends it to the clusters that live.
//! 2. `cull`: one workgroup per cluster, all or the live ones, tests lights against the cluster's
//!    frustum (HS and SAT-N by default) or box (NP) and writes its list.
//!
//! Worked example: of clusters 0 to 7 a view's samples lie in 2, 5 and 6. Dense culls eight, sparse
//! appends `[5, 2, 6]`, in any order, and culls three; the lists of the others are never looked up.
//!
//! # Normals
//!
//! SC-E can split clusters by shading normals as well ([`Normals`]; `SC-E/48x48x40/n6`, Swarbrick 2025,
//! sections 3.4 and 4.2): a group is then a cluster and a bin, a cell of a face of the cube around the
//! unit sphere, and only those that hold samples get a list. `bounds` also reads the normals and keeps
//! a box of each group's, `cull` also leaves out lights that rise above the horizon of no normal in
//! the cone around it (`facing.wesl`). Nothing is lost: such lights add exactly nothing.
//!
//! A specular threshold (`/s0.001`) leaves out the specular term of area lights whose upper bound over
//! the group stays below it (`gloss.wesl`). `bounds` then keeps the range of roughness and the greatest
//! reflectance at normal incidence too. That is lossy by what is left out, light by light.
//!
//! Two more cuts are Swarbrick's own, as baselines, and lossy too ([`SpecularCut`]). `/n54/cone45` tests
//! whether a bin's normals mirror the light's middle to the eye, give or take a lobe of 45 degrees
//! (`reflected.wesl`), and looks only at lights whose diffuse term does not reach. `/dif` lists a light only
//! where its diffuse term reaches the group; of a listed light, specular light is drawn out to its full range.
//!
//! # Cost
//!
//! `bounds` grows with pixels, `cull` with clusters that get a list times lights. Memory is 8 bytes
//! a cluster, 24 more with explicit bounds (4 with sparse implicit ones), and 4 bytes a listed
//! light. With normals it is 60 bytes a cluster and bin, whether it holds samples or not, and 72 with a
//! specular threshold: 1.99 million groups at 1920x1080 with 54 bins and 48x48x40, 119 MB.
//!
//! Figures, ms, of 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`): DC-I/128x128x64
//! 0.322 to assign and 0.182 to shade; DC-E/64x64x40 0.085 and 0.138; SC-I/48x48x40 0.107 and 0.153;
//! SC-E/48x48x40 0.094 and 0.132, through the hierarchy 0.054 and 0.132.
//!
//! # Where it fails
//!
//! Dense: empty clusters are culled as well, and most of a dense grid shows no surface. Implicit:
//! deep slices far away, and wide ones where the tile is large, list lights that no visible sample
//! meets. A near plane much closer than the first surface spends slices on nothing: they grow with
//! `log(far / near)`. Normals: surfaces of many directions make many groups, each culled on its own,
//! and neighbours that read other lists; where lights rise above most horizons it buys nothing.
//!
//! DC-I serves look-ups at any depth, transparent layers and volumes included. The others serve
//! the opaque surfaces in the depth buffer alone, and refuse the rest. A surface whose depth equals
//! the cleared one cannot be told from background: its samples get all lights.

mod clustered;
mod clusters;
mod gather;
mod normals;
mod specular_cut;

pub use clustered::{
    BINS_WESL, Clustered, EXPLICIT_WESL, GLOSSY_BINS_WESL, IMPLICIT_WESL, Occupancy,
};
pub use clusters::{ClusterSize, ClustersUniform, UNBOUNDED};
pub use gather::gather_source;
pub use normals::Normals;
pub use specular_cut::{PAPERS_LOBE_DEGREES, SpecularCut};
