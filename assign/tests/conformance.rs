//! Runs the conformance suite on no culling, and tests the suite's own promises.

use assign::{
    AssignError, Assignment, Everything, Frame, Gpu, Needs, SampleDomain,
    conformance::{self, CASES, ConformanceError, Outcome, SHARED_CASES, faulty::Fault},
    leave_to_inner,
};

fn everything(gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    Ok(Box::new(Everything::new(gpu)?))
}

#[test]
fn no_culling_conforms() {
    let report = conformance::run(&everything).expect("conforms");
    println!("{report}");
    assert_eq!(report.cases.len(), CASES.len());
}

/// Other strategies must list fewer lights than this.
#[test]
fn no_culling_lists_every_light_for_every_sample() {
    let case = conformance::run_case("mixed-kinds", &everything).expect("conforms");
    assert_eq!(case.listed_per_sample(), Some(600.0));
}

#[test]
fn faults_in_no_culling_are_rejected() {
    let planted = conformance::rejects_faults(&everything).expect("rejects");
    assert_eq!(planted.len(), 10, "planted faults: {planted:?}");
}

/// The check of slots does not depend on the strategy.
#[test]
fn a_copied_slot_is_rejected() {
    conformance::rejects_fault(Fault::CopiedSlot, &everything).expect("rejects");
}

#[test]
fn names_are_unique_and_unknown_ones_errors() {
    let all = || CASES.iter().chain(SHARED_CASES);
    let mut names: Vec<&str> = all().map(|case| case.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all().count());
    let error = conformance::run_case("no-such-case", &everything).unwrap_err();
    assert!(matches!(error, ConformanceError::NoCase(_)));
    let error = conformance::run_allowing(&everything, &["no-such-case"]).unwrap_err();
    assert!(matches!(error, ConformanceError::NoCase(_)));
}

/// A strategy without culling that refuses orthographic views and, if told to, look-ups at any
/// depth.
struct Picky {
    inner: Everything,
    opaque_only: bool,
}

impl Assignment for Picky {
    fn id(&self) -> String {
        "Picky".into()
    }

    leave_to_inner!(record, lookup, bind_group, lists, memory_bytes);

    fn needs(&self) -> Needs {
        Needs { depth: true, normals: true, ..Needs::default() }
    }
    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self { inner: self.inner.view(gpu)?, ..*self }))
    }
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let refuse = |asked: &str| {
            Err(AssignError::Unsupported {
                strategy: self.id(),
                asked: asked.into(),
                reason: "picky".into(),
            })
        };
        assert!(frame.depth.is_some() && frame.normals.is_some());
        if self.opaque_only && frame.samples == SampleDomain::AnyDepth {
            return refuse("look-ups at any depth");
        }
        if frame.view.near_m == 0.0 {
            return refuse("orthographic views");
        }
        self.inner.prepare(gpu, frame)
    }
}

fn picky(opaque_only: bool) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| {
        let inner = Everything::new(gpu)?;
        Ok(Box::new(Picky { inner, opaque_only }))
    }
}

#[test]
fn a_refused_case_is_unserved_and_must_be_allowed() {
    let case = "orthographic-near-0";
    let report = conformance::run_case(case, &picky(false)).unwrap();
    let Outcome::Unserved(reason) = report.outcome else {
        panic!("{report:?}");
    };
    assert!(reason.contains("cannot serve orthographic views"), "{reason}");
    let error = conformance::run_allowing(&picky(true), &[case]).unwrap_err();
    assert!(error.to_string().contains("orthographic-reversed: unserved"), "{error}");
    conformance::run_allowing(&picky(true), &[case, "orthographic-reversed"]).expect("allowed");
}

#[test]
fn refused_depths_leave_opaque_surfaces() {
    let figures = |opaque_only| match conformance::run_case("jitter", &picky(opaque_only)) {
        Ok(report) => match report.outcome {
            Outcome::Passed(figures) => figures,
            other => panic!("{other:?}"),
        },
        Err(error) => panic!("{error}"),
    };
    let (all, opaque) = (figures(false), figures(true));
    assert!(all.any_depth && !opaque.any_depth);
    assert!(opaque.samples < all.samples && opaque.pairs > 0);
}
