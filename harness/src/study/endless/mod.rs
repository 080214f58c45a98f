//! Many polygon lights through clusters with normal cones (Swarbrick 2025, chapter 5): light operations and
//! times, from three places.

mod cases;
mod charts;
mod claims;
mod jobs;
mod page;

use super::slice::{Study, TakesMotion, atrium};
use crate::report::markup::Html;

/// The study of many polygon lights.
pub(crate) const STUDY: Study = Study {
    name: "endless",
    answers: "What normal cones gain under many polygon lights: light operations and times",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::AllBut(&[]),
    after_run: |_| Ok(()),
    headline: page::headline,
    findings: page::findings,
    front: |_| Html::default(),
    parts: page::places,
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};
