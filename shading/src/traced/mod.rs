//! The truth about images, on the CPU in f64: direct light with shadows, and bounces.
//!
//! # The idea
//!
//! The samples are those of rays from the eye: positions, normals and materials come from the
//! triangles and textures themselves ([`TracedScene::primary`]). So the distance between an image
//! and the truth includes all errors of rendering. With samples of the G-buffer
//! ([`GBufferSamples`]), it shows only the error of the G-buffer's formats.
//!
//! At each sample, the formulas of [`reference`](crate::reference) evaluate every light that
//! reaches it, summed in f64 in ascending light index. Rays against all of the scene's triangles
//! ([`TracedScene`]) find shadows, and the surfaces that bounces hit.
//!
//! # What is exact and what is sampled
//!
//! | light | without shadows | with shadows |
//! |---|---|---|
//! | points, spots, suns | exact | exact: one ray each |
//! | rectangles, polygons | quadrature, to 1e-4 | directions to the emitter, sampled |
//! | the same, shadows separated | | points of the emitter, sampled |
//! | bounces, and surfaces that emit | | paths, sampled |
//!
//! Samples are points of Owen-scrambled Sobol sequences ([`Numbers`]). Every sampled value has the
//! variance of its mean ([`Estimate`]), from the spread of eight independent sequences. Seed and
//! pixel decide the numbers of each pixel, so an image does not depend on the number of threads.
//!
//! # What blocks light
//!
//! Every triangle blocks light, from both sides. Where alpha is below a material's cutoff, light
//! passes. The back of a surface that is not double-sided is not drawn: rays from the eye pass it,
//! as in the rasteriser, and a bounce that hits it finds black. Emitters of area lights block
//! nothing and are invisible.
//!
//! # What emits
//!
//! Lights emit, and so do triangles whose material emits. The shading pipeline shows such triangles
//! but they light nothing. The same holds for the truth without bounces. Their light on other
//! surfaces is part of the first bounce.

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
mod silhouette;
mod surface;
mod texture;
mod triangles;

pub use bounce::{MAX_BOUNCES, Paths, bounced_light};
pub use direct::{AREA_SAMPLES, direct_light, direct_radiance, direct_sun, separated_light};
pub use estimate::Estimate;
pub use gbuffer::GBufferSamples;
pub use image::{Transport, TruthImage, TruthSettings, truth_image};
pub use numbers::Numbers;
pub use scene::TracedScene;
pub use seen::SurfaceSample;
