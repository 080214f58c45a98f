//! The laws of motion by name.

use std::{fmt, str::FromStr};

use crate::SceneError;

/// How lights move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MotionLaw {
    /// Each light wanders smoothly around its place.
    Drift,
    /// Each light circles around its place.
    Orbit,
    /// All lights drift, and one in four jumps to random places.
    Teleport,
    /// The intensity of each light changes.
    Flicker,
    /// Lights are born and die.
    Births,
    /// Spots, area lights and virtual point lights turn.
    Turn,
    /// Each light follows one of the other laws.
    All,
}

impl MotionLaw {
    /// Every law, in the order in which help lists them.
    pub const LIST: [Self; 7] = [
        Self::Drift,
        Self::Orbit,
        Self::Teleport,
        Self::Flicker,
        Self::Births,
        Self::Turn,
        Self::All,
    ];

    /// Its name, as people write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drift => "drift",
            Self::Orbit => "orbit",
            Self::Teleport => "teleport",
            Self::Flicker => "flicker",
            Self::Births => "births",
            Self::Turn => "turn",
            Self::All => "all",
        }
    }

    /// What it does, in one sentence.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Drift => {
                "Each light wanders smoothly around its place, at the given speed or slower."
            }
            Self::Orbit => "Each light circles around its place at the given speed.",
            Self::Teleport => {
                "All lights drift, and one in four also jumps to a random place in the box, on \
                 average once per three quarters of the box's diagonal at the given speed."
            }
            Self::Flicker => {
                "The intensity of each light swings and jumps between a sixteenth and all of its \
                 own, with up to one swing and two jumps per metre at the given speed."
            }
            Self::Births => {
                "Lights die and are born again at random places in the box, each on average once \
                 per three quarters of the box's diagonal at the given speed; a quarter of them \
                 is missing at any time."
            }
            Self::Turn => {
                "Spots, area lights and virtual point lights turn around an axis: a point one \
                 metre from the axis has the given speed. Point lights stay."
            }
            Self::All => "Each light follows one of the other six laws, chosen at random.",
        }
    }
}

impl fmt::Display for MotionLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for MotionLaw {
    type Err = SceneError;

    fn from_str(text: &str) -> Result<Self, SceneError> {
        Self::LIST.into_iter().find(|law| law.name() == text).ok_or_else(|| {
            let short: String = text.chars().take(60).collect();
            SceneError::OutOfRange {
                field: "motion of lights",
                value: format!("{short:?}"),
                accepted: "drift, orbit, teleport, flicker, births, turn or all",
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_and_errors_list_them_all() {
        let error = "wobble\n".parse::<MotionLaw>().expect_err("no such law").to_string();
        assert!(error.starts_with("motion of lights is \"wobble\\n\": it must be "), "{error}");
        for law in MotionLaw::LIST {
            assert_eq!(law.to_string().parse::<MotionLaw>().expect("its own name"), law);
            assert!(error.contains(law.name()), "{error}");
            assert!(law.summary().ends_with('.'), "{law}");
        }
        assert!("Drift".parse::<MotionLaw>().is_err());
    }
}
