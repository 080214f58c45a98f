//! What the errors of indirect light say: rays against random and constant ranges, a tie where the noise
//! of the truth or of one seed could make the difference, and whether each sweep found its least error
//! inside.

use crate::grouping::grouped_by;
use crate::report::format::{difference, significant};
use crate::results::{Record, TruthImage, Vpls};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::cdi::jobs;
use crate::study::cdi::lights::{RULES, error, rule, setting, total_ms};
use crate::study::data::{Entry, entries};
use crate::study::job::Settings;
use crate::study::manifest::Done;

/// Standard errors on either side that hold 95 % of a normal distribution.
const SIGMAS: f64 = 1.96;

/// Errors within this share of the smaller one are ties. Random ranges come from one seed and the best of
/// a sweep is taken, so a smaller difference may be luck. The limit is ours.
const ALIKE: f64 = 0.02;

/// The verdict where lights lack Fresnel's term.
const STALE: &str = "these lights are 4 to 7 % too bright: measure again";

/// Two mean errors against one truth image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Nearer {
    First,
    Second,
    /// The noise of the truth or the choice of one seed could make the difference.
    Tie,
}

/// Standard error of the mean luminance of a truth image, as a share of it: the root mean square of the
/// pixels' standard errors over the root of their number, for pixels are sampled independently.
pub(crate) fn noise_of(truth: &TruthImage) -> f64 {
    let pixels = f64::from(truth.width) * f64::from(truth.height);
    truth.standard_error / pixels.max(1.0).sqrt()
}

/// Which of two mean errors is smaller, where the truth has a noise ([`noise_of`]). Errors within 2 % of
/// each other are ties.
///
/// A mean error is `mean |image - truth| / mean truth`. Where the truth's pixel is off by `e`, a
/// difference of two images' `|image - truth|` changes by at most `2 |e|`, so its variance is at most
/// four times that of `e`, and the standard error of the difference of means at most `2 noise`. The
/// mean below the line adds `|difference| noise`.
pub(crate) fn nearer(first: f64, second: f64, noise: f64) -> Nearer {
    let apart = first - second;
    let is_alike = apart.abs() <= ALIKE * first.min(second);
    if is_alike || apart.abs() <= SIGMAS * (2.0 + apart.abs()) * noise {
        Nearer::Tie
    } else if apart < 0.0 {
        Nearer::First
    } else {
        Nearer::Second
    }
}

/// The page's note on ties.
pub(crate) fn about_ties(truth: &TruthImage) -> String {
    format!(
        "The noise of the truth changes a difference of two mean errors by at most {} (two \
         standard errors), so smaller differences are ties. Random ranges come from one seed, and \
         the best of each sweep is shown, so errors within {} % of each other are also ties.",
        difference(SIGMAS * 2.0 * noise_of(truth)),
        significant(ALIKE * 100.0)
    )
}

/// The record of least error of a rule among some.
pub(crate) fn best<'a>(
    entries: &[Entry<'a>],
    name: &str,
    among: impl Fn(&Record) -> bool,
) -> Option<Entry<'a>> {
    let of_rule = entries.iter().filter(|entry| rule(entry.record) == name && among(entry.record));
    least(of_rule.copied())
}

fn least<'a>(entries: impl Iterator<Item = Entry<'a>>) -> Option<Entry<'a>> {
    let known = entries.filter_map(|entry| Some((error(entry.record)?, entry)));
    known.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, entry)| entry)
}

/// Rays as they are usually cast, at the rule and factor of least error: other rules have as many
/// settings.
pub(crate) fn best_cast<'a>(entries: &[Entry<'a>]) -> Option<Entry<'a>> {
    let is_usual = |record: &Record| {
        record
            .indirect
            .as_ref()
            .is_some_and(|vpls| jobs::is_usual(vpls) && vpls.given_ranges_m.is_none())
    };
    least(entries.iter().copied().filter(|entry| is_usual(entry.record)))
}

/// The name of a rule by its id.
fn named(id: &str) -> &'static str {
    RULES.iter().find(|(known, ..)| *known == id).map_or("", |(_, _, name)| name)
}

/// The parameter that a sweep varies: the factor on lengths of rays, or the longest range.
fn parameter(vpls: &Vpls) -> f64 {
    vpls.given_ranges_m.map_or(vpls.range_scale, |[_, high]| high)
}

/// Whether the best of a rule's sweep is its first or its last setting, `None` of fewer than three:
/// then a better one may lie beyond.
pub(crate) fn is_at_end(entries: &[Entry<'_>], best: &Record) -> Option<bool> {
    let vpls = best.indirect.as_ref()?;
    let sweep = |vpls: &Vpls| {
        let deep = vpls.deep.as_ref();
        (
            (vpls.ranges.clone(), vpls.candidates),
            (vpls.rays, vpls.is_reflected, vpls.is_corrected),
            deep.map(|deep| (deep.build.clone(), deep.directions(), deep.size_px)),
        )
    };
    let of_sweep = |other: &&Vpls| sweep(other) == sweep(vpls);
    let all = entries.iter().filter_map(|entry| entry.record.indirect.as_ref()).filter(of_sweep);
    let values: Vec<f64> = all.map(parameter).collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    let value = parameter(vpls);
    (values.len() > 2).then_some(value == least || value == most)
}

/// Rays against random and constant ranges: the same map, no more lights, no more time, the same
/// lights left out.
pub(crate) fn quietest(done: &Done, scene: &str) -> Vec<String> {
    let all = entries(done, scene, MODELS);
    let mut found = Vec::new();
    let (Some(cast), Some((_, truth))) = (best_cast(&all), truth_of(done, scene)) else {
        return found;
    };
    let (Some(own), Some(vpls)) = (error(cast.record), cast.record.indirect.as_ref()) else {
        return found;
    };
    let noise = noise_of(truth);
    let say = |other: Entry<'_>, what: &str| {
        let other_error = error(other.record).unwrap_or(f64::NAN);
        let verdict = match nearer(own, other_error, noise) {
            _ if [cast, other].iter().any(|entry| is_stale(entry.record)) => STALE,
            Nearer::First => "rays are nearer to the truth",
            Nearer::Second => "rays are farther from the truth",
            Nearer::Tie => "a tie",
        };
        format!(
            "In {scene}, the mean error with ranges from rays ({}) is {} of the mean luminance{}. \
             With {what} ({}), it is {}{}: {verdict}.{}",
            setting(cast.record),
            difference(own),
            in_time(cast.record),
            setting(other.record),
            difference(other_error),
            in_time(other.record),
            match is_at_end(&all, other.record) {
                Some(true) =>
                    " The best value is the first or last one that was tried, so a better one may \
                     exist.",
                _ => "",
            }
        )
    };
    let kept = |record: &Record| record.indirect.as_ref().map_or(0, |other| other.kept);
    let of_map = |record: &Record| {
        record.indirect.as_ref().is_some_and(|other| other.candidates == vpls.candidates)
    };
    let random = named("random");
    let same_map = best(&all, random, of_map);
    let same_count = best(&all, random, |record| kept(record) <= vpls.kept);
    let limit = total_ms(cast.record);
    let same_time = best(&all, random, |record| total_ms(record) <= limit);
    let same_lights = best(&all, named("random-discard"), of_map);
    let constant = best(&all, named("constant-discard"), of_map);
    for (other, what) in [
        (same_map, "the best random ranges from the same map"),
        (same_lights, "the best random ranges for the same lights"),
        (constant, "the best single range for the same lights"),
        (same_count, "the best random ranges for at most as many lights"),
        (same_time, "the best random ranges in at most the same time"),
    ] {
        found.extend(other.map(|other| say(other, what)));
    }
    if is_at_end(&all, cast.record) == Some(true) {
        found.push(format!(
            "In {scene}, the best factor on ranges from rays is the first or last one that was \
             tried."
        ));
    }
    if let Some(other) = best(&all, named("infinite"), |_| true) {
        let other_error = error(other.record).unwrap_or(f64::NAN);
        found.push(format!(
            "In {scene}, the mean error of lights with infinite range is {} of the mean luminance{}.",
            difference(other_error),
            in_time(other.record)
        ));
    }
    found
}

/// Whether a record's lights lack Fresnel's term. If so, its errors decide nothing.
fn is_stale(record: &Record) -> bool {
    record.indirect.as_ref().is_some_and(|vpls| !vpls.has_fresnel)
}

/// ` in 3.2 ms`; nothing where the clock was not steady.
fn in_time(record: &Record) -> String {
    let ms = total_ms(record);
    if ms.is_finite() { format!(" in {} ms", significant(ms)) } else { String::new() }
}

/// Rays against random ranges from the same map, in the first scene that has both.
pub(crate) fn rays_against_random(done: &Done) -> Option<String> {
    done.scenes().into_iter().find_map(|scene| {
        let all = entries(done, scene, MODELS);
        let cast = best_cast(&all)?;
        let candidates = cast.record.indirect.as_ref()?.candidates;
        let random = best(&all, named("random"), |record| {
            record.indirect.as_ref().is_some_and(|other| other.candidates == candidates)
        })?;
        let (own, theirs) = (error(cast.record)?, error(random.record)?);
        let (_, truth) = truth_of(done, scene)?;
        let verdict = match nearer(own, theirs, noise_of(truth)) {
            _ if is_stale(cast.record) || is_stale(random.record) => format!(": {STALE}"),
            Nearer::Tie => ": a tie".to_owned(),
            _ => String::new(),
        };
        Some(format!(
            "In {scene}, the mean error of lights is {} of the mean luminance{} with ranges from \
             rays, and {}{} with the best random ranges{verdict}.",
            significant(own),
            in_time(cast.record),
            significant(theirs),
            in_time(random.record)
        ))
    })
}

/// The setting of a sweep that errs least on average over the scenes, with that error and the greatest of
/// any scene. A renderer would choose this setting once.
fn best_in_common(done: &Done, is_of: fn(&Settings) -> bool) -> Option<(f64, f64)> {
    let scenes = done.scenes();
    let all = scenes.iter().flat_map(|scene| entries(done, scene, MODELS));
    let errors = all
        .filter(|entry| is_of(&entry.job.settings))
        .filter_map(|entry| Some((&entry.job.settings, error(entry.record)?)));
    grouped_by(errors)
        .into_iter()
        .filter(|(_, errors)| errors.len() == scenes.len())
        .map(|(_, errors)| {
            let worst = errors.iter().copied().fold(0.0, f64::max);
            (errors.iter().sum::<f64>() / errors.len() as f64, worst)
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Whether a job is of the sweep of one of the rules: over factors, or over longest ranges.
fn is_swept(settings: &Settings, rules: &[&str]) -> bool {
    settings.text("sweep").is_some_and(|rule| rules.contains(&rule))
}

/// One setting for all scenes: rays against ranges that know nothing of the scene, where there are
/// several scenes.
pub(crate) fn in_common(done: &Done) -> Option<String> {
    let scenes = done.scenes();
    if scenes.len() < 2 {
        return None;
    }
    let (own, own_worst) = best_in_common(done, |job| is_swept(job, &["average", "maximum"]))?;
    let (theirs, their_worst) = best_in_common(done, |job| is_swept(job, &["random"]))?;
    // The mean of the scenes' errors: their noises are independent.
    let noises = scenes.iter().filter_map(|scene| Some(noise_of(truth_of(done, scene)?.1)));
    let noise = noises.map(|noise| noise * noise).sum::<f64>().sqrt() / scenes.len() as f64;
    let is_stale = done.results.values().flat_map(|results| &results.records).any(is_stale);
    let tie = |error: f64| match nearer(own, error, noise) {
        Nearer::Tie if !is_stale => ", a tie with rays",
        _ => "",
    };
    let others: Vec<String> = [
        (
            "random ranges for the same lights",
            best_in_common(done, |job| is_swept(job, &["random-discard"])),
        ),
        (
            "one range for all of them",
            best_in_common(done, |job| is_swept(job, &["constant-discard"])),
        ),
    ]
    .into_iter()
    .filter_map(|(what, found)| {
        let (mean, worst) = found?;
        let (tie, mean, worst) = (tie(mean), significant(mean), significant(worst));
        Some(format!(". With {what}, it is {mean} ({worst}{tie})"))
    })
    .collect();
    let tie = tie(theirs);
    let stale = if is_stale { format!(": {STALE}") } else { String::new() };
    Some(format!(
        "With one setting for all {} scenes, the mean error of lights with ranges from rays is {} \
         of the mean luminance ({} in the worst scene). With random ranges for all lights, it is \
         {} ({}{tie}){}{stale}.",
        scenes.len(),
        significant(own),
        significant(own_worst),
        significant(theirs),
        significant(their_worst),
        others.concat()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_within_the_noise_is_a_tie() {
        // As in the atrium of 2026-11-25: 51 % of the mean over 480 x 270 pixels.
        let noise = 0.51 / (480.0_f64 * 270.0).sqrt();
        assert_eq!(nearer(0.372, 0.367, noise), Nearer::Tie);
        assert_eq!(nearer(0.372, 0.385, noise), Nearer::First);
        assert_eq!(nearer(0.385, 0.372, noise), Nearer::Second);
        // One seed: 0.3 % apart is a tie without noise, 3 % is not.
        assert_eq!(nearer(0.372, 0.371, 0.0), Nearer::Tie);
        assert_eq!(nearer(0.383, 0.372, 0.0), Nearer::Second);
        assert_eq!(nearer(0.372, 0.372, 0.0), Nearer::Tie);
    }

    /// The bound holds: over 4,000 truths with noise, the difference of two images' mean errors spreads
    /// by less than it says, and by more than a tenth of it.
    #[test]
    fn the_noise_of_a_difference_is_within_its_bound() {
        let pixels = 64_usize;
        let mut state = 7_u64;
        let mut normal = || {
            // The sum of twelve uniform numbers less six: variance 1.
            let sum: f64 = (0..12)
                .map(|_| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    (state >> 11) as f64 / (1_u64 << 53) as f64
                })
                .sum();
            sum - 6.0
        };
        let spread = 0.3;
        // One image errs above the truth, the other below: every pixel's slope is 2.
        let image = |sign: f64, ix: usize| 1.0 + sign * (0.8 + 0.01 * ix as f64);
        let differences: Vec<f64> = (0..4_000)
            .map(|_| {
                let truth: Vec<f64> = (0..pixels).map(|_| 1.0 + spread * normal()).collect();
                let mean = truth.iter().sum::<f64>() / pixels as f64;
                let error = |sign: f64| {
                    let off = truth.iter().enumerate().map(|(ix, t)| (image(sign, ix) - t).abs());
                    off.sum::<f64>() / pixels as f64 / mean
                };
                error(1.0) - error(-1.0)
            })
            .collect();
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
        let found = (variance / differences.len() as f64).sqrt();
        let bound = (2.0 + mean.abs()) * spread / (pixels as f64).sqrt();
        assert!(found < 1.05 * bound && found > 0.5 * bound, "{found}, bound {bound}");
    }
}
