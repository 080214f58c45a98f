//! `lightbench soak`: a short one, and one that must find a planted fault.

use assign::conformance::faulty::{Fault, Faulty};
use harness::{
    bench::Bench,
    cli::SoakArgs,
    soak::{ROUND_FRAMES, soak, soak_altered},
};

fn args(frames: u32, from: u32) -> SoakArgs {
    SoakArgs { frames, seed: 1, from, scene: "town-small".to_owned(), adapter: None }
}

#[test]
fn a_short_soak_finds_nothing() {
    let mut bench = Bench::open(None).expect("an adapter");
    let text = soak(&mut bench, &args(20, 0)).expect("no finding");
    assert!(text.starts_with("soak     20 frames of seed 1: nothing found\n"), "{text}");
    let number = |before: &str, after: &str| -> u64 {
        let (_, rest) = text.split_once(before).expect("the line");
        let number = rest.split_once(after).expect("the words").0.replace(',', "");
        number.trim().parse().expect("a number")
    };
    assert!(number("drawn    ", " images by ") > 30, "{text}");
    assert!(number("lists    ", " (light, sample) pairs, none missed") > 1_000, "{text}");
    assert!(number("none missed; ", " images from a pool that was too small") > 0, "{text}");
}

#[test]
fn a_planted_fault_is_found_and_reproduced() {
    let mut bench = Bench::open(None).expect("an adapter");
    let mut found = |from: u32| {
        let result = soak_altered(&mut bench, &args(20, from), &|gpu, strategy| {
            Box::new(Faulty::new(gpu, strategy, Fault::ShrunkenBound).expect("planted"))
        });
        result.expect_err("a finding").to_string()
    };
    let first = found(0);
    assert!(first.contains(" of seed 1: ") && first.contains(" misses "), "{first}");
    let (_, again) = first.split_once("`lightbench soak --seed 1 --from ").expect("a command");
    let from: u32 = again.split(' ').next().expect("a word").parse().expect("a number");
    assert_eq!(from % ROUND_FRAMES, 0);
    assert_eq!(found(from), first);
}
