//! The rows, a file per crate.

mod baselines;
mod clusters;
mod grid;
mod hybrid;
#[cfg(test)]
pub(crate) mod made_up;
mod models;
mod tiles;
mod walks;

use std::sync::LazyLock;

use super::Row;

/// The id of no culling, which the others are compared with.
pub const BASELINE: &str = baselines::NONE.family;

/// The id of no culling with the early exit that all culling strategies have.
pub const EARLY_EXIT: &str = baselines::SPHERE.family;

/// The id of the control, which draws the surfaces without lights: a cost, not a competitor.
pub const CONTROL: &str = baselines::CLAY.family;

/// The id of the strategy that rasterises light volumes.
pub const RASTER_SPHERE: &str = baselines::RASTER_SPHERE.family;

/// The rows of each file, from the simple strategies to the involved.
const FILES: &[&[Row]] = &[
    baselines::ROWS,
    tiles::ROWS,
    clusters::ROWS,
    grid::ROWS,
    models::ROWS,
    hybrid::ROWS,
    walks::ROWS,
    // A family for tests of what one row is enough for.
    #[cfg(test)]
    made_up::ROWS,
];

/// All rows, from the simple strategies to the involved.
pub fn rows() -> impl DoubleEndedIterator<Item = &'static Row> + Clone {
    FILES.iter().copied().flatten()
}

/// What `compare` measures where the command line names no strategies: `None,Sphere`.
pub fn default_ids() -> &'static str {
    static IDS: LazyLock<String> =
        LazyLock::new(|| rows().filter_map(|row| row.in_default).collect::<Vec<_>>().join(","));
    &IDS
}

/// The row of a family.
pub fn row(family: &str) -> Option<&'static Row> {
    rows().find(|row| row.family == family)
}

#[cfg(test)]
mod tests;
