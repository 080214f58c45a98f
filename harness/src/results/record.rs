//! One measured method: its setting, times, lists and image.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{ImageFigures, ListFigures, Setting, Times};

/// One strategy on one scene in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The strategy's id with its parameters: `DC-I/64x64x24`.
    pub strategy: String,
    /// The strategy's parameters, by name.
    #[serde(default)]
    pub strategy_parameters: BTreeMap<String, serde_json::Value>,
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
