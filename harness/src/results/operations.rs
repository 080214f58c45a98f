//! Light operations of a record.

use serde::{Deserialize, Serialize};

/// Light operations, summed over an image: one term of one light at one sample each (Swarbrick 2025,
/// appendix I). Without another word they are *listed* terms: the list of the sample's group names them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Operations {
    /// Diffuse terms that were listed.
    pub diffuse: u64,
    /// Specular terms that were listed.
    pub specular: u64,
    /// Of those, the ones at samples beyond the reach of the light's diffuse term.
    pub outer_specular: u64,
    /// Terms of either kind whose light would be seen, 0 to 2 of each pair of a sample and a listed light,
    /// *whichever terms its list names*.
    pub perceptible: u64,
    /// Of those, the ones that the lists name; `null` in files older than this field.
    #[serde(default)]
    pub perceptible_listed: Option<u64>,
    /// Listed terms that shading evaluated: it leaves out, sample by sample, what adds nothing there.
    /// `null` in files older than this field.
    #[serde(default)]
    pub evaluated: Option<EvaluatedTerms>,
}

/// Terms that shading evaluated, summed over an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvaluatedTerms {
    /// Diffuse terms.
    pub diffuse: u64,
    /// Specular terms.
    pub specular: u64,
    /// Of those, the ones at samples beyond the reach of the light's diffuse term.
    pub outer_specular: u64,
}

impl From<shading::Operations> for Operations {
    fn from(counted: shading::Operations) -> Self {
        let shading::Operations { listed, evaluated, perceptible, perceptible_of_lights } = counted;
        Self {
            diffuse: listed.diffuse,
            specular: listed.specular,
            outer_specular: listed.outer_specular,
            perceptible: perceptible_of_lights,
            perceptible_listed: Some(perceptible),
            evaluated: Some(EvaluatedTerms {
                diffuse: evaluated.diffuse,
                specular: evaluated.specular,
                outer_specular: evaluated.outer_specular,
            }),
        }
    }
}

impl Operations {
    /// Listed terms of both kinds.
    pub fn listed(&self) -> u64 {
        self.diffuse + self.specular
    }
}
