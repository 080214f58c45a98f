//! What the comparison paper (Enhuber 2019) claims, and what decides each claim in one scene.

mod bounds;
mod field;
mod growth;
mod lists;
mod members;
mod pairs;
mod search;
mod speed;
mod spread;

use crate::study::claims::{Check, Paper};

/// Enhuber 2019.
pub(crate) const PAPER: Paper = Paper {
    name: "the comparison paper",
    about: "Enhuber 2019 timed these strategies on a GTX 780 with forward shading, along paths of 1,200 \
            poses in Robot Lab, Sponza and Viking Village. Where it names no number of lights, it has \
            10,000. Here lighting is deferred. All methods share the depth pre-pass, and only the row on \
            slope and offset of explicit bounds counts its time. Times are those of assigning and \
            shading. The paper\u{2019}s own strategies decide its claims; they take lights from the list \
            of all lights. If the group sizes or shapes of a row were measured only through the \
            hierarchy, the row says so. Each figure states how many poses it averages. With fewer than \
            six rounds or laps, times less than 5 % apart decide nothing.",
    checks: &CHECKS,
};

const NO_PRE_PASS: &str = "no method pays for the depth pre-pass, so at few lights the methods that need it fall behind less \
     than in the paper";

const WHOLE_FRAMES: &str = "times cover assigning and shading; the paper times whole frames, and \
                            the time to draw surfaces varies with the view";

const DEFERRED: &str =
    "lighting is deferred, so hidden surfaces are not lit and shading grows more slowly";

const CHECKS: [Check; 28] = [
    Check {
        id: "sizes",
        place: "table 4.3, figures 4.2 to 4.5",
        words: "The best sizes are 28x28 pixels for tiles, 128x128x64 for DC-I, 64x64x40 for DC-E, 48x48x40 \
                for SC-I and SC-E, and 20x20x20 cells for G.",
        paper: "T-I: best in all scenes. Others: best in two, near the best in the third. G: 18, 22 and 20 \
                cells a side",
        departure: "the search covers sizes around the paper\u{2019}s; a tie with the best counts \
                    as best",
        decide: search::sizes,
    },
    Check {
        id: "many",
        place: "table 4.3",
        words: "DC-E and SC-E are the fastest at 10,000 lights.",
        paper: "DC-E 9.14, 8.87, 9.50 ms; SC-E 9.75, 9.75, 9.90; next SC-I 12.93, 12.27, 12.07",
        departure: NO_PRE_PASS,
        decide: speed::best_at_many,
    },
    Check {
        id: "dense",
        place: "table 4.3",
        words: "DC-E is a little faster than SC-E at 10,000 lights.",
        paper: "SC-E takes 1.07, 1.10 and 1.04 times as long",
        departure: "a little means up to 1.2 times",
        decide: speed::dense_before_sparse,
    },
    Check {
        id: "memory",
        place: "section 4.3.1",
        words: "SC-E stores its lists in far less memory than DC-E.",
        paper: "no figures; the reason why SC-E is chosen",
        departure: "lists share one pool that grows as they need, so dense clusters reserve no \
                    memory; at these sizes SC-E has 1.8 times as many clusters; far less means at \
                    most half",
        decide: speed::sparse_memory,
    },
    Check {
        id: "explicit",
        place: "table 4.3, section 4.4.2.1",
        words: "Explicit bounds are faster than implicit ones at 10,000 lights.",
        paper: "T 16.00 against 43.66, 18.82 against 73.44, 23.05 against 66.76 ms; DC 9.14 against 25.82, \
                8.87 against 31.64, 9.50 against 27.05; SC 9.75 against 12.93, 9.75 against 12.27, 9.90 \
                against 12.07",
        departure: NO_PRE_PASS,
        decide: speed::explicit_at_many,
    },
    Check {
        id: "tests",
        place: "figures 4.6 and 4.7",
        words: "HS+SAT-N is the best intersection test.",
        paper: "T-E: best in all scenes. SC-E: best in two, among the best in the third",
        departure: "SC-E tests boxes here, not frusta, so SC-I and DC-I stand in for it",
        decide: search::tests,
    },
    Check {
        id: "union",
        place: "section 4.3.2",
        words: "HS+SAT-E+SAT-P+SAT-V shades about as fast as HS+SAT-N and assigns slower.",
        paper: "no figures",
        departure: "we call times about as fast if they are within 3 %, and slower if they are more than 5 % longer",
        decide: search::full_union,
    },
    Check {
        id: "steady",
        place: "table 4.4",
        words: "SC-E depends least on the view: its standard deviation (SD) along the path is the least.",
        paper: "order by SD: SC-E, SC-I, then T-E, DC-I, G, then T-I, M; order by SD / mean: G, M, SC-E, SC-I, \
                then DC-I, then T-E, T-I. The paper calls SD the more important value",
        departure: WHOLE_FRAMES,
        decide: spread::steadiest,
    },
    Check {
        id: "spread",
        place: "table 4.4",
        words: "By SD, SC-E and SC-I come before T-E, DC-I and G, and these before T-I and M.",
        paper: "M 84.43 ms in Sponza and 403.30 ms in Viking Village; the paper shows the others only as bars",
        departure: WHOLE_FRAMES,
        decide: spread::groups,
    },
    Check {
        id: "steady-explicit",
        place: "section 4.4.1.1",
        words: "Explicit bounds depend less on the view than implicit ones, by SD and by SD / mean.",
        paper: "bars only",
        departure: WHOLE_FRAMES,
        decide: spread::explicit_is_steadier,
    },
    Check {
        id: "steady-alike",
        place: "section 4.4.1.1",
        words: "G and DC-I have similar SDs.",
        paper: "bars only",
        departure: "we call values similar if they are within a factor of 1.5; the paper times whole frames",
        decide: spread::grid_like_dense,
    },
    Check {
        id: "discontinuity",
        place: "section 4.4.1.2, figure 4.10",
        words: "If depth discontinuity rises from low to high, SC-E\u{2019}s lists grow far less than \
                T-E\u{2019}s.",
        paper: "most groups list 0 to 25 lights. With high discontinuity, many groups of T-E list 25 to 75 and \
                some list more; few of SC-E list 25 to 50",
        departure: "lights listed per sample decide, not the paper\u{2019}s histograms; far less \
                    means at most half the growth. We set this limit after seeing the figures, so \
                    results within 10 % of it are not decided",
        decide: lists::discontinuity,
    },
    Check {
        id: "view-free",
        place: "section 4.4.1.2, figure 4.11",
        words: "The lists of G and M do not depend on the view.",
        paper: "the same histograms in both views",
        departure: "we call lists the same if at most 0.1 % of their entries differ, because rounding moves \
                    the edges of cells",
        decide: lists::view_free,
    },
    Check {
        id: "models",
        place: "sections 4.4.1.2 and 4.5",
        words: "M suffers from a few models with extremely long lists, and dividing them helps.",
        paper: "2,259.77 ms in Sponza, 1,700.07 in Viking Village; the paper expects that dividing helps and did not measure it",
        departure: "we call a list extremely long if it holds a quarter of all lights; parts are 2 m large",
        decide: lists::models,
    },
    Check {
        id: "subdivision",
        place: "section 4.5",
        words: "M in parts can be at least as fast as the grid.",
        paper: "an expectation without figures",
        departure: "parts are 2 m large; M draws model ids in a separate pass",
        decide: lists::subdivision,
    },
    Check {
        id: "grids",
        place: "section 4.5",
        words: "Grids whose cell counts follow the shape of the box are faster than grids with equal counts.",
        paper: "an expectation without figures",
        departure: "one shaped grid, 40x12x20, competes with the best of equal counts",
        decide: search::grids,
    },
    Check {
        id: "few",
        place: "table 4.5",
        words: "DC-I is best at 100 lights.",
        paper: "it calls DC-I, G and T-I fast, in this order; bars only",
        departure: NO_PRE_PASS,
        decide: speed::best_at_few,
    },
    Check {
        id: "few-order",
        place: "table 4.5",
        words: "At 100 lights DC-I, G and T-I are fast, T-E is medium, SC-I and SC-E are slow, M is slowest.",
        paper: "bars only; M 23.01 ms in Sponza, 17.49 in Viking Village",
        departure: NO_PRE_PASS,
        decide: speed::order_at_few,
    },
    Check {
        id: "medium",
        place: "table 4.5",
        words: "T-E is best at 1,000 lights.",
        paper: "it calls T-E, SC-I, SC-E, DC-I and G fast, in this order; bars only",
        departure: NO_PRE_PASS,
        decide: speed::best_at_medium,
    },
    Check {
        id: "medium-order",
        place: "table 4.5",
        words: "At 1,000 lights T-I is behind T-E, SC-I, SC-E, DC-I and G, and M is slowest.",
        paper: "bars only; M 222.48 ms in Sponza, 170.46 in Viking Village",
        departure: NO_PRE_PASS,
        decide: speed::order_at_medium,
    },
    Check {
        id: "many-order",
        place: "table 4.5",
        words: "At 10,000 lights the order is SC-E, SC-I, then T-E, then DC-I and G, then T-I and M.",
        paper: "SC-E 9.75, SC-I 12.27, T-E 18.82, DC-I 31.64, G 43.18, T-I 73.44 ms in Sponza",
        departure: "the paper leaves DC-E out of this table",
        decide: speed::order_at_many,
    },
    Check {
        id: "linear",
        place: "section 4.4.2.2, figure 4.13",
        words: "Time grows linearly with the number of lights.",
        paper: "lines by least squares from 100 to 10,000 lights, without residuals",
        departure: "a line counts as straight if no time is off by more than 10 %, our limit. Its \
                    fit uses relative weights, so that 100 lights count as much as 10,000; plain \
                    least squares over the same counts are shown too",
        decide: growth::linear,
    },
    Check {
        id: "bounds",
        place: "table 4.6",
        words: "Explicit bounds lower the slope and raise the offset.",
        paper: "slope: SC-E lowest, T-E medium, T-I very high; offset: T-I, G and DC-I low, T-E medium, \
                SC-I and SC-E high, because of the depth pre-pass and the bounds",
        departure: "SC-I also reads depth, so both rows of SC pay for the pre-pass. The paper \
                    lights hidden surfaces although it draws a pre-pass; here lighting is \
                    deferred. Figures less than 2 % apart tie.",
        decide: bounds::explicit_against_implicit,
    },
    Check {
        id: "dominates",
        place: "section 4.4.2.2, figure 4.13",
        words: "Shading grows faster with the lights than assignment.",
        paper: "bars; for M in Sponza, shading takes 226.07 of 226.13 \u{b5}s a light",
        departure: DEFERRED,
        decide: growth::shading_dominates,
    },
    Check {
        id: "slopes",
        place: "table 4.6",
        words: "By slope, SC-E and SC-I come before T-E, then DC-I and G, then T-I, then M.",
        paper: "bars; M 9.32, 226.13 and 169.73 \u{b5}s a light",
        departure: DEFERRED,
        decide: growth::slopes,
    },
    Check {
        id: "offsets",
        place: "table 4.6",
        words: "By offset, M, T-I, G and DC-I come before T-E, and T-E before SC-I and SC-E.",
        paper: "bars; M 0.56, -1.74 and 0.37 ms",
        departure: NO_PRE_PASS,
        decide: growth::offsets,
    },
    Check {
        id: "model-slopes",
        place: "table 4.6",
        words: "M has the least slope of assignment and the greatest of shading.",
        paper: "shading 9.23, 226.07 and 169.57 \u{b5}s a light",
        departure: DEFERRED,
        decide: growth::model_slopes,
    },
    Check {
        id: "alike",
        place: "section 4.4.2.2",
        words: "DC-I and G have similar slopes and offsets.",
        paper: "bars only",
        departure: "we call values similar if they are within a factor of 1.5; the paper times whole frames",
        decide: growth::grid_like_dense,
    },
];
