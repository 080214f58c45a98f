//! Tiles whose lists are pruned while they are read have shorter lists that still hold every light, and the suite
//! rejects them with each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Gpu, LightSource, Storage, conformance,
    conformance::faulty::Fault,
};
use assign_tiled::Tiled;

fn tiles(
    bounds: Bounds,
    source: LightSource,
    storage: Storage,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, storage, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Tiled::new(gpu, "28x28".parse()?, bounds, settings)?))
}

fn pruned(
    bounds: Bounds,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    tiles(bounds, source, Storage::PrunedLists)
}

#[test]
fn pruned_lists_conform() {
    // llvmpipe cannot read so many lights: see `LightReader::check_lights`.
    let may_refuse = &["65537-lights"];
    for (bounds, source) in
        [(Bounds::Implicit, LightSource::Linear), (Bounds::Explicit, LightSource::Hierarchy)]
    {
        conformance::run_allowing(&pruned(bounds, source), may_refuse).expect("conforms");
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = pruned(Bounds::Implicit, LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    assert_eq!(planted, Fault::all(false));
}

#[test]
fn pruned_lists_are_shorter() {
    let listed = |storage| {
        let make = tiles(Bounds::Implicit, LightSource::Linear, storage);
        let report = conformance::run_case("depth-discontinuity", &make).expect("conforms");
        report.listed_per_sample().expect("passed")
    };
    let [whole, pruned] = [Storage::Lists, Storage::PrunedLists].map(listed);
    println!("{whole} lights per sample, pruned {pruned}");
    assert!(pruned < 0.6 * whole, "{pruned} of {whole}");
}
