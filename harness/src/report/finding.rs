//! Findings in words, computed from the records.

use super::comparison::{Comparison, comparisons};
use super::format::{difference, factor, number, short_adapter, significant};
use super::rank::tie;
use super::raster;
use crate::results::{Clock, DeviceType, Record, Results, TruthLevel};

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
        varies(|r| format!("in {}", r.scene)),
        varies(|r| r.mode.name().to_owned()),
        varies(|r| format!("at {}\u{d7}{}", r.width, r.height)),
        varies(|r| format!("at scene scale {}", r.scene_scale)),
        varies(|r| format!("at radius scale {}", r.radius_scale)),
        varies(|r| format!("from seed {}", r.seed)),
    ]
    .into_iter()
    .flatten()
    .map(|part| format!(", {part}"))
    .collect()
}

fn sentence(comparison: &Comparison<'_>) -> String {
    let first = comparison.first();
    let Some(fastest) = comparison.fastest() else {
        return format!(
            "{} takes {} ms to shade {}",
            if first.is_baseline() { "no culling".to_owned() } else { comparison.name(first) },
            significant(first.assign_and_shade_ms()),
            lights(first.lights),
        );
    };
    let name = &comparison.name(fastest);
    let took = significant(fastest.assign_and_shade_ms());
    let lights = lights(first.lights);
    let Some(baseline) = comparison.baseline() else {
        return format!("{name} assigns and shades {lights} in {took} ms{}", image(fastest));
    };
    if first.lights == 0 {
        let none = significant(baseline.assign_and_shade_ms());
        return format!(
            "there is no light to assign: {name} takes {took} ms, no culling {none} ms"
        );
    }
    match comparison.speedup(fastest) {
        Some(speedup) if (speedup - 1.0).abs() <= EQUAL => {
            format!("{name} takes as long as no culling to shade {lights}{}", image(fastest))
        }
        Some(speedup) if speedup > 1.0 => format!(
            "{name} shades {lights} {}\u{d7} as fast as no culling{}{}",
            factor(speedup),
            over_exit(comparison, fastest),
            image(fastest)
        ),
        Some(speedup) => format!(
            "{name} takes {}\u{d7} as long as no culling to shade {lights}{}",
            factor(1.0 / speedup),
            image(fastest)
        ),
        None => format!("{name} assigns and shades {lights} in {took} ms{}", image(fastest)),
    }
}

/// How it stands against no culling with the same early exit, where that was measured.
fn over_exit(comparison: &Comparison<'_>, record: &Record) -> String {
    comparison.speedup_over_exit(record).map_or_else(String::new, |speedup| {
        format!(" ({}\u{d7} if that has the same early exit)", factor(speedup))
    })
}

/// What is known of a record's image, to follow the sentence on its speed.
fn image(record: &Record) -> String {
    match loss(record) {
        Some(loss) => format!(", but {loss}"),
        None if record.differing_channels == Some(0) && record.checked_pairs != Some(0) => {
            " and shows the same image, bit for bit".to_owned()
        }
        None => String::new(),
    }
}

/// What a record lost, in words; `None` where nothing is known to be lost.
fn loss(record: &Record) -> Option<String> {
    let missed = record.missed_pairs.filter(|missed| *missed > 0).map(|missed| {
        format!("misses {} of {} (light, sample) pairs", number(missed as f64), checked(record))
    });
    let differs = match (record.differing_channels, record.max_abs_diff) {
        (Some(channels @ 1..), Some(most)) => Some(format!(
            "differs from no culling in {} channels, by at most {}",
            number(channels as f64),
            difference(most)
        )),
        (Some(channels @ 1..), None) => Some(format!(
            "differs from no culling in {} channels, by more than a number can say",
            number(channels as f64)
        )),
        (_, Some(most)) if most != 0.0 => {
            Some(format!("differs from no culling by at most {}", difference(most)))
        }
        _ => None,
    };
    let parts: Vec<String> = [missed, differs].into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join(" and "))
}

fn checked(record: &Record) -> String {
    record
        .checked_pairs
        .map_or_else(|| "an unknown number of".to_owned(), |pairs| number(pairs as f64))
}

pub(super) fn lights(count: u64) -> String {
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
            let lights = lights(first.lights);
            notices.push(format!("{}, {}, {lights}: {tie}.", first.scene, first.mode.name()));
        }
    }
    for record in &results.records {
        if let Some(loss) = loss(record) {
            let mode = record.mode.name();
            notices.push(format!("{}, {mode}, {}: {loss}.", record.scene, record.strategy));
        }
    }
    for record in &results.records {
        if record.checked_pairs == Some(0) && record.lights > 0 {
            notices.push(format!(
                "{}, {}, {}: no light reaches any of the {} samples, so nothing was checked.",
                record.scene,
                record.mode.name(),
                record.strategy,
                number(record.samples as f64),
            ));
        }
    }
    for record in results.records.iter().filter(|record| record.overflowed_groups > 0) {
        notices.push(format!(
            "{}, {}, {}: {} of {} groups fell back to all lights, because a list did not fit.",
            record.scene,
            record.mode.name(),
            record.strategy,
            number(record.overflowed_groups as f64),
            number(record.groups as f64),
        ));
    }
    if results.truth.level == TruthLevel::None && !results.records.is_empty() {
        notices.push("The lists were not checked for missed lights (--truth none).".to_owned());
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

pub(super) fn clock_notice(results: &Results) -> Option<String> {
    let wall_clock = results.records.iter().any(|record| record.clock == Clock::WallClock);
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
