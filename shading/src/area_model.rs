//! How the light of an area light is integrated over its emitter.

use std::{fmt, str::FromStr};

use assign::AssignError;
use serde::{Deserialize, Serialize};

/// The most samples of [`AreaModel::MonteCarlo`].
pub const MAX_AREA_SAMPLES: u32 = 4096;

/// A model of area lights, from the floor up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum AreaModel {
    /// All light comes from the emitter's middle.
    Point,
    /// The most representative point of each term (Drobot 2014; Dobetsberger 2025, section 5.3).
    Mrp,
    /// Linearly transformed cosines, their matrices looked up in the fitted table.
    #[default]
    LtcTable,
    /// The same, their matrices from the fitted polynomials.
    LtcPolynomial,
    /// Samples over the spherical rectangle: the integral itself, with noise.
    MonteCarlo {
        /// Samples of a light, 1 to [`MAX_AREA_SAMPLES`].
        samples: u32,
    },
}

/// Samples where none are named.
const DEFAULT_SAMPLES: u32 = 16;

impl AreaModel {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Point,
        Self::Mrp,
        Self::LtcTable,
        Self::LtcPolynomial,
        Self::MonteCarlo { samples: DEFAULT_SAMPLES },
    ];

    /// The flag that compiles it, together with `areas`.
    pub fn flag(self) -> &'static str {
        match self {
            Self::Point => "area_point",
            Self::Mrp => "area_mrp",
            Self::LtcTable => "area_ltc_table",
            Self::LtcPolynomial => "area_ltc_polynomial",
            Self::MonteCarlo { .. } => "area_monte_carlo",
        }
    }

    /// Samples of a light; 0 where none are drawn.
    pub(crate) fn samples(self) -> u32 {
        match self {
            Self::MonteCarlo { samples } => samples,
            _ => 0,
        }
    }

    /// Checks the number of samples.
    pub fn check(self) -> Result<(), AssignError> {
        match self {
            Self::MonteCarlo { samples } if !(1..=MAX_AREA_SAMPLES).contains(&samples) => {
                Err(refused(&self.to_string()))
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for AreaModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point => f.write_str("point"),
            Self::Mrp => f.write_str("mrp"),
            Self::LtcTable => f.write_str("ltc"),
            Self::LtcPolynomial => f.write_str("ltc-polynomial"),
            Self::MonteCarlo { samples } => write!(f, "monte-carlo:{samples}"),
        }
    }
}

impl FromStr for AreaModel {
    type Err = AssignError;

    /// Reads what [`Display`](fmt::Display) writes; `monte-carlo` alone draws 16 samples.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let model = match text.split_once(':') {
            Some(("monte-carlo", samples)) => {
                samples.parse().ok().map(|samples| Self::MonteCarlo { samples })
            }
            None if text == "monte-carlo" => Some(Self::MonteCarlo { samples: DEFAULT_SAMPLES }),
            _ => Self::ALL.into_iter().find(|model| model.to_string() == text),
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

fn refused(value: &str) -> AssignError {
    AssignError::Parameter {
        field: "area model".into(),
        value: value.into(),
        accepted: "point, mrp, ltc, ltc-polynomial or monte-carlo:SAMPLES, 1 to 4096".into(),
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
        for bad in ["", "LTC", "ltc:3", "monte-carlo:0", "monte-carlo:4097", "monte-carlo:x"] {
            let error = bad.parse::<AreaModel>().unwrap_err().to_string();
            assert!(error.contains("area model") && error.contains("4096"), "{bad}: {error}");
        }
    }
}
