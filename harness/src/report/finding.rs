//! Findings in words, computed from the records.

use super::comparison::{Comparison, comparisons};
use super::explained::worst_places;
use super::format::{factor, number, short_adapter, significant};
use super::lead::{Lead, span};
use super::loss::{loss, range_loss};
use super::rank::{is_timed, tie};
use super::raster;
use crate::digits::rounded;
use crate::grouping::distinct;
use crate::results::{Clock, DeviceType, Record, Results, TruthLevel, Untested};

/// Times whose ratio is closer to 1 than this are called equal: a few samples do not show more.
const EQUAL: f64 = 0.03;

/// What a comparison found.
pub(crate) struct Finding {
    /// The result and its limits, one sentence.
    pub(crate) headline: String,
    /// What explains it, a sentence each.
    pub(crate) details: Vec<String>,
}

/// What a run found, a paragraph per comparison: the result, then what explains it.
pub fn finding(results: &Results) -> Vec<String> {
    let paragraph = |found: Finding| [vec![found.headline], found.details].concat().join(" ");
    findings(results).into_iter().map(paragraph).collect()
}

/// What a run found, one per comparison. The first headline is that of the run.
pub(crate) fn findings(results: &Results) -> Vec<Finding> {
    let all = comparisons(results);
    let adapter = short_adapter(&results.machine.adapter);
    if all.is_empty() {
        let headline = format!("On {adapter}, nothing was measured.");
        return vec![Finding { headline, details: Vec::new() }];
    }
    let found = |comparison: &Comparison<'_>| {
        let (sentence, details) = sentence(comparison);
        let headline = format!("On {adapter}{}, {sentence}.", setting(&all, comparison));
        Finding { headline, details }
    };
    all.iter().map(found).collect()
}

/// The settings in which a comparison differs from the others of its run: `, in atrium, deferred`.
fn setting(all: &[Comparison<'_>], comparison: &Comparison<'_>) -> String {
    let first = comparison.first();
    let varies = |key: fn(&Record) -> String| {
        let value = key(first);
        all.iter().any(|other| key(other.first()) != value).then_some(value)
    };
    [
        varies(|r| format!("in {}", r.setting.scene)),
        varies(|r| r.setting.mode.name().to_owned()),
        varies(|r| format!("at {}\u{d7}{}", r.setting.width, r.setting.height)),
        varies(|r| format!("at scene scale {}", rounded(r.setting.scene_scale))),
        varies(|r| {
            r.setting.roughness.map_or_else(
                || "of the file's roughness".to_owned(),
                |r| format!("at roughness {}", rounded(r)),
            )
        }),
        varies(|r| format!("at radius scale {}", rounded(r.setting.radius_scale))),
        varies(|r| format!("from seed {}", r.setting.seed)),
    ]
    .into_iter()
    .flatten()
    .map(|part| format!(", {part}"))
    .collect()
}

/// The result of a comparison, without a full stop, and the sentences that explain it.
fn sentence(comparison: &Comparison<'_>) -> (String, Vec<String>) {
    let first = comparison.first();
    if let Some(why) = first.untested_words().filter(|_| !is_dark(first)) {
        return (format!("nothing was tested: {why}"), Vec::new());
    }
    let Some(fastest) = comparison.fastest().filter(|record| is_timed(record)) else {
        let name = match first.is_baseline() {
            true => "no culling".to_owned(),
            false => comparison.name(first),
        };
        let words = match is_timed(first) {
            true => format!(
                "{name} takes {} ms to shade {}",
                significant(first.assign_and_shade_ms()),
                lights(first.setting.lights)
            ),
            false => format!("no time was recorded for {name}"),
        };
        return (words, Vec::new());
    };
    let Some(lead) = Lead::of_comparison(comparison) else {
        // All that cull lost something: the fastest says what.
        let subject = Subject::one(comparison, fastest);
        let details = over_exit(comparison, &subject).into_iter().collect();
        return (speed(comparison, &subject) + &image(fastest), details);
    };
    let subject = Subject::lead(comparison, &lead);
    let image = match lead.is_tie() {
        true if lead.records.iter().all(|record| image(record) == SAME_IMAGE) => {
            " and show the same image, bit for bit".to_owned()
        }
        true => String::new(),
        false => image(fastest),
    };
    let details = [plain_names(&lead), over_exit(comparison, &subject), lead.cost_of_lights()];
    (speed(comparison, &subject) + &image + &lead.doubt(), details.into_iter().flatten().collect())
}

/// Whether surfaces are there but no light at all. The times are then those of an empty frame.
fn is_dark(record: &Record) -> bool {
    record.setting.lights == 0 && record.lists.untested == Some(Untested::NoLight)
}

/// The subject of a sentence: one strategy, or several that tie.
struct Subject<'a> {
    records: Vec<&'a Record>,
    /// `A (its plain name)`, or `A and B tie for fastest: they`.
    words: String,
    /// Comes before the words: for which lights all of them are fastest.
    condition: &'static str,
    /// Follows a speed: how the lights move, or for which lights some of them are fastest.
    of_lights: String,
}

impl<'a> Subject<'a> {
    fn one(comparison: &Comparison<'_>, record: &'a Record) -> Self {
        let words = comparison.name(record) + &plain_name(record);
        Self { records: vec![record], words, condition: "", of_lights: String::new() }
    }

    fn lead(comparison: &Comparison<'_>, lead: &Lead<'a>) -> Self {
        let words = match lead.is_tie() {
            true => format!("{}: they", lead.is_fastest()),
            false => comparison.name(lead.leader()) + &plain_name(lead.leader()),
        };
        let condition = if lead.all_need_still_lights() { "if no light moves, " } else { "" };
        let of_lights = lead.lights_of_some();
        Self { records: lead.records.clone(), words, condition, of_lights }
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

/// ` (sparse clusters, explicit bounds)`; empty for a family that the registry does not know.
fn plain_name(record: &Record) -> String {
    record.strategy.row().map_or_else(String::new, |row| format!(" ({})", row.name))
}

/// What the families of a tie are: `DC-I: dense clusters, implicit bounds.`; `None` where one leads, whose
/// name its sentence explains.
fn plain_names(lead: &Lead<'_>) -> Option<String> {
    let rows = lead.records.iter().filter_map(|record| record.strategy.row());
    let names = distinct(rows.map(|row| format!("{}: {}", row.family, row.name)));
    (lead.is_tie() && !names.is_empty()).then(|| format!("{}.", names.join("; ")))
}

/// How fast the best is, compared with no culling where that was measured.
fn speed(comparison: &Comparison<'_>, subject: &Subject<'_>) -> String {
    let leader = subject.records[0];
    let words = format!("{}{}", subject.condition, subject.words);
    let lights = lights(leader.setting.lights);
    let of_lights = &subject.of_lights;
    let takes = subject.verb("takes", "take");
    let time = |record: &Record| Some(record.assign_and_shade_ms());
    let took = subject.span(time).unwrap_or_default();
    let alone = || {
        let verb = subject.verb("assigns and shades", "assign and shade");
        format!("{words} {verb} {lights} in {took} ms{of_lights}")
    };
    let Some(baseline) = comparison.baseline().filter(|record| is_timed(record)) else {
        return alone();
    };
    if leader.setting.lights == 0 {
        let none = significant(baseline.assign_and_shade_ms());
        return format!(
            "there is no light to assign: {} {takes} {took} ms, no culling {none} ms",
            subject.words
        );
    }
    let faster = |record: &Record| comparison.speedup(record);
    match (comparison.speedup(leader), subject.span(faster)) {
        (Some(speedup), _) if (speedup - 1.0).abs() <= EQUAL => {
            format!("{words} {takes} as long as no culling to shade {lights}{of_lights}")
        }
        (Some(speedup), Some(factors)) if speedup > 1.0 => {
            let verb = subject.verb("shades", "shade");
            format!("{words} {verb} {lights} {factors}\u{d7} as fast as no culling{of_lights}")
        }
        (Some(speedup), _) => {
            let factor = factor(1.0 / speedup);
            format!(
                "{words} {takes} {factor}\u{d7} as long as no culling to shade {lights}{of_lights}"
            )
        }
        (None, _) => alone(),
    }
}

/// How fast they are against no culling with the same early exit, where that was measured and they are
/// faster.
fn over_exit(comparison: &Comparison<'_>, subject: &Subject<'_>) -> Option<String> {
    let leader = comparison.speedup(subject.records[0])?;
    let factors = subject.span(|record| comparison.speedup_over_exit(record))?;
    (leader > 1.0 + EQUAL).then(|| {
        format!("The strategy Sphere, which exits early but does not cull, takes {factors} times as long.")
    })
}

/// Follows the speed of a strategy whose image is that of no culling.
const SAME_IMAGE: &str = " and shows the same image, bit for bit";

/// What is known of a record's image, to follow the sentence on its speed.
fn image(record: &Record) -> String {
    match loss(record) {
        Some(loss) => format!(", but {loss}"),
        None if record.lists.untested.is_some() => ", but the scene did not test it".to_owned(),
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

/// What a reader has to know before trusting a figure: one paragraph each, the most important first.
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
            let places = worst_places(&results.command, record);
            let places = places.map_or_else(String::new, |places| format!(" {places}"));
            let scene = &record.setting.scene;
            notices.push(format!("{scene}, {mode}, {}: {loss}.{places}", record.strategy));
        }
    }
    for record in &results.records {
        if record.lists.checked_pairs == Some(0)
            && record.setting.lights > 0
            && record.lists.untested.is_none()
        {
            notices.push(format!(
                "{}, {}, {}: no light reaches any of the {} samples, so the lists were not tested.",
                record.setting.scene,
                record.setting.mode.name(),
                record.strategy,
                number(record.lists.samples as f64),
            ));
        }
    }
    for record in results.records.iter().filter(|record| record.lists.overflowed_groups > 0) {
        notices.push(format!(
            "{}, {}, {}: {} of {} groups evaluated all lights because a list did not fit.",
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
    // The range loses the same with every strategy, so the first of each scene and mode stands for all.
    let mut stated = Vec::new();
    for record in &results.records {
        let case = (&record.setting.scene, record.setting.mode);
        if let Some(loss) = range_loss(record).filter(|_| !stated.contains(&case)) {
            notices.push(loss);
            stated.push(case);
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
             and each pass was submitted separately and timed by wall clock. Lists, errors and images \
             are the same as on a GPU. Times and their ratios are not."
        ))
    } else if wall_clock {
        Some(
            "Times are wall-clock times of the host, and each pass was submitted separately. They include the \
             time to submit and to wait."
                .to_owned(),
        )
    } else {
        None
    }
}
