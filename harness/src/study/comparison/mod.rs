//! The comparison paper (Enhuber 2019) on any scene, and what it left out: many more lights, other radii,
//! and speed against accuracy.

mod claims;
mod depth_views;
mod extent;
mod frame_jobs;
mod jobs;
mod page;

use self::page::{accuracy, frames, overview, path, scaling, sizes, views};
use super::{
    claims::Paper,
    job::Job,
    manifest::Done,
    page::{figure::Charts, part::Part, shots::Shots},
    scene::StudyScene,
    slice::Study,
};
use crate::{bench::Bench, cli::StudyArgs, error::HarnessError, report::markup::Html};

/// The greatest relMSE at which a lossy knob is called cheap.
const CHEAP_REL_MSE: f64 = 1e-2;

/// The comparison.
pub(crate) struct Comparison;

impl Study for Comparison {
    fn name(&self) -> &'static str {
        "comparison"
    }

    fn answers(&self) -> &'static str {
        "Which strategy is fastest: the comparison paper, more lights, other radii, and speed against accuracy"
    }

    fn jobs(
        &self,
        bench: &mut Bench,
        args: &StudyArgs,
        scene: &StudyScene,
    ) -> Result<Vec<Job>, HarnessError> {
        jobs::jobs(bench, args, scene)
    }

    fn headline(&self, done: &Done) -> Option<String> {
        overview::headline(done)
    }

    fn findings(&self, done: &Done, scene: &str) -> Vec<String> {
        let mut all = overview::findings(done, scene);
        all.extend(accuracy::cheapest(done, scene, CHEAP_REL_MSE));
        all
    }

    fn parts(
        &self,
        done: &Done,
        scene: &str,
        charts: &mut Charts,
        shots: &mut Shots<'_>,
    ) -> Vec<Part> {
        let mut parts = Vec::from(accuracy::accuracy(done, scene, charts, shots));
        parts.extend(scaling::scaling(done, scene, charts));
        parts.push(path::path(done, scene, charts));
        parts.push(frames::frames(done, scene));
        parts.push(views::views(done, scene, charts, shots));
        parts.extend(sizes::sizes(done, scene, charts));
        parts.push(overview::overview(done, scene, charts));
        parts
    }

    fn overall(&self, done: &Done) -> Html {
        sizes::best_overall(done)
    }

    fn paper(&self) -> &'static Paper {
        &claims::PAPER
    }

    fn notices(&self, done: &Done) -> Vec<String> {
        done.scenes().into_iter().flat_map(|scene| overview::ties(done, scene)).collect()
    }
}
