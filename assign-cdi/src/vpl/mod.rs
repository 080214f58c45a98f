//! Virtual point lights from a reflective shadow map (Archer et al. 2019, section 3.2).
//!
//! 1. `rsm-mips`: each texel's reflected light, then that of blocks of 2, 4, 8 … texels a side.
//! 2. `vpl-choose`: the largest blocks no wider on the surface than a spacing become VPLs, single
//!    texels where even those are wider; they are written in Morton order, so that neighbours are
//!    near each other.
//! 3. The caller's pass fills [`VplBuffer::ranges_m`] from [`VplBuffer::positions`] and
//!    [`VplBuffer::normals`].
//! 4. `vpl-keep`: VPLs with too small or too large a range drop out, the others become lights.
//!
//! Nothing depends on the order in which threads run: the same map gives the same lights.
//!
//! # Light
//!
//! A texel of solid angle `w` seen from a spot of intensity `I` reflects the flux `I w a`, with `a` the
//! diffuse albedo after Fresnel's term ([`lambertian_albedo`]); Lambert's law gives the intensity `I w a / pi` along the normal, whose integral over
//! the half space is that flux. A texel whose shading normal faces away from the light reflects nothing,
//! though its facet faces it. A block has its texels' sum and the place and normal of one of them, so
//! the spacing changes where light comes from and not how much there is.

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
