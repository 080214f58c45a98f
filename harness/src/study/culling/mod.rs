//! The culling survey (Watrous 2024): 0 to 1,500 lights in spawn cylinders, along a path, in both modes.

mod claims;
mod jobs;
mod page;

use super::{
    claims::Paper,
    job::Job,
    manifest::Done,
    page::{figure::Charts, part::Part, shots::Shots},
    scene::StudyScene,
    slice::Study,
};
use crate::{bench::Bench, cli::StudyArgs, error::HarnessError};

/// The culling survey.
pub(crate) struct Culling;

impl Study for Culling {
    fn name(&self) -> &'static str {
        "culling"
    }

    fn answers(&self) -> &'static str {
        "What culling gains in a frame with 0 to 1,500 lights along a path, deferred and forward"
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
        page::headline(done)
    }

    fn findings(&self, done: &Done, scene: &str) -> Vec<String> {
        page::findings(done, scene)
    }

    fn parts(
        &self,
        done: &Done,
        scene: &str,
        charts: &mut Charts,
        _shots: &mut Shots<'_>,
    ) -> Vec<Part> {
        page::modes(done, scene, charts)
    }

    fn paper(&self) -> &'static Paper {
        &claims::PAPER
    }
}
