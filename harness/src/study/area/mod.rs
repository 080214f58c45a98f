//! Models of area lights (Dobetsberger 2025, chapter 5): how far each is from the truth, what it costs,
//! what area lights cost beside spots, and what bounding them by balls costs.

mod claims;
mod jobs;
mod page;

pub use self::jobs::BOUNDS;
use self::page::{cost, models, pictures};
use super::{
    against_truth::{MODELS, TRUTH, TruthOf, compare_with_truths},
    slice::{Study, TakesMotion, atrium},
};
use crate::report::markup::Html;

/// The study of area lights.
pub(crate) const STUDY: Study = Study {
    name: "area",
    answers: "How far each model of area lights is from the truth, what it costs, and what area lights cost beside spots",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::AllBut(&[MODELS]),
    after_run: |done| compare_with_truths(done, &[(MODELS, TRUTH)], TruthOf::Scene),
    headline: models::headline,
    findings: |done, scene| [models::findings(done, scene), cost::findings(done, scene)].concat(),
    front: |_| Html::default(),
    parts: |done, scene, charts, shots| {
        let mut parts = models::models(done, scene, charts, shots);
        parts.extend(pictures::pictures(done, scene, shots));
        parts.extend(cost::cost(done, scene, charts));
        parts
    },
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};
