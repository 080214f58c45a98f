//! How lights are shadowed.

use std::{fmt, str::FromStr};

use assign::AssignError;
use serde::{Deserialize, Serialize};

/// The accepted numbers of maps for each area light: the middle, the corners of a rectangle, and the corners of its
/// quads after one to four subdivisions (Dobetsberger 2025, section 6.1).
pub const MAP_COUNTS: [u32; 6] = [1, 4, 9, 25, 81, 289];

/// The accepted numbers of rays to each area light: those of maps, and the corners of three by three quads.
pub const RAY_COUNTS: [u32; 7] = [1, 4, 9, 16, 25, 81, 289];

/// The accepted numbers of taps: squares of 1 to 5 texels.
pub const TAP_COUNTS: [u32; 5] = [1, 4, 9, 16, 25];

/// The accepted numbers of taps of a soft filter.
pub const SOFT_TAP_COUNTS: [u32; 6] = [4, 9, 16, 25, 49, 81];

/// The smallest accepted side of a map, texels. The widest filter leaves 12 of 32 texels to a face.
pub const MIN_MAP_PX: u32 = 32;

/// The largest accepted side of a map, texels.
pub const MAX_MAP_PX: u32 = 4096;

/// The accepted divisors of the viewport for the test of bands: 1 tests every pixel, 16 one in 256.
pub const BAND_DIVISORS: [u32; 5] = [1, 2, 4, 8, 16];

/// The fewest maps of a rectangle that is subdivided: its corners.
pub const FEWEST_ADAPTIVE: u32 = MAP_COUNTS[1];

/// The most maps of a rectangle that is subdivided: the corners of its quads after four subdivisions.
pub const MOST_ADAPTIVE: u32 = MAP_COUNTS[5];

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
    /// Depth maps whose filter is as wide as the penumbra: percentage-closer soft shadows (Fernando 2005). Each map looks
    /// for what hides its part of the emitter, and the mean distance of that gives the width. Meant for one map for each
    /// area light. Lights without an area have hard shadows.
    Pcss {
        /// Maps for each area light: one of [`MAP_COUNTS`]. Each is drawn from the middle of its part of the emitter.
        maps: u32,
        /// Texels on a side of each map face, even, [`MIN_MAP_PX`] to [`MAX_MAP_PX`].
        px: u32,
        /// Look-ups of the search for blockers, and of the filter: one of [`SOFT_TAP_COUNTS`].
        taps: u32,
    },
    /// Depth maps that are paraboloids: one square holds all directions of half a space (Brabec et al. 2002; Dobetsberger
    /// 2025, section 6.1). Vertices are projected, and edges between them are drawn straight, which bends them. So maps are
    /// wrong where triangles are large beside their distance from the light. A look-up compares one texel.
    Paraboloids {
        /// Maps for each area light: one of [`MAP_COUNTS`].
        maps: u32,
        /// Texels on a side of each square, even, [`MIN_MAP_PX`] to [`MAX_MAP_PX`].
        px: u32,
    },
    /// Depth maps with flat faces as above, but each rectangle is subdivided where a frame shows bands, by a quadtree that frames
    /// refine (Dobetsberger 2025, section 6.3 and algorithm 1). A look-up compares one texel.
    Adaptive {
        /// Texels on a side of each map face, even, [`MIN_MAP_PX`] to [`MAX_MAP_PX`].
        px: u32,
        /// The test of bands looks at one pixel in `down` along each axis: one of [`BAND_DIVISORS`].
        down: u32,
        /// The most maps of each area light, [`FEWEST_ADAPTIVE`] to [`MOST_ADAPTIVE`].
        most: u32,
    },
    /// Rays through compound deep images of the scene (Archer, Leach, Knowles 2019) to the points from which maps would be
    /// drawn, in place of maps ([`Renderer::cast_rays_through`](crate::Renderer::cast_rays_through)).
    Cdi {
        /// Rays to each area light: one of [`RAY_COUNTS`]. Other lights get one.
        rays: u32,
    },
}

impl ShadowModel {
    /// Whether lights cast shadows.
    pub fn is_on(self) -> bool {
        self != Self::None
    }

    /// Whether frames subdivide rectangles.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Self::Adaptive { .. })
    }

    /// Whether rays take the place of maps.
    pub fn casts_rays(self) -> bool {
        matches!(self, Self::Cdi { .. })
    }

    /// Whether the filter is as wide as the penumbra.
    pub fn is_soft(self) -> bool {
        matches!(self, Self::Pcss { .. })
    }

    /// Whether maps are paraboloids.
    pub fn is_curved(self) -> bool {
        matches!(self, Self::Paraboloids { .. })
    }

    /// Maps or rays for each area light, or the most maps if frames subdivide; 0 without shadows.
    pub fn maps(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Maps { maps, .. } | Self::Pcss { maps, .. } | Self::Paraboloids { maps, .. } => {
                maps
            }
            Self::Adaptive { most, .. } => most,
            Self::Cdi { rays } => rays,
        }
    }

    /// Texels on a side of each map face; 0 without maps.
    pub fn px(self) -> u32 {
        match self {
            Self::None | Self::Cdi { .. } => 0,
            Self::Maps { px, .. } | Self::Pcss { px, .. } => px,
            Self::Paraboloids { px, .. } | Self::Adaptive { px, .. } => px,
        }
    }

    /// Texels that a look-up compares, or 1 for each ray; 0 without shadows.
    pub fn taps(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Maps { taps, .. } => taps,
            Self::Pcss { .. } | Self::Paraboloids { .. } => 1,
            Self::Adaptive { .. } | Self::Cdi { .. } => 1,
        }
    }

    /// Look-ups of each map, or rays to each point, for one sample.
    pub fn look_ups(self) -> u32 {
        match self {
            Self::None => 0,
            Self::Pcss { taps, .. } => 2 * taps,
            Self::Maps { .. } | Self::Paraboloids { .. } | Self::Adaptive { .. } => 1,
            Self::Cdi { .. } => 1,
        }
    }

    /// Checks each number.
    pub fn check(self) -> Result<(), AssignError> {
        let has_sides = |px: u32| (MIN_MAP_PX..=MAX_MAP_PX).contains(&px) && px.is_multiple_of(2);
        let is_sound = match self {
            Self::None => true,
            Self::Maps { maps, px, taps } => {
                MAP_COUNTS.contains(&maps) && has_sides(px) && TAP_COUNTS.contains(&taps)
            }
            Self::Pcss { maps, px, taps } => {
                MAP_COUNTS.contains(&maps) && has_sides(px) && SOFT_TAP_COUNTS.contains(&taps)
            }
            Self::Paraboloids { maps, px } => MAP_COUNTS.contains(&maps) && has_sides(px),
            Self::Adaptive { px, down, most } => {
                has_sides(px)
                    && BAND_DIVISORS.contains(&down)
                    && (FEWEST_ADAPTIVE..=MOST_ADAPTIVE).contains(&most)
            }
            Self::Cdi { rays } => RAY_COUNTS.contains(&rays),
        };
        if is_sound { Ok(()) } else { Err(refused(&self.to_string())) }
    }
}

impl fmt::Display for ShadowModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Maps { maps, px, taps: 1 } => write!(f, "maps:{maps},{px}"),
            Self::Maps { maps, px, taps } => write!(f, "maps:{maps},{px},pcf{taps}"),
            Self::Pcss { maps, px, taps } => write!(f, "maps:{maps},{px},pcss{taps}"),
            Self::Paraboloids { maps, px } => write!(f, "maps:{maps},{px},paraboloid"),
            Self::Adaptive { px, down, most } => write!(f, "adaptive:{px},{down},{most}"),
            Self::Cdi { rays } => write!(f, "cdi:{rays}"),
        }
    }
}

impl FromStr for ShadowModel {
    type Err = AssignError;

    /// Reads what [`Display`](fmt::Display) writes.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let model = match text {
            "none" => Some(Self::None),
            _ => match text.split_once(':') {
                Some(("maps", numbers)) => maps_of(numbers),
                Some(("adaptive", numbers)) => adaptive_of(numbers),
                Some(("cdi", rays)) => number(rays).map(|rays| Self::Cdi { rays }),
                _ => None,
            },
        };
        let model = model.ok_or_else(|| refused(text))?;
        model.check().map_err(|_| refused(text))?;
        Ok(model)
    }
}

/// `N,PX`, `N,PX,pcfK`, `N,PX,pcssK` or `N,PX,paraboloid`.
fn maps_of(numbers: &str) -> Option<ShadowModel> {
    let parts: Vec<&str> = numbers.split(',').collect();
    let (maps, px, filter) = match parts[..] {
        [maps, px] => (maps, px, "pcf1"),
        [maps, px, filter] => (maps, px, filter),
        _ => return None,
    };
    let (maps, px) = (number(maps)?, number(px)?);
    if filter == "paraboloid" {
        return Some(ShadowModel::Paraboloids { maps, px });
    }
    match (filter.strip_prefix("pcf"), filter.strip_prefix("pcss")) {
        (Some(taps), _) => Some(ShadowModel::Maps { maps, px, taps: number(taps)? }),
        (_, Some(taps)) => Some(ShadowModel::Pcss { maps, px, taps: number(taps)? }),
        _ => None,
    }
}

/// `PX,DOWN,MOST`.
fn adaptive_of(numbers: &str) -> Option<ShadowModel> {
    let parts: Vec<&str> = numbers.split(',').collect();
    let [px, down, most] = parts[..] else { return None };
    Some(ShadowModel::Adaptive { px: number(px)?, down: number(down)?, most: number(most)? })
}

/// A whole number without a sign, which `parse` alone accepts.
fn number(text: &str) -> Option<u32> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
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
pub const ACCEPTED_SHADOW_MODELS: &str = "none, maps:N,PX, maps:N,PX,pcfK, maps:N,PX,pcssK, maps:N,PX,paraboloid, \
    adaptive:PX,DOWN,MOST or cdi:N, with N of 1, 4, 9, 25, 81 or 289 maps for each area light, or as many rays or 16, an \
    even PX of 32 to 4096 texels, K of 1, 4, 9, 16 or 25 taps for pcf and 4, 9, 16, 25, 49 or 81 for pcss, a test of bands \
    at 1/DOWN of the viewport, 1, 2, 4, 8 or 16, and at MOST 4 to 289 maps for each area light";

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
        models.extend(MAP_COUNTS.map(|maps| ShadowModel::Paraboloids { maps, px: 64 }));
        models.extend(SOFT_TAP_COUNTS.map(|taps| ShadowModel::Pcss { maps: 4, px: 64, taps }));
        for down in BAND_DIVISORS {
            for most in [4, 64, 289] {
                models.push(ShadowModel::Adaptive { px: 32 * most.min(128), down, most });
            }
        }
        models.extend(RAY_COUNTS.map(|rays| ShadowModel::Cdi { rays }));
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
            "maps:4,512,paraboloids",
            "maps:4,512,paraboloid,pcf4",
            "maps:4,513,paraboloid",
            "maps:4,512,pcss",
            "maps:4,512,pcss1",
            "maps:4,512,pcss8",
            "maps:4,512,pcss9,1",
            "maps:+4,512",
            "maps:4,99999999999",
            "maps:-4,512",
            "adaptive",
            "adaptive:",
            "adaptive:256,8",
            "adaptive:256,8,64,1",
            "adaptive:256,3,64",
            "adaptive:256,32,64",
            "adaptive:255,8,64",
            "adaptive:30,8,64",
            "adaptive:256,8,3",
            "adaptive:256,8,290",
            "adaptive:256,8,+64",
            "Adaptive:256,8,64",
            "cdi",
            "cdi:",
            "cdi:0",
            "cdi:5",
            "cdi:+4",
            "cdi:4,256",
            "CDI:4",
            "cdi:99999999999",
        ] {
            let error = bad.parse::<ShadowModel>().unwrap_err().to_string();
            let expected = format!("shadow model is {bad}: it must be none, maps:N,PX");
            assert!(error.starts_with(&expected), "{error}");
            let counts = RAY_COUNTS.iter().chain(&TAP_COUNTS).chain(&BAND_DIVISORS);
            for count in counts.chain(&SOFT_TAP_COUNTS) {
                assert!(error.contains(&count.to_string()), "{count} is not named: {error}");
            }
        }
    }
}
