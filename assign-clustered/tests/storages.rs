//! Clusters whose lists have trees of depths, and clusters whose masks subgroups read together, pass the conformance
//! suite, and the suite rejects them with each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Gpu, LightSource, Storage,
    conformance::{self, CASES, faulty::Fault},
};
use assign_clustered::{Clustered, Occupancy};

fn clustered(
    size: &'static str,
    (bounds, occupancy): (Bounds, Occupancy),
    source: LightSource,
    storage: Storage,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, storage, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Clustered::new(gpu, size.parse()?, bounds, occupancy, settings)?))
}

const SPARSE: (Bounds, Occupancy) = (Bounds::Explicit, Occupancy::Sparse);
const DENSE: (Bounds, Occupancy) = (Bounds::Implicit, Occupancy::Dense);

#[test]
fn trees_conform() {
    // llvmpipe might end the loops over so many lights silently: see `LightReader::check_lights`.
    let may_refuse = &["65537-lights", "gpu-order-many"];
    for (size, variant, source) in
        [("32x32x8", SPARSE, LightSource::Hierarchy), ("64x48x2", DENSE, LightSource::Linear)]
    {
        let make = clustered(size, variant, source, Storage::Trees);
        conformance::run_allowing(&make, may_refuse).expect("conforms");
    }
}

#[test]
fn scalar_masks_conform() {
    for (size, variant, source) in
        [("13x9x8", SPARSE, LightSource::Hierarchy), ("32x32x8", DENSE, LightSource::Linear)]
    {
        let make = clustered(size, variant, source, Storage::ScalarMasks);
        // The probe reads at most 16,384 lights of a sample. Here, samples of several clusters read more together.
        for case in CASES.iter().filter(|case| case.name != "65537-lights") {
            conformance::run_case(case.name, &make).expect(case.name);
        }
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = clustered("32x32x4", SPARSE, LightSource::Linear, Storage::Trees);
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
    let make = clustered("32x32x4", SPARSE, LightSource::Linear, Storage::ScalarMasks);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    let left_out = |fault: &Fault| !planted.contains(fault);
    let mut missing = Fault::all(false).into_iter().filter(left_out);
    assert!(missing.all(Fault::needs_entries), "{planted:?}");
}
