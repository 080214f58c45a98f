//! What was found of the engines' defaults, in words.

use super::cases::{Case, Cost, Method, cases};
use crate::grouping::distinct;
use crate::report::error_words;
use crate::report::finding::lights;
use crate::report::format::{percent, short_adapter, significant};
use crate::report::lead::Lead;
use crate::report::rank::{SURE, listed, ranks};
use crate::results::Record;
use crate::study::manifest::Done;

/// How many defaults lose light at the most lights of each scene, how much, and what not losing it costs.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let mut parts = Vec::new();
    let mut most = None;
    for scene in done.scenes() {
        let Some(case) = cases(done, scene).pop() else { continue };
        most = most.max(Some(case.lights));
        parts.push(format!("in {scene}, {}", summary(&case)));
    }
    let adapter = done.results.values().next().map_or("", |r| short_adapter(&r.machine.adapter));
    Some(format!("On {adapter} at {}, {}.", lights(most?), parts.join("; ")))
}

/// `3 of 9 stand-ins for engines' defaults lose light`.
fn count(case: &Case<'_>) -> String {
    let defaults = case.defaults();
    let losing = defaults.iter().filter(|method| method.loses_light()).count();
    let of_all = format!("of {} stand-ins for engines\u{2019} defaults", defaults.len());
    match losing {
        0 => format!("none {of_all} loses light"),
        1 => format!("1 {of_all} loses light"),
        _ => format!("{losing} {of_all} lose light"),
    }
}

/// The count, how much light is lost, and what not losing it costs: `... lose light (1.0 to 12 % of the energy)
/// and take 1.1 to 2.0 times as long without their limits`.
fn summary(case: &Case<'_>) -> String {
    let mut losing = case.defaults();
    losing.retain(Method::loses_light);
    let mut text = count(case);
    let missing = losing.iter().map(|method| method.error("missing_energy"));
    if let Some(missing) = span(missing, percent) {
        text += &format!(" ({missing} % of the energy)");
    }
    let ratios = losing.iter().map(|method| method.cost().map(|cost| cost.ratio));
    if let Some(ratios) = span(ratios, significant) {
        let [take, their] = match losing.len() {
            1 => ["takes", "its limits"],
            _ => ["take", "their limits"],
        };
        text += &format!(" and {take} {ratios} times as long without {their}");
        match losing.iter().filter(|method| method.cost().is_some_and(|cost| cost.ties)).count() {
            0 => {}
            1 => text += " (one is a tie)",
            ties => text += &format!(" ({ties} are ties)"),
        }
    }
    text
}

/// The least and the greatest of some figures: `1.1 to 5.2`. `None` where one is not known.
fn span(figures: impl Iterator<Item = Option<f64>>, show: fn(f64) -> String) -> Option<String> {
    let figures: Vec<f64> = figures.collect::<Option<_>>()?;
    let least = show(figures.iter().copied().reduce(f64::min)?);
    let most = show(figures.iter().copied().reduce(f64::max)?);
    Some(if least == most { least } else { format!("{least} to {most}") })
}

/// A paragraph per number of lights, the most lights first.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    cases(done, scene).iter().rev().map(|case| finding(scene, case)).collect()
}

/// How many defaults lose light, what each of them loses, what not losing it costs, and which method is fastest
/// without a loss.
fn finding(scene: &str, case: &Case<'_>) -> String {
    let methods = case.methods();
    let defaults = methods.iter().filter(|method| method.engine.is_some());
    let losing: Vec<&Method<'_>> = defaults.filter(|method| method.loses_light()).collect();
    let mut text = format!("In {scene} at {}, {}.", lights(case.lights), count(case));
    text.extend(losing.iter().filter_map(|method| loss(method)));
    let exact = methods.iter().filter_map(|method| method.timed);
    if let Some(lead) = Lead::from_ranks(&ranks(exact)) {
        text += &format!(
            " Of the methods in the table that lose no light, {}{} with {} ms{}.",
            lead.is_fastest(),
            lead.lights(),
            ms(lead.leader()),
            lead.doubt()
        );
    }
    text
}

/// ` A takes 0.2 ms with 12 % missing energy. B loses nothing and takes 0.3 ms, 1.5 times as long.`
fn loss(method: &Method<'_>) -> Option<String> {
    let record = method.timed?;
    let errors = error_words(record);
    let with = if errors.is_empty() { errors } else { format!(" with {errors}") };
    let mut text = format!(" {} takes {} ms{with}.", method.name(), ms(record));
    if let (Some((id, Some(lossless))), Some(cost)) = (&method.lossless, method.cost()) {
        text += &format!(" {id} loses nothing and takes {} ms, {}.", ms(lossless), cost.words());
    }
    Some(text)
}

fn ms(record: &Record) -> String {
    significant(record.assign_and_shade_ms())
}

impl Cost {
    /// `1.52 times as long`, or that the two tie.
    fn words(&self) -> String {
        let ratio = significant(self.ratio);
        match self.ties {
            true => format!("{ratio} times as long: the two tie"),
            false => format!("{ratio} times as long"),
        }
    }
}

/// What a reader must know: limits that nothing put to the test, and laps that are too few to test ties.
pub(crate) fn notices(done: &Done) -> Vec<String> {
    let mut notices = Vec::new();
    let all: Vec<(&str, Case<'_>)> = done
        .scenes()
        .into_iter()
        .flat_map(|scene| cases(done, scene).into_iter().map(move |case| (scene, case)))
        .collect();
    for (scene, case) in &all {
        let defaults = case.defaults();
        let is_idle = |method: &&Method<'_>| {
            method.lossless.is_some() && method.timed.is_some() && !method.loses_light()
        };
        let idle: Vec<String> = defaults.iter().filter(is_idle).map(Method::name).collect();
        if !idle.is_empty() {
            notices.push(format!(
                "{scene}, {}: these defaults have a limit that loses no light here, because too few lights are in \
                 view or in a list: {}.",
                lights(case.lights),
                listed(&idle)
            ));
        }
    }
    let laps = |record: &&Record| {
        record.interval_ms().is_none_or(|interval| interval.coverage < SURE).then(|| record.laps())
    };
    let few: Vec<u32> =
        distinct(all.iter().flat_map(|(_, case)| case.records()).filter_map(|r| laps(&r)));
    if let Some(laps) = few.first() {
        notices.push(format!(
            "{laps} laps are too few to test ties. Ratios of times compare means only, and nothing is surely \
             faster than something else. The full study has 6 laps."
        ));
    }
    notices
}
