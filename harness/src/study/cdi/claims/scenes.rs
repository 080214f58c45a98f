//! Which scenes a claim on the number of triangles compares.

use crate::report::format::significant;
use crate::study::cdi::jobs;
use crate::study::cdi::times::runs;
use crate::study::claims::{Answer, Verdict};
use crate::study::manifest::Done;

/// The scene of the fewest triangles among those whose deep images were built.
pub(crate) fn simplest(done: &Done) -> Option<&str> {
    let triangles = |scene: &&str| runs(done, scene, jobs::BUILDS).first().map(|run| run.triangles);
    let known = done.scenes().into_iter().filter(|scene| triangles(scene).is_some());
    known.min_by_key(|scene| triangles(scene))
}

/// The scene that another is compared with; the reason where there is none.
pub(crate) fn other<'a>(done: &'a Done, scene: &str) -> Result<&'a str, Answer> {
    match simplest(done) {
        Some(simplest) if simplest != scene => Ok(simplest),
        Some(_) => Err(Answer::undecided("this scene is the reference")),
        None => Err(Answer::unknown("builds")),
    }
}

/// The claims are about a town of 20 times the triangles: scenes that differ by less than half of that
/// decide nothing.
pub(crate) fn too_alike(done: &Done, scene: &str, simple: &str) -> Option<Verdict> {
    const LEAST: f64 = 10.0;
    let triangles = |scene| runs(done, scene, jobs::BUILDS).first().map(|run| run.triangles as f64);
    let ratio = triangles(scene)? / triangles(simple)?;
    (ratio < LEAST).then(|| {
        let ratio = significant(ratio);
        Verdict::undecided(&format!(
            "{ratio} times the triangles of {simple}, not the paper\u{2019}s 20"
        ))
    })
}
