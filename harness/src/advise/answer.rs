//! The verdict in words. The first line is the answer; it states every limit that it has.

use std::fmt::Write;

use super::verdict::{Verdict, error_of, verdict};
use crate::{
    report::{self, bill::assign_passes, format::mebibytes, living, significant as ms},
    results::{DeviceType, Record, Results},
};

/// What to use, what it costs, what comes next, and why.
pub fn answer(results: &Results, error_budget: f64) -> String {
    if let Some(why) = untested(results) {
        return format!("{why}\n");
    }
    let Some(verdict) = verdict(results, error_budget) else {
        return format!("No strategy stayed within the error budget, relMSE {error_budget}.\n");
    };
    let mut text = first_line(verdict.best) + "\n";
    if let Some(motion) = living::motion_words(&verdict.best.setting) {
        let _ = writeln!(text, "The lights move: {motion}. {}", bill(verdict.best));
    }
    if let Some(other) = verdict.without_hierarchy {
        let _ = writeln!(
            text,
            "Without a hierarchy: {}, {}. Lights that move were not measured: --motion LAW does so.",
            other.strategy,
            time(other)
        );
    }
    if !verdict.tied.is_empty() {
        let _ = writeln!(text, "{}", tie(&verdict));
    }
    if let Some(next) = verdict.next {
        let ratio = next.assign_and_shade_ms() / verdict.best.assign_and_shade_ms();
        let _ = writeln!(
            text,
            "Next: {}, {}, {} % slower{}.",
            next.strategy,
            time(next),
            ms((ratio - 1.0) * 100.0),
            loss(next).map_or_else(String::new, |loss| format!(", {loss}")),
        );
    }
    if error_budget > 0.0 && verdict.best.is_exact() {
        let _ = writeln!(text, "{}", no_gain(&verdict, error_budget));
    }
    let _ = writeln!(text, "Why: {}.", why(&verdict, results));
    if results.machine.device_type == DeviceType::Cpu {
        let _ = writeln!(
            text,
            "These are times of a software adapter: a GPU may rank the strategies differently."
        );
    }
    text
}

/// Why there is no advice; `None` if the methods were tested.
fn untested(results: &Results) -> Option<String> {
    let why = results.records.iter().find_map(Record::untested_words)?;
    Some(format!("No advice: {why}, so no method was tested."))
}

/// `Use ID (what it is): its time and parts. What its image is. What its lights must be.`
fn first_line(best: &Record) -> String {
    let mut text = format!(
        "Use {}{}: {} to assign and shade {} ({} + {})",
        best.strategy,
        about(best),
        time(best),
        lights(best),
        ms(best.times.assign_ms),
        ms(best.times.shade_ms),
    );
    if let Some(interval) = best.interval_ms() {
        let statistic = if best.setting.along_path { "mean" } else { "median" };
        let (low, high) = (ms(interval.low), ms(interval.high));
        let _ = write!(text, ", {statistic} between {low} and {high}");
    }
    text += ". ";
    let views = if best.setting.along_path { "these views" } else { "this view" };
    text += &match (loss(best), error_of(best)) {
        (None, _) => match best.image.differing_channels {
            Some(0) => "Its image is that of no culling, bit for bit.".to_owned(),
            Some(_) => "Its image is that of no culling within the tolerance it states.".to_owned(),
            None => "Its image was not compared with that of no culling.".to_owned(),
        },
        (Some(_), Some(0.0)) => {
            format!("Its image is that of no culling in {views}; in others it may lose light.")
        }
        (Some(loss), _) => format!("In {views}, {loss}."),
    };
    if report::needs_built_hierarchy(best) {
        text += " Still lights only: it uses a hierarchy that the CPU builds";
        if let Some(build) = best.times.light_build_ms {
            let _ = write!(text, " in {} ms", ms(build));
        }
        text += ", not counted in this time.";
    }
    text
}

/// `10,000 lights`, or `10,000 lights that move`.
fn lights(record: &Record) -> String {
    let moving = if record.setting.motion.is_some() { " that move" } else { "" };
    report::lights(record.setting.lights) + moving
}

/// The time of each pass that assigns and shades: `In each frame: order 0.00310 ms, boxes ...`.
fn bill(record: &Record) -> String {
    let pass = |name: &str| format!("{name} {} ms", ms(record.time_of(|pass, _| pass == name)));
    let shade = record.times.passes.get("shade").map(|_| "shade");
    let passes: Vec<String> = assign_passes([record]).into_iter().chain(shade).map(pass).collect();
    let size = record.times.upload_bytes.map_or_else(String::new, |bytes| {
        format!(" The CPU uploads {} MiB.", mebibytes(bytes as f64))
    });
    format!("In each frame: {}.{size}", report::listed(&passes))
}

/// A record's time, and over what it was taken.
fn time(record: &Record) -> String {
    format!("{} ms", ms(record.assign_and_shade_ms()))
}

/// What a method is, in brackets.
fn about(record: &Record) -> String {
    record.strategy.row().map_or_else(String::new, |row| format!(" ({})", row.name))
}

/// What a record loses, with its error; `None` for an exact one.
fn loss(record: &Record) -> Option<String> {
    if record.is_exact() {
        return None;
    }
    let errors = report::error_words(record);
    Some(if errors.is_empty() {
        "it may lose light".to_owned()
    } else {
        format!("its error is {errors}")
    })
}

/// What the best ties with, and why it was preferred.
fn tie(verdict: &Verdict<'_>) -> String {
    let tied: Vec<String> = verdict
        .tied
        .iter()
        .map(|record| format!("{} ({})", record.strategy, time(record)))
        .collect();
    let reasons = match verdict.reasons.is_empty() {
        true => "it is slightly the fastest of them".to_owned(),
        false => report::listed(&verdict.reasons),
    };
    format!("It ties with {}; preferred because {reasons}.", report::listed(&tied))
}

/// Says that the budget buys nothing.
fn no_gain(verdict: &Verdict<'_>, error_budget: f64) -> String {
    let none = format!("No lossy setting within relMSE {error_budget} is certainly faster");
    match verdict.lossy {
        Some(lossy) => format!("{none}: the fastest is {}, {}.", lossy.strategy, time(lossy)),
        None => format!("{none}: none stays within it."),
    }
}

/// What makes the difference.
fn why(verdict: &Verdict<'_>, results: &Results) -> String {
    let best = verdict.best;
    if !best.culls() {
        let lights = report::lights(best.setting.lights);
        return format!("with {lights} the passes that make lists cost more than lists save");
    }
    let mut reasons = Vec::new();
    if let (Some(listed), Some(reach)) =
        (best.lists.listed_per_sample, best.lists.contributing_per_sample)
    {
        let (listed, reach) = (ms(listed), ms(reach));
        reasons.push(format!("its lists hold {listed} lights per sample, and {reach} reach it"));
    }
    if let Some(next) = verdict.next.filter(|next| next.culls()) {
        let part = |name: &str, gain: f64| {
            let word = if gain < 0.0 { "costs" } else { "saves" };
            format!("{name} {word} {} ms", ms(gain.abs()))
        };
        reasons.push(format!(
            "against {}, {} and {}",
            next.strategy,
            part("assigning", next.times.assign_ms - best.times.assign_ms),
            part("shading", next.times.shade_ms - best.times.shade_ms)
        ));
    }
    let none = results.records.iter().find(|record| record.is_baseline());
    let ratio = none.map(|none| none.assign_and_shade_ms() / best.assign_and_shade_ms());
    if let Some(ratio) = ratio.filter(|ratio| ratio.is_finite()) {
        reasons.push(format!("no culling takes {} times as long", ms(ratio)));
    }
    if reasons.is_empty() {
        reasons.push("it is the fastest".to_owned());
    }
    reasons.join("; ")
}
