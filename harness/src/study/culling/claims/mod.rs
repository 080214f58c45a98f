//! What the culling survey (Watrous 2024) claims: the rows. What [times](times) and [images](images)
//! decide of them is beside.
//!
//! The survey's statistic is the mean time of a whole frame along the path. *Growth* is the frame at the
//! most lights less the frame without a light: what lights cost.

mod images;
mod modes;
mod times;

use images::{cap, range, tiles};
use times::{clay, clusters, deferred, gain, linear, raster, rate, slowest, sphere};

use crate::study::claims::{Check, Paper};

/// Watrous 2024.
pub(crate) const PAPER: Paper = Paper {
    name: "the culling survey",
    about: "Watrous 2024 timed four methods on an RTX 3080, in a scene and with light intensities \
            of its own. Its times are means over 1,000 frames. Here a verdict compares the mean \
            times of a frame along the path, within each renderer. A data-centre GPU runs fragment \
            shaders on only a few of its processors, so forward rendering, Clay and RasterSphere \
            are slower there than on the survey\u{2019}s GPU.",
    checks: &CHECKS,
};

const CHECKS: [Check; 12] = [
    Check {
        id: "survey-linear",
        place: "evaluation, figure 2",
        words: "The frame time of each method grows linearly with the number of lights.",
        paper: "0 to 1,500 lights",
        departure: "we measured fewer counts of lights. \u{201c}Linearly\u{201d} means that points \
                    are off the line by at most 5 % of the growth",
        decide: linear,
    },
    Check {
        id: "survey-clay",
        place: "evaluation",
        words: "No method is faster than the clay renderer.",
        paper: "",
        departure: "",
        decide: clay,
    },
    Check {
        id: "survey-slowest",
        place: "evaluation",
        words: "No culling is the slowest method.",
        paper: "in both renderers",
        departure: "",
        decide: slowest,
    },
    Check {
        id: "survey-gain",
        place: "conformance to principles",
        words: "Every method that culls takes no longer than no culling.",
        paper: "\u{201c}net-nonnegative performance\u{201d}",
        departure: "",
        decide: gain,
    },
    Check {
        id: "survey-sphere",
        place: "evaluation",
        words: "The bounding sphere cuts the cost of lights nearly in half.",
        paper: "nearly half",
        departure: "no culling also runs the test of the early exit here, which makes it 9 % \
                    slower. \u{201c}Nearly in half\u{201d} means that 40 to 60 % is left",
        decide: sphere,
    },
    Check {
        id: "survey-raster",
        place: "evaluation",
        words: "The raster sphere gains slightly less than the bounding sphere.",
        paper: "slightly less",
        departure: "",
        decide: raster,
    },
    Check {
        id: "survey-deferred",
        place: "evaluation",
        words: "Without culling and with the bounding sphere, deferred is faster than forward.",
        paper: "",
        departure: "deferred lighting here is a compute pass",
        decide: deferred,
    },
    Check {
        id: "survey-clusters",
        place: "evaluation",
        words: "Clusters greatly outperform all other methods, in both renderers.",
        paper: "",
        departure: "\u{201c}greatly\u{201d} means half the frame time or less. We test clusters as \
                    frusta (HS+SAT-N), and the paper tests them as boxes",
        decide: clusters,
    },
    Check {
        id: "survey-rate",
        place: "evaluation",
        words: "Clusters light 1,500 lights in 10 ms per frame.",
        paper: "10 ms on an RTX 3080",
        departure: "decided on the paper\u{2019}s GPU only. The claim holds from 5 to 20 ms",
        decide: rate,
    },
    Check {
        id: "survey-cap",
        place: "methods, conformance to principles",
        words: "A cluster rarely has more than 128 lights.",
        paper: "rare",
        departure: "list lengths are those of the path\u{2019}s first pose",
        decide: cap,
    },
    Check {
        id: "survey-range",
        place: "failure modes, figure 3a",
        words: "Ranges lose visible light, most of all on reflective surfaces.",
        paper: "pictures",
        departure: "we compare the whole image of the path\u{2019}s first pose, not only its \
                    reflective surfaces",
        decide: range,
    },
    Check {
        id: "survey-tiles",
        place: "failure modes, figure 3b",
        words: "Clusters show tiles on reflective surfaces.",
        paper: "a picture",
        departure: "shading ends each light at its range, whatever list contains it",
        decide: tiles,
    },
];
