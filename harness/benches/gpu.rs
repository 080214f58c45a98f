//! Device time of every method: `cargo bench --bench gpu -- SC-E/` runs one.
//!
//! Benches are named `strategy/scene/lights/motion`, then `assign` or `shade`. The motion is `still`, or
//! the law by which the lights move in every frame. The environment chooses what is drawn:
//! `LIGHTBENCH_SCENE` (a name or a file, default atrium), `LIGHTBENCH_LIGHTS` (default 200),
//! `LIGHTBENCH_SIZE` (default 128x72), `LIGHTBENCH_MOTION` (a law of `--motion`, default still), and
//! `LIGHTBENCH_STRATEGIES` (default all, from both sources). The defaults are small, for software
//! adapters. Times are those of the clock
//! of `lightbench compare`; on a software adapter they are the host's, and say nothing of a GPU.

use std::{
    cell::{OnceCell, RefCell},
    time::Duration,
};

use assign::{AssignError, Gpu};
use criterion::{Criterion, criterion_group, criterion_main};
use harness::{
    choice::Choice,
    cli::{self, CompareArgs, Invocation, MotionChoice},
    clock::PassClock,
    error::HarnessError,
    messages::say_error,
    painter::Painter,
    results::{PassKind, pass_kind},
    stage::Stage,
};
use shading::{Cut, Mode};

/// The motion of lights that do not move.
const STILL: &str = "still";

fn setting(name: &str, default: &str) -> String {
    std::env::var(name).unwrap_or_else(|_| default.to_owned())
}

fn arguments() -> Result<CompareArgs, HarnessError> {
    let options = [
        ("--scene", setting("LIGHTBENCH_SCENE", "atrium")),
        ("--lights", setting("LIGHTBENCH_LIGHTS", "200")),
        ("--size", setting("LIGHTBENCH_SIZE", "128x72")),
        ("--strategies", setting("LIGHTBENCH_STRATEGIES", "all")),
        ("--source", "both".to_owned()),
    ];
    let motion = setting("LIGHTBENCH_MOTION", STILL);
    let moving = (motion != STILL).then_some(("--motion", motion));
    let words =
        options.into_iter().chain(moving).flat_map(|(option, value)| [option.to_owned(), value]);
    // Whatever strategies are asked for: some take no source.
    match cli::parse_stored(std::iter::once("lightbench".to_owned()).chain(words))? {
        Invocation::Compare(args) => Ok(args),
        _ => unreachable!("no subcommand was given"),
    }
}

/// Device time of the passes of a kind, summed over `frames` frames.
fn time_of(
    kind: PassKind,
    frames: u64,
    gpu: &Gpu,
    stage: &mut Stage,
    choice: &Choice,
) -> Result<Duration, HarnessError> {
    let mut method = choice.make(gpu)?;
    let mut painter = Painter::new(stage, &mut method, Mode::Deferred, Cut::default())?;
    let mut clock = PassClock::new(gpu);
    // The pool grows to what the lists ask for before anything is timed.
    for frame in 0..3 {
        stage.go_to(frame, 3)?;
        painter.draw(gpu, stage, Mode::Deferred, &mut clock)?;
        clock.finish()?;
    }
    let mut ms = 0.0;
    for frame in 0..frames {
        // The lights' clock starts again after an hour.
        stage.go_to((frame % 216_000) as u32, 1)?;
        painter.draw(gpu, stage, Mode::Deferred, &mut clock)?;
        let passes = clock.finish()?;
        ms += passes
            .iter()
            .filter(|(name, _)| pass_kind(name, Mode::Deferred) == kind)
            .map(|(_, ms)| ms)
            .sum::<f64>();
    }
    Ok(Duration::from_secs_f64(ms / 1e3))
}

fn methods(criterion: &mut Criterion) {
    let run = |criterion: &mut Criterion| -> Result<(), HarnessError> {
        let args = arguments()?;
        let gpu = Gpu::open(None)?;
        // Loaded when the first bench that no filter leaves out runs.
        let stage = OnceCell::new();
        let stage = || {
            stage.get_or_init(|| {
                let stage = Stage::new(&gpu, &args.stage).unwrap_or_else(|error| fail(&error));
                RefCell::new(stage)
            })
        };
        for choice in args.choices()? {
            if !choice.is_named && matches!(choice.make(&gpu), Err(AssignError::Unsupported { .. }))
            {
                // This device cannot run it.
                continue;
            }
            let scene = args.stage.scene.rsplit('/').next().unwrap_or_default();
            let motion = args.stage.motion.motion.map_or(STILL, MotionChoice::name);
            let name = format!("{}/{scene}/{}/{motion}", choice.id(), args.stage.scattered());
            for (kind, family) in [(PassKind::Assign, "assign"), (PassKind::Shade, "shade")] {
                // No lists, nothing to assign.
                if kind == PassKind::Assign && !choice.has_groups() {
                    continue;
                }
                criterion.bench_function(&format!("{name}/{family}"), |bencher| {
                    bencher.iter_custom(|frames| {
                        time_of(kind, frames, &gpu, &mut stage().borrow_mut(), &choice)
                            .unwrap_or_else(|error| fail(&error))
                    });
                });
            }
        }
        Ok(())
    };
    run(criterion).unwrap_or_else(|error| fail(&error));
}

fn fail(error: &HarnessError) -> ! {
    say_error(error);
    std::process::exit(1);
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1));
    targets = methods
}
criterion_main!(benches);
