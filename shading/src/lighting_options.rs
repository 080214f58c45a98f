//! How lights are evaluated: the options of a lighting pass.

use assign::{LightKinds, Shader, Suns};
use serde::{Deserialize, Serialize};

use crate::AreaModel;

/// How the lights of a list are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightingOptions {
    /// The kinds of lights that it lights.
    pub kinds: LightKinds,
    /// A light is left out of a sample, before its BRDF, where its fall-off or the cosine of
    /// incidence is at most this. 0 leaves out what adds nothing, out of range (the survey's
    /// bounding sphere, Watrous 2024), cone or horizon, and changes no bit of the image, for the
    /// shader is one, told by a uniform; [`EVALUATE_ALL`](Self::EVALUATE_ALL) leaves out nothing.
    /// Anything above 0 loses light: per square metre of the fall-off, and as a cosine.
    pub exit_weight: f32,
    /// How the fall-off ends at a light's range.
    pub cut: Cut,
    /// How the light of area lights is integrated.
    pub area: AreaModel,
    /// Brightness compensation (Archer, Leach, Knowles 2019, section 3.2): a sample's radiance times
    /// this number over that of the lights that add something to it, within a factor of 4. It hides
    /// where virtual point lights lie thick or thin, and is no light that anything sends: `None`,
    /// which changes no bit, wherever errors are measured.
    pub compensation: Option<f32>,
    /// Suns, which light every sample beside its list; without any, nothing of them is compiled or
    /// bound.
    pub suns: Suns,
}

/// How a light's fall-off ends at its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cut {
    /// Smoothly: times `(1 - (d / range)^4)^2`.
    #[default]
    Windowed,
    /// At once: inverse square up to the range, 0 beyond.
    Hard,
}

impl Cut {
    /// As in results: `windowed` or `hard`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Windowed => "windowed",
            Self::Hard => "hard",
        }
    }
}

impl LightingOptions {
    /// The [`exit_weight`](Self::exit_weight) with which every light of a list is evaluated.
    pub const EVALUATE_ALL: f32 = -1.0;

    /// Compiles what they ask for.
    pub(crate) fn set_flags(self, shader: Shader<'_>) -> Shader<'_> {
        let shader = shader
            .light_kinds(self.kinds)
            .flag("hard_cut", self.cut == Cut::Hard)
            .flag("compensation", self.compensation.is_some())
            .flag("suns", !self.suns.is_empty());
        let flags = self.area.flags().iter();
        flags.fold(shader, |shader, flag| shader.flag(flag, self.kinds.areas))
    }
}
