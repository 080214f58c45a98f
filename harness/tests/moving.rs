//! `compare` with lights that move: lists and images, and the same bits in a second run.

use std::{path::Path, process::Command};

use harness::results::Results;

/// Runs `compare` at a small size into `out`; returns what it wrote.
fn compare(out: &Path, arguments: &[&str]) -> Results {
    let small = ["compare", "--scene", "town-small", "--size", "160x90", "--warmup", "0", "--out"];
    let all = [&small[..], &[out.to_str().expect("UTF-8")], arguments].concat();
    let mut program = Command::new(env!("CARGO_BIN_EXE_lightbench"));
    let output = program.env_remove("XDG_RUNTIME_DIR").args(all).output().expect("starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Results::read(&out.join("results.json")).expect("results.json")
}

/// Draws frames in which lights move; checks that no method loses light, and returns the raw images.
fn images(out: &Path, motion: &[&str]) -> Vec<Vec<u8>> {
    let methods = "None,T-E/28x28,SC-E/48x48x40/bvh/keep3,G/8x8x8/bvh/keep3,HG/48x48x40";
    let lights = ["--lights", "200", "--spots", "0.3", "--areas", "0.1", "--frames", "4"];
    let results = compare(out, &[&["--strategies", methods], &lights[..], motion].concat());
    assert_eq!(results.records.len(), 5);
    let image = |record: &harness::results::Record| {
        let id = &record.strategy;
        assert_eq!(record.lists.missed_pairs, Some(0), "{id}");
        assert_eq!(record.image.differing_channels, Some(0), "{id}");
        std::fs::read(out.join(record.image.files.raw.as_ref().expect("a raw image"))).expect("it")
    };
    results.records.iter().map(image).collect()
}

#[test]
fn lights_that_move_lose_nothing_and_frames_repeat() {
    let folder = tempfile::tempdir().expect("a folder");
    let on_gpu = ["--motion", "drift", "--moved-by", "gpu", "--light-order", "gpu2"];
    let first = images(&folder.path().join("gpu"), &on_gpu);
    assert!(first == images(&folder.path().join("again"), &on_gpu), "a second run differs");
    let on_cpu = ["--motion", "all", "--speed", "5", "--light-order", "gpu25%"];
    images(&folder.path().join("cpu"), &on_cpu);
}
