//! The frames that lighting can be part of: which passes are drawn before it, and how it runs.

use assign::Needs;
use serde::{Deserialize, Serialize};

/// How pixels are lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// A depth pre-pass and a G-buffer, then one compute thread per pixel. The models of pixels take a
    /// pass of their own, which only strategies that need them draw.
    Deferred,
    /// The same with the model of each pixel in the G-buffer, drawn for every strategy.
    DeferredIds,
    /// A depth pre-pass, then lit fragments.
    Forward,
    /// Lit fragments that test and write depth themselves, so that hidden surfaces are lit as well
    /// where they are drawn first. Only strategies that read the surfaces draw a depth pre-pass.
    ForwardNoPrepass,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Deferred, Self::DeferredIds, Self::Forward, Self::ForwardNoPrepass];

    /// Its name in results: `deferred`, `deferred-ids`, `forward` or `forward-no-prepass`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Deferred => "deferred",
            Self::DeferredIds => "deferred-ids",
            Self::Forward => "forward",
            Self::ForwardNoPrepass => "forward-no-prepass",
        }
    }

    /// Whether fragments are lit as they are drawn.
    pub fn is_forward(self) -> bool {
        matches!(self, Self::Forward | Self::ForwardNoPrepass)
    }

    /// Whether depth is drawn before lighting, for a strategy that reads this.
    pub fn has_prepass(self, needs: Needs) -> bool {
        self != Self::ForwardNoPrepass || needs.depth || needs.normals || needs.materials
    }

    /// Whether a G-buffer is drawn, for a strategy that reads this.
    pub fn has_gbuffer(self, needs: Needs) -> bool {
        !self.is_forward() || needs.normals || needs.materials
    }

    /// Whether the models of pixels are drawn in a pass of their own, for a strategy that reads this.
    /// Fragments know their model.
    pub fn has_model_pass(self, needs: Needs) -> bool {
        self == Self::Deferred && needs.models
    }
}
