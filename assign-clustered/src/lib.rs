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
//!
//! # Phases
//!
//! 1. `cull`: one workgroup per cluster tests all lights against the cluster's frustum (HS and
//!    SAT-N) and writes its list. Nothing else: no depth buffer is read, so lists serve look-ups
//!    at any depth, transparent layers and volumes included.
//!
//! # Cost
//!
//! `cull` grows with clusters times lights, and with neither pixels nor triangles. Memory is 8
//! bytes a cluster and 4 bytes a listed light.
//!
//! # Where it fails
//!
//! Empty clusters are culled as well: most of a dense grid shows no surface. Deep slices far
//! away, and wide ones where the tile is large, list lights that no visible sample meets. A near
//! plane much closer than the first surface spends slices on nothing: they grow with
//! `log(far / near)`.

mod clustered;
mod clusters;
mod gather;

pub use clustered::{Clustered, EXPLICIT_WESL, IMPLICIT_WESL, Occupancy};
pub use clusters::{ClusterSize, ClustersUniform, UNBOUNDED};
pub use gather::gather_source;
