//! Models of area lights (Dobetsberger 2025, sections 5.5 and 5.6): how far each is from the truth,
//! what it costs, and what area lights cost beside spots.
//!
//! All lights are evaluated at every sample (`None`), so that no error is one of culling and no
//! time is one of assignment.

use super::{Job, MODELS, StudyScene, TRUTH};
use crate::{
    cli::{Size, StudyArgs},
    compare::Bench,
    error::HarnessError,
    results::BASELINE,
};

/// The range of a light as a share of the diagonal of the scene's core: from where it hangs, it is
/// seen on floor and walls.
const RANGE_SHARE: f32 = 0.5;

/// Lights of the one view of the truth.
const FEW: &str = "4";

/// How much the study looks at.
struct Extent {
    size: Size,
    /// Frames of the view and of each cost.
    frames: &'static str,
    warmup: &'static str,
    models: &'static [&'static str],
    /// Lights whose cost is taken.
    counts: &'static [u32],
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    frames: "64",
    warmup: "8",
    models: &[
        "point",
        "mrp",
        "ltc",
        "ltc-polynomial",
        "monte-carlo:1",
        "monte-carlo:4",
        "monte-carlo:16",
        "monte-carlo:64",
    ],
    counts: &[1, 4, 16, 64],
};

const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    frames: "6",
    warmup: "1",
    models: &[
        "point",
        "mrp",
        "ltc",
        "ltc-polynomial",
        "monte-carlo:1",
        "monte-carlo:4",
        "monte-carlo:16",
    ],
    counts: &[1, 4, 16],
};

/// The jobs of one scene: the truth, each model against it, and the cost of each by lights.
pub(super) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let extent = if args.quick { QUICK } else { FULL };
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let [core, _] = scene.boxes(bench)?;
    let range = format!("{:.3}", (core.diagonal() * RANGE_SHARE).clamp(1e-3, 1e5));
    let common = [&drawn[..], &["--radii", "equal", "--radius-scale", &range]].concat();
    let timed = ["--strategies", BASELINE, "--frames", extent.frames, "--warmup", extent.warmup];
    let timed = [&timed[..], &["--truth", "none"]].concat();
    let view = [&common[..], &["--lights", FEW, "--areas", "1"]].concat();
    let mut jobs = Vec::new();
    jobs.push(Job::new(scene, TRUTH, "", &[&["truth"], &view[..]].concat()));
    for model in extent.models {
        let words = [&["compare"], &view[..], &timed, &["--area-model", model]].concat();
        jobs.push(Job::new(scene, MODELS, &plain(model), &words));
    }
    for count in extent.counts {
        let count = count.to_string();
        let mut cost = |what: &str, options: &[&str]| {
            let words = [&["compare"], &common[..], &timed, &["--lights", &count], options];
            let words = [&words.concat()[..], &["--pictures", "none"]].concat();
            jobs.push(Job::new(scene, "cost", &format!("{count}-{what}"), &words));
        };
        cost("spots", &["--spots", "1"]);
        for model in extent.models {
            cost(&plain(model), &["--areas", "1", "--area-model", model]);
        }
    }
    Ok(jobs)
}

/// A model's name as part of a folder's.
fn plain(model: &str) -> String {
    model.replace(':', "-")
}
