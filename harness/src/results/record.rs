//! One measured method: what was asked, and what came of it.

use serde::{Deserialize, Serialize};

use super::{ImageFigures, ListFigures, Setting, Times};
use crate::strategy::StrategyId;

/// One strategy on one scene in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The strategy's id: `DC-I/64x64x24`. Files hold its family and parameters beside it.
    pub strategy: StrategyId,
    /// Whether a knob of the method loses light on purpose.
    #[serde(default)]
    pub is_lossy: bool,
    /// What is drawn, with which lights, from where: the same for all methods of a run.
    pub setting: Setting,
    /// How long it took.
    pub times: Times,
    /// What its lists hold, and whether they hold enough.
    pub lists: ListFigures,
    /// How far its image is from what it should be.
    pub image: ImageFigures,
    /// What a reader of this record has to know.
    #[serde(default)]
    pub note: Option<String>,
}
