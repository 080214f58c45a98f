//! The page of models of area lights.

pub(crate) mod cost;
pub(crate) mod models;
pub(crate) mod pictures;
