//! The cells of the matrix: what each method did in each scenario.

use std::str::FromStr;

use super::jobs::{FLAWED, SEPARATOR};
use super::outcome::{Outcome, words};
use crate::cli::Size;
use crate::results::{Mode, Record, Results};
use crate::strategy::{Flaw, Role, StrategyId, flaws, rows};
use crate::study::data::Entry;
use crate::study::job::Job;
use crate::study::manifest::Done;

/// One run of a method in a scenario.
pub(crate) struct Case<'a> {
    pub(crate) job: &'a Job,
    pub(crate) id: StrategyId,
    pub(crate) mode: Option<Mode>,
    pub(crate) outcome: Outcome,
    /// What was seen, or why it was refused.
    pub(crate) words: String,
    pub(crate) entry: Option<Entry<'a>>,
}

/// A method in a scenario: all its runs.
pub(crate) struct Cell<'a> {
    pub(crate) method: Method,
    pub(crate) cases: Vec<Case<'a>>,
}

impl Cell<'_> {
    /// The worst of its runs; `None` where it did not run.
    pub(crate) fn outcome(&self) -> Option<Outcome> {
        self.cases.iter().map(|case| case.outcome).max()
    }

    /// Why it refuses some runs, if it does not refuse all of them.
    pub(crate) fn refuses_some(&self) -> Option<&Case<'_>> {
        let refused = self.cases.iter().find(|case| case.outcome == Outcome::Refused)?;
        (self.outcome() != Some(Outcome::Refused)).then_some(refused)
    }

    /// The run that shows its outcome best: the first of the worst.
    pub(crate) fn worst(&self) -> Option<&Case<'_>> {
        let worst = self.outcome()?;
        self.cases.iter().find(|case| case.outcome == worst)
    }
}

/// A column of the matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// A method that should not fail.
    Sound(StrategyId),
    /// A method that fails on purpose.
    Flawed(&'static Flaw),
}

impl Method {
    /// Its id in a job.
    fn id_in(&self, job: &Job) -> StrategyId {
        match self {
            Self::Sound(id) => id.clone(),
            Self::Flawed(flaw) => {
                // The ids of engines' defaults depend on the size of the image.
                let size = job.option("--size").and_then(|size| Size::from_str(size).ok());
                let size = size.map_or([1, 1], |size| [size.width, size.height]);
                flaw.id_at(size)
            }
        }
    }

    /// The outcome of one of its records. A method that fails on purpose has failed if it lost light, stated or not.
    fn outcome(&self, record: &Record) -> Outcome {
        match (self, Outcome::of(record)) {
            (Self::Flawed(_), Outcome::Lossy) => Outcome::Wrong,
            (_, outcome) => outcome,
        }
    }

    /// The head of its column.
    pub(crate) fn head(&self) -> String {
        match self {
            Self::Sound(id) => id.family().to_owned(),
            Self::Flawed(_) => self.name(),
        }
    }

    /// What the page calls it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Sound(id) => id.to_string(),
            Self::Flawed(flaw) => [&[flaw.id], flaw.options].concat().join(" "),
        }
    }

    /// Whether it fails in some scenarios only, and so tells what a scenario tests.
    pub(crate) fn tells_scenarios(&self) -> bool {
        match self {
            Self::Sound(_) => true,
            Self::Flawed(flaw) => flaw.options.is_empty() && !flaw.id.ends_with("/unordered"),
        }
    }

    /// Whether a job ran it.
    fn is_in(&self, job: &Job) -> bool {
        match self {
            Self::Sound(_) => job.section != FLAWED,
            Self::Flawed(flaw) => {
                let names = job.settings.text("flaws").unwrap_or_default();
                names.split(SEPARATOR).any(|name| name == flaw.name)
            }
        }
    }
}

/// The methods of a study without those that fail on purpose, in the order of its records.
pub(crate) fn methods(done: &Done) -> Vec<Method> {
    let mut ids: Vec<StrategyId> = Vec::new();
    for (job, results) in jobs_of(done, None) {
        if job.section == FLAWED {
            continue;
        }
        let refused = results.refused.iter().map(|refused| StrategyId::read(&refused.strategy));
        for id in results.records.iter().map(|record| record.strategy.clone()).chain(refused) {
            if !ids.contains(&id) && id.role() != Some(Role::Control) {
                ids.push(id);
            }
        }
    }
    let order = |id: &StrategyId| rows().position(|row| row.family == id.family());
    ids.sort_by_key(|id| order(id).unwrap_or(usize::MAX));
    ids.into_iter().map(Method::Sound).collect()
}

/// The methods that fail on purpose, of which the study has records.
pub(crate) fn flawed_methods(done: &Done) -> Vec<Method> {
    let all = flaws().map(Method::Flawed);
    all.filter(|method| jobs_of(done, None).any(|(job, _)| method.is_in(job))).collect()
}

/// What a method did in a scenario.
pub(crate) fn cell<'a>(done: &'a Done, scenario: &'a str, method: &Method) -> Cell<'a> {
    let mut cases = Vec::new();
    for (job, results) in jobs_of(done, Some(scenario)) {
        if !method.is_in(job) {
            continue;
        }
        let id = method.id_in(job);
        for record in results.records.iter().filter(|record| record.strategy == id) {
            let entry = Some(Entry::new(job, record, &results.machine));
            let (outcome, words) = (method.outcome(record), words(record));
            let (id, mode) = (id.clone(), Some(record.setting.mode));
            cases.push(Case { job, id, mode, outcome, words, entry });
        }
        let refused = results.refused.iter().filter(|refused| refused.strategy == id.as_str());
        cases.extend(refused.map(|refused| Case {
            job,
            id: id.clone(),
            mode: refused.mode,
            outcome: Outcome::Refused,
            words: refused.reason.clone(),
            entry: None,
        }));
    }
    Cell { method: method.clone(), cases }
}

/// The jobs that are done, of one scenario or of all.
fn jobs_of<'a>(
    done: &'a Done,
    scenario: Option<&'a str>,
) -> impl Iterator<Item = (&'a Job, &'a Results)> {
    let jobs = done.manifest.jobs.iter();
    let jobs = jobs.filter(move |job| scenario.is_none_or(|scenario| job.scene == scenario));
    jobs.filter_map(|job| Some((job, done.results.get(&job.name)?)))
}
