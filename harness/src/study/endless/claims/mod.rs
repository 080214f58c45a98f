//! What the polygon-light paper (Swarbrick 2025) claims: one row per claim.

mod operations;
mod rows;
mod times;

use self::operations::{artefact, growth, in_vain, inner, outer_24, outer_54, seen_lost, tracking};
use self::times::{
    assignment, balance, dif, early_exit, far, flagless, most, shading, six, sixteenfold, slices,
    thread_per_cluster, without,
};
use crate::study::claims::{Check, Paper};

/// Swarbrick 2025.
pub(crate) const PAPER: Paper = Paper {
    name: "the polygon-light paper",
    about: "Swarbrick 2025 timed 126 and 2,016 polygon lights in Sun Temples, at 1280 x 720 on a \
            GTX 1060, forward, with 16 x 9 x 24 clusters times normal cones. Here scene and GPU \
            differ, lighting is deferred, and only clusters that hold samples have lists. Verdicts \
            use the paper\u{2019}s settings where they were measured: its clusters, and its cone \
            test without an early exit. Where these are missing, verdicts use its cone test in \
            clusters of 48x48x40. Where that is missing too, they use cones without a loss. One \
            cone does not count. A case is a location (A, B or C) with its number of lights. \
            Settings that lose light state their FLIP. For scale: linearly transformed cosines \
            have a FLIP of 0.018 and 0.037 against the true integral (h200-area).",
    checks: &CHECKS,
};

const CHECKS: [Check; 21] = [
    Check {
        id: "six",
        place: "tables 5.1 and D.1",
        words: "6 cones take less time than clusters by position.",
        paper: "91.5 against 106 ms at location A with 126 lights, 92.2 against 121 ms at A with \
                2,016; less in 5 of 5 cases",
        departure: "",
        decide: six,
    },
    Check {
        id: "most",
        place: "section 5.2",
        words: "Even 54 cones take less time than clusters by position.",
        paper: "97.8 against 106 ms at A with 126 lights. In its own table they take longer in the \
                other 4 of 5 cases, such as 153 against 121 ms at A with 2,016",
        departure: "",
        decide: most,
    },
    Check {
        id: "balance",
        place: "section 5.2",
        words: "6 cones take the least time of 6, 24 and 54.",
        paper: "5 of 5 cases",
        departure: "",
        decide: balance,
    },
    Check {
        id: "dif",
        place: "tables 5.1, 5.2 and D.1",
        words: "Specular light that ends with diffuse light is fastest of all.",
        paper: "60.0 ms at A with 126 lights, 67.0 ms at A with 2,016; in 5 of 5 cases, and in 3 \
                of 3 on an RTX 4070",
        departure: "",
        decide: dif,
    },
    Check {
        id: "shading",
        place: "section 5.2",
        words: "54 cones almost halve shading time.",
        paper: "its table has \u{d7} 0.69 and 0.67 at A, 0.90 and 0.81 at B, 1.03 at C",
        departure: "the claim holds up to \u{d7} 0.7, which is the paper\u{2019}s own factor at A",
        decide: shading,
    },
    Check {
        id: "early-exit",
        place: "chapter 4",
        words: "Normal cones save shading that evaluates every listed light.",
        paper: "its shading has no early exit: \u{d7} 0.67 to 1.03 by 54 cones",
        departure: "measured with 54 cones without a loss. With an early exit, shading skips the \
                    same terms by itself",
        decide: early_exit,
    },
    Check {
        id: "outer-54",
        place: "equations 5.1 and 5.3",
        words: "54 cones leave out 80 % of outer specular operations.",
        paper: "80 % at A, 77 and 79 % at B",
        departure: "the claim holds within 10 points of 80 %, of listed terms by the \
                    paper\u{2019}s test. Appendix H.3 aims from the middle of the cluster. We aim \
                    from the middle of the box around its samples. H.3 limits the range by a ball \
                    of 1.5 times the light\u{2019}s sphere, which includes its size. We limit it \
                    by the light\u{2019}s outline plus its range",
        decide: outer_54,
    },
    Check {
        id: "outer-24",
        place: "equations 5.1 and 5.2",
        words: "24 cones leave out 54 % of outer specular operations.",
        paper: "53 % at A, 32 % at B with 126 lights",
        departure: "the cone test departs as in the row on 54 cones. The claim holds within 10 \
                    points of 54 %. The half angle of 24 cones is as printed, 19.5\u{b0}, so a \
                    third of the directions of a bin lie outside its cone",
        decide: outer_24,
    },
    Check {
        id: "assignment",
        place: "section 5.2",
        words: "24 cones take about four times as long to assign as 6.",
        paper: "\u{d7} 3.6 to 4.0",
        departure: "the paper culls for every cluster and cone. We cull only for those that hold \
                    samples. The claim holds from 3 to 5 times",
        decide: assignment,
    },
    Check {
        id: "sixteenfold",
        place: "section 5.2",
        words: "16 times the lights and triangles add about 10 % to shading.",
        paper: "13 % at A and 18 % at B by position; all rows of table D.1: -5 to +22 %",
        departure: "measured with clusters by position. The claim holds from 5 to 20 %",
        decide: sixteenfold,
    },
    Check {
        id: "without",
        place: "section 5.1",
        words: "Without culling a frame takes more than 140 times as long, at 2,016 lights.",
        paper: "over 140",
        departure: "compared with frames of the diffuse reach where they were measured, otherwise \
                    with clusters by position",
        decide: without,
    },
    Check {
        id: "growth",
        place: "section 3.4",
        words: "A specular radius half as large again raises light operations by 54 %.",
        paper: "54 % at A with 126 lights (63 % at A with 2,016, 16 and 25 % at B)",
        departure: "judged at A with the fewest lights. The claim holds within 10 points",
        decide: growth,
    },
    Check {
        id: "in-vain",
        place: "appendix I",
        words: "Cones list fewer terms for each that would be seen.",
        paper: "position 2.9, 24 cones 2.5, 54 cones 2.3 at A with 126 lights",
        departure: "terms count as seen if they are visible and the lists name them. The cone test \
                    departs as in the row on 54 cones",
        decide: in_vain,
    },
    Check {
        id: "seen-lost",
        place: "appendix I",
        words: "24 and 54 cones lose 6 and 9 % of the terms that would be seen.",
        paper: "22.7, 21.4 and 20.7 million at A with 126 lights",
        departure: "the claim holds within 3 points each. The cone test departs as in the row on \
                    54 cones",
        decide: seen_lost,
    },
    Check {
        id: "inner",
        place: "equations 5.4 to 5.7",
        words: "54 cones over the whole radius would list 1.25 terms for each that would be seen.",
        paper: "an estimate: 25.8 of 20.7 million, 31.5 of 21.4 by 24 cones",
        departure: "we judge it by our radiance cut at its mildest setting. The claim holds up to \
                    1.35 terms. Older files do not say which terms a list holds, so both terms of \
                    every light are counted and the ratios are lower bounds",
        decide: inner,
    },
    Check {
        id: "tracking",
        place: "section 5.2",
        words: "6 cones lose highlights that 24 and 54 keep.",
        paper: "no figures",
        departure: "judged by FLIP against no culling. The cone test departs as in the row on 54 \
                    cones",
        decide: tracking,
    },
    Check {
        id: "artefact",
        place: "section 5.2",
        words: "Specular light that ends with diffuse light shows at B, and not at A and C.",
        paper: "no figures",
        departure: "\u{201c}shows\u{201d} means a FLIP of at least 0.01",
        decide: artefact,
    },
    Check {
        id: "far",
        place: "table 5.2, section 5.2",
        words: "Far fragments (C) cost several times the shading of near ones (A).",
        paper: "\u{d7} 2.5 on a GTX 1060, 5.1 on an RTX 4070",
        departure: "half of C is background here, and slices follow the depth of the lights. The \
                    claim holds from 2 times upwards",
        decide: far,
    },
    Check {
        id: "slices",
        place: "section 3.3",
        words: "24 slices list 15 % fewer terms than 12, and take twice as long to assign.",
        paper: "15 %, \u{d7} 2",
        departure: "the claim holds from 10 to 20 % and from 1.7 to 2.3 times",
        decide: slices,
    },
    Check {
        id: "workgroups",
        place: "section 3.3, appendix F",
        words: "A workgroup per cluster assigns 25 times as fast as a thread per cluster.",
        paper: "\u{d7} 25",
        departure: "",
        decide: thread_per_cluster,
    },
    Check {
        id: "flags",
        place: "section 3.4",
        words: "Separating diffuse and specular terms halves shading where only one reaches.",
        paper: "no figures",
        departure: "",
        decide: flagless,
    },
];
