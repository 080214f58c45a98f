//! One measured method: its setting, times, lists and image.

use serde::{Deserialize, Serialize};

use super::{ImageFigures, ListFigures, Setting, Times};
use crate::strategy::StrategyId;

/// One strategy on one scene in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The strategy's id: `DC-I/64x64x24`. Files also hold its family and parameters.
    pub strategy: StrategyId,
    /// Whether a setting of the method loses light on purpose.
    #[serde(default)]
    pub is_lossy: bool,
    /// The scene, the lights and the camera, equal for all methods of a run.
    pub setting: Setting,
    /// Its times.
    pub times: Times,
    /// Figures of its lists, and missed lights.
    pub lists: ListFigures,
    /// The differences and errors of its image.
    pub image: ImageFigures,
    /// A note for readers of this record.
    #[serde(default)]
    pub note: Option<String>,
}
