//! Which layers are drawn.

use assign::AssignError;
use scenes::Particle;

/// The thinnest fog, per metre.
pub const MIN_FOG_PER_M: f32 = 1e-6;

/// The thickest fog, per metre.
pub const MAX_FOG_PER_M: f32 = 1e3;

/// The layers of a renderer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerOptions {
    /// Whether the scene's [transparent materials](scenes::Material::is_transparent) are blended. Otherwise they are
    /// drawn as opaque ones.
    pub sheets: bool,
    /// Particles.
    pub particles: Vec<Particle>,
    /// The density of fog: the rate, per metre, at which light decays because the fog scatters it.
    /// [`MIN_FOG_PER_M`] to [`MAX_FOG_PER_M`].
    pub fog_per_m: Option<f32>,
}

impl LayerOptions {
    /// Checks each field.
    pub(super) fn check(&self) -> Result<(), AssignError> {
        let fail = |field: String, value: String, accepted: &str| {
            Err(AssignError::Parameter { field, value, accepted: accepted.into() })
        };
        if let Some(fog) = self.fog_per_m
            && !(MIN_FOG_PER_M..=MAX_FOG_PER_M).contains(&fog)
        {
            return fail("fog".into(), fog.to_string(), "0.000001 to 1000 per metre");
        }
        for (ix, particle) in self.particles.iter().enumerate() {
            let is_sound = particle.position.is_finite()
                && particle.radius_m > 0.0
                && particle.radius_m.is_finite()
                && (0.0..=1.0).contains(&particle.opacity)
                && particle.color.cmpge(glam::Vec3::ZERO).all()
                && particle.color.cmple(glam::Vec3::ONE).all();
            if !is_sound {
                let accepted =
                    "a finite place, a radius above 0, and colour and opacity from 0 to 1";
                return fail(format!("particle {ix}"), format!("{particle:?}"), accepted);
            }
        }
        Ok(())
    }
}

/// Which kinds of layers there are: what shaders are compiled for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerKinds {
    /// Transparent surfaces.
    pub sheets: bool,
    /// Particles.
    pub particles: bool,
    /// Fog.
    pub fog: bool,
}

impl LayerKinds {
    /// Whether there is any layer.
    pub fn any(self) -> bool {
        self.sheets || self.particles || self.fog
    }

    /// Whether anything is blended over the opaque surfaces besides fog.
    pub(super) fn is_blended(self) -> bool {
        self.sheets || self.particles
    }
}
