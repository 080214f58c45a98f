//! How the light of an area light is integrated over its emitter.

use std::{fmt, str::FromStr};

use assign::AssignError;
use serde::{Deserialize, Serialize};

use crate::ltc::Masking;

/// The most samples of [`AreaModel::MonteCarlo`].
pub const MAX_AREA_SAMPLES: u32 = 4096;

/// A model of area lights. From the cheapest to the most exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum AreaModel {
    /// All light comes from the emitter's middle.
    Point,
    /// The most representative point of each term (Drobot 2014), weighted by solid angles that
    /// `area_mrp.wesl` derives.
    Mrp,
    /// The most representative point with the weights of Dobetsberger 2025, section 5.3: the cone of
    /// equation 5.5 for the specular term.
    MrpPublished,
    /// Linearly transformed cosines. Each sample looks its matrix up once, in the fitted table.
    #[default]
    LtcTable,
    /// The same with a table fitted to GGX with Hammon's approximate masking, which some engines
    /// use. The truth still uses the exact masking (Dobetsberger 2025, table 5.1).
    LtcHammon,
    /// The table, without splitting edges that span more than a right angle (Dobetsberger 2025,
    /// section 5.4.4, before the fix).
    LtcUnsplit,
    /// The table, looked up once per light and sample. Its image equals that of [`Self::LtcTable`],
    /// bit for bit.
    LtcPerLight,
    /// Matrices from the fitted polynomials, evaluated once per sample.
    LtcPolynomial,
    /// The polynomials, evaluated once per light and sample. Its image equals that of
    /// [`Self::LtcPolynomial`], bit for bit.
    LtcPolynomialPerLight,
    /// Random samples over the spherical rectangle: the integral itself, with noise.
    MonteCarlo {
        /// Samples per light, 1 to [`MAX_AREA_SAMPLES`].
        samples: u32,
    },
    /// The same, but specular samples come only from the part that the surface mirrors
    /// (Dobetsberger 2025, section 5.2). It has less noise and is biased.
    MonteCarloReflected {
        /// Samples per light, 1 to [`MAX_AREA_SAMPLES`].
        samples: u32,
    },
}

/// The number of samples if none is given.
const DEFAULT_SAMPLES: u32 = 16;

impl AreaModel {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Point,
        Self::Mrp,
        Self::MrpPublished,
        Self::LtcTable,
        Self::LtcHammon,
        Self::LtcUnsplit,
        Self::LtcPerLight,
        Self::LtcPolynomial,
        Self::LtcPolynomialPerLight,
        Self::MonteCarlo { samples: DEFAULT_SAMPLES },
        Self::MonteCarloReflected { samples: DEFAULT_SAMPLES },
    ];

    /// The flags that compile this model, together with `areas`.
    pub fn flags(self) -> &'static [&'static str] {
        match self {
            Self::Point => &["area_point"],
            Self::Mrp => &["area_mrp"],
            Self::MrpPublished => &["area_mrp_published"],
            Self::LtcTable | Self::LtcHammon => &["area_ltc_table"],
            Self::LtcUnsplit => &["area_ltc_table", "ltc_unsplit"],
            Self::LtcPerLight => &["area_ltc_table", "ltc_per_light"],
            Self::LtcPolynomial => &["area_ltc_polynomial"],
            Self::LtcPolynomialPerLight => &["area_ltc_polynomial", "ltc_per_light"],
            Self::MonteCarlo { .. } => &["area_monte_carlo"],
            Self::MonteCarloReflected { .. } => &["area_monte_carlo", "area_reflected"],
        }
    }

    /// The masking of the table that shading looks up; `None` if it looks none up.
    pub fn table(self) -> Option<Masking> {
        match self {
            Self::LtcTable | Self::LtcUnsplit | Self::LtcPerLight => Some(Masking::Correlated),
            Self::LtcHammon => Some(Masking::Hammon),
            _ => None,
        }
    }

    /// Samples per light; 0 if the model draws none.
    pub fn samples(self) -> u32 {
        match self {
            Self::MonteCarlo { samples } | Self::MonteCarloReflected { samples } => samples,
            _ => 0,
        }
    }

    /// Checks the number of samples.
    pub fn check(self) -> Result<(), AssignError> {
        match self {
            Self::MonteCarlo { samples } | Self::MonteCarloReflected { samples }
                if !(1..=MAX_AREA_SAMPLES).contains(&samples) =>
            {
                Err(refused(&self.to_string()))
            }
            _ => Ok(()),
        }
    }

    /// The name without a number of samples.
    fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Mrp => "mrp",
            Self::MrpPublished => "mrp-published",
            Self::LtcTable => "ltc",
            Self::LtcHammon => "ltc-hammon",
            Self::LtcUnsplit => "ltc-unsplit",
            Self::LtcPerLight => "ltc-per-light",
            Self::LtcPolynomial => "ltc-polynomial",
            Self::LtcPolynomialPerLight => "ltc-polynomial-per-light",
            Self::MonteCarlo { .. } => "monte-carlo",
            Self::MonteCarloReflected { .. } => "monte-carlo-reflected",
        }
    }

    fn with_samples(self, samples: u32) -> Option<Self> {
        match self {
            Self::MonteCarlo { .. } => Some(Self::MonteCarlo { samples }),
            Self::MonteCarloReflected { .. } => Some(Self::MonteCarloReflected { samples }),
            _ => None,
        }
    }
}

impl fmt::Display for AreaModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        match self.samples() {
            _ if self.with_samples(1).is_none() => Ok(()),
            samples => write!(f, ":{samples}"),
        }
    }
}

impl FromStr for AreaModel {
    type Err = AssignError;

    /// Reads what [`Display`](fmt::Display) writes. A sampling model without a number draws 16
    /// samples.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let (name, samples) = match text.split_once(':') {
            Some((name, samples)) => (name, Some(samples)),
            None => (text, None),
        };
        let known = Self::ALL.into_iter().find(|model| model.name() == name);
        let model = match samples {
            None => known,
            Some(samples) => known
                .zip(samples.parse().ok())
                .and_then(|(model, samples)| model.with_samples(samples)),
        };
        let model = model.ok_or_else(|| refused(text))?;
        model.check()?;
        Ok(model)
    }
}

impl TryFrom<String> for AreaModel {
    type Error = AssignError;

    fn try_from(text: String) -> Result<Self, AssignError> {
        text.parse()
    }
}

impl From<AreaModel> for String {
    fn from(model: AreaModel) -> Self {
        model.to_string()
    }
}

/// The accepted names.
pub const ACCEPTED_AREA_MODELS: &str = "point, mrp, mrp-published, ltc, ltc-hammon, ltc-unsplit, \
    ltc-per-light, ltc-polynomial, ltc-polynomial-per-light, monte-carlo:SAMPLES or \
    monte-carlo-reflected:SAMPLES, 1 to 4096 samples";

fn refused(value: &str) -> AssignError {
    AssignError::Parameter {
        field: "area model".into(),
        value: value.into(),
        accepted: ACCEPTED_AREA_MODELS.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for model in AreaModel::ALL {
            assert_eq!(model.to_string().parse::<AreaModel>().unwrap(), model);
        }
        assert_eq!("monte-carlo".parse::<AreaModel>().unwrap().samples(), 16);
        for bad in ["", "LTC", "ltc:3", "monte-carlo:0", "monte-carlo:4097", "mrp:1"] {
            let error = bad.parse::<AreaModel>().unwrap_err().to_string();
            assert!(error.contains("area model") && error.contains("4096"), "{bad}: {error}");
            for model in AreaModel::ALL {
                assert!(error.contains(model.name()), "{model} is not named: {error}");
            }
        }
    }
}
