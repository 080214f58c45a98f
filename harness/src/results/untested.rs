//! Why a run tested nothing.

use serde::{Deserialize, Serialize};

/// Why a run tested no list and no image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Untested {
    /// No pixel shows a surface.
    NoSurface,
    /// No light reaches a visible surface.
    NoLight,
    /// Only suns light the visible surfaces. Suns stand in no list, so all lists are empty here.
    OnlySuns,
}

impl Untested {
    /// The reason as a sentence without its full stop.
    pub fn words(self, lights: u64, along_path: bool) -> &'static str {
        match (self, along_path) {
            (Self::NoSurface, false) => "the view shows no surface",
            (Self::NoSurface, true) => "no compared view along the path shows a surface",
            (Self::NoLight, _) if lights == 0 => "there is no light",
            (Self::NoLight, false) => "no light reaches a surface in the view",
            (Self::NoLight, true) => {
                "no light reaches a surface in the compared views along the path"
            }
            (Self::OnlySuns, _) => {
                "only suns light the visible surfaces, and suns stand in no list"
            }
        }
    }
}
