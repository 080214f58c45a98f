//! Where methods fail: every scenario of `scenes::stability` with every strategy in both modes, still and over time.
//!
//! A scenario is a scene of the study. Its jobs:
//!
//! 1. `still`: one frame. Lists are checked pair by pair, images bit by bit.
//! 2. `over-time-MOVE`: frames in which the camera or the lights move, images bit by bit in each.
//! 3. `flawed`: methods that fail on purpose (`strategy::flaws`). They are the negative control: where none of them
//!    fails, the scenario tests little.
//!
//! The page begins with a matrix of all scenarios and methods (`matrix.rs`). Each cell leads to what was seen there
//! (`page.rs`).

mod cells;
mod jobs;
mod matrix;
mod outcome;
mod page;
mod sentences;

pub(crate) use jobs::scenario_of;

use super::claims::Paper;
use super::slice::{Study, TakesMotion};
use crate::report::markup::Html;

/// The study of stability.
pub(crate) const STUDY: Study = Study {
    name: "stability",
    answers: "Where methods fail: every scenario with every strategy, still and over time, beside methods that fail \
              on purpose",
    scenes: jobs::scenes,
    jobs: jobs::jobs,
    motion: TakesMotion::None("each scenario has the motions that break methods there"),
    after_run: |_| Ok(()),
    headline: sentences::headline,
    findings: |_, _| Vec::new(),
    front: matrix::matrices,
    parts: page::parts,
    overall: |_| Html::default(),
    paper: &NO_PAPER,
    tells_warnings: false,
    notices: sentences::notices,
};

/// No paper claims anything of these scenarios.
const NO_PAPER: Paper = Paper { name: "no paper", about: "", checks: &[] };
