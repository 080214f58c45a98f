//! One measured method: its setting, times, lists, image and indirect light.

use serde::{Deserialize, Serialize};

use super::{ImageFigures, ListFigures, Setting, Times, Vpls};
use crate::strategy::StrategyId;

/// One strategy on one scene in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The strategy's id: `DC-I/64x64x24`. Files also hold its family and parameters.
    pub strategy: StrategyId,
    /// Whether a setting of the method loses light on purpose.
    #[serde(default)]
    pub is_lossy: bool,
    /// The scene, the lights, the camera and the mode.
    pub setting: Setting,
    /// Its times.
    pub times: Times,
    /// Figures of its lists, and missed lights.
    pub lists: ListFigures,
    /// The differences and errors of its image.
    pub image: ImageFigures,
    /// The virtual point lights, if there are any: how they were made, their number and their times.
    #[serde(default)]
    pub indirect: Option<Vpls>,
    /// A note for readers of this record.
    #[serde(default)]
    pub note: Option<String>,
}
