//! The page of the comparison.

pub(crate) mod accuracy;
pub(crate) mod frames;
pub(crate) mod overview;
pub(crate) mod path;
pub(crate) mod scaling;
pub(crate) mod sizes;
pub(crate) mod views;
