//! What each study supplies.

use super::{
    claims::Paper,
    job::Job,
    manifest::Done,
    page::{figure::Charts, part::Part, shots::Shots},
    scene::StudyScene,
};
use crate::{bench::Bench, cli::StudyArgs, error::HarnessError, report::markup::Html};

/// A study: its jobs, and how its page shows their results.
pub(crate) trait Study: Sync {
    /// Its name on the command line and in `study.json`.
    fn name(&self) -> &'static str;

    /// What it answers, in one sentence without a full stop.
    fn answers(&self) -> &'static str;

    /// The jobs of one scene, in the order in which they run.
    ///
    /// # Errors
    ///
    /// Names what is wrong with the scene or with an option.
    fn jobs(
        &self,
        bench: &mut Bench,
        args: &StudyArgs,
        scene: &StudyScene,
    ) -> Result<Vec<Job>, HarnessError>;

    /// Computes what needs the images of several jobs: after a run, and before each report.
    ///
    /// # Errors
    ///
    /// Names the image that cannot be read.
    fn after_run(&self, _done: &mut Done) -> Result<(), HarnessError> {
        Ok(())
    }

    /// The sentence at the top of the page; `None` while nothing is done.
    fn headline(&self, done: &Done) -> Option<String>;

    /// What a scene found, one sentence each, the most important first.
    fn findings(&self, done: &Done, scene: &str) -> Vec<String>;

    /// The parts of a scene's section, in the order in which a reader sees them.
    fn parts(
        &self,
        done: &Done,
        scene: &str,
        charts: &mut Charts,
        shots: &mut Shots<'_>,
    ) -> Vec<Part>;

    /// What the page shows of all scenes together, below them.
    fn overall(&self, _done: &Done) -> Html {
        Html::default()
    }

    /// The paper whose claims the study judges.
    fn paper(&self) -> &'static Paper;

    /// What a reader must know before trusting a figure; the frame of the page adds its own notices.
    fn notices(&self, _done: &Done) -> Vec<String> {
        Vec::new()
    }
}
