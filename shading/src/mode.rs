//! How pixels are lit: the passes before lighting, and the stage that runs it.

use assign::Needs;
use serde::{Deserialize, Serialize};

/// How pixels are lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// A depth pre-pass and a G-buffer, then one compute thread per pixel. The models of pixels are
    /// drawn in a separate pass, and only for strategies that need them.
    Deferred,
    /// The same, but the G-buffer holds the model of each pixel, for every strategy.
    DeferredIds,
    /// A depth pre-pass, then fragments that light.
    Forward,
    /// Fragments that light, and that test and write depth themselves. Hidden surfaces are lit too
    /// if they are drawn first. A depth pre-pass is drawn only for strategies that read surfaces.
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

    /// Whether fragments light pixels while they are drawn.
    pub fn is_forward(self) -> bool {
        matches!(self, Self::Forward | Self::ForwardNoPrepass)
    }

    /// Whether depth is drawn before lighting, for a strategy with these needs.
    pub fn has_prepass(self, needs: Needs) -> bool {
        self != Self::ForwardNoPrepass || needs.depth || needs.normals || needs.materials
    }

    /// Whether a G-buffer is drawn, for a strategy with these needs.
    pub fn has_gbuffer(self, needs: Needs) -> bool {
        !self.is_forward() || needs.normals || needs.materials
    }

    /// Whether the models of pixels are drawn in a separate pass, for a strategy with these needs.
    /// In forward modes, fragments know their model.
    pub fn has_model_pass(self, needs: Needs) -> bool {
        self == Self::Deferred && needs.models
    }
}
