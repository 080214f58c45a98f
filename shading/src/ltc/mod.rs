//! Linearly transformed cosines (Heitz et al. 2016): the reflection of polygon lights in closed
//! form.
//!
//! # The idea
//!
//! The integral of a cosine over a spherical polygon is a sum over its edges (Lambert 1760). A
//! matrix M stretches the cosine into a lobe of about the shape of a BRDF. So the integral of the
//! BRDF over a polygon is about the integral of the cosine over the polygon transformed by M^-1. A
//! [`Table`] holds M^-1 for each roughness and view, and the integrals that scale the lobe.
//!
//! # The frame
//!
//! Everything happens in the shading frame: the shaded point at the origin, z the shading normal, x
//! the view direction's projection onto the surface. A polygon is a slice of its vertices in that
//! frame, in order, clockwise or counter-clockwise. Integrals are those of a light that shines to
//! both sides. For a one-sided light, the caller skips points behind it. Any unit of length will
//! do, because only directions count.
//!
//! # The terms
//!
//! The table gives the radiance reflected to the eye from a polygon of unit radiance. `f0` is the
//! reflectance at normal incidence, A and B are the integrals of an [`Entry`], and C is
//! [`diffuse_fresnel`].
//!
//! | term | value |
//! |---|---|
//! | specular | `ltc_integral * (f0 * (A - B) + B) / share` |
//! | diffuse | `albedo * cosine_integral * (1 - f0) * (1 - C)` |
//!
//! A fitted lobe extends below the surface's horizon, where [`ltc_integral`] counts nothing. So its
//! light is divided by its share above the horizon ([`Entry::share_above_horizon`]). Under light
//! from all directions, a surface then reflects what its BRDF reflects.
//!
//! The BRDF is that of `brdf.wesl`. [`integrate`] integrates it without any approximation, for
//! comparison.

mod accuracy;
mod diffuse_fresnel;
mod ellipse;
mod fit;
mod generate;
mod integrals;
pub(crate) mod lobe;
mod nelder_mead;
mod polygon;
mod polynomial;
mod polynomial_coefficients;
mod quadrature;
mod spherical_rectangle;
mod table;

pub use accuracy::{ACCURACY_DEGREES, Accuracy, AccuracyCase, accuracy_cases};
pub use diffuse_fresnel::{DIFFUSE_FRESNEL, diffuse_fresnel};
pub use ellipse::{
    Ellipse, cap_integral, ellipse_integral, ltc_ellipse_integral, ltc_sphere_integral,
    sphere_integral,
};
pub(crate) use ellipse::{cone_polygon, disc_of_sphere};
pub use fit::{Fit, fit};
pub use generate::{FitReport, TableDifference, generate};
pub use integrals::Integrals;
pub use lobe::Masking;
pub use polygon::{cosine_integral, ltc_integral};
pub use polynomial::{LTC_POLYNOMIAL_WESL, POLYNOMIAL_COMPONENTS, Polynomial};
pub use quadrature::{Estimate, integrate};
pub use spherical_rectangle::SphericalRectangle;
pub use table::{Entry, TABLE_SIZE, Table};
