//! Models of area lights (Dobetsberger 2025, chapter 5): how far each is from the truth, what it costs,
//! what area lights cost beside spots, and what bounding them by balls costs.
//!
//! Models light every sample with every light (`None`), so no error comes from culling and no time from
//! assignment. Lights are rectangles, as in the paper.

use crate::study::against_truth::{MODELS, TRUTH};
use crate::study::job::Job;
use crate::study::scene::StudyScene;
use crate::{
    bench::Bench,
    cli::{Size, StudyArgs},
    error::HarnessError,
    strategy::BASELINE,
};

/// The section whose records list area lights by their outlines and by balls around them.
pub const BOUNDS: &str = "bounds";

/// The range of a light as a share of the diagonal of the scene's core: from where it hangs, it is
/// seen on floor and walls.
const RANGE_SHARE: f32 = 0.5;

/// The same where lights are culled: each reaches a part of the scene.
const CULLED_RANGE_SHARE: f32 = 0.12;

/// Lights of the one view of the truth.
const FEW: &str = "4";

/// Strategies whose lists are made by outlines and by balls.
const CULLED: [&str; 2] = ["T-E/28x28", "SC-E/48x48x40"];

/// The models that one count of lights is timed with.
type Cost = (u32, &'static [&'static str]);

/// How much the study looks at.
struct Extent {
    size: Size,
    /// Frames of the view and of each cost.
    frames: &'static str,
    warmup: &'static str,
    models: &'static [&'static str],
    costs: &'static [Cost],
    /// Lights that are culled.
    culled: &'static str,
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    frames: "32",
    warmup: "4",
    models: &[
        "point",
        "mrp",
        "mrp-published",
        "ltc",
        "ltc-hammon",
        "ltc-unsplit",
        "ltc-polynomial",
        "monte-carlo:2",
        "monte-carlo:8",
        "monte-carlo:32",
        "monte-carlo-reflected:2",
        "monte-carlo-reflected:8",
        "monte-carlo-reflected:32",
    ],
    costs: &[
        (
            1,
            &[
                "mrp",
                "mrp-published",
                "ltc",
                "ltc-per-light",
                "ltc-polynomial-per-light",
                "monte-carlo-reflected:1",
            ],
        ),
        (16, COSTS),
        (64, COSTS),
    ],
    culled: "200",
};

/// Models whose times the paper has at 16 and 64 lights, with their variants.
const COSTS: &[&str] = &[
    "point",
    "mrp",
    "mrp-published",
    "ltc",
    "ltc-unsplit",
    "ltc-per-light",
    "ltc-polynomial",
    "ltc-polynomial-per-light",
    "monte-carlo-reflected:1",
    "monte-carlo-reflected:4",
];

const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    frames: "6",
    warmup: "1",
    models: &[
        "point",
        "mrp",
        "mrp-published",
        "ltc",
        "ltc-hammon",
        "ltc-polynomial",
        "monte-carlo:4",
        "monte-carlo-reflected:4",
    ],
    costs: &[(1, QUICK_COSTS), (4, QUICK_COSTS), (16, QUICK_COSTS)],
    culled: "20",
};

const QUICK_COSTS: &[&str] = &["mrp-published", "ltc", "monte-carlo-reflected:1"];

/// The jobs of one scene: the truth, each model against it, the cost of each by lights, and bounds.
pub(crate) fn jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let extent = if args.quick { QUICK } else { FULL };
    let drawn = scene.options(args.size.unwrap_or(extent.size), args.seed);
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    let ([core, _], _) = scene.boxes(bench)?;
    // All digits: in a scene of millimetres, a rounded range would differ.
    let range = |share: f32| (core.diagonal() * share).clamp(1e-6, 1e6).to_string();
    let alike = [&drawn[..], &["--radii", "equal"]].concat();
    let far = range(RANGE_SHARE);
    let scaled = [&alike[..], &["--radius-scale", &far]].concat();
    let outlines = ["--outlines", "rectangles"];
    let common = [&scaled[..], &outlines].concat();
    let frames = ["--frames", extent.frames, "--warmup", extent.warmup, "--truth", "none"];
    let timed = [&["--strategies", BASELINE], &frames[..]].concat();
    let view = [&common[..], &["--lights", FEW, "--areas", "1"]].concat();
    let mut jobs = Vec::new();
    jobs.push(Job::new(scene, TRUTH, "", &[&["truth"], &view[..]].concat()));
    for model in extent.models {
        let words = [&["compare"], &view[..], &timed, &["--area-model", model]].concat();
        jobs.push(Job::new(scene, MODELS, &plain(model), &words));
    }
    for (count, models) in extent.costs {
        let count = count.to_string();
        let mut cost = |what: &str, drawn: &[&str], options: &[&str]| {
            let words = [&["compare"], drawn, &timed, &["--lights", &count], options];
            let words = [&words.concat()[..], &["--pictures", "none"]].concat();
            let name = format!("{count}-{}", plain(what));
            jobs.push(Job::new(scene, "cost", &name, &words));
        };
        cost("spots", &scaled, &["--spots", "1"]);
        for model in *models {
            cost(model, &common, &["--areas", "1", "--area-model", model]);
        }
    }
    let ids: Vec<String> =
        CULLED.iter().flat_map(|id| [(*id).to_owned(), format!("{id}/ball")]).collect();
    let ids = format!("{BASELINE},{}", ids.join(","));
    let near = range(CULLED_RANGE_SHARE);
    let culled = ["--lights", extent.culled, "--areas", "1", "--radius-scale", &near];
    let options = ["--strategies", &ids, "--pictures", "none"];
    let words = [&["compare"], &alike[..], &outlines, &culled, &frames, &options].concat();
    jobs.push(Job::new(scene, BOUNDS, extent.culled, &words));
    Ok(jobs)
}

/// A model's name as part of a folder's.
fn plain(model: &str) -> String {
    model.replace(':', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_of_the_study_is_one() {
        for extent in [FULL, QUICK] {
            let costs = extent.costs.iter().flat_map(|(_, models)| *models);
            for model in extent.models.iter().chain(costs) {
                assert!(model.parse::<shading::AreaModel>().is_ok(), "{model}");
            }
            let has_ltc = extent.models.contains(&"ltc");
            assert!(has_ltc && extent.models.len() < 16, "a figure has 16 colours");
        }
    }
}
