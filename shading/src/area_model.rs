//! How the light of an area light is integrated over its emitter.

use serde::{Deserialize, Serialize};

/// A model of area lights, from the floor up.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum AreaModel {
    /// All light comes from the emitter's middle.
    #[default]
    Point,
}

impl AreaModel {
    /// All of them.
    pub const ALL: [Self; 1] = [Self::Point];

    /// The flag that compiles it.
    pub(crate) fn flag(self) -> &'static str {
        match self {
            Self::Point => "area_point",
        }
    }
}
