//! `lightbench soak`: thousands of random frames, each of them checked.
//!
//! A soak looks for what no case of a test names: rare combinations, state that an earlier frame leaves behind, and
//! memory that nobody frees.
//!
//! # How
//!
//! 1. Frames come in rounds of `ROUND_FRAMES`. A round draws its lights, their motion and order, its image size, its
//!    mode and its strategies (`plan`). All of that follows from the seed and the round's number.
//! 2. Each frame of a round has a camera of its own and a time of its own. Some frames have an entry pool that is far
//!    too small.
//! 3. Each strategy draws each frame once. Its lists are checked in f64 for missed lights, and its image is compared
//!    with that of no culling, bit for bit. Only strategies that promise both take part.
//! 4. After each round, everything that the round made is freed, and memory is looked at (`memory`).
//!
//! The first finding ends the soak. Its message gives the command that starts again at that round, which reproduces
//! it: what a round draws depends on no other. A finding of memory may need the rounds before it.
//!
//! Every tenth round draws the first one again, to see whether memory grew, so nine in ten frames are new.
//!
//! The device and its compiled shaders are kept for `REOPEN_EVERY` rounds. Then the device is opened anew, because
//! every combination of axes has shaders of its own, which would pile up. Device loss is not simulated here;
//! `tests/device_loss.rs` is an ignored test of it, which fails.
//!
//! Rounds do not depend on each other, so processes can share a soak: each takes some of the frames by `--from`.

mod frame;
mod memory;
mod plan;

use std::time::Instant;

use assign::{Assignment, Gpu};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    bench::Bench,
    cli::{SOAK_SCENE, SoakArgs, StageArgs},
    error::HarnessError,
    report::{page::shell_words, significant},
    strategy::Method,
};

use frame::{Counts, draw_round};
use memory::{Memory, MemoryWatch};
use plan::{Round, canonical_stage};

/// Frames of a round.
pub const ROUND_FRAMES: u32 = 10;

/// Rounds that share a device. 400 frames of seed 7 on llvmpipe took the process from 0.4 to 1.6 GiB of compiled
/// shaders.
const REOPEN_EVERY: u32 = 50;

/// Every so many rounds, the first round is drawn again: its shaders are compiled, so the process should not grow.
const AGAIN_EVERY: u32 = 10;

/// Alters a strategy before it draws; for tests that plant a fault.
pub type Alter<'a> = dyn Fn(&Gpu, Box<dyn Assignment>) -> Box<dyn Assignment> + 'a;

/// Opens a device and runs a soak; returns what to print.
pub fn soak_alone(args: &SoakArgs) -> Result<String, HarnessError> {
    let mut bench = Bench::open(args.adapter.as_deref())?;
    soak(&mut bench, args)
}

/// Runs a soak on an open device; returns what to print.
///
/// # Errors
///
/// [`HarnessError::Finding`] with the seed and the frame that reproduce it.
pub fn soak(bench: &mut Bench, args: &SoakArgs) -> Result<String, HarnessError> {
    soak_altered(bench, args, &|_, strategy| strategy)
}

/// Runs a soak whose strategies were altered.
///
/// # Errors
///
/// As [`soak`].
pub fn soak_altered(
    bench: &mut Bench,
    args: &SoakArgs,
    alter: &Alter<'_>,
) -> Result<String, HarnessError> {
    let began = Instant::now();
    let rest = canonical_stage(&args.scene)?;
    // Targets of the largest size, so that no round replaces them.
    bench.stage(&rest)?;
    let first = args.from / ROUND_FRAMES;
    let rounds = args.frames.div_ceil(ROUND_FRAMES);
    let bar = progress_bar(u64::from(args.frames));
    let mut counts = Counts::default();
    let mut watch = MemoryWatch::default();
    let mut drawn = 0;
    // Whether this device has compiled the shaders of the first round.
    let mut knows_first = false;
    for ix in first..first + rounds {
        if ix > first && (ix - first).is_multiple_of(REOPEN_EVERY) {
            *bench = Bench::open(args.adapter.as_deref())?;
            bench.stage(&rest)?;
            watch.forget_device();
            knows_first = false;
        }
        let gpu = bench.gpu().clone();
        let is_again = ix.is_multiple_of(AGAIN_EVERY);
        let round = Round::new(args, if is_again { 0 } else { ix })?;
        let frames = ROUND_FRAMES.min(args.frames - drawn);
        bar.set_message(round.summary());
        let before = Memory::now(&gpu);
        let found = draw_round(bench, &round, frames, alter, &mut counts, &bar)?;
        drawn += frames;
        if let Some(found) = found {
            bar.finish_and_clear();
            let frame = ix * ROUND_FRAMES + found.frame;
            return Err(finding(args, frame, &round, &found.words));
        }
        free(bench, &rest)?;
        let after = Memory::now(&gpu);
        let is_known = is_again && knows_first;
        knows_first |= is_again;
        if let Some(words) = watch.look(before, after, is_known) {
            bar.finish_and_clear();
            return Err(finding(args, (ix + 1) * ROUND_FRAMES - 1, &round, &words));
        }
    }
    bar.finish_and_clear();
    let seconds = significant(began.elapsed().as_secs_f64());
    Ok(format!("{}{}\nin {seconds} s\n", counts.summary(args.seed, drawn), watch.summary()))
}

/// Replaces the lights of the last round by few ones, and waits until the device has freed the others.
fn free(bench: &mut Bench, rest: &StageArgs) -> Result<(), HarnessError> {
    bench.stage(rest)?.prepare()?;
    bench.gpu().queue.submit([]);
    Ok(bench.gpu().wait()?)
}

/// Alters the strategy of a method.
fn altered(gpu: &Gpu, method: Method, alter: &Alter<'_>) -> Method {
    match method {
        Method::Lists { strategy, early_exit, stochastic, is_random } => {
            Method::Lists { strategy: alter(gpu, strategy), early_exit, stochastic, is_random }
        }
        other => other,
    }
}

/// The error that ends a soak.
fn finding(args: &SoakArgs, frame: u32, round: &Round, words: &str) -> HarnessError {
    let scene = match args.scene == SOAK_SCENE {
        true => String::new(),
        false => format!(" --scene {}", shell_words(std::slice::from_ref(&args.scene))),
    };
    let adapter = args.adapter.as_ref().map_or_else(String::new, |adapter| {
        format!(" --adapter {}", shell_words(std::slice::from_ref(adapter)))
    });
    let again = format!(
        "lightbench soak --seed {} --from {} --frames {ROUND_FRAMES}{scene}{adapter}",
        args.seed,
        frame / ROUND_FRAMES * ROUND_FRAMES
    );
    let drawn = round.words.join(" ");
    let mode = round.mode.name();
    HarnessError::Finding(format!(
        "frame {frame} of seed {}: {words}; drawn {mode} with {drawn}; `{again}` draws it again",
        args.seed
    ))
}

fn progress_bar(total: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} frames, {eta} left  {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(total).with_style(style)
}
