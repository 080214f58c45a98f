//! The stored study of polygon lights, judged as the program judges it today.

mod made_study;

use std::path::Path;

use harness::study::Done;
use made_study::{Written, verdict, write};

/// The paper's own rows decide: its grid, its cone test and its `dif`, without the early exit.
#[test]
fn the_stored_study_is_judged_by_the_papers_settings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../results/h200-endless");
    let done = Done::read(&[folder]).expect("it is there");
    let Written { text, page, .. } = write(&done);
    for (claim, expected) in [
        ("six", "differs"),
        ("most", "holds"),
        ("balance", "fails"),
        ("dif", "holds"),
        ("assignment", "fails"),
        ("sixteenfold", "differs"),
        ("without", "fails"),
        ("growth", "holds"),
        ("far", "fails"),
        ("early-exit", "holds"),
        ("outer-54", "fails"),
        ("outer-24", "holds"),
        ("seen-lost", "fails"),
        ("tracking", "fails"),
        ("slices", "fails"),
        ("flags", "unknown"),
    ] {
        assert_eq!(verdict(&page, claim), expected, "{claim}: {text}");
    }
    // Without a loss no number of cones wins, and one cone, which the paper lacks, is set apart.
    assert!(text.contains("beat clusters by position in 0 of 5 cases in sponza"), "{text}");
    assert!(text.contains("1 cone, which the paper does not have"), "{text}");
    // What wins with a loss states its error, and what it loses.
    assert!(text.contains("Diffuse reach takes 1.46 ms with a FLIP of 0.0634"), "{text}");
    assert!(text.contains("Of 26,473,761 visible terms, 8,200,622 are lost"), "{text}");
}
