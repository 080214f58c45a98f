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

/// The study of compound deep images.
pub(crate) struct Cdi;

impl Study for Cdi {
    fn name(&self) -> &'static str {
        "cdi"
    }

    fn answers(&self) -> &'static str {
        "What deep images cost, how exact their ranges are, and how near indirect light by them is to a path-traced image"
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
        compare_with_truth(done)?;
        compare_builds(done)
    }

    fn headline(&self, done: &Done) -> Option<String> {
        tables::headline(done)
    }

    fn findings(&self, done: &Done, scene: &str) -> Vec<String> {
        tables::findings(done, scene)
    }

    fn notices(&self, done: &Done) -> Vec<String> {
        times::notices(done)
    }

    fn parts(
        &self,
        done: &Done,
        scene: &str,
        charts: &mut Charts,
        shots: &mut Shots<'_>,
    ) -> Vec<Part> {
        tables::parts(done, scene, charts, shots)
    }

    fn paper(&self) -> &'static Paper {
        &claims::PAPER
    }
}
