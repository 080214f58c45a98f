//! A device that is lost: what is asked of it afterwards fails with an error. It neither panics nor shows a picture.

use assign::Gpu;
use harness::{
    choice::Choice,
    cli::{BAD_INPUT, Invocation, StageArgs, parse},
    measure::{Contest, Plan},
    stage::Stage,
    strategy::Method,
};
use shading::{Cut, KeptImage, LightBvh, ListCheck, Mode};

/// A method of each kind of storage and look-up.
const METHODS: [&str; 7] = [
    "None",
    "T-I/16x16",
    "SC-E/16x16x8/bvh",
    "HG/16x16x8",
    "DC-I/16x16x8/mask",
    "W",
    "RasterSphere",
];

const PLAN: Plan = Plan {
    warmup: 0,
    timed: 1,
    laps: 0,
    checks: 1,
    is_temporal: false,
    seed: 1,
    cut: Cut::Windowed,
    operations: false,
};

fn stage_args() -> StageArgs {
    let words = "lightbench --scene stability:count-33 --size 32x18";
    match parse(words.split(' ')) {
        Ok(Invocation::Compare(args)) => args.stage,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_lost_device_gives_errors_and_no_picture() {
    // A bench's handler would end the program. This one lets errors of writes to lost buffers pass, as a renderer's does.
    let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
    gpu.device.on_uncaptured_error(std::sync::Arc::new(|_| {}));
    let args = stage_args();
    let mut stage = Stage::new(&gpu, &args).expect("a stage");
    let lights = stage.lights.lights().to_vec();
    let bvh = LightBvh::new(&lights);
    let mut check = ListCheck::new(&bvh);
    let make =
        |id: &&str| -> Method { Choice::parse(id).expect("an id").make(&gpu).expect("made") };
    let mut methods: Vec<Method> = METHODS.iter().map(make).collect();
    let mut contest =
        Contest::new(&gpu, &mut stage, &mut methods, Mode::Deferred, PLAN).expect("compiled");
    contest.compare_with(&mut stage, 0).expect("an image");
    for (ix, id) in METHODS.iter().enumerate() {
        contest.check(&mut stage, ix, Some(&mut check)).unwrap_or_else(|e| panic!("{id}: {e}"));
    }

    gpu.device.destroy();
    for (ix, id) in METHODS.iter().enumerate() {
        let error = contest.check(&mut stage, ix, Some(&mut check)).err();
        let error = error.unwrap_or_else(|| panic!("{id} shows an image of a lost device"));
        assert_ne!(error.exit_code(), BAD_INPUT, "{id}: {error}");
        assert!(!error.to_string().is_empty(), "{id}");
    }
    assert!(contest.compare_with(&mut stage, 0).is_err(), "no culling shows an image");
    let (targets, viewport) = (stage.renderer.targets(), stage.view.viewport);
    let kept = KeptImage::keep(&gpu, targets, viewport);
    assert!(kept.and_then(|kept| kept.read()).is_err(), "an image is kept");
    assert!(gpu.read(stage.lights.spheres(), 16).is_err(), "a buffer is read");
}
