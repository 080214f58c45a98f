//! How lights are shadowed.

use std::{fmt, str::FromStr};

use assign::AssignError;
use serde::{Deserialize, Serialize};

/// The accepted numbers of maps for each area light: the middle, the corners of a rectangle, and the corners of its
/// quads after one to four subdivisions (Dobetsberger 2025, section 6.1).
pub const MAP_COUNTS: [u32; 6] = [1, 4, 9, 25, 81, 289];

/// The accepted numbers of taps: squares of 1 to 5 texels.
pub const TAP_COUNTS: [u32; 5] = [1, 4, 9, 16, 25];

/// The smallest accepted side of a map, texels. The widest filter leaves 12 of 32 texels to a face.
pub const MIN_MAP_PX: u32 = 32;

/// The largest accepted side of a map, texels.
pub const MAX_MAP_PX: u32 = 4096;

/// A model of shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum ShadowModel {
    /// Light passes through surfaces. Nothing is compiled or bound for shadows.
    #[default]
    None,
    /// Depth maps from points of each emitter (Dobetsberger 2025, sections 6.1 and 6.2). Points and spots have one
    /// position, and so one map.
    Maps {
        /// Maps for each area light: one of [`MAP_COUNTS`].
        maps: u32,
        /// Texels on a side of each map face, even, [`MIN_MAP_PX`] to [`MAX_MAP_PX`].
        px: u32,
        /// Texels that are compared for each map, a square around the sample: one of [`TAP_COUNTS`].
        taps: u32,
    },
}

impl ShadowModel {
    /// Whether lights cast shadows.
    pub fn is_on(self) -> bool {
        self != Self::None
    }

    /// Maps for each area light; 0 without shadows.
    pub fn maps(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Maps { maps, .. } => maps,
        }
    }

    /// Taps for each map; 0 without shadows.
    pub fn taps(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Maps { taps, .. } => taps,
        }
    }

    /// Checks each number.
    pub fn check(self) -> Result<(), AssignError> {
        let Self::Maps { maps, px, taps } = self else { return Ok(()) };
        let is_sound = MAP_COUNTS.contains(&maps)
            && (MIN_MAP_PX..=MAX_MAP_PX).contains(&px)
            && px.is_multiple_of(2)
            && TAP_COUNTS.contains(&taps);
        if is_sound { Ok(()) } else { Err(refused(&self.to_string())) }
    }
}

impl fmt::Display for ShadowModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Maps { maps, px, taps: 1 } => write!(f, "maps:{maps},{px}"),
            Self::Maps { maps, px, taps } => write!(f, "maps:{maps},{px},pcf{taps}"),
        }
    }
}

impl FromStr for ShadowModel {
    type Err = AssignError;

    /// Reads what [`Display`](fmt::Display) writes.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let model = match text {
            "none" => Some(Self::None),
            _ => text.strip_prefix("maps:").and_then(maps_of),
        };
        let model = model.ok_or_else(|| refused(text))?;
        model.check().map_err(|_| refused(text))?;
        Ok(model)
    }
}

/// `N,PX` or `N,PX,pcfK`.
fn maps_of(numbers: &str) -> Option<ShadowModel> {
    let parts: Vec<&str> = numbers.split(',').collect();
    let (maps, px, taps) = match parts[..] {
        [maps, px] => (maps, px, "1"),
        [maps, px, taps] => (maps, px, taps.strip_prefix("pcf")?),
        _ => return None,
    };
    let number = |text: &str| {
        // `parse` alone accepts a sign.
        text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
    };
    Some(ShadowModel::Maps { maps: number(maps)?, px: number(px)?, taps: number(taps)? })
}

impl TryFrom<String> for ShadowModel {
    type Error = AssignError;

    fn try_from(text: String) -> Result<Self, AssignError> {
        text.parse()
    }
}

impl From<ShadowModel> for String {
    fn from(model: ShadowModel) -> Self {
        model.to_string()
    }
}

/// The accepted models.
pub const ACCEPTED_SHADOW_MODELS: &str = "none, maps:N,PX or maps:N,PX,pcfK, with N of 1, 4, 9, 25, 81 or 289 maps for \
    each area light, an even PX of 32 to 4096 texels, and K of 1, 4, 9, 16 or 25 taps";

fn refused(value: &str) -> AssignError {
    AssignError::Parameter {
        field: "shadow model".into(),
        value: value.into(),
        accepted: ACCEPTED_SHADOW_MODELS.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        let mut models = vec![ShadowModel::None];
        for maps in MAP_COUNTS {
            for taps in TAP_COUNTS {
                models.push(ShadowModel::Maps { maps, px: 32 * maps.min(128), taps });
            }
        }
        for model in models {
            model.check().unwrap();
            assert_eq!(model.to_string().parse::<ShadowModel>().unwrap(), model);
        }
        let plain = "maps:9,512".parse::<ShadowModel>().unwrap();
        assert_eq!(plain, ShadowModel::Maps { maps: 9, px: 512, taps: 1 });
        assert_eq!("maps:9,512,pcf1".parse::<ShadowModel>().unwrap(), plain);
    }

    #[test]
    fn faulty_models_name_the_value_and_what_is_accepted() {
        for bad in [
            "",
            "None",
            "maps",
            "maps:",
            "maps:4",
            "maps:5,512",
            "maps:4,30",
            "maps:4,513",
            "maps:4,4098",
            "maps:4,512,9",
            "maps:4,512,pcf",
            "maps:4,512,pcf8",
            "maps:4,512,pcf9,1",
            "maps:+4,512",
            "maps:4,99999999999",
            "maps:-4,512",
        ] {
            let error = bad.parse::<ShadowModel>().unwrap_err().to_string();
            let expected = format!("shadow model is {bad}: it must be none, maps:N,PX");
            assert!(error.starts_with(&expected), "{error}");
            for count in MAP_COUNTS.iter().chain(&TAP_COUNTS) {
                assert!(error.contains(&count.to_string()), "{count} is not named: {error}");
            }
        }
    }
}
