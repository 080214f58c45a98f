//! The conformance suite: it checks whether a strategy keeps the promises of the contract.
//!
//! ```no_run
//! # use assign::{AssignError, Everything, conformance};
//! conformance::run(&|gpu| Ok(Box::new(Everything::new(gpu)?))).expect("conforms");
//! conformance::rejects_faults(&|gpu| Ok(Box::new(Everything::new(gpu)?))).expect("rejects");
//! ```
//!
//! # How
//!
//! 1. A case of [`CASES`] traces procedural surfaces on the CPU, one depth and one normal per
//!    pixel, and places lights. A third of the lights barely reach a sample, so that a test which
//!    is a little too tight fails.
//! 2. The suite draws the surfaces into a real depth buffer and a texture of normals. Samples are
//!    all pixels with a surface and, if the strategy serves them, points at random depths, some of
//!    them on the near and the far plane.
//! 3. The strategy prepares and records a frame. A probe shader then rebuilds every sample as
//!    shading does, calls the strategy's `group_of` and `list_of`, and records the sample's
//!    position and list.
//! 4. The CPU reads everything back and checks it. [`Light::reach`](crate::Light::reach) decides in
//!    f64 whether a light reaches a sample, at the position that shading would use. A pair closer
//!    to the edge than one part in a million does not count. If the strategy [needs](crate::Needs)
//!    normals, a pair whose light stays below the sample's horizon
//!    ([`Light::above_horizon`](crate::Light::above_horizon)) does not count either. Half of the
//!    samples are looked up with the normal that the G-buffer rounded, as in deferred shading, and
//!    half with the exact normal, as in forward shading.
//!
//! Before a case's first frame the suite fills all records with a mark, which reveals lists that no
//! pass wrote. Frames repeat until no list overflows (at most six), and then once more: the same
//! frame must give the same lists. The suite checks every frame, including those that overflow.
//!
//! # What is checked
//!
//! See [`Breach`], which has one value per promise. A case also fails if it should have (light,
//! sample) pairs and has none, so no case passes without having checked anything.
//!
//! # What a strategy may refuse
//!
//! A strategy refuses by returning [`AssignError::Unsupported`] from `prepare`. If it refuses
//! look-ups at any depth, the case runs with samples on opaque surfaces only. If it refuses these
//! too, the case's outcome is [`Outcome::Unserved`], which [`run_allowing`] accepts for the cases
//! that it is given.
//!
//! # Negative controls
//!
//! [`rejects_faults`] plants each [`Fault`] in the strategy and requires the suite to name it. Faults in
//! the order of the lights and in the boxes over them do not depend on the strategy. They are planted
//! once, by [`rejects_fault`].

mod cases;
mod check;
mod counted_passes;
mod fault;
pub mod faulty;
mod feed;
mod flat_images;
mod lights;
mod linked;
mod living;
mod plan;
mod reaching;
mod reworded;
mod rig;
mod run_kernel;
mod seen;
mod session;
mod stage;
mod views;
mod violation;

use std::sync::OnceLock;

use cases::BEYOND_PLANES;
pub use cases::{CASES, Case, SHARED_CASES};
pub use counted_passes::CountedPasses;
use faulty::{Fault, Faulty};
pub use flat_images::{flat_depth, flat_half_floats};
pub use linked::{LinkedModule, StructLayout};
pub use reworded::{Reworded, reword, trusting};
use rig::{Asked, Rig};
pub use run_kernel::{Bound, download, run_kernel, upload};
pub use violation::{
    Breach, CaseReport, ConformanceError, Figures, Outcome, Place, Report, SamplePlace, Violation,
};

use crate::{AssignError, Assignment, Gpu, SampleDomain};

/// Makes a new instance of the strategy under test.
pub type Make<'a> = dyn Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> + 'a;

/// Runs all cases. An error holds every violation, one per line.
///
/// It needs an adapter, which may be a software one. Without an adapter it returns an error; it
/// never passes.
pub fn run(make: &Make<'_>) -> Result<Report, ConformanceError> {
    run_allowing(make, &[])
}

/// Runs all cases. The strategy may refuse those named in `unserved`.
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

/// Runs all cases with samples on surfaces and in front of them ([`SampleDomain::InFront`]). [`run`] does not ask for
/// these. A refusal is an error.
pub fn run_in_front(make: &Make<'_>) -> Result<Report, ConformanceError> {
    every_case(CASES, Asked::stated(SampleDomain::InFront), make)
}

/// The cases of [`run_unstated`]: among them, frames in which groups hold samples that held none before, and the
/// reverse. The first ones look up all samples of the depth buffer, so they show which groups hold samples.
const UNSTATED_CASES: [&str; 6] = [
    "33-lights",
    "resize",
    "camera-teleports",
    "light-count-changes",
    "lights-from-gpu",
    BEYOND_PLANES,
];
const WHOLE_CASES: usize = 4;

/// Runs some cases with samples at any depth, and beyond the near and far planes, in frames that state only those on
/// opaque surfaces. No light may be lost: with [`Shader::looks_up_anywhere`](crate::Shader::looks_up_anywhere), look-ups that no list serves read all
/// lights, and without, those in groups without samples do. A refusal is an error.
pub fn run_unstated(make: &Make<'_>) -> Result<Report, ConformanceError> {
    let cases = UNSTATED_CASES.iter().map(|name| find(name).copied());
    let cases: Vec<Case> = cases.collect::<Result<_, _>>()?;
    every_case(&cases[..WHOLE_CASES], Asked::unstated(false), make)?;
    every_case(&cases, Asked::unstated(true), make)
}

/// Runs cases. A refusal is an error.
fn every_case(cases: &[Case], asked: Asked, make: &Make<'_>) -> Result<Report, ConformanceError> {
    let rig = rig()?;
    let mut report = Report { strategy: make(&rig.gpu).map_err(setup)?.id(), cases: Vec::new() };
    for case in cases {
        let outcome = session::run(rig, case, make, asked);
        let outcome = outcome.map_err(|error| failed(case, error))?;
        report.cases.push(CaseReport { case: case.name, outcome });
    }
    let is_passed = |case: &CaseReport| matches!(case.outcome, Outcome::Passed(_));
    match report.cases.iter().all(is_passed) {
        true => Ok(report),
        false => Err(ConformanceError::Rejected(report)),
    }
}

/// Runs one case of [`CASES`] or [`SHARED_CASES`]. Violations are an error; a refusal is an outcome.
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

/// Plants every fault that applies to the strategy, and requires the suite to reject each one with
/// the right breach. Returns the planted faults.
pub fn rejects_faults(make: &Make<'_>) -> Result<Vec<Fault>, ConformanceError> {
    let rig = rig()?;
    let plain = find("33-lights")?;
    let has_groups = session::has_groups(rig, plain, make).map_err(|e| failed(plain, e))?;
    let strategy = make(&rig.gpu).map_err(setup)?;
    let normals = strategy.needs().normals;
    let entries = !strategy.lists().storage().is_mask();
    let mut planted = Vec::new();
    for fault in Fault::ALL {
        let applies = (has_groups || !fault.needs_groups())
            && (normals || !fault.needs_normals())
            && (entries || !fault.needs_entries());
        if !applies {
            continue;
        }
        rejects_fault(fault, make)?;
        planted.push(fault);
    }
    Ok(planted)
}

/// Plants one fault and requires the suite to reject it with the right breach.
pub fn rejects_fault(fault: Fault, make: &Make<'_>) -> Result<(), ConformanceError> {
    let (name, breach) = fault.shows_in();
    let faulty = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Faulty::new(gpu, make(gpu)?, fault)?))
    };
    let is_per_sample = make(&rig()?.gpu).map_err(setup)?.lookup().is_per_sample();
    // Of a sample's own list only its contents can be checked.
    let breach =
        if is_per_sample && breach == Breach::Lookup { Breach::MissedPair } else { breach };
    rejects(&format!("{fault:?}"), name, breach, fault.shows_from_stage(), &faulty)
}

/// Requires a case to reject a strategy with a breach. `fault` names what is wrong with the strategy.
pub fn rejects_in(
    fault: &str,
    case: &str,
    breach: Breach,
    make: &Make<'_>,
) -> Result<(), ConformanceError> {
    rejects(fault, case, breach, 0, make)
}

/// The same for a breach that may not show before a stage.
fn rejects(
    fault: &str,
    case: &str,
    breach: Breach,
    from_stage: u32,
    make: &Make<'_>,
) -> Result<(), ConformanceError> {
    let case = find(case)?;
    let outcome = one(rig()?, case, make)?.outcome;
    let is_named = match &outcome {
        Outcome::Failed(violations) => {
            let is_early = |v: &Violation| v.stage < from_stage;
            violations.iter().any(|v| v.breach == breach) && !violations.iter().any(is_early)
        }
        _ => false,
    };
    if is_named {
        return Ok(());
    }
    Err(ConformanceError::FaultPassed {
        fault: fault.to_owned(),
        case: case.name,
        outcome: format!("{outcome:?}"),
    })
}

/// All tests of a process share one device.
fn rig() -> Result<&'static Rig, ConformanceError> {
    static RIG: OnceLock<Result<Rig, AssignError>> = OnceLock::new();
    let opened = RIG.get_or_init(|| Gpu::open(None).map(Rig::new));
    opened.as_ref().map_err(|error| setup(error.clone()))
}

fn find(name: &str) -> Result<&'static Case, ConformanceError> {
    let found = CASES.iter().chain(SHARED_CASES).find(|case| case.name == name);
    found.ok_or_else(|| ConformanceError::NoCase(name.to_owned()))
}

fn one(rig: &Rig, case: &Case, make: &Make<'_>) -> Result<CaseReport, ConformanceError> {
    let outcome = session::run(rig, case, make, Asked::stated(SampleDomain::AnyDepth));
    let outcome = outcome.map_err(|error| failed(case, error))?;
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
    fn a_case_without_pairs_fails() {
        let case = Case { has_pairs: true, ..*find("no-lights").unwrap() };
        let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Everything::new(gpu)?))
        };
        let outcome =
            session::run(rig().unwrap(), &case, &make, Asked::stated(SampleDomain::AnyDepth));
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
            detail: "the list has 2 entries".into(),
            count: 9,
        };
        let line = "case jitter, frame 1: missed pair, group 3, light 7, sample at pixel (1.5, 2.5) \
                    depth 4.25 m: the list has 2 entries (9 of this kind)";
        assert_eq!(violation.to_string(), line);
    }
}
