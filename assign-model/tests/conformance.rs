//! M keeps the contract's promises, and the suite rejects it with planted faults.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, CullSettings, Frame, Gpu, LightBuffer, LightSource, SampleDomain,
    Touched, View,
    conformance::{self, CASES, Outcome, faulty::Fault},
};
use assign_model::PerModel;
use glam::Vec3;

fn per_model(
    limit_m: Option<f32>,
    settings: CullSettings,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(PerModel::new(gpu, limit_m, settings)?))
}

fn conforms(limit_m: Option<f32>, settings: CullSettings) {
    let report = conformance::run(&per_model(limit_m, settings)).expect("conforms");
    println!("{report}");
}

#[test]
fn lists_that_stay_conform() {
    let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        let inner = per_model(None, CullSettings::default())(gpu)?;
        Ok(Box::new(Touched::new(gpu, inner)?))
    };
    for case in ["33-lights", "lights-move", "gpu-order-some-move"] {
        conformance::run_case(case, &touched).expect(case);
    }
}

#[test]
fn whole_models_conform() {
    conforms(None, CullSettings::default());
}

#[test]
fn models_in_parts_conform() {
    // `lists_are_short` and `faults_are_rejected` use finer parts. Parts of 20 m of a plain that is kilometres long
    // take minutes.
    for case in CASES {
        let limit_m = if case.name == "far-slices" { 400.0 } else { 20.0 };
        let make = per_model(Some(limit_m), CullSettings::default());
        let report = conformance::run_case(case.name, &make).expect(case.name);
        assert!(matches!(report.outcome, Outcome::Passed(_)), "{report:?}");
    }
}

#[test]
fn all_conform_through_the_hierarchy() {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    conforms(None, settings);
}

#[test]
fn any_depth_missing_models_and_bad_limits_are_refused() {
    let gpu = Gpu::open(None).unwrap();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let frame = Frame::new(&view, &lights);
    let mut strategy = PerModel::new(&gpu, None, CullSettings::default()).unwrap();
    let error = strategy.prepare(&gpu, &frame.sampled_at(SampleDomain::AnyDepth)).unwrap_err();
    assert!(matches!(error, AssignError::Unsupported { .. }), "{error}");
    let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("needs models"), "{error}");
    // A scene without models is served, because no sample lies on a model.
    strategy.prepare(&gpu, &frame.with_models(&[])).unwrap();
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let error = PerModel::new(&gpu, Some(bad), CullSettings::default()).unwrap_err();
        assert!(error.to_string().contains("0.001 to 1000000 m"), "{error}");
    }
}

#[test]
fn look_ups_that_no_frame_stated_lose_no_light() {
    let make = per_model(Some(2.0), CullSettings::default());
    conformance::run_unstated(&make).expect("conforms");
}

/// A strategy that lists every light for every sample would conform, so this test checks that lists
/// are short.
#[test]
fn lists_are_short() {
    let listed = |limit_m| {
        let make = per_model(limit_m, CullSettings::default());
        let case = conformance::run_case("mixed-kinds", &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let (whole, parts) = (listed(None), listed(Some(1.0)));
    println!("{whole:.1} lights per sample by models, {parts:.1} by parts, of 600 lights");
    // The tilted boxes of the plane and the wall contain about two thirds of the lights.
    assert!(
        whole < 480.0 && parts < 0.8 * whole,
        "lights per sample: {whole} by models, {parts} by parts"
    );
}

#[test]
fn faults_are_rejected() {
    let make = per_model(Some(2.0), CullSettings::default());
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}
