//! The culling survey (Watrous 2024): 0 to 1,500 lights in spawn cylinders, along a path, in both modes.

mod claims;
mod jobs;
mod page;

use super::slice::{Study, TakesMotion, atrium};
use crate::report::markup::Html;

/// The culling survey.
pub(crate) const STUDY: Study = Study {
    name: "culling",
    answers: "What culling gains in a frame with 0 to 1,500 lights along a path, deferred and forward",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::AllBut(&[]),
    after_run: |_| Ok(()),
    headline: page::headline,
    findings: page::findings,
    front: |_| Html::default(),
    parts: |done, scene, charts, _| page::modes(done, scene, charts),
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};
