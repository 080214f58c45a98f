//! The truth about images, on the CPU in f64: direct light with shadows, and one bounce.
//!
//! # The idea
//!
//! The samples are those of the rasteriser's G-buffer ([`GBufferSamples`]), or of rays from the eye
//! where there is no GPU. At each, every light that reaches it is evaluated by the formulas of
//! [`reference`](crate::reference), summed in f64 in ascending light index. Rays against all of the
//! scene's triangles ([`TracedScene`]) tell shadows, and what a bounce meets.
//!
//! # What is exact and what is sampled
//!
//! | light | without shadows | with shadows |
//! |---|---|---|
//! | points, spots, suns | exact | exact: one ray each |
//! | rectangles, polygons | quadrature, to 1e-4 | points on the emitter, sampled |
//! | one bounce | | directions, sampled |
//!
//! Every sampled value comes with the variance of its mean ([`Estimate`]), estimated from the samples
//! themselves; each pixel has random numbers of its own, from seed and pixel, so that an image does
//! not depend on the number of threads.
//!
//! # What blocks light
//!
//! Every triangle, from both sides; alpha below a material's cutoff lets light through. The back of
//! a surface that is not double-sided is not drawn: rays from the eye pass it as the rasteriser does,
//! and a bounce that meets it finds black. Emitters of area lights block nothing and are not seen.

mod area;
mod bounce;
mod brdf_sampler;
mod direct;
mod estimate;
mod gbuffer;
mod image;
mod scene;
mod texture;
mod triangles;

pub use bounce::bounced_light;
pub use direct::{AREA_SAMPLES, direct_light, direct_radiance, direct_sun};
pub use estimate::Estimate;
pub use gbuffer::GBufferSamples;
pub use image::{Transport, TruthImage, TruthSettings, truth_image};
pub use scene::{SurfaceSample, TracedScene};
