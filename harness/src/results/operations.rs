//! Light operations of a record.

use serde::{Deserialize, Serialize};

/// Light operations, summed over an image. One operation is one term of one light at one sample (Swarbrick
/// 2025, appendix I). *Listed* operations stand in the list of the sample's group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Operations {
    /// Listed diffuse terms.
    pub diffuse: u64,
    /// Listed specular terms.
    pub specular: u64,
    /// The specular terms among them at samples beyond the range of the light's diffuse term.
    pub outer_specular: u64,
    /// Terms of both kinds that change the image: 0 to 2 per pair of a sample and a listed light, *even if the
    /// list names only one term*.
    pub perceptible: u64,
    /// The listed terms among them; `null` in files older than this field.
    #[serde(default)]
    pub perceptible_listed: Option<u64>,
    /// Listed terms that shading evaluated; at each sample it skips terms that add nothing. `null` in files
    /// older than this field.
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
    /// The specular terms among them at samples beyond the range of the light's diffuse term.
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
        self.diffuse.saturating_add(self.specular)
    }
}
