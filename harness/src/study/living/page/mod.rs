//! The page of the living frame.

pub(crate) mod bill;
pub(crate) mod density;
pub(crate) mod images;
pub(crate) mod times;
