//! Many polygon lights through clusters with normal cones (Swarbrick 2025, chapter 5): light operations and
//! times, from three places.

mod cases;
mod charts;
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

/// The study of many polygon lights.
pub(crate) struct Endless;

impl Study for Endless {
    fn name(&self) -> &'static str {
        "endless"
    }

    fn answers(&self) -> &'static str {
        "What normal cones gain under many polygon lights: light operations and times"
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
        shots: &mut Shots<'_>,
    ) -> Vec<Part> {
        page::places(done, scene, charts, shots)
    }

    fn paper(&self) -> &'static Paper {
        &claims::PAPER
    }
}
