//! HG keeps the contract, and the suite would notice if it did not.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, Assignment, Gpu, Reuse,
    conformance::{self, faulty::Fault},
};
use assign_cdi::HybridGrid;

fn grid(size: &str) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(HybridGrid::new(gpu, size.parse()?)?))
}

fn conforms(size: &str) {
    let report = conformance::run(&grid(size)).expect("conforms");
    println!("{report}");
}

#[test]
fn coarse_cells_conform() {
    conforms("48x48x40");
    conforms("4096x4096x1");
}

#[test]
fn odd_cells_conform() {
    conforms("13x9x5");
}

#[test]
fn fine_cells_conform() {
    conforms("9x7x200");
}

#[test]
fn faults_are_rejected() {
    let make = grid("16x16x8");
    assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
}

#[test]
fn kept_lists_miss_lights_that_move() {
    let reused = |frames| {
        let make = grid("16x16x8");
        move |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Reuse::new(make(gpu)?, frames)?))
        }
    };
    conformance::run_case("lights-move", &reused(1)).expect("conforms");
    let error = conformance::run_case("lights-move", &reused(3)).expect_err("stale lists");
    assert!(error.to_string().contains("missed pair"), "{error}");
}
