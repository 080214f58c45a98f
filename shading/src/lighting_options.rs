//! How lights are evaluated: the options of a lighting pass.

use assign::{AssignError, LightKinds, Shader, Suns};
use serde::{Deserialize, Serialize};

use crate::{AreaModel, ShadowModel};

/// How the lights of a list are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightingOptions {
    /// The kinds of lights that the pass lights.
    pub kinds: LightKinds,
    /// A light is skipped at a sample, before its BRDF, if its fall-off or the cosine of incidence
    /// is at most this.
    ///
    /// 0 skips lights that add nothing because the sample is out of range (the survey's bounding
    /// sphere, Watrous 2024), out of the cone, or behind the horizon. It changes no bit of the
    /// image: a uniform holds the number, so the shader is the same.
    /// [`EVALUATE_ALL`](Self::EVALUATE_ALL) skips nothing. Values above 0 lose light; they compare
    /// with the fall-off per square metre, and with the cosine.
    pub exit_weight: f32,
    /// How the fall-off ends at a light's range.
    pub cut: Cut,
    /// The model that integrates the light of area lights.
    pub area: AreaModel,
    /// Brightness compensation (Archer, Leach, Knowles 2019, section 3.2): a sample's radiance is
    /// multiplied by this number over the number of lights that add something to it, within a
    /// factor of 4. It hides where virtual point lights are dense or sparse. No light emits what it
    /// adds, so it is off (`None`) wherever errors are measured. Off, it changes no bit.
    pub compensation: Option<f32>,
    /// The threshold of stochastic light culling, an irradiance, as in [`Stochastic`](assign::Stochastic). Off
    /// (`None`), it changes no bit.
    pub stochastic: Option<f32>,
    /// The most that the specular term of a point or a spot reaches, in ranges of the light: 1 to
    /// [`MAX_SPECULAR_REACH`](assign::MAX_SPECULAR_REACH). The term ends at the window of
    /// [`specular_reach`](assign::specular_reach) times the range, which depends on the sample's material and its angle
    /// to the eye. A strategy must [list lights as far](assign::Assignment::specular_reach). Off (`None`), it ends with
    /// the diffuse term, and nothing is compiled for it.
    pub specular_reach: Option<f32>,
    /// The solid angle, steradians, below which an area light is a point of the same flux: above 0 and at most 2 pi.
    /// On a surface of a GGX alpha below 1/2, it shrinks by 4 alpha^2. **Lossy**: the smaller the solid angle, the
    /// smaller the error (METHODOLOGY has figures). Off (`None`), nothing is compiled for it.
    pub area_lod: Option<f32>,
    /// Suns light every sample in addition to its list. Without suns, none of their code is
    /// compiled and nothing is bound for them.
    pub suns: Suns,
    /// How lights are shadowed. Other than [`ShadowModel::None`], it must be the model of the renderer's maps
    /// ([`Renderer::cast_shadows`](crate::Renderer::cast_shadows)), with these suns. Off, nothing is
    /// compiled or bound for it.
    pub shadows: ShadowModel,
}

/// How a light's fall-off ends at its range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cut {
    /// Smoothly: inverse square times `(1 - (d / range)^4)^2`.
    #[default]
    Windowed,
    /// Abruptly: inverse square up to the range, 0 beyond.
    Hard,
    /// Not at all: inverse square at any distance. Lists still end at the range, so every strategy that culls
    /// **loses light**, and the edges of its groups show (Watrous 2024, figure 3).
    Never,
}

impl Cut {
    /// The name in results: `windowed`, `hard` or `never`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Windowed => "windowed",
            Self::Hard => "hard",
            Self::Never => "never",
        }
    }
}

impl LightingOptions {
    /// The [`exit_weight`](Self::exit_weight) with which every light of a list is evaluated.
    pub const EVALUATE_ALL: f32 = -1.0;

    /// How far from a light a sample may lie to which it adds something, in ranges of the light.
    pub fn ranges_lit(&self) -> f32 {
        match self.cut {
            Cut::Never => f32::INFINITY,
            Cut::Windowed | Cut::Hard => self.specular_reach.unwrap_or(1.0).max(1.0),
        }
    }

    /// Checks the solid angle below which area lights are points.
    pub(crate) fn check_area_lod(&self) -> Result<(), AssignError> {
        match self.area_lod {
            Some(angle) if !(angle > 0.0 && angle <= std::f32::consts::TAU) => {
                Err(AssignError::Parameter {
                    field: "area light LOD".into(),
                    value: format!("{angle} steradians"),
                    accepted: "above 0 and at most 2 pi".into(),
                })
            }
            _ => Ok(()),
        }
    }

    /// Sets the shader flags that these options need.
    pub(crate) fn set_flags(self, shader: Shader<'_>) -> Shader<'_> {
        let shader = shader
            .light_kinds(self.kinds)
            .flag("hard_cut", self.cut == Cut::Hard)
            .flag("no_cut", self.cut == Cut::Never)
            .flag("compensation", self.compensation.is_some())
            .flag("stochastic", self.stochastic.is_some())
            .flag("specular_reach", self.specular_reach.is_some())
            .flag("area_lod", self.kinds.areas && self.area_lod.is_some())
            .flag("suns", !self.suns.is_empty())
            .flag("shadows", self.shadows.is_on())
            .flag("shadow_rays", self.shadows.casts_rays())
            .flag("pcss", self.shadows.is_soft())
            .flag("paraboloids", self.shadows.is_curved());
        let flags = self.area.flags().iter();
        flags.fold(shader, |shader, flag| shader.flag(flag, self.kinds.areas))
    }
}
