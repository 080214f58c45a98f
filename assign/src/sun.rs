//! Suns: lights so far away that the whole scene sees them in one direction.
//!
//! A sun reaches every sample, so every list of every strategy would hold it. Suns are therefore
//! kept outside the lists: a shader sums the list's lights and then adds the suns in their order.

use glam::Vec3;

use crate::{AssignError, LightFault};

/// The most suns of a scene. Shaders evaluate all of them at every sample.
pub const MAX_SUNS: usize = 8;

/// The greatest accepted irradiance of a channel. GGX's peak multiplies it by up to 8e4.
pub const MAX_IRRADIANCE: f32 = 1e18;

/// A light from one direction (KHR_lights_punctual's `directional`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sun {
    /// Unit vector along which its light travels, world space.
    pub direction: Vec3,
    /// Irradiance of a surface that faces the sun, linear RGB, each channel 0 to [`MAX_IRRADIANCE`]
    /// and not all 0.
    pub irradiance: Vec3,
}

impl Sun {
    /// Checks every field.
    ///
    /// # Errors
    ///
    /// A [`LightFault`] that names the first faulty field.
    pub fn check(&self) -> Result<(), LightFault> {
        let out = |field, value, accepted| Err(LightFault::OutOfRange { field, value, accepted });
        for (field, v) in [("sun direction", self.direction), ("sun irradiance", self.irradiance)] {
            if let Some(value) = v.to_array().into_iter().find(|x| !x.is_finite()) {
                return Err(LightFault::NotFinite { field, value });
            }
        }
        let length = self.direction.length();
        if (length - 1.0).abs() > 1e-3 {
            return out("sun direction", length, "of length 1");
        }
        let [least, greatest] = [self.irradiance.min_element(), self.irradiance.max_element()];
        if least < 0.0 {
            return out("sun irradiance", least, "0 or more");
        }
        if greatest > MAX_IRRADIANCE {
            return out("sun irradiance", greatest, "at most 1e18");
        }
        if greatest == 0.0 {
            return out("sun irradiance", 0.0, "above 0 in some channel");
        }
        Ok(())
    }
}

/// The suns of a scene: at most [`MAX_SUNS`], none faulty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Suns {
    suns: [Sun; MAX_SUNS],
    count: usize,
}

impl Suns {
    /// Takes suns in the order of a slice.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if there are too many or one is faulty.
    pub fn new(suns: &[Sun]) -> Result<Self, AssignError> {
        let refuse = |value: String, accepted: String| {
            Err(AssignError::Parameter { field: "suns".into(), value, accepted })
        };
        if suns.len() > MAX_SUNS {
            return refuse(suns.len().to_string(), format!("at most {MAX_SUNS}"));
        }
        if let Some(fault) = suns.iter().find_map(|sun| sun.check().err()) {
            return refuse(fault.to_string(), "without faults".into());
        }
        let mut all = Self { count: suns.len(), ..Self::default() };
        all.suns[..suns.len()].copy_from_slice(suns);
        Ok(all)
    }

    /// Whether the scene has no sun.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// All suns.
    pub fn as_slice(&self) -> &[Sun] {
        &self.suns[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_field_and_value() {
        let sun = Sun { direction: Vec3::NEG_Y, irradiance: Vec3::ONE };
        assert_eq!(sun.check(), Ok(()));
        let message = |sun: Sun| sun.check().unwrap_err().to_string();
        let lit = |irradiance| Sun { irradiance, ..sun };
        let black = message(lit(Vec3::ZERO));
        assert_eq!(black, "sun irradiance is 0: it must be above 0 in some channel");
        assert_eq!(message(lit(Vec3::NEG_X)), "sun irradiance is -1: it must be 0 or more");
        assert!(message(lit(Vec3::splat(1e30))).ends_with("at most 1e18"));
        assert!(message(lit(Vec3::NAN)).contains("NaN: it must be finite"));
        assert!(message(Sun { direction: Vec3::ZERO, ..sun }).contains("direction is 0"));
    }

    #[test]
    fn at_most_eight_suns_without_faults() {
        let sun = Sun { direction: Vec3::NEG_Y, irradiance: Vec3::ONE };
        assert_eq!(Suns::new(&[sun; 8]).unwrap().as_slice(), [sun; 8]);
        assert_eq!(
            Suns::new(&[sun; 9]).unwrap_err().to_string(),
            "suns is 9: it must be at most 8"
        );
        let faulty = Suns::new(&[sun, Sun::default()]).unwrap_err().to_string();
        assert!(faulty.contains("sun direction is 0"), "{faulty}");
        assert!(Suns::new(&[]).unwrap().is_empty());
    }
}
