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
    about: "Enhuber 2019 timed these strategies on a GTX 780 with forward shading, along paths of \
            1,200 poses in three scenes. If a row has three figures of the paper, they belong to \
            Robot Lab, Sponza and Viking Village, in this order. Where the paper does not state \
            the number of lights, it used 10,000. Here lighting is deferred. The renderer draws a \
            depth pre-pass for every method. Its time is left out, except in the row \
            \u{201c}Explicit bounds lower the slope and raise the offset\u{201d}. Times are the \
            time to make the lists (assign) plus the time to light the samples with them (shade). \
            A verdict uses only the strategies that are in the paper. Those test the list of all \
            lights, so a verdict uses no ids with /bvh. Next to each time stands the number of \
            poses that it is a mean of. Many claims put strategies in an order, with the least \
            time or the least other figure first. The verdict then says how many pairs of \
            strategies come in that order. \u{201c}Measured in the opposite order: A before B\u{201d} \
            means that A came first here, and that the claim has B first. Strategies are measured in \
            rounds, and along a path in laps. With fewer than six rounds or laps, times less \
            than 5 % apart do not decide a verdict. Slopes and offsets of fitted lines tie if they \
            are less than 2 % apart.",
    checks: &CHECKS,
};

const NO_PRE_PASS: &str = "the time of the depth pre-pass is left out. The paper adds it to the \
                           times of the methods that read depth, which matters most with few \
                           lights";

const WHOLE_FRAMES: &str = "times are assign + shade. The paper times whole frames, and the time \
                            to draw surfaces also varies with the view";

const DEFERRED: &str = "lighting is deferred, so hidden surfaces are not lit, and shading grows more slowly than in \
     the paper";

const CHECKS: [Check; 28] = [
    Check {
        id: "sizes",
        place: "table 4.3, figures 4.2 to 4.5",
        words: "The best sizes are 28x28 pixels for tiles, 128x128x64 for DC-I, 64x64x40 for DC-E, 48x48x40 \
                for SC-I and SC-E, and 20x20x20 cells for G.",
        paper: "the size of T-I is the best in all scenes. For G, the best sizes are 18, 22 and 20 \
                cells along each side. The sizes of the other families are the best in two scenes \
                and near the best in the third",
        departure: "we searched sizes around the paper\u{2019}s. A size that ties with the best \
                    counts as best",
        decide: search::sizes,
    },
    Check {
        id: "many",
        place: "table 4.3",
        words: "DC-E and SC-E are the fastest at 10,000 lights.",
        paper: "DC-E 9.14, 8.87, 9.50 ms; SC-E 9.75, 9.75, 9.90; next SC-I 12.93, 12.27, 12.07",
        departure: "",
        decide: speed::best_at_many,
    },
    Check {
        id: "dense",
        place: "table 4.3",
        words: "DC-E is a little faster than SC-E at 10,000 lights.",
        paper: "SC-E takes 1.07, 1.10 and 1.04 times as long",
        departure: "\u{201c}a little\u{201d} means that SC-E takes at most 1.2 times as long",
        decide: speed::dense_before_sparse,
    },
    Check {
        id: "memory",
        place: "section 4.3.1",
        words: "SC-E stores its lists in far less memory than DC-E.",
        paper: "no figures, but it chooses SC-E for this reason",
        departure: "all lists share one pool that grows when needed, so DC-E reserves no list \
                    memory for empty clusters. At the sizes used, SC-E has 1.8 times as many \
                    clusters as DC-E. \u{201c}Far less\u{201d} means at most half",
        decide: speed::sparse_memory,
    },
    Check {
        id: "explicit",
        place: "table 4.3, section 4.4.2.1",
        words: "Explicit bounds are faster than implicit ones at 10,000 lights.",
        paper: "T-E and T-I: 16.00 and 43.66, 18.82 and 73.44, 23.05 and 66.76 ms. DC-E and DC-I: \
                9.14 and 25.82, 8.87 and 31.64, 9.50 and 27.05 ms. SC-E and SC-I: 9.75 and 12.93, \
                9.75 and 12.27, 9.90 and 12.07 ms",
        departure: "",
        decide: speed::explicit_at_many,
    },
    Check {
        id: "tests",
        place: "figures 4.6 and 4.7",
        words: "The best intersection test is HS+SAT-N: half-spaces, then the axis towards the \
                nearest corner.",
        paper: "for T-E it is the best in all scenes. For SC-E it is the best in two scenes, and \
                among the best in the third",
        departure: "our SC-E tests boxes, not frusta, so SC-I and DC-I stand in for it",
        decide: search::tests,
    },
    Check {
        id: "union",
        place: "section 4.3.2",
        words: "With all tests but SAT-N (HS+SAT-E+SAT-P+SAT-V), shading takes about as long as \
                with HS+SAT-N, and assigning takes longer.",
        paper: "no figures",
        departure: "\u{201c}about as long\u{201d} means within 3 %, and \u{201c}longer\u{201d} \
                    means by more than 5 %",
        decide: search::full_union,
    },
    Check {
        id: "steady",
        place: "table 4.4",
        words: "SC-E depends least on the view: its standard deviation (SD) along the path is the least.",
        paper: "three groups by SD, least first: SC-E and SC-I; T-E, DC-I and G; T-I and M. By SD \
                / mean: G, M, SC-E and SC-I; DC-I; T-E and T-I. The paper calls SD the more \
                important value",
        departure: WHOLE_FRAMES,
        decide: spread::steadiest,
    },
    Check {
        id: "spread",
        place: "table 4.4",
        words: "The order by SD, least first, is: SC-E and SC-I, then T-E, DC-I and G, then T-I and M.",
        paper: "M has an SD of 84.43 ms in Sponza and 403.30 ms in Viking Village. The others are \
                in a bar chart without numbers",
        departure: WHOLE_FRAMES,
        decide: spread::groups,
    },
    Check {
        id: "steady-explicit",
        place: "section 4.4.1.1",
        words: "Explicit bounds depend less on the view than implicit ones, by SD and by SD / mean.",
        paper: "a bar chart without numbers",
        departure: WHOLE_FRAMES,
        decide: spread::explicit_is_steadier,
    },
    Check {
        id: "steady-alike",
        place: "section 4.4.1.1",
        words: "G and DC-I have similar SDs.",
        paper: "a bar chart without numbers",
        departure: "\u{201c}similar\u{201d} means within a factor of 1.5. Times are assign + shade, but \
                    the paper times whole frames",
        decide: spread::grid_like_dense,
    },
    Check {
        id: "discontinuity",
        place: "section 4.4.1.2, figure 4.10",
        words: "From a view of low depth discontinuity to a view of high depth discontinuity, \
                SC-E\u{2019}s lists grow far less than T-E\u{2019}s.",
        paper: "most groups list 0 to 25 lights. With high discontinuity, many groups of T-E list 25 to 75 \
                lights, and some list more. Few groups of SC-E list 25 to 50 lights",
        departure: "we compare the mean number of lights listed per sample, not histograms as the \
                    paper does. \u{201c}Far less\u{201d} means at most half the growth. We set \
                    this limit after seeing the figures, so a result within 10 % of it does not \
                    count as \u{201c}holds\u{201d}",
        decide: lists::discontinuity,
    },
    Check {
        id: "view-free",
        place: "section 4.4.1.2, figure 4.11",
        words: "The lists of G and M do not depend on the view.",
        paper: "the same histograms in both views",
        departure: "we call lists the same if their total numbers of entries differ by at most 0.1 \
                    %, because rounding moves the edges of cells a little",
        decide: lists::view_free,
    },
    Check {
        id: "models",
        place: "sections 4.4.1.2 and 4.5",
        words: "M (one list per model) suffers from a few models with extremely long lists, and \
                dividing these models into parts helps.",
        paper: "M takes 2,259.77 ms in Sponza and 1,700.07 ms in Viking Village. The paper expects \
                that dividing helps, but did not measure it",
        departure: "\u{201c}extremely long\u{201d} means at least a quarter of all lights. M/2 has \
                    parts of at most 2 m",
        decide: lists::models,
    },
    Check {
        id: "subdivision",
        place: "section 4.5",
        words: "M in parts (M/2) can be at least as fast as the grid (G).",
        paper: "an expectation without figures",
        departure: "parts are at most 2 m large. M and M/2 draw model ids in a separate pass, and \
                    its time counts",
        decide: lists::subdivision,
    },
    Check {
        id: "grids",
        place: "section 4.5",
        words: "Grids whose cell counts follow the proportions of the box around the lights are \
                faster than grids with the same count along each side.",
        paper: "an expectation without figures",
        departure: "one such grid, 40x12x20, competes with the best grid that has the same count \
                    along each side",
        decide: search::grids,
    },
    Check {
        id: "few",
        place: "table 4.5",
        words: "DC-I is best at 100 lights.",
        paper: "it calls DC-I, G and T-I fast, in this order, and shows a bar chart without numbers",
        departure: NO_PRE_PASS,
        decide: speed::best_at_few,
    },
    Check {
        id: "few-order",
        place: "table 4.5",
        words: "At 100 lights, DC-I, G and T-I are fast, T-E is medium, SC-I and SC-E are slow, and M is \
                slowest.",
        paper: "a bar chart without numbers, but M takes 23.01 ms in Sponza and 17.49 ms in Viking \
                Village",
        departure: NO_PRE_PASS,
        decide: speed::order_at_few,
    },
    Check {
        id: "medium",
        place: "table 4.5",
        words: "T-E is best at 1,000 lights.",
        paper: "it calls T-E, SC-I, SC-E, DC-I and G fast, in this order, and shows a bar chart \
                without numbers",
        departure: NO_PRE_PASS,
        decide: speed::best_at_medium,
    },
    Check {
        id: "medium-order",
        place: "table 4.5",
        words: "At 1,000 lights, T-I is slower than T-E, SC-I, SC-E, DC-I and G, and M is slowest.",
        paper: "a bar chart without numbers, but M takes 222.48 ms in Sponza and 170.46 ms in Viking \
                Village",
        departure: NO_PRE_PASS,
        decide: speed::order_at_medium,
    },
    Check {
        id: "many-order",
        place: "table 4.5",
        words: "At 10,000 lights, the order is SC-E, then SC-I, then T-E, then DC-I and G, then T-I and M.",
        paper: "SC-E 9.75, SC-I 12.27, T-E 18.82, DC-I 31.64, G 43.18, T-I 73.44 ms in Sponza",
        departure: "the paper leaves DC-E out of this table",
        decide: speed::order_at_many,
    },
    Check {
        id: "linear",
        place: "section 4.4.2.2, figure 4.13",
        words: "Time grows linearly with the number of lights.",
        paper: "lines by least squares from 100 to 10,000 lights, without residuals",
        departure: "growth counts as linear if no time is more than 10 % off the fitted line. This \
                    limit is ours. The fit minimises relative errors, so that the time at 100 \
                    lights weighs as much as the time at 10,000. The distance from the plain \
                    least-squares line stands in brackets",
        decide: growth::linear,
    },
    Check {
        id: "bounds",
        place: "table 4.6",
        words: "Explicit bounds lower the slope and raise the offset.",
        paper: "the slope of SC-E is lowest, that of T-E medium, and that of T-I very high. The \
                offset is low for T-I, G and DC-I, medium for T-E, and high for SC-I and SC-E, \
                because of the depth pre-pass and the bounds",
        departure: "in this row, methods that read depth pay for the depth pre-pass. SC-I reads \
                    depth too, so SC-I and SC-E both pay. In the paper, hidden surfaces are lit \
                    even after a depth pre-pass. Here lighting is deferred, so they are not lit",
        decide: bounds::explicit_against_implicit,
    },
    Check {
        id: "dominates",
        place: "section 4.4.2.2, figure 4.13",
        words: "Shading grows faster with the lights than assignment.",
        paper: "a bar chart. For M in Sponza, shading takes 226.07 of 226.13 \u{b5}s per light",
        departure: DEFERRED,
        decide: growth::shading_dominates,
    },
    Check {
        id: "slopes",
        place: "table 4.6",
        words: "The order by slope, least first, is: SC-E and SC-I, then T-E, then DC-I and G, \
                then T-I, then M.",
        paper: "a bar chart. M has 9.32, 226.13 and 169.73 \u{b5}s per light",
        departure: DEFERRED,
        decide: growth::slopes,
    },
    Check {
        id: "offsets",
        place: "table 4.6",
        words: "The order by offset, least first, is: M, T-I, G and DC-I, then T-E, then SC-I and SC-E.",
        paper: "a bar chart. M has 0.56, -1.74 and 0.37 ms",
        departure: NO_PRE_PASS,
        decide: growth::offsets,
    },
    Check {
        id: "model-slopes",
        place: "table 4.6",
        words: "M has the least slope of assignment and the greatest of shading.",
        paper: "shading of M takes 9.23, 226.07 and 169.57 \u{b5}s per light",
        departure: DEFERRED,
        decide: growth::model_slopes,
    },
    Check {
        id: "alike",
        place: "section 4.4.2.2",
        words: "DC-I and G have similar slopes and offsets.",
        paper: "a bar chart without numbers",
        departure: "\u{201c}similar\u{201d} means within a factor of 1.5. Times are assign + shade, but \
                    the paper times whole frames",
        decide: growth::grid_like_dense,
    },
];
