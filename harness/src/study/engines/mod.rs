//! What the defaults of engines cost: their times, their lists, the light that they lose, and the nearest setting
//! that loses none.
//!
//! An engine's default is one of our strategies with the engine's grid, slices and limits
//! (`strategy::engines`). Some engines limit the lights of a frame or of a list, and so lose light. Beside each
//! such default, the study measures the same strategy without these limits. All methods run in the same jobs:
//!
//! 1. `path`: times and errors of images, as means along the scene's path.
//! 2. `view`: lists that are checked pair by pair, and pictures, from the still camera.

mod cases;
mod jobs;
mod page;
mod sentences;

use super::claims::Paper;
use super::slice::{Study, TakesMotion, atrium};
use crate::report::markup::Html;

/// The study of engines.
pub(crate) const STUDY: Study = Study {
    name: "engines",
    answers: "What the defaults of engines cost with 1,000 and 10,000 lights: time, lists, and light that is lost",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::None(
        "the CPU chooses lights for the engines' limits, and does not know the order of lights that move",
    ),
    after_run: |_| Ok(()),
    headline: sentences::headline,
    findings: sentences::findings,
    front: |_| Html::default(),
    parts: page::parts,
    overall: page::differences,
    paper: &NO_PAPER,
    tells_warnings: true,
    notices: sentences::notices,
};

/// No paper claims anything of these defaults.
const NO_PAPER: Paper = Paper { name: "no paper", about: "", checks: &[] };
