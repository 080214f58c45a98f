//! What the deep-image paper claims of building deep images.

use crate::report::fit::Fit;
use crate::report::format::{mebibytes, number, percent, significant};
use crate::results::DeepImageRun;
use crate::study::cdi::claims::scenes::{other, too_alike};
use crate::study::cdi::jobs;
use crate::study::cdi::page::builds::most_directions;
use crate::study::cdi::times::{runs, timed_runs};
use crate::study::claims::{Answer, Verdict};
use crate::study::manifest::Done;

/// The paper's least factor of a pass for each direction over one for all.
const LEAST_FACTOR: f64 = 20.0;

pub(crate) fn one_pass(done: &Done, scene: &str) -> Answer {
    let Some(most) = most_directions(done, scene) else {
        return Answer::unknown("builds at a steady clock");
    };
    let factor = |ms: Option<f64>| ms.map(|ms| ms / most.single_ms);
    let time = |ms: Option<f64>, what: &str| match ms {
        Some(ms) => {
            let times = significant(ms / most.single_ms);
            format!("{what} takes {} ms, {times} times as long", significant(ms))
        }
        None => format!("{what} was not measured"),
    };
    let figure = format!(
        "{} directions: one pass takes {} ms; {}; {}",
        most.directions,
        significant(most.single_ms),
        time(most.each_ms, "a dispatch per direction"),
        time(most.batched_ms, "one dispatch for all")
    );
    let reaches = |ms| factor(ms).map(|factor| factor >= LEAST_FACTOR);
    let verdict = match (reaches(most.each_ms), reaches(most.batched_ms)) {
        (None, None) => Verdict::unmeasured("brute force"),
        (Some(true), Some(true)) => Verdict::Holds,
        (Some(true), Some(false)) => {
            Verdict::Differs("only against a dispatch per direction".into())
        }
        (Some(true), None) => {
            Verdict::Differs("brute force in one dispatch was not measured".into())
        }
        (_, Some(true)) => Verdict::Differs("only against one dispatch for all".into()),
        _ => Verdict::Fails,
    };
    Answer { figure, verdict }
}

/// Builds by compute that differ only in the number of directions, by that number, ms.
fn by_directions(done: &Done, scene: &str) -> Vec<(f64, f64)> {
    let all = timed_runs(done, scene, jobs::BUILDS);
    let Some(first) = all.iter().find(|run| run.deep.build == "compute") else { return Vec::new() };
    let plain = |run: &&&DeepImageRun| {
        let (own, known) = (&run.deep, &first.deep);
        own.build == "compute"
            && (own.size_px, own.oversampling, &own.spread)
                == (known.size_px, known.oversampling, &known.spread)
    };
    let point = |run: &&DeepImageRun| (f64::from(run.deep.directions()), run.build_ms());
    let mut points: Vec<(f64, f64)> = all.iter().filter(plain).map(point).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

pub(crate) fn overhead(done: &Done, scene: &str) -> Answer {
    /// The paper's greatest factor from 8 to 128 directions.
    const MOST: f64 = 4.7 / 1.5;
    let points = by_directions(done, scene);
    let at = |wanted: f64| points.iter().find(|(count, _)| *count == wanted).map(|(_, ms)| *ms);
    let (Some(few), Some(many)) = (at(8.0), at(128.0)) else {
        return Answer::unknown("8 and 128 directions");
    };
    let figure = format!(
        "8 to 128 directions: from {} to {} ms, {} times as long",
        significant(few),
        significant(many),
        significant(many / few)
    );
    let verdict = if many / few <= MOST { Verdict::Holds } else { Verdict::Fails };
    Answer { figure, verdict }
}

pub(crate) fn build_linear(done: &Done, scene: &str) -> Answer {
    /// No time may be farther off the line than this share of itself: the rule of the comparison paper's
    /// claim on lights.
    const TOLERANCE: f64 = 0.1;
    /// A line through three points with two ends always comes close.
    const FEWEST: usize = 4;
    let points = by_directions(done, scene);
    let Some(fit) = Fit::relative(&points).filter(|fit| fit.points >= FEWEST) else {
        return Answer::unknown("four numbers of directions");
    };
    let (off, at) = fit.worst(&points);
    let ends = [points.first(), points.last()].map(|end| end.map_or(0.0, |end| end.0));
    let figure = format!(
        "{} to {} directions: the line is {} ms plus {} \u{b5}s per direction. No time is farther \
         off the line than {} %, at {} directions",
        number(ends[0]),
        number(ends[1]),
        significant(fit.offset),
        significant(fit.slope * 1e3),
        percent(off),
        number(at)
    );
    Answer { figure, verdict: if off <= TOLERANCE { Verdict::Holds } else { Verdict::Fails } }
}

/// A scene's images of most directions, as a build makes them.
pub(crate) fn usual<'a>(done: &'a Done, scene: &'a str, build: &str) -> Option<&'a DeepImageRun> {
    let all = runs(done, scene, jobs::BUILDS);
    let first = all.first().copied()?;
    let found = all.into_iter().filter(|run| {
        run.deep.build == build
            && (run.deep.size_px, run.deep.oversampling) == (first.deep.size_px, 1)
            && run.deep.spread == first.deep.spread
    });
    found.max_by_key(|run| run.deep.directions())
}

pub(crate) fn size(done: &Done, scene: &str) -> Answer {
    /// Bytes may differ by a quarter and still be about the same.
    const ABOUT: f64 = 1.25;
    let bytes = |scene| usual(done, scene, "compute").map(|run| run.deep.bytes as f64);
    let Some(own) = bytes(scene) else { return Answer::unknown("builds") };
    let simple = match other(done, scene) {
        Ok(simple) => simple,
        Err(answer) => {
            return Answer { figure: format!("{} MiB", mebibytes(own)), ..answer };
        }
    };
    let Some(known) = bytes(simple) else { return Answer::unknown("builds") };
    let figure = format!("{} MiB, in {simple} {} MiB", mebibytes(own), mebibytes(known));
    let verdict = match too_alike(done, scene, simple) {
        Some(verdict) => verdict,
        None if (1.0 / ABOUT..=ABOUT).contains(&(own / known)) => Verdict::Holds,
        None => Verdict::Fails,
    };
    Answer { figure, verdict }
}

pub(crate) fn redundant(done: &Done, scene: &str) -> Answer {
    /// The paper's most.
    const MOST: f64 = 1.25;
    let fragments = |build| usual(done, scene, build).map(|run| run.deep.fragments as f64);
    let (Some(one), Some(each)) = (fragments("compute"), fragments("per-direction")) else {
        return Answer::unknown("both builds");
    };
    let figure = format!(
        "one pass stores {} million fragments, a pass for each direction {} million: {} times as many",
        significant(one / 1e6),
        significant(each / 1e6),
        significant(one / each)
    );
    let verdict = if one / each <= MOST { Verdict::Holds } else { Verdict::Fails };
    Answer { figure, verdict }
}

pub(crate) fn coverage(done: &Done, scene: &str) -> Answer {
    /// Errors of ranges may grow by a tenth.
    const SUFFICES: f64 = 1.1;
    let all = runs(done, scene, jobs::BUILDS);
    let conservative = all.iter().find(|run| run.deep.build == "conservative");
    let same = |run: &&&DeepImageRun| {
        conservative.is_some_and(|known| {
            run.deep.build == "compute"
                && run.deep.oversampling == 1
                && (run.deep.stacks, run.deep.slices, run.deep.size_px)
                    == (known.deep.stacks, known.deep.slices, known.deep.size_px)
        })
    };
    let centres = all.iter().find(same).and_then(|run| run.range_errors.as_ref());
    let touched = conservative.and_then(|run| run.range_errors.as_ref());
    let (Some(touched), Some(centres)) = (touched, centres) else {
        return Answer::unknown("rays through both builds");
    };
    let lost = |errors: &crate::results::RangeErrors| {
        percent(errors.lost as f64 / errors.rays.max(1) as f64)
    };
    let figure = format!(
        "the median error of a range is {} footprints, with conservative rasterisation {}; lost \
         rays: {} %, with conservative rasterisation {} %",
        significant(centres.median_range_error),
        significant(touched.median_range_error),
        lost(centres),
        lost(touched)
    );
    let suffices = centres.median_range_error <= SUFFICES * touched.median_range_error;
    Answer { figure, verdict: if suffices { Verdict::Holds } else { Verdict::Fails } }
}
