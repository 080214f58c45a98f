//! Shadows of area lights by many shadow maps (Dobetsberger 2025, chapter 6): how far images are from the truth by the
//! number of maps, their size, their filter and the number of lights in one atlas.
//!
//! Each job draws four rectangles (or the number that it names) without culling. So no error comes from lists and no
//! time from assignment. Errors are those against T, the truth with shadows. P is the exact visible share times the
//! exact light without shadows. Its own error against T is the floor: no model of visible shares is below it. Another
//! floor is the error of the pipeline without shadows against the truth without shadows: G-buffer, textures, area-light
//! model.

mod cells;
mod claims;
mod jobs;
mod lod;
mod occlusion;
mod page;
mod rays;
mod roughness;

use super::against_truth::{TruthOf, compare_with_truths};
use super::job::Job;
use super::scene::StudyScene;
use super::slice::{Study, TakesMotion, atrium};
use crate::bench::Bench;
use crate::cli::StudyArgs;
use crate::error::HarnessError;
use crate::report::markup::Html;

/// The study of shadow maps.
pub(crate) const STUDY: Study = Study {
    name: "shadows",
    answers: "How far shadow maps of area lights are from the truth, by their number, size and filter, and by the lights in one atlas",
    scenes: atrium,
    jobs: all_jobs,
    motion: TakesMotion::None(
        "its times of moving lights are sums of the times of drawing and shading",
    ),
    after_run: |done| compare_with_truths(done, &jobs::AGAINST, TruthOf::Alike(jobs::ALIKE)),
    headline: page::headline,
    findings: page::findings,
    front: |_| Html::default(),
    parts: page::parts,
    overall: |_| Html::default(),
    paper: &claims::PAPER,
    tells_warnings: true,
    notices: |_| Vec::new(),
};

/// The jobs of all sections.
fn all_jobs(
    bench: &mut Bench,
    args: &StudyArgs,
    scene: &StudyScene,
) -> Result<Vec<Job>, HarnessError> {
    let mut all = jobs::jobs(bench, args, scene)?;
    all.extend(rays::jobs(bench, args, scene)?);
    all.extend(roughness::jobs(bench, args, scene)?);
    all.extend(lod::jobs(bench, args, scene)?);
    all.push(occlusion::job(args, scene, jobs::extent_of(args)));
    Ok(all)
}
