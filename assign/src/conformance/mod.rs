//! The conformance suite: does a strategy keep the promises of the contract?
//!
//! ```no_run
//! # use assign::{AssignError, Everything, conformance};
//! conformance::run(&|gpu| Ok(Box::new(Everything::new(gpu)?))).expect("conforms");
//! conformance::rejects_faults(&|gpu| Ok(Box::new(Everything::new(gpu)?))).expect("rejects");
//! ```
//!
//! # How
//!
//! 1. A case of [`CASES`] traces procedural surfaces on the CPU, a depth and a normal a pixel,
//!    and places lights: a third of them barely reach a sample, where a test that is a little
//!    too tight shows.
//! 2. The surfaces are drawn into a real depth buffer and normals. Samples are every pixel with
//!    a surface and, where the strategy serves them, points at random depths, the near and the
//!    far plane among them.
//! 3. The strategy prepares and records a frame. A probe shader then rebuilds every sample as
//!    shading does, asks the strategy's own `group_of` and `list_of`, and writes down where the
//!    sample lies and what list it got.
//! 4. Everything is read back and checked on the CPU. Whether a light reaches the sample is
//!    [`Light::reach`](crate::Light::reach) in f64 at the position that shading would use; a pair
//!    closer to the edge than one part in a million does not count. Nor does one whose light stays
//!    below the sample's horizon, [`Light::above_horizon`](crate::Light::above_horizon), where the
//!    strategy [needs](crate::Needs) normals. Every other sample is looked up with the normal as the
//!    G-buffer rounds it, as deferred shading does, and with the exact one, as forward shading does.
//!
//! Records are filled with a mark before a case's first frame, so that a list which no pass wrote
//! shows. Frames repeat until no list overflows (at most six), then once more: the same frame
//! must give the same lists. Every frame is checked, also those that overflow.
//!
//! # What is checked
//!
//! See [`Breach`]: one value a promise. A case that should have had (light, sample) pairs and had
//! none fails too, so nothing passes for want of a question.
//!
//! # What a strategy may refuse
//!
//! Look-ups at any depth, by [`AssignError::Unsupported`] from `prepare`: the case then runs with
//! those on opaque surfaces. A whole case, likewise: it is [`Outcome::Unserved`], which
//! [`run_allowing`] accepts of the cases it is given.
//!
//! # Negative controls
//!
//! [`rejects_faults`] plants each [`Fault`] in the strategy and demands that the
//! suite names it.

mod cases;
mod check;
pub mod faulty;
mod flat_depth;
mod lights;
mod linked;
mod reaching;
mod rig;
mod run_kernel;
mod session;
mod stage;
mod views;
mod violation;

use std::sync::OnceLock;

pub use cases::{CASES, Case};
use faulty::{Fault, Faulty};
pub use flat_depth::flat_depth;
pub use linked::{LinkedModule, StructLayout};
use rig::Rig;
pub use run_kernel::{Bound, download, run_kernel, upload};
pub use violation::{
    Breach, CaseReport, ConformanceError, Figures, Outcome, Place, Report, SamplePlace, Violation,
};

use crate::{AssignError, Assignment, Gpu};

/// Makes a fresh instance of the strategy under test.
pub type Make<'a> = dyn Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> + 'a;

/// Runs all cases; an error holds every violation, a line each.
///
/// It needs an adapter, a software one will do; without one it is an error, never a pass.
pub fn run(make: &Make<'_>) -> Result<Report, ConformanceError> {
    run_allowing(make, &[])
}

/// Runs all cases; those named in `unserved` may be refused.
pub fn run_allowing(make: &Make<'_>, unserved: &[&str]) -> Result<Report, ConformanceError> {
    if let Some(name) = unserved.iter().find(|name| find(name).is_err()) {
        return Err(ConformanceError::NoCase((*name).to_owned()));
    }
    let rig = rig()?;
    let mut report = Report { strategy: make(&rig.gpu).map_err(setup)?.id(), cases: Vec::new() };
    for case in CASES {
        report.cases.push(one(rig, case, make)?);
    }
    let may = |case: &CaseReport| match case.outcome {
        Outcome::Passed(_) => true,
        Outcome::Unserved(_) => unserved.contains(&case.case),
        Outcome::Failed(_) => false,
    };
    if report.cases.iter().all(may) { Ok(report) } else { Err(ConformanceError::Rejected(report)) }
}

/// Runs one case of [`CASES`]. Violations are an error; a refusal is an outcome.
pub fn run_case(name: &str, make: &Make<'_>) -> Result<CaseReport, ConformanceError> {
    let case = find(name)?;
    let rig = rig()?;
    let done = one(rig, case, make)?;
    if let Outcome::Failed(_) = done.outcome {
        return Err(ConformanceError::Rejected(Report {
            strategy: make(&rig.gpu).map_err(setup)?.id(),
            cases: vec![done],
        }));
    }
    Ok(done)
}

/// Plants every fault that applies to the strategy and demands that the suite rejects it as what
/// it is. Returns the faults that were planted.
pub fn rejects_faults(make: &Make<'_>) -> Result<Vec<Fault>, ConformanceError> {
    let rig = rig()?;
    let plain = find("33-lights")?;
    let has_groups = session::has_groups(rig, plain, make).map_err(|e| failed(plain, e))?;
    let normals = make(&rig.gpu).map_err(setup)?.needs().normals;
    let mut planted = Vec::new();
    for fault in Fault::ALL {
        let applies = (has_groups || !fault.needs_groups()) && (normals || !fault.needs_normals());
        if !applies {
            continue;
        }
        rejects_fault(fault, make)?;
        planted.push(fault);
    }
    Ok(planted)
}

/// Plants one fault and demands that the suite rejects it as what it is.
pub fn rejects_fault(fault: Fault, make: &Make<'_>) -> Result<(), ConformanceError> {
    let (name, breach) = fault.shows_in();
    let case = find(name)?;
    let faulty = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Faulty::new(gpu, make(gpu)?, fault)?))
    };
    let outcome = one(rig()?, case, &faulty)?.outcome;
    let is_named = match &outcome {
        Outcome::Failed(violations) => {
            let is_early = |v: &Violation| v.stage < fault.shows_from_stage();
            violations.iter().any(|v| v.breach == breach) && !violations.iter().any(is_early)
        }
        _ => false,
    };
    if is_named {
        return Ok(());
    }
    Err(ConformanceError::FaultPassed {
        fault: format!("{fault:?}"),
        case: case.name,
        outcome: format!("{outcome:?}"),
    })
}

/// One device for all tests of a process.
fn rig() -> Result<&'static Rig, ConformanceError> {
    static RIG: OnceLock<Result<Rig, AssignError>> = OnceLock::new();
    let opened = RIG.get_or_init(|| Gpu::open(None).map(Rig::new));
    opened.as_ref().map_err(|error| setup(error.clone()))
}

fn find(name: &str) -> Result<&'static Case, ConformanceError> {
    let found = CASES.iter().find(|case| case.name == name);
    found.ok_or_else(|| ConformanceError::NoCase(name.to_owned()))
}

fn one(rig: &Rig, case: &Case, make: &Make<'_>) -> Result<CaseReport, ConformanceError> {
    let outcome = session::run(rig, case, make).map_err(|error| failed(case, error))?;
    Ok(CaseReport { case: case.name, outcome })
}

fn failed(case: &Case, error: AssignError) -> ConformanceError {
    ConformanceError::Assign { case: case.name, error }
}

fn setup(error: AssignError) -> ConformanceError {
    ConformanceError::Assign { case: "setup", error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Everything;

    #[test]
    fn a_case_that_asks_nothing_fails() {
        let case = Case { has_pairs: true, ..*find("no-lights").unwrap() };
        let outcome =
            session::run(rig().unwrap(), &case, &|gpu| Ok(Box::new(Everything::new(gpu)?)));
        let Ok(Outcome::Failed(violations)) = outcome else {
            panic!("{outcome:?}");
        };
        assert_eq!(violations.len(), 1);
        assert_eq!(violations[0].breach, Breach::Vacuous);
    }

    #[test]
    fn a_violation_is_one_line_that_names_its_place() {
        let violation = Violation {
            case: "jitter",
            stage: 0,
            frame: 1,
            breach: Breach::MissedPair,
            place: Place {
                group: Some(3),
                light: Some(7),
                sample: Some(SamplePlace { pixel: [1.5, 2.5], depth_m: 4.25 }),
            },
            detail: "the list holds 2".into(),
            count: 9,
        };
        let line = "case jitter, frame 1: missed pair, group 3, light 7, sample at pixel (1.5, 2.5) \
                    depth 4.25 m: the list holds 2 (9 such)";
        assert_eq!(violation.to_string(), line);
    }
}
