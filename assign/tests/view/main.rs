//! Views of every projection: from matrices, with oblique near planes, and as shaders rebuild positions in them.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(missing_docs, reason = "a test")]

mod matrices;
mod oblique;
mod rebuilt;
mod refused;
mod views;
