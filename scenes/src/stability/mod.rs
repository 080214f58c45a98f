//! Small procedural scenes in which ways of assigning lights are known to fail.
//!
//! A [`Scenario`] is one row: a name, a sentence about what breaks, and a function that makes the scene with
//! its lights and its camera. Each group of scenarios is one file. [`open`](crate::open) takes two forms of id:
//!
//! - `stability:NAME` opens the scenario. If the camera moves in it, the scene's path is its first move.
//! - `stability:NAME:MOVE` opens it with the path of another of its moves: `dolly`, `rotation` or `teleport`.
//!
//! A scenario brings all of its lights, and its camera sets lens and planes. Its scenes have hundreds to a few
//! thousand triangles, so that a software adapter can draw them.
//!
//! The numbers are those of the project's list of 34 situations. Scenarios without a number come from reports
//! of engine users.

mod geometry;
mod gloss;
mod indirect;
mod kit;
mod light_data;
mod moves;
mod reported;
mod scenario;
mod shapes;
#[cfg(test)]
mod tests;
mod time;
mod views;

use std::sync::LazyLock;

use crate::{Scene, SceneError};

pub use moves::Move;
pub use scenario::{Figure, Group, PREFIX, Scenario};

/// All scenarios, group by group.
static ALL: LazyLock<Vec<Scenario>> = LazyLock::new(|| {
    [
        geometry::ROWS,
        light_data::ROWS,
        shapes::ROWS,
        views::ROWS,
        time::ROWS,
        gloss::ROWS,
        indirect::ROWS,
        reported::ROWS,
    ]
    .concat()
});

/// All scenarios, group by group.
pub fn list() -> &'static [Scenario] {
    &ALL
}

/// The scenario of a name.
pub fn named(name: &str) -> Option<&'static Scenario> {
    list().iter().find(|scenario| scenario.name == name)
}

/// Opens the scene of an id that starts with [`PREFIX`]; `None` if no scenario has its name.
///
/// # Errors
///
/// [`SceneError::Move`] if the camera does not move as the id asks.
pub(crate) fn open(id: &str, seed: u64) -> Result<Option<Scene>, SceneError> {
    let words = id.strip_prefix(PREFIX).unwrap_or(id);
    let (name, way) = words.split_once(':').map_or((words, None), |(name, way)| (name, Some(way)));
    named(name).map(|scenario| scenario.open(way, seed)).transpose()
}
