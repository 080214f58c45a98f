//! Stability scenarios with unusual views, as a run sees them: they reach the renderer, and lists serve them.

use harness::{
    bench::Bench,
    cli::{CompareArgs, Invocation, parse},
    compare::compare_on,
    results::Results,
};
use shading::HdrImage;

fn args(name: &str, out: &str, more: &str) -> CompareArgs {
    let scene = format!("stability:{name}");
    let mut words = vec!["lightbench", "compare", "--scene", &scene, "--out", out];
    words.extend(["--size", "64x36", "--frames", "1", "--warmup", "0", "--pictures", "all"]);
    words.extend(more.split_whitespace());
    match parse(&words) {
        Ok(Invocation::Compare(args)) => args,
        other => panic!("{words:?}: {other:?}"),
    }
}

/// The results of a scenario, and its image without culling.
fn run(bench: &mut Bench, name: &str, more: &str) -> (Results, HdrImage) {
    let folder = tempfile::tempdir().expect("a folder");
    let args = args(name, folder.path().to_str().expect("UTF-8"), more);
    let (results, _) = compare_on(bench, &args, Vec::new()).expect(name);
    let image = HdrImage::read_exr(&folder.path().join("deferred-None.exr")).expect("an image");
    (results, image)
}

/// Largest difference between the channels of two images, over the largest channel.
fn difference(a: &HdrImage, b: &HdrImage) -> f32 {
    let channels = |image: &HdrImage| image.pixels.as_flattened().to_vec();
    let (a, b) = (channels(a), channels(b));
    assert_eq!(a.len(), b.len());
    let largest = a.iter().copied().fold(0.0, f32::max);
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) / largest
}

fn flipped(image: &HdrImage) -> HdrImage {
    let rows = image.pixels.chunks(image.width as usize);
    let pixels = rows.flat_map(|row| row.iter().rev().copied()).collect();
    HdrImage { pixels, ..image.clone() }
}

/// Methods by tiles, clusters and cells, and those that draw light volumes, in views that break simpler ones.
#[test]
fn unusual_views_are_exact_and_show_what_they_promise() {
    let mut bench = Bench::open(None).expect("an adapter");
    let methods = "--mode both --strategies None,T-I/16x16,SC-E/16x16x8,G/8x8x8";
    let drawn = "--strategies None,RasterSphere,HG/16x16x8";
    let mut images = Vec::new();
    for (name, more) in [
        ("split-screen", methods),
        ("mirrored-view", methods),
        ("mirrored-view", drawn),
        ("oblique-near-plane", methods),
        ("oblique-near-plane", drawn),
        ("infinite-far", methods),
        ("orthographic-near-0", methods),
        ("standard-depth", methods),
    ] {
        let (results, image) = run(&mut bench, name, more);
        for record in &results.records {
            let what = format!("{name} {} {}", record.strategy, record.setting.mode.name());
            assert!(record.lists.untested.is_none(), "{what}: {:?}", record.lists.untested);
            assert_eq!(record.lists.missed_pairs.unwrap_or(0), 0, "{what}");
            assert!(record.is_lossless(), "{what}: {:?}", record.image.max_rel_diff);
        }
        // The baseline checks pairs, so there is something to miss.
        assert!(results.records[0].lists.checked_pairs > Some(1_000), "{name}");
        images.push(image);
    }
    // Half a target shows what a whole one shows, and a mirror the same from right to left.
    let [whole, mirrored, ..] = images.as_slice() else { panic!("two images") };
    assert_eq!((whole.width, whole.height), (64, 36));
    assert!(
        difference(whole, &flipped(mirrored)) < 1e-3,
        "{}",
        difference(whole, &flipped(mirrored))
    );
    assert!(difference(whole, mirrored) > 0.1, "{}", difference(whole, mirrored));
}

/// Bounds from the depths of a plain near plane lack the lights of a reflection.
#[test]
fn the_formula_of_plain_near_planes_fails_in_a_reflection() {
    let mut bench = Bench::open(None).expect("an adapter");
    let both = "--strategies None,T-E/8x8,T-E/8x8/plain-depth";
    for (name, fails) in [("oblique-near-plane", true), ("mirrored-view", false)] {
        let (results, _) = run(&mut bench, name, both);
        let [_, sound, flawed] = results.records.as_slice() else { panic!("three records") };
        assert!(sound.is_exact(), "{name}: {:?} {:?}", sound.lists, sound.image);
        assert!(flawed.is_lossy, "{name}");
        let missed = flawed.lists.missed_pairs.expect("checked");
        assert_eq!(missed > 1_000, fails, "{name}: {missed} missed");
        assert_eq!(
            flawed.image.differing_channels > Some(1_000),
            fails,
            "{name}: {:?}",
            flawed.image
        );
    }
}

/// Two cameras in turn, and cuts: the same strategy serves each frame of the path.
#[test]
fn one_strategy_serves_cameras_in_turn() {
    let mut bench = Bench::open(None).expect("an adapter");
    for name in ["two-cameras", "same-frame-twice"] {
        let more = "--path --frames 4 --strategies None,T-I/16x16,SC-E/16x16x8 --pictures none";
        let folder = tempfile::tempdir().expect("a folder");
        let mut words = format!("compare --scene stability:{name} --size 64x36 --warmup 0 {more}");
        words += &format!(" --out {}", folder.path().display());
        let words = std::iter::once("lightbench").chain(words.split_whitespace());
        let Ok(Invocation::Compare(args)) = parse(words) else { panic!("{name}") };
        let (results, _) = compare_on(&mut bench, &args, Vec::new()).expect(name);
        for record in &results.records {
            assert!(
                record.is_lossless(),
                "{name} {}: {:?}",
                record.strategy,
                record.image.max_rel_diff
            );
            assert_eq!(record.lists.missed_pairs.unwrap_or(0), 0, "{name} {}", record.strategy);
        }
    }
}
