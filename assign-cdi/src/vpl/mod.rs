//! Virtual point lights (VPLs) from a reflective shadow map (RSM; Archer et al. 2019, section 3.2).
//!
//! 1. `rsm-mips` computes the light that each texel reflects, then sums it over blocks of 2, 4, 8 … texels a side.
//! 2. `vpl-choose` turns blocks into VPLs: the largest blocks whose footprint on the surface is no wider than the
//!    spacing, or a single texel if even that is wider. It writes them in Morton order, so neighbours in the buffer
//!    are near each other.
//! 3. The caller's pass fills [`VplBuffer::ranges_m`] from [`VplBuffer::positions`] and [`VplBuffer::normals`].
//! 4. `vpl-keep` drops VPLs whose range is too small or too large. The others become lights.
//!
//! Nothing depends on the order in which threads run: the same map gives the same lights.
//!
//! # Light
//!
//! Let a texel of solid angle `w` be lit by a spot of intensity `I`, and let `a` be the diffuse albedo after
//! Fresnel's term ([`lambertian_albedo`]). The texel reflects the flux `I w a`. By Lambert's law its intensity along
//! the normal is `I w a / pi`, because that integrates to the flux over the half-space.
//!
//! A texel whose shading normal faces away from the light reflects nothing, although its facet faces the light. A
//! block has the summed light of its texels, and the position and normal of one of them. So the spacing changes where
//! light comes from, but not how much there is.

mod buffer;
mod choose;
mod emission;
mod keep;
mod rsm;
mod settings;

pub use buffer::{VplBuffer, VplCounts};
pub use choose::choose_shader;
pub use emission::lambertian_albedo;
pub use keep::{KeepUniform, keep_shader};
pub use rsm::{MAX_RSM_SIDE, Rsm, RsmUniform};
pub use settings::{Large, VplSettings};
