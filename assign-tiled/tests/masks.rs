//! Tiles that keep a bit per light have the lights of lists, and the suite rejects them with each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Gpu, LightSource, Storage, Touched, conformance,
    conformance::faulty::Fault,
};
use assign_tiled::Tiled;

fn masks(
    size: &'static str,
    bounds: Bounds,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, storage: Storage::Masks, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Tiled::new(gpu, size.parse()?, bounds, settings)?))
}

#[test]
fn masks_conform() {
    for (size, bounds, source) in [
        ("16x16", Bounds::Implicit, LightSource::Linear),
        ("13x9", Bounds::Explicit, LightSource::Hierarchy),
    ] {
        conformance::run(&masks(size, bounds, source)).expect("conforms");
    }
}

#[test]
fn many_lights_conform() {
    let make = masks("16x16", Bounds::Implicit, LightSource::Hierarchy);
    conformance::run_case("three-levels-of-nodes", &make).expect("conforms");
}

#[test]
fn masks_of_touched_groups_conform() {
    let inner = masks("16x16", Bounds::Explicit, LightSource::Hierarchy);
    let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Touched::new(gpu, inner(gpu)?)?))
    };
    for case in ["33-lights", "light-count-changes", "gpu-order-some-move", "lights-from-gpu"] {
        conformance::run_case(case, &make).expect(case);
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = masks("16x16", Bounds::Implicit, LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    let left_out = |fault: &Fault| !planted.contains(fault);
    let missing: Vec<Fault> = Fault::all(false).into_iter().filter(left_out).collect();
    assert!(missing.iter().all(|fault| fault.needs_entries()), "{missing:?}");
}
