//! How the light of an area light is integrated over its emitter.

use std::{fmt, str::FromStr};

use assign::AssignError;
use serde::{Deserialize, Serialize};

/// A model of area lights, from the floor up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AreaModel {
    /// All light comes from the emitter's middle.
    Point,
    /// Linearly transformed cosines, their matrices looked up in the fitted table.
    #[default]
    LtcTable,
    /// The same, their matrices from the fitted polynomials.
    LtcPolynomial,
}

impl AreaModel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Point, Self::LtcTable, Self::LtcPolynomial];

    /// The flag that compiles it, together with `areas`.
    pub fn flag(self) -> &'static str {
        match self {
            Self::Point => "area_point",
            Self::LtcTable => "area_ltc_table",
            Self::LtcPolynomial => "area_ltc_polynomial",
        }
    }
}

impl fmt::Display for AreaModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Point => "point",
            Self::LtcTable => "ltc",
            Self::LtcPolynomial => "ltc-polynomial",
        })
    }
}

impl FromStr for AreaModel {
    type Err = AssignError;

    /// Reads what [`Display`](fmt::Display) writes.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let known = Self::ALL.into_iter().find(|model| model.to_string() == text);
        known.ok_or_else(|| AssignError::Parameter {
            field: "area model".into(),
            value: text.into(),
            accepted: Self::ALL.map(|model| model.to_string()).join(", "),
        })
    }
}
