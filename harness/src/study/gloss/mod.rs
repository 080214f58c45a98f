//! What polished surfaces lose to ranges, and what it costs to give it back: errors against lights without a range, with
//! specular terms that end at the range and with ones that reach beyond it.
//!
//! The survey shows highlights that vanish on reflective surfaces, because a light ends where its diffuse light is
//! negligible (Watrous 2024, figure 3a). It proposes to adjust light volumes by a summary of each cluster's materials.
//! `SC-E/.../reachN` does so (`assign::specular_reach` has the derivation). Each job draws a scene with another N.

mod jobs;
mod page;

use super::claims::Paper;
use super::slice::{Study, TakesMotion};
use crate::report::markup::Html;

/// The study of gloss.
pub(crate) const STUDY: Study = Study {
    name: "gloss",
    answers: "What polished surfaces lose where lights end at their range, and what lists with a specular reach gain and cost",
    scenes: jobs::scenes,
    jobs: jobs::jobs,
    motion: TakesMotion::None(
        "each image is compared with that of lights without a range, which is drawn once",
    ),
    after_run: |_| Ok(()),
    headline: page::headline,
    findings: page::findings,
    front: |_| Html::default(),
    parts: page::parts,
    overall: |_| Html::default(),
    paper: &NO_PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};

/// The survey only proposes the method, and claims nothing of it.
const NO_PAPER: Paper = Paper { name: "no paper", about: "", checks: &[] };
