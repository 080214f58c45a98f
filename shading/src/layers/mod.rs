//! Layers over the opaque surfaces: transparent surfaces, particles, and fog.
//!
//! Layers are lit at depths where no opaque surface lies. So a frame with layers asks strategies for more look-ups
//! ([`SampleDomain`](assign::SampleDomain)). Transparent surfaces and particles need look-ups in front of opaque
//! surfaces. Fog needs them at any depth, because its froxels cover several pixels and lie behind surfaces too. A
//! strategy that does not serve them refuses the frame before it is drawn.
//!
//! # Passes, after `shade`
//!
//! | pass | what it does | look-ups |
//! |---|---|---|
//! | `fog-light` | finds the light that each froxel of the fog scatters | one at each froxel's centre |
//! | `fog-sum` | sums the fog from the eye on, slice by slice | |
//! | `fog-apply` | draws the fog over the opaque surfaces | |
//! | `blend` | draws transparent surfaces and particles, from back to front | one per fragment |
//!
//! All modes draw layers in the same way: in deferred modes, too, fragments look lights up.
//!
//! # Order
//!
//! The CPU sorts transparent surfaces and particles by the distance of their centres, once per view, off the clock.
//! Every strategy draws them in this order, and blending rounds to the same bits, so images can be compared bit for
//! bit. A surface is one instance of a mesh. Where it overlaps itself, its triangles are blended in the order of the
//! mesh. Where two surfaces cross each other, one of them is drawn over all of the other.
//!
//! # Light
//!
//! Transparent surfaces reflect light as opaque ones do. Fog and particles scatter the light of all directions alike
//! (`scattered_light.wesl`). Fog is even: it has one density, and scatters all light that it stops. With
//! [shadow maps](crate::ShadowModel), opaque surfaces shadow all layers. Layers cast no shadows: light passes them
//! unweakened.
//!
//! Fog is lit at the centres of its froxels (Wronski 2014, "Volumetric Fog"): a lamp smaller than a froxel has a
//! halo as wide as the froxel. It is summed by the integral over each slice (Hillaire 2015, "Physically Based and
//! Unified Volumetric Rendering in Frostbite").

mod blend;
mod capture;
mod capture_buffers;
mod fog;
mod fog_passes;
mod options;
mod order;
mod passes;
mod scene;

pub use capture::{LayerSamples, visit_layer_lists};
pub use fog::FogRecord;
pub use options::{LayerKinds, LayerOptions, MAX_FOG_PER_M, MIN_FOG_PER_M};
pub use scene::ParticleRecord;

pub(crate) use passes::LayerPasses;
pub(crate) use scene::LayerScene;
