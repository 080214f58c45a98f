//! Claims of the engine paper that nothing here measures.

use crate::study::claims::{Answer, Check};
use crate::study::manifest::Done;

/// A claim that nothing here measures.
const fn unmeasured(
    id: &'static str,
    place: &'static str,
    words: &'static str,
    paper: &'static str,
    decide: fn(&Done, &str) -> Answer,
) -> Check {
    Check { id, place, words, paper, departure: "", decide }
}

pub(crate) const LPIPS: Check = unmeasured(
    "lpips",
    "table 5.2",
    "LPIPS falls with the number of samples, and LTC\u{2019}s is least.",
    "0.290, 0.259, 0.247 and 0.242 at 2 to 128 samples; MRP 0.203, LTC 0.196",
    |_, _| Answer::unknown("LPIPS is a trained network, which this workspace does not run"),
);

pub(crate) const MANY_SAMPLES: Check = unmeasured(
    "many-samples",
    "section 5.5.3, figure 5.22",
    "Beyond 32 samples, time grows considerably more than noise falls.",
    "a figure without numbers",
    |_, _| Answer::unknown("no more than 32 samples are drawn"),
);

pub(crate) const CPU: Check = unmeasured(
    "cpu",
    "section 5.5.3",
    "The algorithms take the same time on the CPU.",
    "no numbers",
    |_, _| Answer::unknown("the CPU\u{2019}s share of a frame is not timed"),
);
