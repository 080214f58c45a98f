//! The suite's results: violations, figures and errors, each in one line.

use std::fmt;

use crate::AssignError;

/// A broken promise of the contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breach {
    /// A light reaches a sample, but the list of the sample's group lacks the light or the flag of
    /// a term that reaches.
    MissedPair,
    /// A list's light indices do not ascend.
    NotAscending,
    /// A list names a light twice.
    Repeated,
    /// An entry names a light that does not exist.
    ForeignLight,
    /// An entry has neither of the flags DIFFUSE and SPECULAR.
    NoTerm,
    /// A list ends beyond the entry buffer.
    OutsideBuffer,
    /// `group_of` returned a group that does not exist.
    NoSuchGroup,
    /// A sample's group has a record that no pass wrote.
    Unwritten,
    /// Record 0 does not list all lights.
    Record0,
    /// The counters contradict the lists.
    Counters,
    /// The look-up's record differs from the one read back.
    Lookup,
    /// The same frame, drawn twice, gave different lists.
    Unstable,
    /// The pool did not grow to what the lists need.
    OverflowStays,
    /// A pool that is far too small caused no counted overflow.
    NoOverflow,
    /// Faulty lights were accepted, not counted, or changed the lists of other lights.
    Quarantine,
    /// The slots of lights that the GPU orders do not hold each sound light once.
    Slots,
    /// A case that should have (light, sample) pairs had none, so it checked nothing.
    Vacuous,
}

impl Breach {
    fn text(self) -> &'static str {
        match self {
            Self::MissedPair => "missed pair",
            Self::NotAscending => "list not ascending",
            Self::Repeated => "light repeated",
            Self::ForeignLight => "light does not exist",
            Self::NoTerm => "entry without a term",
            Self::OutsideBuffer => "list outside the buffer",
            Self::NoSuchGroup => "group does not exist",
            Self::Unwritten => "record never written",
            Self::Record0 => "record 0 is not all lights",
            Self::Counters => "counters wrong",
            Self::Lookup => "look-up wrong",
            Self::Unstable => "same frame, different list",
            Self::OverflowStays => "overflow does not end",
            Self::NoOverflow => "no overflow counted",
            Self::Quarantine => "quarantine broken",
            Self::Slots => "light without a slot of its own",
            Self::Vacuous => "nothing was checked",
        }
    }
}

/// Where a violation occurred. Fields that do not apply are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// The group.
    pub group: Option<u32>,
    /// The light's index.
    pub light: Option<u32>,
    /// The view sample.
    pub sample: Option<SamplePlace>,
}

/// A view sample, located in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplePlace {
    /// Pixel centre in the target.
    pub pixel: [f32; 2],
    /// View depth, metres.
    pub depth_m: f32,
}

/// A broken promise, with its place. Its `Display` is one line.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The case's name.
    pub case: &'static str,
    /// The stage of the case, from 0. Lights and camera do not move within a stage.
    pub stage: u32,
    /// The frame of the case, from 0.
    pub frame: u32,
    /// The promise.
    pub breach: Breach,
    /// Where the first such violation occurred.
    pub place: Place,
    /// What was found there.
    pub detail: String,
    /// How many such violations the frame had.
    pub count: u64,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (case, frame) = (self.case, self.frame);
        write!(f, "case {case}, frame {frame}: {}", self.breach.text())?;
        let Place { group, light, sample } = self.place;
        if let Some(group) = group {
            write!(f, ", group {group}")?;
        }
        if let Some(light) = light {
            write!(f, ", light {light}")?;
        }
        if let Some(SamplePlace { pixel, depth_m }) = sample {
            let [x, y] = pixel;
            write!(f, ", sample at pixel ({x}, {y}) depth {depth_m} m")?;
        }
        write!(f, ": {}", self.detail)?;
        if self.count > 1 {
            write!(f, " ({} of this kind)", self.count)?;
        }
        Ok(())
    }
}

/// Counts of what a case checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Frames drawn.
    pub frames: u32,
    /// View samples looked up, all frames together.
    pub samples: u64,
    /// (light, sample) pairs that had to be in the lists.
    pub pairs: u64,
    /// (light, sample) pairs that the lists held.
    pub listed: u64,
    /// View samples and listed pairs of the frames in which every list fitted.
    pub fitting: [u64; 2],
    /// Whether look-ups at any depth were also served and checked.
    pub any_depth: bool,
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The strategy kept all promises.
    Passed(Figures),
    /// The strategy refused the case before its first frame.
    Unserved(String),
    /// The strategy broke promises.
    Failed(Vec<Violation>),
}

/// One case's outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseReport {
    /// The case's name.
    pub case: &'static str,
    /// How it ended.
    pub outcome: Outcome,
}

/// The outcome of every case. Its `Display` is one line per case or violation.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The strategy's id.
    pub strategy: String,
    /// The cases' reports, in the order of [`CASES`](super::CASES).
    pub cases: Vec<CaseReport>,
}

impl CaseReport {
    /// Mean number of entries that a sample reads in frames in which every list fitted; `None` if the case did not
    /// pass. When counters arrive decides how many frames overflow, and lists of all lights would drown the others.
    pub fn listed_per_sample(&self) -> Option<f64> {
        match &self.outcome {
            Outcome::Passed(Figures { fitting: [samples, listed], .. }) => {
                Some(*listed as f64 / (*samples).max(1) as f64)
            }
            Outcome::Failed(_) | Outcome::Unserved(_) => None,
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for CaseReport { case, outcome } in &self.cases {
            let strategy = &self.strategy;
            match outcome {
                Outcome::Passed(figures) => writeln!(
                    f,
                    "{strategy} {case}: {} frames, {} samples, {} pairs, {} listed",
                    figures.frames, figures.samples, figures.pairs, figures.listed
                )?,
                Outcome::Unserved(reason) => writeln!(f, "{strategy} {case}: unserved: {reason}")?,
                Outcome::Failed(violations) => {
                    for violation in violations {
                        writeln!(f, "{strategy} {violation}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Why a strategy does not conform. `Debug` prints the same as `Display`, so that a failing
/// `expect` is readable.
#[derive(Clone, thiserror::Error)]
#[non_exhaustive]
pub enum ConformanceError {
    /// No case has that name.
    #[error("no conformance case is named {0}")]
    NoCase(String),
    /// The strategy or the device failed without breaking a promise.
    #[error("case {case}: {error}")]
    Assign {
        /// The case's name; `setup` before the first case.
        case: &'static str,
        /// The error.
        error: AssignError,
    },
    /// The strategy broke promises, or refused cases that it may not refuse.
    #[error("does not conform:\n{}", failures(.0))]
    Rejected(Report),
    /// The suite did not reject a planted fault with the right breach.
    #[error("case {case} did not reject the planted fault {fault}: {outcome}")]
    FaultPassed {
        /// The fault's name.
        fault: String,
        /// The case that should have rejected it.
        case: &'static str,
        /// The case's outcome.
        outcome: String,
    },
}

impl fmt::Debug for ConformanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

fn failures(report: &Report) -> String {
    let failed = report.cases.iter().filter(|c| !matches!(c.outcome, Outcome::Passed(_)));
    Report { strategy: report.strategy.clone(), cases: failed.cloned().collect() }.to_string()
}

/// Collects the violations of one case. It keeps the first of each kind in each frame and counts
/// the others.
#[derive(Debug)]
pub(super) struct Findings {
    pub(super) case: &'static str,
    pub(super) stage: u32,
    pub(super) frame: u32,
    pub(super) violations: Vec<Violation>,
}

impl Findings {
    pub(super) fn new(case: &'static str) -> Self {
        Self { case, stage: 0, frame: 0, violations: Vec::new() }
    }

    pub(super) fn add(&mut self, breach: Breach, place: Place, detail: String) {
        self.add_with(breach, place, || detail);
    }

    /// As [`add`](Self::add), but makes the detail only for the first of its kind in a frame.
    pub(super) fn add_with(
        &mut self,
        breach: Breach,
        place: Place,
        detail: impl FnOnce() -> String,
    ) {
        let same = |v: &&mut Violation| v.frame == self.frame && v.breach == breach;
        if let Some(known) = self.violations.iter_mut().find(same) {
            known.count += 1;
            return;
        }
        self.violations.push(Violation {
            case: self.case,
            stage: self.stage,
            frame: self.frame,
            breach,
            place,
            detail: detail(),
            count: 1,
        });
    }
}
