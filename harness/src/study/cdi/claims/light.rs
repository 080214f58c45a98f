//! What the deep-image paper claims of images, against the path-traced one.

use crate::report::format::{difference, number, percent, significant};
use crate::results::{Record, Vpls};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::cdi::lights::{METRIC, RULES, error, rule, setting};
use crate::study::cdi::same_build::image_by_build;
use crate::study::cdi::verdicts::{Nearer, best, best_cast, is_at_end, nearer, noise_of};
use crate::study::claims::{Answer, Verdict};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;

/// A share for a sentence: `0.12 %`.
fn share(value: f64) -> String {
    format!("{} %", percent(value))
}

/// Whether how deep images are built shows in the image.
pub(crate) fn same_image(done: &Done, scene: &str) -> Answer {
    /// Up to this share of pixels that are off by a twentieth, the claim holds in part.
    const FEW: f64 = 0.01;
    let Some((mean_error, off)) = image_by_build(done, scene) else {
        return Answer::unknown("images through both builds");
    };
    let figure = format!(
        "the mean error is {} of the mean luminance; {} of pixels are off by more than a twentieth",
        difference(mean_error),
        share(off)
    );
    let verdict = match off {
        0.0 => Verdict::Holds,
        off if off < FEW => Verdict::Differs(format!("{} of pixels are off", share(off))),
        _ => Verdict::Fails,
    };
    Answer { figure, verdict }
}

/// The best of rays and of another rule, with the noise of the truth.
struct Against<'a> {
    all: Vec<Entry<'a>>,
    cast: &'a Record,
    noise: f64,
}

impl<'a> Against<'a> {
    fn new(done: &'a Done, scene: &'a str) -> Option<Self> {
        let all = entries(done, scene, MODELS);
        let cast = best_cast(&all)?.record;
        let noise = noise_of(truth_of(done, scene)?.1);
        Some(Self { all, cast, noise })
    }

    fn vpls(record: &Record) -> Option<&Vpls> {
        record.indirect.as_ref()
    }

    /// The best of a rule from the same map.
    fn best(&self, id: &str) -> Option<&'a Record> {
        let name = RULES.iter().find(|(known, ..)| *known == id).map(|(_, _, name)| *name)?;
        let candidates = Self::vpls(self.cast)?.candidates;
        let of_map = |record: &Record| {
            Self::vpls(record).is_some_and(|other| other.candidates == candidates)
        };
        best(&self.all, name, of_map).map(|entry| entry.record)
    }

    /// Whether rays are nearer to the truth than another record.
    fn nearer(&self, other: &Record) -> Option<Nearer> {
        Some(nearer(error(self.cast)?, error(other)?, self.noise))
    }

    /// `random: mean error 0.52 (0 to 11 m, 9,701 of 39,421 lights)`, and whether its sweep ended there.
    fn described(&self, what: &str, record: &Record) -> String {
        let end = match is_at_end(&self.all, record) {
            Some(true) => ", the end of its sweep",
            _ => "",
        };
        let error = error(record).unwrap_or(f64::NAN);
        format!("{what}: mean error {} ({}{end})", significant(error), setting(record))
    }
}

/// Lights that are 4 to 7 % too bright decide nothing.
fn stale(records: &[&Record]) -> Option<Verdict> {
    let is_stale =
        |record: &&Record| record.indirect.as_ref().is_some_and(|vpls| !vpls.has_fresnel);
    let any = records.iter().any(is_stale);
    any.then(|| Verdict::undecided("these lights were 4 to 7 % too bright: measure again"))
}

/// The fewest random lights that come as near to the truth as those with ranges by rays.
pub(crate) fn fewer_lights(done: &Done, scene: &str) -> Answer {
    let Some(against) = Against::new(done, scene) else {
        return Answer::unknown("errors of rays against the truth");
    };
    let kept = |record: &Record| record.indirect.as_ref().map_or(0, |vpls| vpls.kept);
    let as_near = against.all.iter().map(|entry| entry.record).filter(|record| {
        rule(record) == "random" && against.nearer(record).is_some_and(|who| who != Nearer::First)
    });
    let fewest = as_near.min_by_key(|record| kept(record));
    let kept_lights = kept(against.cast);
    let mut figure = against.described("rays", against.cast);
    figure += &match fewest {
        Some(record) => format!(
            "; the fewest lights with random ranges that are as near: {} with a mean error of {}",
            number(kept(record) as f64),
            significant(error(record).unwrap_or(f64::NAN))
        ),
        None => "; no random ranges are as near".to_owned(),
    };
    let same_lights = against.best("random-discard");
    if let Some(record) = same_lights {
        figure += &format!("; {}", against.described("random ranges, the same lights", record));
    }
    if let Some(verdict) = stale(&[against.cast]) {
        return Answer { figure, verdict };
    }
    let is_fewer = fewest.is_none_or(|record| kept(record) > kept_lights);
    let verdict = match (is_fewer, same_lights.and_then(|record| against.nearer(record))) {
        (false, _) => Verdict::Fails,
        (true, Some(Nearer::First)) => Verdict::Holds,
        (true, Some(_)) => Verdict::Differs(
            "removing lights whose rays hit nothing explains it, not the length of the rays".into(),
        ),
        (true, None) => Verdict::Differs(
            "whether the removed lights or the lengths of rays explain it was not measured".into(),
        ),
    };
    Answer { figure, verdict }
}

/// Rays against random ranges, each at its best, of the same map.
pub(crate) fn visual_quality(done: &Done, scene: &str) -> Answer {
    let Some(against) = Against::new(done, scene) else {
        return Answer::unknown("errors of rays against the truth");
    };
    let Some(random) = against.best("random") else { return Answer::unknown("random ranges") };
    let others: Vec<String> = [
        ("random-discard", "random ranges, the same lights"),
        ("constant-discard", "one range, the same lights"),
    ]
    .into_iter()
    .filter_map(|(id, what)| Some(format!("; {}", against.described(what, against.best(id)?))))
    .collect();
    let figure = format!(
        "{}; {}{}",
        against.described("rays", against.cast),
        against.described("random ranges", random),
        others.concat()
    );
    if let Some(verdict) = stale(&[against.cast, random]) {
        return Answer { figure, verdict };
    }
    let verdict = match against.nearer(random) {
        Some(Nearer::First) if is_at_end(&against.all, random) == Some(true) => {
            Verdict::Differs("the sweep of random ranges ends at its best".into())
        }
        Some(Nearer::First) => Verdict::Holds,
        Some(Nearer::Tie) => Verdict::Differs("a tie within the noise of the truth".into()),
        Some(Nearer::Second) => Verdict::Fails,
        None => Verdict::unmeasured("errors"),
    };
    Answer { figure, verdict }
}

/// How far the best image is from the truth; the paper has no measure of it.
pub(crate) fn similar(done: &Done, scene: &str) -> Answer {
    let Some(against) = Against::new(done, scene) else {
        return Answer::unknown("errors of rays against the truth");
    };
    let find =
        |id: &str| against.cast.image.truth_errors.get(id).copied().flatten().unwrap_or(f64::NAN);
    let figure = format!(
        "mean error {} of the mean luminance, missing energy {} %, bias {} %, FLIP {}",
        significant(find(METRIC)),
        percent(find("missing_energy")),
        percent(find("bias")),
        significant(find("flip"))
    );
    if let Some(verdict) = stale(&[against.cast]) {
        return Answer { figure, verdict };
    }
    Answer { figure, verdict: Verdict::undecided("the paper gives no measure to compare with") }
}
