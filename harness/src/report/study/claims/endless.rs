//! What the polygon-light paper (Swarbrick 2025) claims, and what decides each claim in one scene.

use super::super::super::format::{percent, significant};
use super::super::super::rank::Ratio;
use super::super::endless_data::{Case, cases, cones, cut, setting};
use super::{Answer, Check, Paper, Verdict};
use crate::results::Record;
use crate::study::Done;

/// Swarbrick 2025.
pub(super) const PAPER: Paper = Paper {
    name: "the polygon-light paper",
    about: "Swarbrick 2025 timed polygon lights with normal cones on a GTX 1060. Its cones lose light; \
            here settings without a loss and with a cut are told apart.",
    checks: &CHECKS,
};

const CHECKS: [Check; 3] = [
    Check {
        id: "cones",
        place: "chapter 5",
        words: "The best number of cones beats clusters by position in assign + shade.",
        paper: "",
        departure: "",
        decide: best_cones,
    },
    Check {
        id: "outer",
        place: "equations 5.1 and 5.3",
        words: "54 cones leave out 80 % of outer specular operations.",
        paper: "80 %",
        departure: "",
        decide: outer,
    },
    Check {
        id: "assignment",
        place: "chapter 5",
        words: "54 cones cost less than 1 ms of assignment.",
        paper: "72 ms at 2,016 lights",
        departure: "",
        decide: assignment,
    },
];

/// The most cones, of which two claims speak.
const MOST: u32 = 54;

/// The share of outer specular operations that they leave out in the paper (equations 5.1 and 5.3).
const LEFT_OUT: f64 = 0.8;

/// The most that they may cost, ms.
const CHEAP_MS: f64 = 1.0;

/// The fastest setting with cones, exact or not.
fn fastest<'a>(case: &Case<'a>, exact: bool) -> Option<&'a Record> {
    let all = case.entries.iter().map(|entry| entry.record);
    all.filter(|record| cones(&record.strategy).is_some() && record.is_exact() == exact)
        .filter(|record| record.assign_and_shade_ms().is_finite())
        .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
}

/// The fastest exact setting with cones is faster than position alone, in every case.
fn best_cones(done: &Done, scene: &str) -> Answer {
    let (mut figures, mut good, mut all) = (Vec::new(), 0, 0);
    for case in cases(done, scene) {
        let (Some(position), Some(best)) = (case.position(), fastest(&case, true)) else {
            continue;
        };
        all += 1;
        good += usize::from(Ratio::of(best, position).is_some_and(|ratio| ratio.is_faster()));
        let said = |record: &Record| {
            let time = significant(record.assign_and_shade_ms());
            format!("{} {time} ms", setting(&record.strategy))
        };
        let lossy = fastest(&case, false).map_or_else(String::new, |r| format!(", {}", said(r)));
        figures.push(format!("{}: {}, {}{lossy}", case.name(), said(position), said(best)));
    }
    if all == 0 {
        return Answer::unknown("clusters with cones and without");
    }
    Answer { figure: figures.join("; "), verdict: Verdict::of_parts(good, all, "cases") }
}

/// The share of outer specular operations that a setting leaves out of those by position alone.
fn left_out(record: &Record, position: &Record) -> Option<f64> {
    let outer = |record: &Record| record.operations.map(|all| all.outer_specular as f64);
    let (own, all) = (outer(record)?, outer(position)?);
    (all > 0.0).then(|| 1.0 - own / all)
}

/// The mildest cut by 54 cones leaves out four fifths of the outer specular operations, in every case;
/// without a cut it is told beside it.
fn outer(done: &Done, scene: &str) -> Answer {
    let (mut figures, mut good, mut all) = (Vec::new(), 0, 0);
    for case in cases(done, scene) {
        let Some(position) = case.position() else { continue };
        let mut shares: Vec<(&Record, f64)> = case
            .of(Some(MOST))
            .filter_map(|record| Some((record, left_out(record, position)?)))
            .collect();
        let threshold = |record: &Record| {
            cut(&record.strategy).and_then(|cut| cut.parse::<f64>().ok()).unwrap_or(0.0)
        };
        shares.sort_by(|a, b| threshold(a.0).total_cmp(&threshold(b.0)));
        let mildest = shares.iter().find(|(record, _)| threshold(record) > 0.0).or(shares.first());
        let Some((_, share)) = mildest else { continue };
        all += 1;
        good += usize::from(*share >= LEFT_OUT);
        let said: Vec<String> = shares
            .iter()
            .map(|(record, share)| format!("{} {} %", setting(&record.strategy), percent(*share)))
            .collect();
        figures.push(format!("{}: left out by {}", case.name(), said.join(", ")));
    }
    if all == 0 {
        return Answer::unknown("light operations by 54 cones and by position");
    }
    Answer { figure: figures.join("; "), verdict: Verdict::of_parts(good, all, "cases") }
}

/// Assignment by 54 cones, the slowest of its settings, takes less than a millisecond, in every case.
fn assignment(done: &Done, scene: &str) -> Answer {
    let (mut figures, mut good, mut all) = (Vec::new(), 0, 0);
    for case in cases(done, scene) {
        let times = case.of(Some(MOST)).map(|record| record.assign_ms);
        let Some(slowest) = times.filter(|time| time.is_finite()).max_by(f64::total_cmp) else {
            continue;
        };
        all += 1;
        good += usize::from(slowest < CHEAP_MS);
        figures.push(format!("{}: {} ms", case.name(), significant(slowest)));
    }
    if all == 0 {
        return Answer::unknown("54 cones");
    }
    Answer { figure: figures.join("; "), verdict: Verdict::of_parts(good, all, "cases") }
}
