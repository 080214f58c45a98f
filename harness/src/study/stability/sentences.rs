//! What was found, in words.

use super::cells::{Cell, Method, cell, flawed_methods, methods};
use super::outcome::Outcome;
use crate::report::format::{number, short_adapter};
use crate::report::rank::listed;
use crate::strategy::BASELINE;
use crate::study::manifest::Done;

/// How many cells failed among the methods that should not, and how many of the methods that fail on purpose did.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let results = done.results.values().next()?;
    let adapter = short_adapter(&results.machine.adapter);
    let mut sound = methods(done);
    // No culling is what the others are compared with.
    sound.retain(|method| method.name() != BASELINE);
    let sound = cells(done, &sound);
    let count =
        |outcome: Outcome| sound.iter().filter(|(_, cell)| cell.outcome() == Some(outcome)).count();
    let tested = sound.iter().filter(|(_, cell)| cell.outcome().is_some()).count();
    let untested = match count(Outcome::Untested) {
        0 => String::new(),
        count => format!(", {} test nothing", number(count as f64)),
    };
    let wrong = count(Outcome::Wrong);
    let wrongs = match wrong {
        0 => "none is wrong".to_owned(),
        1 => "1 is wrong".to_owned(),
        _ => format!("{} are wrong", number(wrong as f64)),
    };
    let flawed = flawed_methods(done);
    let failing = flawed.iter().filter(|method| fails_somewhere(done, method)).count();
    let control = match flawed.len() {
        0 => String::new(),
        all if failing == all => format!(" All {all} methods that fail on purpose do fail."),
        all => format!(" Of {all} methods that fail on purpose, {failing} do fail."),
    };
    Some(format!(
        "On {adapter}, of {} cells (a scenario and a method that should not fail), {} are exact, {} refuse{untested}, and \
         {wrongs}.{control}",
        number(tested as f64),
        number(count(Outcome::Exact) as f64),
        number(count(Outcome::Refused) as f64),
    ))
}

/// What a reader must know: which planted failures did not fail, and which scenarios break nothing.
pub(crate) fn notices(done: &Done) -> Vec<String> {
    let mut notices = Vec::new();
    let flawed = flawed_methods(done);
    for method in flawed.iter().filter(|method| !fails_somewhere(done, method)) {
        notices.push(format!(
            "{} should fail somewhere, and fails nowhere: what it controls is not tested.",
            method.name()
        ));
    }
    // Light beyond its range and other last bits show nearly everywhere, so they say nothing of a scenario.
    let telling = flawed.iter().filter(|method| method.tells_scenarios()).cloned();
    let flawed_cells = cells(done, &telling.collect::<Vec<_>>());
    let mut quiet: Vec<String> = Vec::new();
    for scene in done.scenes() {
        let of_scene: Vec<&Cell<'_>> =
            flawed_cells.iter().filter(|(name, _)| *name == scene).map(|(_, cell)| cell).collect();
        let ran = of_scene.iter().any(|cell| cell.outcome().is_some());
        if ran && !of_scene.iter().any(|cell| has_failed(cell)) {
            quiet.push(scene.to_owned());
        }
    }
    if !quiet.is_empty() {
        notices.push(format!(
            "In {}, no method that fails on purpose fails, except those that fail nearly everywhere (--cut never, and lists in \
             random order without a limit): {}.",
            match quiet.len() {
                1 => "1 scenario".to_owned(),
                count => format!("{count} scenarios"),
            },
            listed(&quiet)
        ));
    }
    notices
}

/// Whether a method fails in a scenario at least.
fn fails_somewhere(done: &Done, method: &Method) -> bool {
    done.scenes().into_iter().any(|scene| has_failed(&cell(done, scene, method)))
}

/// Whether light was lost, stated or not.
pub(crate) fn has_failed(cell: &Cell<'_>) -> bool {
    matches!(cell.outcome(), Some(Outcome::Lossy | Outcome::Wrong))
}

/// All cells of some methods, with their scenarios.
fn cells<'a>(done: &'a Done, methods: &[Method]) -> Vec<(&'a str, Cell<'a>)> {
    let of_scene =
        |scene: &'a str| methods.iter().map(move |method| (scene, cell(done, scene, method)));
    done.scenes().into_iter().flat_map(of_scene).collect()
}
