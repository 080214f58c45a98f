//! The living frame: everything that lights which move cost in each frame, from a thousand lights to four
//! million, beside still lights and beside the figures of Van Oosten 2017.

mod claims;
mod jobs;
mod movement;
mod page;

use self::page::{bill, density, images, times};
use super::slice::{Study, TakesMotion, atrium};
use crate::report::markup::Html;

/// The study of the living frame.
pub(crate) const STUDY: Study = Study {
    name: "living",
    answers: "What lights that move cost in each frame, from 1,000 lights to 4,000,000",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::BySection,
    after_run: |_| Ok(()),
    headline: times::headline,
    findings: times::findings,
    front: |_| Html::default(),
    parts: |done, scene, charts, _| {
        vec![
            times::times(done, scene, charts),
            bill::bill(done, scene, charts),
            bill::memory(done, scene, charts),
            bill::kinds(done, scene, charts),
            density::density(done, scene),
            images::images(done, scene),
        ]
    },
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};
