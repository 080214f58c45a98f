//! What the engine paper (Dobetsberger 2025) claims of shadow maps of area lights, and what decides each claim in one
//! scene.

mod adaptive;
mod maps;
mod times;

use self::adaptive::{ADAPTIVE, COST, RESOLUTION};
use self::maps::{BELOW, FILTER, LARGE_ATLAS, SMALL_ATLAS, TURN};
use self::times::TIME;
use crate::study::claims::{Answer, Check, Paper};

/// Why a software adapter decides no claim on times.
const SOFTWARE: &str = "times of a software adapter are not those of a GPU";

/// Dobetsberger 2025, chapter 6.
pub(crate) const PAPER: Paper = Paper {
    name: "the engine paper",
    about: "Dobetsberger 2025 shadowed one rectangle light in the Godot engine. Each map is a paraboloid in one square \
            tile. Its truth is a path tracer\u{2019}s image, and LPIPS measures errors. LPIPS is a trained network, \
            which this workspace does not run: FLIP stands in for it here. The truth here has the shader\u{2019}s own \
            BRDF. Four lights share the atlas, and each map takes three squares (half a cube). Errors of single images \
            tie where they are less than 5 % apart.",
    checks: &[
        TURN,
        LARGE_ATLAS,
        SMALL_ATLAS,
        LEAST_LPIPS,
        BELOW,
        FILTER,
        TIME,
        COST,
        RESOLUTION,
        ADAPTIVE,
    ],
};

const LEAST_LPIPS: Check = Check {
    id: "least-lpips",
    place: "section 6.2",
    words: "At the best number of maps, the mean LPIPS is about 0.071.",
    paper: "0.071 at 81 maps in 8192\u{b2} texels",
    departure: "",
    decide: |_, _| Answer::unknown("LPIPS is a trained network, which this workspace does not run"),
};
