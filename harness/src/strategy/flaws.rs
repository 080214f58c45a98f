//! Methods that fail on purpose: flaws that renderers ship, each with the public report or the paper that shows it.
//!
//! They are the negative control of a study of failures: what finds no fault in them finds none anywhere. A flaw is
//! a segment of an id (`/rect`), an option of `compare` that makes lists too short for what shading adds
//! (`--cut never`), or the limit of an engine's default. No search, verdict or frontier ever picks an id with a
//! flaw, and `all` does not include one.

use super::{Axis, StrategyId, engines};

/// A method that fails on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// What is wrong, in a few words.
    pub name: &'static str,
    /// What `--strategies` is given: a full id, or the name of an engine's default.
    pub id: &'static str,
    /// Further options of `compare` without which it does not fail.
    pub options: &'static [&'static str],
    /// What is seen, and where: one sentence.
    pub fails: &'static str,
    /// Where the failure is public.
    pub source: &'static str,
}

impl Flaw {
    /// The options of `compare` that draw it: `--strategies T-E/32x32 --cut never`.
    pub fn options_of_compare(&self) -> String {
        [&["--strategies", self.id], self.options].concat().join(" ")
    }

    /// Its id in an image of that width and height, pixels: those of engines' defaults depend on the size.
    pub fn id_at(&self, size_px: [u32; 2]) -> StrategyId {
        let ids = engines::expand(self.id, size_px).and_then(Result::ok).unwrap_or_default();
        StrategyId::read(ids.first().map_or(self.id, String::as_str))
    }
}

/// All flaws, those of ids first.
pub fn flaws() -> impl Iterator<Item = &'static Flaw> {
    FLAWS.iter()
}

const FLAWS: &[Flaw] = &[
    Flaw {
        name: "lists in random order",
        id: "T-E/32x32/unordered",
        options: &[],
        fails: "Each frame sums the lights of a list in another order, so the last bits of the image flicker, also if \
                nothing moves.",
        source: "Bevy, \"Implement GPU clustering for lights, light probes, and decals\", 2026: a light takes the next place \
                 of a list by an atomic",
    },
    Flaw {
        name: "lists in random order, with a limit",
        id: "T-E/32x32/unordered/cap32",
        options: &[],
        fails: "Where more lights reach a tile than a list may hold, each frame loses other ones, so the tile flickers, \
                also if nothing moves.",
        source: "Castor3D, \"Fix clustered lighting lights sort\", 2024: thousands of candles flicker",
    },
    Flaw {
        name: "a ball that is a rectangle of radius over depth on the screen",
        id: "T-I/32x32/rect",
        options: &[],
        fails: "Towards the border of a wide view, tiles lack lights whose ball they cross: bars and squares are dark.",
        source: "Mara and McGuire 2013, \"2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D Sphere\"; Bevy, \
                 \"At high FOV, there are bars on the sides of the screen with no lighting\", 2022; three.js, \
                 \"TiledLightsNode: Compute point light radius in screen space\", 2026",
    },
    Flaw {
        name: "culling in half precision",
        id: "T-E/32x32/half",
        options: &[],
        fails: "Far from the origin, tiles lack lights that reach them, and beyond 65 km all lights are missing.",
        source: "FreeSpace 2 Open, \"Add Z-Compression shader to better use position buffer's FP16\", 2026",
    },
    Flaw {
        name: "view depth by the formula of a plain near plane",
        id: "T-E/32x32/plain-depth",
        options: &[],
        fails: "In a reflection whose near plane lies on the mirror, tiles are bounded where their samples are not, and \
                lack the lights of what they show.",
        source: "Unity, \"Added support for oblique matrices in light loop culling\", 2018; KlayGE, \"General depth \
                 buffer linearization\", 2018; Lengyel 2005",
    },
    Flaw {
        name: "shading beyond the range that lists are made for",
        id: "T-E/32x32",
        options: &["--cut", "never"],
        fails: "A light ends at the edge of the last tile that lists it, so the light's rim is made of squares.",
        source: "Watrous 2024, figure 3b; Unvanquished, \"Dynamic light blockiness (tile edges visible)\", 2023; Godot, \
                 \"Lighting artefacts are produced just outside of the area of effect of Spotlights and Omnilights\", \
                 2023",
    },
    Flaw {
        name: "ranges from a threshold of diffuse light",
        id: "SC-E/48x48x40",
        options: &["--cut", "never", "--threshold", "0.1"],
        fails: "Dim light is missing everywhere. On a mirror-like floor bright light is too: it shows lights from beyond \
                the reach of their diffuse light, and their highlights vanish or are cut off at the edge of a cluster.",
        source: "Watrous 2024, Results, figure 3a",
    },
    Flaw {
        name: "256 lights of a frame, nearest first",
        id: "engine:filament",
        options: &[],
        fails: "With more than 256 lights in view, the farthest ones are missing in the whole image, and pop in as the \
                camera moves.",
        source: "Filament, CONFIG_MAX_LIGHT_COUNT 256",
    },
    Flaw {
        name: "512 lights of a frame",
        id: "engine:godot",
        options: &[],
        fails: "With more than 512 lights in view, the last ones are missing in the whole image.",
        source: "Godot, ClusterBuilderRD: max_clustered_elements 512",
    },
    Flaw {
        name: "254 lights of a frame, 255 of a cell",
        id: "engine:playcanvas",
        options: &[],
        fails: "With more than 254 lights in view, the last ones are missing in the whole image.",
        source: "PlayCanvas, LightingParams: 254 lights, 255 lights per cell",
    },
    Flaw {
        name: "64 lights of a list",
        id: "engine:three",
        options: &[],
        fails: "Where more than 64 lights reach a cluster, the rest is missing, so clusters show as dark blocks.",
        source: "three.js, ClusteredLightsNode: 64 lights per cluster",
    },
    Flaw {
        name: "8 lights of a list",
        id: "engine:three-tiled",
        options: &[],
        fails: "Where more than 8 lights reach a tile, the rest is missing, so tiles show as dark squares.",
        source: "three.js, TiledLightsNode: 8 lights per tile",
    },
    Flaw {
        name: "256 lights of a frame",
        id: "engine:urp",
        options: &[],
        fails: "With more than 256 lights in view, the last ones are missing in the whole image.",
        source: "Unity, ForwardLights: 256 lights",
    },
];

/// The end of what `lightbench list strategies` prints: methods that are wrong, and engines with a limit.
pub(super) fn list() -> String {
    let of_kind = |is_engine: bool| -> String {
        flaws().filter(|flaw| engines::is_engine(flaw.id) == is_engine).map(entry).collect()
    };
    format!(
        "Fail on purpose:\n\n{}\nDefaults of engines that lose light beyond a limit (`lightbench list engines` lists \
         all engines):\n\n{}\nNeither are part of `all`, and no ranking picks one.\n",
        of_kind(false),
        of_kind(true)
    )
}

fn entry(flaw: &Flaw) -> String {
    let Flaw { name, fails, source, .. } = flaw;
    format!("{}\n    {name}: {fails}\n    {source}\n", flaw.options_of_compare())
}

impl StrategyId {
    /// The flaw of the id; `None` for methods that are right, and for limits that only make a method lossy.
    pub fn flaw(&self) -> Option<&'static Flaw> {
        let mut wrong = Axis::ALL.iter().filter(|axis| axis.is_flaw());
        let segment = wrong.find_map(|axis| axis.segment(self.options()))?;
        let of_segment = flaws().filter(|flaw| flaw.id.split('/').any(|known| known == segment));
        // A flaw may have a row without and with a cap.
        let is_capped = |flaw: &&Flaw| flaw.id.contains("/cap") == self.options().cap.is_some();
        of_segment.max_by_key(|flaw| is_capped(flaw))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{engines, rows};
    use super::*;

    fn id(text: &str) -> StrategyId {
        StrategyId::parse(text).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn every_flaw_has_an_id_that_runs_and_says_what_is_seen() {
        for flaw in flaws() {
            match engines::expand(flaw.id, [1920, 1080]) {
                Some(ids) => assert_eq!(ids.map(|ids| ids.len()), Ok(1), "{}", flaw.id),
                None => assert_eq!(id(flaw.id).as_str(), flaw.id, "a canonical id"),
            }
            for text in [flaw.name, flaw.fails, flaw.source] {
                assert!(!text.is_empty() && !text.contains("  "), "{text}");
            }
            assert!(flaw.fails.ends_with('.') && !flaw.source.ends_with('.'), "{}", flaw.id);
            assert!(list().contains(flaw.fails), "{}", flaw.id);
        }
    }

    #[test]
    fn engines_whose_limits_lose_lights_are_flaws_and_others_are_not() {
        for engine in engines::ENGINES {
            let name = format!("{}{}", engines::PREFIX, engine.name);
            let is_lossy = id(&engine.id([1920, 1080])).is_lossy(u64::MAX);
            assert_eq!(flaws().any(|flaw| flaw.id == name), is_lossy, "{name}");
        }
    }

    #[test]
    fn every_flawed_segment_has_a_row_and_makes_an_id_lossy() {
        let flawed = Axis::ALL.into_iter().filter(|axis| axis.is_flaw());
        for axis in flawed.clone() {
            let shows = |flaw: &&Flaw| axis.segment(StrategyId::read(flaw.id).options()).is_some();
            let row = flaws().find(shows).unwrap_or_else(|| panic!("{axis:?} has no row"));
            let found = id(row.id);
            assert!(found.has_flaw() && found.is_lossy(1), "{found}");
            assert_eq!(found.flaw().map(|flaw| flaw.id), Some(row.id));
            let sound = found.nearest_lossless().expect("without the flaw");
            assert!(!sound.has_flaw() && !sound.is_lossy(u64::MAX) && sound.flaw().is_none());
        }
        let name = |text: &str| id(text).flaw().map(|flaw| flaw.name);
        assert_eq!(name("HG/unordered/cap7"), Some("lists in random order, with a limit"));
        assert_eq!(name("DC-I/UNORDERED"), Some("lists in random order"));
        assert_eq!(name("DC-I/cap7"), None);
        for row in rows() {
            assert!(!id(row.family).has_flaw(), "`all` includes {}", row.family);
            assert!(row.in_default.is_none_or(|id| !StrategyId::read(id).has_flaw()));
        }
    }

    #[test]
    fn flaws_that_contradict_other_segments_are_refused() {
        for text in [
            "T-E/unordered/mask",
            "T-E/unordered/tree",
            "T-E/unordered/reuse2",
            "T-E/unordered/keep2",
            "T-E/unordered/touched",
            "T-E/half/keep2",
            "T-E/half/touched",
        ] {
            let refused = StrategyId::parse(text).expect_err(text).to_string();
            assert!(refused.contains("contradict each other"), "{refused}");
        }
        for text in
            ["G/rect", "SC-E/plain-depth", "DC-E/rect", "None/unordered", "M/half", "W/half"]
        {
            let refused = StrategyId::parse(text).expect_err(text).to_string();
            assert!(refused.contains("is unknown"), "{refused}");
        }
    }
}
