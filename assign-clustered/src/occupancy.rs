//! Which clusters get a list.

/// Which clusters get a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Occupancy {
    /// All clusters.
    Dense,
    /// Only those that hold a sample.
    Sparse,
}
