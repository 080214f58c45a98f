//! The page of a study: its frame, and what the pages of several studies share.

pub(crate) mod error_columns;
pub(crate) mod errors_plot;
pub(crate) mod figure;
pub(crate) mod frame;
pub(crate) mod lines;
pub(crate) mod part;
pub(crate) mod pictures;
pub(crate) mod shots;
