//! Findings in words, computed from the records.

use super::comparison::{Comparison, comparisons};
use super::format::{factor, number, short_adapter, significant};
use super::lead::{Lead, span};
use super::loss::{loss, range_loss};
use super::rank::{is_timed, tie};
use super::raster;
use crate::results::{Clock, DeviceType, Record, Results, TruthLevel, Untested};

/// Ratios nearer to 1 are called equal: no more is known from a handful of samples.
const EQUAL: f64 = 0.03;

/// What a run found, one sentence per comparison; the first is the headline.
pub fn finding(results: &Results) -> Vec<String> {
    let all = comparisons(results);
    let adapter = short_adapter(&results.machine.adapter);
    if all.is_empty() {
        return vec![format!("On {adapter}, nothing was measured.")];
    }
    all.iter()
        .map(|comparison| {
            let setting = setting(&all, comparison);
            format!("On {adapter}{setting}, {}.", sentence(comparison))
        })
        .collect()
}

/// What tells a comparison from the others of its run.
fn setting(all: &[Comparison<'_>], comparison: &Comparison<'_>) -> String {
    let first = comparison.first();
    let varies = |key: fn(&Record) -> String| {
        let own = key(first);
        all.iter().any(|other| key(other.first()) != own).then_some(own)
    };
    [
        varies(|r| format!("in {}", r.setting.scene)),
        varies(|r| r.setting.mode.name().to_owned()),
        varies(|r| format!("at {}\u{d7}{}", r.setting.width, r.setting.height)),
        varies(|r| format!("at scene scale {}", r.setting.scene_scale)),
        varies(|r| format!("at radius scale {}", r.setting.radius_scale)),
        varies(|r| format!("from seed {}", r.setting.seed)),
    ]
    .into_iter()
    .flatten()
    .map(|part| format!(", {part}"))
    .collect()
}

fn sentence(comparison: &Comparison<'_>) -> String {
    let first = comparison.first();
    if let Some(why) = first.untested_words().filter(|_| !is_dark(first)) {
        return format!("nothing can be said: {why}, so no method was put to a test");
    }
    let Some(fastest) = comparison.fastest().filter(|record| is_timed(record)) else {
        if !is_timed(first) {
            return match first.is_baseline() {
                true => "no time was recorded without culling".to_owned(),
                false => format!("no time was recorded of {}", comparison.name(first)),
            };
        }
        return format!(
            "{} takes {} ms to shade {}",
            if first.is_baseline() { "no culling".to_owned() } else { comparison.name(first) },
            significant(first.assign_and_shade_ms()),
            lights(first.setting.lights),
        );
    };
    let Some(lead) = Lead::of_comparison(comparison) else {
        // All that cull lost something: the fastest says what.
        let subject = Subject::of(fastest, comparison.name(fastest));
        return speed(comparison, &subject) + &image(fastest);
    };
    let subject = Subject::lead(&lead);
    let image = match lead.is_tie() {
        true if lead.records.iter().all(|record| image(record) == SAME_IMAGE) => {
            " and show the same image, bit for bit".to_owned()
        }
        true => String::new(),
        false => image(fastest),
    };
    speed(comparison, &subject) + &image + &lead.doubt()
}

/// Whether surfaces are there, and no light at all: the times are then those of an empty frame.
fn is_dark(record: &Record) -> bool {
    record.setting.lights == 0 && record.lists.untested == Some(Untested::NoLight)
}

/// Who a sentence speaks of: one method, or several that tie.
struct Subject<'a> {
    records: Vec<&'a Record>,
    /// `A`, or `A and B tie for fastest: they`.
    words: String,
    /// Follows a speed: for which lights it holds.
    still_lights: String,
}

impl<'a> Subject<'a> {
    fn of(record: &'a Record, words: String) -> Self {
        Self { records: vec![record], words, still_lights: String::new() }
    }

    fn lead(lead: &Lead<'a>) -> Self {
        let words = match lead.is_tie() {
            true => format!("{}: they", lead.is_fastest()),
            false => lead.names(),
        };
        Self { records: lead.records.clone(), words, still_lights: lead.still_lights() }
    }

    /// A verb in the singular or the plural.
    fn verb<'v>(&self, one: &'v str, several: &'v str) -> &'v str {
        if self.records.len() > 1 { several } else { one }
    }

    /// The least and the greatest of a figure: `15.9 to 16.1`.
    fn span(&self, figure: impl Fn(&Record) -> Option<f64>) -> Option<String> {
        span(&self.records, figure)
    }
}

/// How fast the best is, beside no culling where that was measured.
fn speed(comparison: &Comparison<'_>, subject: &Subject<'_>) -> String {
    let leader = subject.records[0];
    let words = &subject.words;
    let lights = lights(leader.setting.lights);
    let still = &subject.still_lights;
    let takes = subject.verb("takes", "take");
    let time = |record: &Record| Some(record.assign_and_shade_ms());
    let took = subject.span(time).unwrap_or_default();
    let alone = || {
        let verb = subject.verb("assigns and shades", "assign and shade");
        format!("{words} {verb} {lights} in {took} ms{still}")
    };
    let Some(baseline) = comparison.baseline().filter(|record| is_timed(record)) else {
        return alone();
    };
    if leader.setting.lights == 0 {
        let none = significant(baseline.assign_and_shade_ms());
        return format!(
            "there is no light to assign: {words} {takes} {took} ms, no culling {none} ms"
        );
    }
    let faster = |record: &Record| comparison.speedup(record);
    match (comparison.speedup(leader), subject.span(faster)) {
        (Some(speedup), _) if (speedup - 1.0).abs() <= EQUAL => {
            format!("{words} {takes} as long as no culling to shade {lights}{still}")
        }
        (Some(speedup), Some(factors)) if speedup > 1.0 => {
            let verb = subject.verb("shades", "shade");
            let exit = over_exit(comparison, subject);
            format!("{words} {verb} {lights} {factors}\u{d7} as fast as no culling{exit}{still}")
        }
        (Some(speedup), _) => {
            let factor = factor(1.0 / speedup);
            format!("{words} {takes} {factor}\u{d7} as long as no culling to shade {lights}{still}")
        }
        (None, _) => alone(),
    }
}

/// How they stand against no culling with the same early exit, where that was measured.
fn over_exit(comparison: &Comparison<'_>, subject: &Subject<'_>) -> String {
    subject
        .span(|record| comparison.speedup_over_exit(record))
        .map_or_else(String::new, |factors| {
            format!(" ({factors}\u{d7} if that has the same early exit)")
        })
}

/// What is said of an image that is that of no culling.
const SAME_IMAGE: &str = " and shows the same image, bit for bit";

/// What is known of a record's image, to follow the sentence on its speed.
fn image(record: &Record) -> String {
    match loss(record) {
        Some(loss) => format!(", but {loss}"),
        None if record.lists.untested.is_some() => ", which puts no method to a test".to_owned(),
        None if record.image.differing_channels == Some(0)
            && record.lists.checked_pairs != Some(0) =>
        {
            SAME_IMAGE.to_owned()
        }
        None => String::new(),
    }
}

/// `1 light`, `10,000 lights`.
pub fn lights(count: u64) -> String {
    match count {
        1 => "1 light".to_owned(),
        _ => format!("{} lights", number(count as f64)),
    }
}

/// Whatever a reader has to know before trusting a figure: one paragraph each, most important
/// first.
pub fn notices(results: &Results) -> Vec<String> {
    let mut notices = Vec::new();
    notices.extend(clock_notice(results));
    notices.extend(raster::notice(&results.machine, &results.records));
    for comparison in comparisons(results) {
        if let Some(tie) = tie(&comparison.ranks()) {
            let first = comparison.first();
            let lights = lights(first.setting.lights);
            notices.push(format!(
                "{}, {}, {lights}: {tie}.",
                first.setting.scene,
                first.setting.mode.name()
            ));
        }
    }
    for record in &results.records {
        if let Some(loss) = loss(record) {
            let mode = record.setting.mode.name();
            notices.push(format!("{}, {mode}, {}: {loss}.", record.setting.scene, record.strategy));
        }
    }
    for record in &results.records {
        if record.lists.checked_pairs == Some(0)
            && record.setting.lights > 0
            && record.lists.untested.is_none()
        {
            notices.push(format!(
                "{}, {}, {}: no light reaches any of the {} samples, so nothing was checked.",
                record.setting.scene,
                record.setting.mode.name(),
                record.strategy,
                number(record.lists.samples as f64),
            ));
        }
    }
    for record in results.records.iter().filter(|record| record.lists.overflowed_groups > 0) {
        notices.push(format!(
            "{}, {}, {}: {} of {} groups fell back to all lights, because a list did not fit.",
            record.setting.scene,
            record.setting.mode.name(),
            record.strategy,
            number(record.lists.overflowed_groups as f64),
            number(record.lists.groups as f64),
        ));
    }
    if results.truth.level == TruthLevel::None && !results.records.is_empty() {
        notices.push("The lists were not checked for missed lights (--truth none).".to_owned());
    }
    // Methods that lose nothing else say the same: the first of each scene and mode stands for all.
    let mut told = Vec::new();
    for record in &results.records {
        let case = (&record.setting.scene, record.setting.mode);
        if let Some(loss) = range_loss(record).filter(|_| !told.contains(&case)) {
            notices.push(loss);
            told.push(case);
        }
    }
    if let Some(first) = results.rejected_lights.first() {
        let count = lights(results.rejected_lights.len() as u64);
        notices.push(format!(
            "{count} left out; the first is light {} of {}: {}.",
            first.index, first.scene, first.reason
        ));
    }
    notices.extend(results.warnings.iter().cloned());
    notices.extend(results.truth.notes.iter().cloned());
    for record in &results.records {
        if let Some(note) = raster::unmarked_note(record).filter(|note| !notices.contains(note)) {
            notices.push(note);
        }
    }
    notices
}

pub(crate) fn clock_notice(results: &Results) -> Option<String> {
    let wall_clock = results.records.iter().any(|record| record.times.clock == Clock::WallClock);
    let adapter = short_adapter(&results.machine.adapter);
    if results.machine.device_type == DeviceType::Cpu {
        Some(format!(
            "These are not GPU figures. {adapter} is a software adapter: the CPU did all the work, \
             and each pass was submitted alone and timed by wall clock. Lists, errors and images \
             are as on a GPU; times and their ratios are not."
        ))
    } else if wall_clock {
        Some(
            "Times are wall-clock times of the host, each pass submitted alone: they include the \
             cost of submitting and waiting."
                .to_owned(),
        )
    } else {
        None
    }
}
