//! The truth about images, on the CPU in f64: direct light with shadows, and bounces.
//!
//! # The idea
//!
//! The samples are those of rays from the eye: positions, normals and materials come from the triangles
//! and textures themselves ([`TracedScene::primary`]). So an image's distance to the truth holds all that
//! rendering costs. What the G-buffer's formats cost alone shows when the samples are the G-buffer's
//! ([`GBufferSamples`]). At each sample, every light that reaches it is evaluated by the formulas of
//! [`reference`](crate::reference), summed in f64 in ascending light index. Rays against all of the
//! scene's triangles ([`TracedScene`]) tell shadows, and what a bounce meets.
//!
//! # What is exact and what is sampled
//!
//! | light | without shadows | with shadows |
//! |---|---|---|
//! | points, spots, suns | exact | exact: one ray each |
//! | rectangles, polygons | quadrature, to 1e-4 | directions to the emitter, sampled |
//! | bounces, and surfaces that emit | | paths, sampled |
//!
//! Samples are points of Owen-scrambled Sobol sequences ([`Numbers`]). Every sampled value comes with the
//! variance of its mean ([`Estimate`]), from the spread of eight independent sequences. Each pixel has
//! numbers of its own, from seed and pixel, so that an image does not depend on the number of threads.
//!
//! # What blocks light
//!
//! Every triangle, from both sides; alpha below a material's cutoff lets light through. The back of
//! a surface that is not double-sided is not drawn: rays from the eye pass it as the rasteriser does,
//! and a bounce that meets it finds black. Emitters of area lights block nothing and are not seen.
//!
//! # What emits
//!
//! Lights, and triangles whose material emits. The shading pipeline shows the latter's own radiance but
//! lights nothing with it. So does the truth without bounces; their light on other surfaces is part of the
//! first bounce.

mod area;
mod bounce;
mod brdf_sampler;
mod direct;
mod emissive;
mod estimate;
mod gbuffer;
mod image;
mod numbers;
mod primary;
mod scene;
mod seen;
mod surface;
mod texture;
mod triangles;

pub use bounce::{MAX_BOUNCES, Paths, bounced_light};
pub use direct::{AREA_SAMPLES, direct_light, direct_radiance, direct_sun};
pub use estimate::Estimate;
pub use gbuffer::GBufferSamples;
pub use image::{Transport, TruthImage, TruthSettings, truth_image};
pub use numbers::Numbers;
pub use scene::TracedScene;
pub use seen::SurfaceSample;
