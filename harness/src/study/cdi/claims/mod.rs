//! What the deep-image paper (Archer, Leach and Knowles 2019) claims: one row per claim.

mod builds;
mod casts;
mod light;
mod scenes;

use self::builds::{build_linear, coverage, one_pass, overhead, redundant, size};
use self::casts::{against_random, arrays, cast_share, geometry, rate, rays_linear};
use self::light::{fewer_lights, same_image, similar, visual_quality};
use crate::study::claims::{Check, Paper};

/// Archer, Leach and Knowles 2019.
pub(crate) const PAPER: Paper = Paper {
    name: "the deep-image paper",
    about: "Archer, Leach and Knowles 2019 timed a GTX 1060 at 1920 x 1080 in two scenes: the \
            Sponza Atrium (280,000 triangles) and Rungholt (7 million). Here scenes and GPU \
            differ. Times that were taken while the GPU clock was low or rising decide nothing.",
    checks: &CHECKS,
};

const CHECKS: [Check; 16] = [
    Check {
        id: "one-pass",
        place: "section 4",
        words: "One pass for all directions is 20 to 100 times as fast as a pass for each.",
        paper: "169 directions: 5.5 against 121 ms (22 times) and 22.1 against 2,296 ms (104 \
                times)",
        departure: "brute force runs as compute, in a dispatch per direction and in one for all, \
                    and sorts once. The claim holds from 20 times against both",
        decide: one_pass,
    },
    Check {
        id: "same-image",
        place: "section 4",
        words: "It makes no difference to the indirect light.",
        paper: "no difference",
        departure: "we compare images with ranges of twice the average that rays found, from a \
                    shadow map of 256 x 256 pixels",
        decide: same_image,
    },
    Check {
        id: "overhead",
        place: "table 2",
        words: "Many directions cost little more than few.",
        paper: "8 to 128 directions: 1.5 to 4.7 ms (3.1 times) and 18.0 to 21.3 ms (1.2 times)",
        departure: "the claim holds up to the paper\u{2019}s 3.1 times",
        decide: overhead,
    },
    Check {
        id: "build-linear",
        place: "section 4",
        words: "Build time grows linearly with the number of directions.",
        paper: "table 2, 8 to 128 directions",
        departure: "growth counts as linear if no time is more than 10 % off the fitted line. This \
                    limit is ours. The fit minimises relative errors over at least four numbers of \
                    directions",
        decide: build_linear,
    },
    Check {
        id: "share",
        place: "table 1",
        words: "Casting rays takes about 1 % of a frame.",
        paper: "0.15 of 20.6 ms and 0.4 of 43.5 ms (0.7 and 0.9 %), with the time to choose lights",
        departure: "lights that lie close to others are kept. The claim holds from 0.5 to 2 %",
        decide: cast_share,
    },
    Check {
        id: "rays-linear",
        place: "table 3",
        words: "Time of casting grows nearly linearly with the number of rays.",
        paper: "64 times the pixels take 40 and 39 times as long: an exponent of 0.89 and 0.88",
        departure: "only pixels that show a surface cast rays. \u{201c}Nearly linearly\u{201d} \
                    means an exponent of 0.8 to 1.2",
        decide: rays_linear,
    },
    Check {
        id: "random",
        place: "table 3",
        words: "Casting takes about 10 times as long as random ranges.",
        paper: "9.6 to 13 times, 11 to 15 in the town",
        departure: "the claim holds from 5 to 20 times",
        decide: against_random,
    },
    Check {
        id: "rate",
        place: "section 4",
        words: "25 million rays take 20 ms.",
        paper: "20.2 and 23.5 ms: 1.2 and 1.1 thousand million rays a second",
        departure: "decided on the paper\u{2019}s GPU only. The claim holds from half to twice the \
                    rate",
        decide: rate,
    },
    Check {
        id: "geometry",
        place: "section 4",
        words: "A town of 20 times the triangles is at most 10 % slower to cast through.",
        paper: "at most 10 %; its table 3 has 15 to 20 %",
        departure: "we compare the time per ray with that in the scene of this study that has the \
                    fewest triangles. A scene needs at least 10 times as many triangles for a \
                    verdict",
        decide: geometry,
    },
    Check {
        id: "size",
        place: "section 4",
        words: "Deep images of both scenes are about the same size.",
        paper: "18 MB at 169 directions",
        departure: "we compare all buffers of a build with those in the scene of this study that \
                    has the fewest triangles. A scene needs at least 10 times as many triangles \
                    for a verdict. \u{201c}About the same\u{201d} means within a factor of 1.25",
        decide: size,
    },
    Check {
        id: "redundant",
        place: "section 3.1",
        words: "One pass stores up to 25 % more than a pass for each direction.",
        paper: "up to 25 %",
        departure: "we count fragments, at the most directions. The claim holds up to 1.25 times",
        decide: redundant,
    },
    Check {
        id: "arrays",
        place: "section 3.1",
        words: "Linked lists are quicker to build. Arrays are quicker to cast through, and quicker \
                in total.",
        paper: "no figures",
        departure: "measured with 169 directions and with rays from the largest shadow map",
        decide: arrays,
    },
    Check {
        id: "coverage",
        place: "section 3.1",
        words: "Ranges need no conservative rasterisation.",
        paper: "no figures",
        departure: "compared with exact rays, at 16 directions. The claim holds if the median \
                    error grows by at most a tenth",
        decide: coverage,
    },
    Check {
        id: "fewer-lights",
        place: "section 4",
        words: "Ranges from rays need fewer lights than random ranges.",
        paper: "no figures",
        departure: "judged by the mean error against the path-traced image. Random ranges have one \
                    seed and their best span",
        decide: fewer_lights,
    },
    Check {
        id: "quality",
        place: "section 1",
        words: "Ranges from rays can look better than random ranges.",
        paper: "no comparison",
        departure: "judged by the mean error against the path-traced image, with the same shadow \
                    map and each rule at its best setting",
        decide: visual_quality,
    },
    Check {
        id: "similar",
        place: "figure 7",
        words: "The image is similar to one bounce of path tracing, darker and brighter in places.",
        paper: "pictures, no measure",
        departure: "nothing decides this claim; only figures are shown",
        decide: similar,
    },
];
