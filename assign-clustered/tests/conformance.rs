//! DC-I keeps the contract, and the suite would notice if it did not.

use assign::{
    AssignError, Assignment, FrustumTests, Gpu,
    conformance::{self, faulty::Fault},
};
use assign_clustered::DenseImplicit;

fn dense_implicit(
    size: &str,
    sat_n: bool,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| {
        let tests = FrustumTests { sat_n };
        Ok(Box::new(DenseImplicit::new(gpu, size.parse()?, tests)?))
    }
}

fn conforms(size: &str, sat_n: bool) {
    let report = conformance::run(&dense_implicit(size, sat_n)).expect("conforms");
    println!("{report}");
}

#[test]
fn usual_clusters_conform() {
    conforms("32x32x8", true);
}

#[test]
fn clusters_tested_by_half_spaces_alone_conform() {
    conforms("32x32x8", false);
}

#[test]
fn small_uneven_clusters_conform() {
    conforms("13x9x5", true);
}

#[test]
fn thin_slices_conform() {
    conforms("64x16x40", true);
}

#[test]
fn one_cluster_conforms() {
    conforms("4096x4096x1", true);
}

#[test]
fn faults_are_rejected() {
    let planted = conformance::rejects_faults(&dense_implicit("16x16x8", true)).expect("rejects");
    assert_eq!(planted, Fault::ALL);
}
