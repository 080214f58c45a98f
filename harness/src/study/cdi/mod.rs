//! Compound deep images (Archer, Leach, Knowles 2019): time of every step, ranges against exact rays,
//! and indirect light by virtual point lights against a path-traced image.

mod against_builds;
mod claims;
mod jobs;
mod lights;
mod page;
mod same_build;
mod times;
mod verdicts;

use self::against_builds::compare_builds;
use self::page::tables;
use super::{
    against_truth::{MODELS, TRUTH, TruthOf, compare_with_truths},
    slice::{Study, TakesMotion, atrium},
};
use crate::report::markup::Html;

/// The study of compound deep images.
pub(crate) const STUDY: Study = Study {
    name: "cdi",
    answers: "What deep images cost, how exact their ranges are, and how near indirect light by them is to a path-traced image",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::None("its lights are virtual ones, or the one primary light"),
    after_run: |done| {
        compare_with_truths(done, &[(MODELS, TRUTH)], TruthOf::Scene)?;
        compare_builds(done)
    },
    headline: tables::headline,
    findings: tables::findings,
    front: |_| Html::default(),
    parts: tables::parts,
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: times::notices,
};
