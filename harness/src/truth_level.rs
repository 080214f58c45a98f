//! How much of a comparison is checked on the CPU.

use serde::{Deserialize, Serialize};

/// How much of a run was checked against the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TruthLevel {
    /// Every (light, sample) pair, on the CPU in f64.
    Full,
    /// Images only.
    None,
}

impl TruthLevel {
    /// The name on the command line and in `results.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::None => "none",
        }
    }
}
