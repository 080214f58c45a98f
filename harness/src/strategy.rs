//! The registry: every strategy that can be compared, and how its ids are read.
//!
//! A **family** is one way of assigning lights, such as sparse clusters with explicit bounds (`SC-E`).
//! Each family is one [`Row`] in `strategy/rows/`. The row says everything that the rest of the program
//! asks about a family: its parameters and further axes, what it is, where it comes from, its role, its
//! colour, the sizes that searches try, what it needs, what it refuses, and how to make it. The command
//! line, `list strategies`, studies, `advise`, reports and the table in README filter rows.
//!
//! A [`StrategyId`] names one point on the axes of a family. [`StrategyId::parse`] is the only reader of
//! ids. Example:
//!
//! | part of `SC-E/48x48x40/n6/bvh/cap32` | meaning |
//! |---|---|
//! | `SC-E` | the family |
//! | `48x48x40` | its parameters: tiles of 48 x 48 pixels, 40 depth slices |
//! | `n6` | six bins of normals per cluster |
//! | `bvh` | lights come from the hierarchy |
//! | `cap32` | lists keep 32 lights at most: a lossy knob |
//!
//! Some segments are flaws, such as `rect`: methods with them fail on purpose ([`flaws`]).
//!
//! To add a family, write its crate and one row. A new file of rows also needs its `mod` line and its entry
//! among the files in `strategy/rows.rs`; a new crate its line in `harness/Cargo.toml` and among the sources
//! of `build.rs`, which tell whether a commit is clean. A new axis needs its arms in [`Axis`] and its field
//! in [`Options`].

mod axis;
pub mod engines;
mod flaws;
mod id;
mod method;
mod parse;
mod plug_in;
mod refusal;
mod row;
mod rows;
mod segments;
mod specular;
mod table;

pub use axis::Axis;
pub use flaws::{Flaw, flaws};
pub use id::StrategyId;
pub use method::{Method, Options};
pub use parse::IdError;
pub use plug_in::plug_in_markdown;
pub use refusal::Refusal;
pub use row::{Colour, GREY, Role, Row, Sizes, StandIn};
pub use rows::{BASELINE, CONTROL, EARLY_EXIT, RASTER_SPHERE, default_ids, row, rows};
pub use table::{list, markdown};

#[cfg(test)]
pub(crate) use rows::made_up;

#[cfg(test)]
mod tests;
