//! Light assignment without lists: a sample's lights are found while it is shaded.
//!
//! # Idea
//!
//! A list is made once and read by many samples. If lights are few, making lists, and even the passes that do
//! so, cost more than they save. Here there is no assignment pass: the look-up itself tests lights.
//!
//! | id | who tests |
//! |---|---|
//! | `W` | the lanes of a subgroup together: each tests one light against the box around their samples |
//! | `W/bvh` | the same, first boxes around 64 lights, and then only the lights of boxes that reach the samples |
//! | `W1` | each sample for itself, through the same boxes |
//!
//! A subgroup is what runs in step: 32 lanes on NVIDIA, 32 or 64 on AMD, 8 to 32 on Intel. In a compute shader
//! with workgroups of 8 x 8 pixels, 32 lanes are 8 x 4 pixels on the GPUs that we know.
//!
//! Fragment shaders have lanes that only help their neighbours, and whether those take part in subgroup operations
//! differs. So in forward shading, each sample tests the lights for itself.
//!
//! W is our own, and no engine that we know of ships it. W1 is what the comparison paper calls direct light data:
//! each sample finds its lights in a structure over them (Enhuber 2019, outlook).
//!
//! # Phases
//!
//! None: shading is all. The hierarchy, if used, is made by [`LightBuffer`](assign::LightBuffer), and its passes
//! count as assignment.
//!
//! # Cost
//!
//! W tests every light once per subgroup: `pixels / 32 * lights` tests of 16 bytes each, and lights that pass are
//! then evaluated by all lanes. W/bvh tests `lights / 64` boxes instead, and 64 lights per box that reaches the
//! subgroup. The hierarchy takes 0.5 bytes per light. The list of all lights, 4 bytes per light, is there for tools
//! only.
//!
//! Measured along a path of Sponza at 1920x1080 (H200, 2026-11-30; `docs/methods.md`): W shades 100 lights in 0.064 ms
//! and 1,000 in 0.33. Tiles that find their bounds while culling (`T-E1/48x48`) take 0.044 and 0.055 ms, culling
//! included.
//!
//! # Where it fails
//!
//! - Many lights: W grows with lights times pixels. W/bvh grows slower, but finds the same lights again for each
//!   subgroup of 32 pixels, where a tile finds them once for 784.
//! - A subgroup at a silhouette has a long box, which lists the lights of the gap. A cluster would not.
//! - A shader that samples many textures or evaluates heavy materials has fewer registers left, because the
//!   search's state lives beside the surface's.
//! - Without subgroup operations W and W/bvh are refused. W1 needs none. Browsers refuse such operations where some
//!   lanes may have left (the diagnostic `subgroup_uniformity`), so W is for native programs.
//! - Only the look-up knows a sample's lights, so there are no lists to inspect. Tools run the look-up and write
//!   down what it returns.

mod walk;

pub use walk::{Walk, walk_wesl};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
