//! Models of area lights (Dobetsberger 2025, chapter 5): how far each is from the truth, what it costs,
//! what area lights cost beside spots, and what bounding them by balls costs.

mod claims;
mod jobs;
mod page;

pub use self::jobs::BOUNDS;
use self::page::{cost, models, pictures};
use super::against_truth::compare_with_truth;
use super::{
    claims::Paper,
    job::Job,
    manifest::Done,
    page::{figure::Charts, part::Part, shots::Shots},
    scene::StudyScene,
    slice::Study,
};
use crate::{bench::Bench, cli::StudyArgs, error::HarnessError};

/// The study of area lights.
pub(crate) struct Area;

impl Study for Area {
    fn name(&self) -> &'static str {
        "area"
    }

    fn answers(&self) -> &'static str {
        "How far each model of area lights is from the truth, what it costs, and what area lights cost beside spots"
    }

    fn jobs(
        &self,
        bench: &mut Bench,
        args: &StudyArgs,
        scene: &StudyScene,
    ) -> Result<Vec<Job>, HarnessError> {
        jobs::jobs(bench, args, scene)
    }

    fn after_run(&self, done: &mut Done) -> Result<(), HarnessError> {
        compare_with_truth(done)
    }

    fn headline(&self, done: &Done) -> Option<String> {
        models::headline(done)
    }

    fn findings(&self, done: &Done, scene: &str) -> Vec<String> {
        [models::findings(done, scene), cost::findings(done, scene)].concat()
    }

    fn parts(
        &self,
        done: &Done,
        scene: &str,
        charts: &mut Charts,
        shots: &mut Shots<'_>,
    ) -> Vec<Part> {
        let mut parts = models::models(done, scene, charts, shots);
        parts.extend(pictures::pictures(done, scene, shots));
        parts.extend(cost::cost(done, scene, charts));
        parts
    }

    fn paper(&self) -> &'static Paper {
        &claims::PAPER
    }
}
