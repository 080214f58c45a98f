//! What lists and images decide.

use crate::report::format::{number, percent, significant};
use crate::report::rank::listed;
use crate::results::Record;
use crate::study::claims::{Answer, Tally, Verdict};
use crate::study::culling::claims::modes::{Mode, bounding_sphere, capped, whole};
use crate::study::manifest::Done;

/// The paper's cap.
const CAP: u64 = 128;

/// A loss of energy from which on a picture shows it.
const SEEN: f64 = 0.01;

/// No list is longer than the cap, and no channel differs, at any count of lights.
pub(crate) fn cap(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene).iter().take(1) {
        for lights in mode.lit() {
            let Some((own, all)) = mode.at(lights, capped).zip(mode.at(lights, whole)) else {
                continue;
            };
            let is_whole =
                all.lists.longest <= CAP && own.image.differing_channels.unwrap_or(0) == 0;
            let lost = own.image.errors.get("missing_energy").copied().flatten().unwrap_or(0.0);
            let figure = format!(
                "{} lights: longest list {}, the cap loses {} % of the light",
                number(lights as f64),
                number(all.lists.longest as f64),
                percent(lost)
            );
            tally.add(is_whole, figure);
        }
    }
    tally.answer("counts of lights", "clusters with the paper\u{2019}s cap and without")
}

/// What light without a range would add.
pub(crate) fn range(done: &Done, scene: &str) -> Answer {
    for mode in Mode::all(done, scene) {
        let Some(sphere) = mode.last(bounding_sphere) else { continue };
        let error = |name: &str| sphere.image.unbounded_errors.get(name).copied().flatten();
        let Some(lost) = error("missing_energy") else { continue };
        let flip =
            error("flip").map_or_else(String::new, |flip| format!(", FLIP {}", significant(flip)));
        let figure = format!(
            "{}, {} lights: the ranges lose {} % of the light{flip}",
            mode.name,
            number(sphere.setting.lights as f64),
            percent(lost)
        );
        let verdict = if lost >= SEEN { Verdict::Holds } else { Verdict::Fails };
        return Answer { figure, verdict };
    }
    Answer::unknown("the image of lights without a range")
}

/// Whether whole lists of clusters show another image than no culling. They cannot where shading ends each
/// light at its range, as here: equal images decide nothing.
pub(crate) fn tiles(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let rows: Vec<&Record> = mode.lit().filter_map(|lights| mode.at(lights, whole)).collect();
        let Some(differ) =
            rows.iter().map(|record| record.image.differing_channels).sum::<Option<u64>>()
        else {
            continue;
        };
        if rows.is_empty() {
            continue;
        }
        let names: Vec<String> = rows.iter().map(|r| number(r.setting.lights as f64)).collect();
        let differing = number(differ as f64);
        let lights = listed(&names);
        let figure = format!("{}: {differing} channels differ at {lights} lights", mode.name);
        tally.add(differ > 0, figure);
    }
    let mut answer = tally.answer("renderers", "clusters with whole lists");
    if answer.verdict == Verdict::Fails {
        answer.verdict = Verdict::undecided(
            "shading here ends each light at its range, so whole lists cannot show",
        );
    }
    answer
}
