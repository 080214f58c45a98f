//! The comparison paper (Enhuber 2019) on any scene, and what it left out: many more lights, other radii,
//! and speed against accuracy.

mod claims;
mod depth_views;
mod extent;
mod frame_jobs;
mod jobs;
mod page;

use self::page::{accuracy, frames, overview, path, scaling, sizes, views};
use super::slice::{Study, TakesMotion, atrium};
use crate::report::markup::Html;

/// The greatest relMSE at which a lossy knob is called cheap.
const CHEAP_REL_MSE: f64 = 1e-2;

/// The comparison.
pub(crate) const STUDY: Study = Study {
    name: "comparison",
    answers: "Which strategy is fastest: the comparison paper, more lights, other radii, and speed against accuracy",
    scenes: atrium,
    jobs: jobs::jobs,
    motion: TakesMotion::AllBut(&[]),
    after_run: |_| Ok(()),
    headline: overview::headline,
    findings: |done, scene| {
        let mut all = overview::findings(done, scene);
        all.extend(accuracy::cheapest(done, scene, CHEAP_REL_MSE));
        all
    },
    front: |_| Html::default(),
    parts: |done, scene, charts, shots| {
        let mut parts = Vec::from(accuracy::accuracy(done, scene, charts, shots));
        parts.extend(scaling::scaling(done, scene, charts));
        parts.push(path::path(done, scene, charts));
        parts.push(frames::frames(done, scene));
        parts.push(views::views(done, scene, charts, shots));
        parts.extend(sizes::sizes(done, scene, charts));
        parts.push(overview::overview(done, scene, charts));
        parts
    },
    overall: sizes::best_overall,
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |done| {
        done.scenes().into_iter().flat_map(|scene| overview::ties(done, scene)).collect()
    },
};
