//! Why a record certifies nothing.

use serde::{Deserialize, Serialize};

use super::Record;

/// Why a run put no list and no image to a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Untested {
    /// No pixel shows a surface.
    NoSurface,
    /// No light reaches a surface that a pixel shows.
    NoLight,
    /// Only suns light what is seen: they stand beside the lists, which hold nothing here.
    OnlySuns,
}

impl Untested {
    /// Why, as a sentence without its full stop.
    pub fn words(self, lights: u64, along_path: bool) -> &'static str {
        match (self, along_path) {
            (Self::NoSurface, false) => "the view shows no surface",
            (Self::NoSurface, true) => "no compared view along the path shows a surface",
            (Self::NoLight, _) if lights == 0 => "there is no light",
            (Self::NoLight, false) => "no light reaches what the view shows",
            (Self::NoLight, true) => "no light reaches what the compared views along the path show",
            (Self::OnlySuns, _) => "only suns light what is seen, and they stand in no list",
        }
    }
}

impl Record {
    /// Why nothing can be said of the methods of its run; `None` where they were tested, or where the
    /// record is older than this question.
    pub fn untested_words(&self) -> Option<&'static str> {
        self.lists.untested.map(|why| why.words(self.setting.lights, self.setting.along_path))
    }
}
