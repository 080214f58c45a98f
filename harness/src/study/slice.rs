//! What each study supplies.

use super::{
    claims::Paper,
    job::Job,
    manifest::Done,
    page::{figure::Charts, part::Part, shots::Shots},
    scene::StudyScene,
};
use crate::{bench::Bench, cli::StudyArgs, error::HarnessError, report::markup::Html};

/// Which jobs of a study move their lights where `--motion` asks for it.
pub(crate) enum TakesMotion {
    /// All comparisons, but those of these sections.
    AllBut(&'static [&'static str]),
    /// The study itself says which; `--motion` chooses the law.
    BySection,
    /// None, for this reason.
    None(&'static str),
}

/// A study: its jobs, and how its page shows their results. A row of data, as strategies are.
pub(crate) struct Study {
    /// Its name on the command line and in `study.json`.
    pub(crate) name: &'static str,
    /// What it answers, in one sentence without a full stop.
    pub(crate) answers: &'static str,
    /// The scenes that it measures where the command line names none.
    pub(crate) scenes: fn(&StudyArgs) -> Vec<String>,
    /// Makes the jobs of one scene, in the order in which they run. An error names what is wrong with the
    /// scene or with an option.
    pub(crate) jobs: fn(&mut Bench, &StudyArgs, &StudyScene) -> Result<Vec<Job>, HarnessError>,
    /// Which jobs take `--motion`.
    pub(crate) motion: TakesMotion,
    /// Computes what needs the images of several jobs: after a run, and before each report. An error names
    /// the image that cannot be read.
    pub(crate) after_run: fn(&mut Done) -> Result<(), HarnessError>,
    /// The sentence at the top of the page; `None` while nothing is done.
    pub(crate) headline: fn(&Done) -> Option<String>,
    /// What a scene found, one sentence each, the most important first.
    pub(crate) findings: fn(&Done, &str) -> Vec<String>,
    /// What the page shows of all scenes together, above their sections.
    pub(crate) front: fn(&Done) -> Html,
    /// The parts of a scene's section, in the order in which a reader sees them.
    pub(crate) parts: fn(&Done, &str, &mut Charts, &mut Shots<'_>) -> Vec<Part>,
    /// What the page shows of all scenes together, below their sections.
    pub(crate) overall: fn(&Done) -> Html,
    /// The paper whose claims the study judges.
    pub(crate) paper: &'static Paper,
    /// Whether the page repeats the warnings of jobs. Where each cell says what happened there, it does not.
    pub(crate) tells_warnings: bool,
    /// What a reader must know before trusting a figure; the frame of the page adds its own notices.
    pub(crate) notices: fn(&Done) -> Vec<String>,
}

/// The scene of a study that a reader can run without a file.
pub(crate) fn atrium(_: &StudyArgs) -> Vec<String> {
    vec!["atrium".to_owned()]
}
