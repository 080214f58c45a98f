//! The page of deep images.

pub(crate) mod builds;
mod light;
mod ranges;
pub(crate) mod tables;
