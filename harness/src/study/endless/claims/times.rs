//! Claims of the polygon-light paper about times.

use crate::report::format::{percent, significant};
use crate::report::rank::listed;
use crate::results::Record;
use crate::study::claims::{Answer, Outcome, Tally, Verdict};
use crate::study::endless::cases::{Case, Cut, HALF_SLICES, PAPER_SLICES, USUAL, cases, setting};
use crate::study::endless::claims::rows::{Rows, by_case, error, faster, with_time};
use crate::study::manifest::Done;

/// Cones against position in assign + shade.
fn beats(done: &Done, scene: &str, count: u32) -> Answer {
    by_case(done, scene, false, &|_, rows| {
        let cones = rows.cones(count)?;
        let figure = format!("{}, {}", with_time(cones), with_time(rows.position));
        Some((figure, faster(cones, rows.position)))
    })
}

pub(crate) fn six(done: &Done, scene: &str) -> Answer {
    beats(done, scene, 6)
}

pub(crate) fn most(done: &Done, scene: &str) -> Answer {
    beats(done, scene, 54)
}

/// 6 cones take no more time than 24 and 54: a case in which one of these ties with 6 is a tie.
pub(crate) fn balance(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, false, &|_, rows| {
        let six = rows.cones(6)?;
        let others: Vec<&Record> =
            rows.all_cones().filter(|(count, _)| *count != 6).map(|(_, record)| record).collect();
        let outcomes: Vec<Outcome> = others.iter().map(|other| faster(six, other)).collect();
        let outcome = match outcomes.as_slice() {
            [] => return None,
            all if all.contains(&Outcome::Bad) => Outcome::Bad,
            all if all.contains(&Outcome::Unsure) => Outcome::Unsure,
            all if all.contains(&Outcome::Tie) => Outcome::Tie,
            _ => Outcome::Good,
        };
        let times: Vec<String> = std::iter::once(six).chain(others).map(with_time).collect();
        Some((listed(&times), outcome))
    })
}

/// `dif` against everything else that the paper has.
pub(crate) fn dif(done: &Done, scene: &str) -> Answer {
    let answer = by_case(done, scene, false, &|_, rows| {
        let dif = rows.dif?;
        let others: Vec<&Record> =
            rows.all_cones().map(|(_, record)| record).chain([rows.position]).collect();
        let fastest = others
            .iter()
            .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))?;
        let figure = format!("{}, the fastest other {}", with_time(dif), with_time(fastest));
        Some((figure, faster(dif, fastest)))
    });
    match answer.verdict {
        Verdict::Unknown(_) => Answer::unknown("specular light that ends with diffuse light"),
        _ => answer,
    }
}

/// Shading counts as almost halved up to this share of the time by position: the paper's own at A.
const HALVED: f64 = 0.7;

pub(crate) fn shading(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, false, &|_, rows| {
        let cones = rows.cones(54)?;
        let share = cones.times.shade_ms / rows.position.times.shade_ms;
        let times = [cones, rows.position].map(|record| significant(record.times.shade_ms));
        let figure = format!(
            "shading \u{d7} {}, {} ms with cones and {} ms by position{}",
            significant(share),
            times[0],
            times[1],
            error(cones)
        );
        Some((figure, Outcome::from(share <= HALVED)))
    })
}

/// Roughly four times, as the paper has it: it has 3.6 to 4.0.
const FOUR_TIMES: std::ops::RangeInclusive<f64> = 3.0..=5.0;

pub(crate) fn assignment(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, false, &|_, rows| {
        let (few, many) = (rows.cones(6)?, rows.cones(24)?);
        let ratio = many.times.assign_ms / few.times.assign_ms;
        let times = [few, many].map(|record| significant(record.times.assign_ms));
        let figure =
            format!("assign \u{d7} {}, from {} to {} ms", significant(ratio), times[0], times[1]);
        Some((figure, Outcome::from(FOUR_TIMES.contains(&ratio))))
    })
}

/// The case of a place with the fewest lights, or with the most.
fn case_of<'a>(cases: &'a [Case<'a>], place: &str, most: bool) -> Option<&'a Case<'a>> {
    let at = cases.iter().filter(|case| case.place == place);
    if most { at.max_by_key(|case| case.lights) } else { at.min_by_key(|case| case.lights) }
}

/// About 10 % more: half to twice that. The paper's table D.1 has 13 and 18 % by position.
const SIXTEENFOLD: std::ops::RangeInclusive<f64> = 1.05..=1.2;

/// Shading under all lights against that under a sixteenth of them, from the same place in one of sixteen
/// copies: A and B.
pub(crate) fn sixteenfold(done: &Done, scene: &str) -> Answer {
    let cases = cases(done, scene);
    let (mut tally, mut less) = (Tally::default(), 0);
    for place in ["a", "b"] {
        let ends = [false, true].map(|most| case_of(&cases, place, most));
        let [Some(few), Some(many)] = ends else { continue };
        let (Some(one), Some(all)) = (few.position(), many.position()) else { continue };
        if few.lights == many.lights {
            continue;
        }
        let ratio = all.times.shade_ms / one.times.shade_ms;
        let times = [one, all].map(|record| significant(record.times.shade_ms));
        let name = place.to_uppercase();
        let ratio_text = significant(ratio);
        let figure =
            format!("{name}: shading \u{d7} {ratio_text}, from {} to {} ms", times[0], times[1]);
        tally.add(SIXTEENFOLD.contains(&ratio), figure);
        less += usize::from(ratio < *SIXTEENFOLD.start());
    }
    let all = tally.all;
    let mut answer = tally.answer("cases", "few lights and many from one place");
    if less > 0 {
        answer.verdict = Verdict::Differs(format!("less than 5 % more in {less} of {all} cases"));
    }
    answer
}

/// How many times as long a frame takes in the paper without culling.
const WITHOUT: f64 = 140.0;

/// A frame of no culling over one by `dif`, or by position, under most lights.
pub(crate) fn without(done: &Done, scene: &str) -> Answer {
    let cases = cases(done, scene);
    let most = cases.iter().filter(|case| case.none().is_some());
    let most = most.max_by_key(|case| (case.lights, case.place == "a"));
    let found = most.and_then(|case| {
        let culled = match case.find(|s| s.cut == Cut::Diffuse) {
            Some(dif) => dif,
            None => case.position()?,
        };
        Some((case, case.none()?, culled))
    });
    let Some((case, none, culled)) = found else { return Answer::unknown("no culling") };
    let ratio = none.times.frame_ms / culled.times.frame_ms;
    let figure = format!(
        "{}: a frame \u{d7} {}, {} ms without culling; with {} ms",
        case.name(),
        significant(ratio),
        significant(none.times.frame_ms),
        [setting(&culled.strategy), significant(culled.times.frame_ms)].join(" ")
    );
    Answer { figure, verdict: Verdict::of_parts(usize::from(ratio >= WITHOUT), 1, "cases") }
}

/// Far fragments against near ones under most lights, by position: the paper has 2.5 on the one GPU and 5.1
/// on the other.
pub(crate) fn far(done: &Done, scene: &str) -> Answer {
    let cases = cases(done, scene);
    let position = |place| case_of(&cases, place, true).and_then(Case::position);
    let (Some(near), Some(far)) = (position("a"), position("c")) else {
        return Answer::unknown("near fragments and far ones");
    };
    let ratio = far.times.shade_ms / near.times.shade_ms;
    let times = [near, far].map(|record| significant(record.times.shade_ms));
    let ratio_text = significant(ratio);
    let figure =
        format!("from A to C: shading \u{d7} {ratio_text}, from {} to {} ms", times[0], times[1]);
    Answer { figure, verdict: Verdict::of_parts(usize::from(ratio >= 2.0), 1, "cases") }
}

/// Twice the slices: fewer listed terms, and twice the time to assign.
pub(crate) fn slices(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for case in cases(done, scene) {
        let by_position = |slices| case.find(|s| s.is_position() && s.slices == Some(slices));
        let (Some(half), Some(full)) = (by_position(HALF_SLICES), by_position(PAPER_SLICES)) else {
            continue;
        };
        let (Some(many), Some(few)) = (half.lists.operations, full.lists.operations) else {
            continue;
        };
        let fewer = 1.0 - few.listed() as f64 / many.listed().max(1) as f64;
        let ratio = full.times.assign_ms / half.times.assign_ms;
        let figure = format!(
            "{}: {} % fewer terms, \u{d7} {} to assign",
            case.name(),
            percent(fewer),
            significant(ratio)
        );
        tally.add((0.1..=0.2).contains(&fewer) && (1.7..=2.3).contains(&ratio), figure);
    }
    tally.answer("cases", "12 slices and 24")
}

/// The early exit, which the paper's shading lacks: the gain of cones without a loss, with and without
/// it.
pub(crate) fn early_exit(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for case in cases(done, scene) {
        let record = |cones: Option<u32>, exits: bool| {
            case.find(|s| {
                s.cones == cones && s.cut == Cut::None && s.exits == exits && s.grid == USUAL
            })
        };
        let shares: Option<Vec<f64>> = [true, false]
            .into_iter()
            .map(|exits| {
                Some(record(Some(54), exits)?.times.shade_ms / record(None, exits)?.times.shade_ms)
            })
            .collect();
        let Some(shares) = shares else { continue };
        let figure = format!(
            "{}: 54 cones multiply shading by {} with the early exit and by {} without",
            case.name(),
            significant(shares[0]),
            significant(shares[1])
        );
        let cones = record(Some(54), false).zip(record(None, false));
        let outcome = match cones.map(|(cones, position)| faster(cones, position)) {
            Some(alike @ (Outcome::Tie | Outcome::Unsure)) => alike,
            _ => (shares[1] < shares[0]).into(),
        };
        tally.add(outcome, figure);
    }
    tally.answer("cases", "shading without the early exit")
}

/// Nothing here can answer this claim.
pub(crate) fn thread_per_cluster(_: &Done, _: &str) -> Answer {
    Answer::unknown("one thread per cluster is not built")
}

/// Nothing here can answer this claim.
pub(crate) fn flagless(_: &Done, _: &str) -> Answer {
    Answer::unknown("lists that do not separate their terms are not built")
}

/// The rows of a case, for figures of other claims.
pub(crate) fn shares(rows: &Rows<'_>, of: impl Fn(&Record) -> Option<f64>) -> Vec<(u32, f64)> {
    rows.all_cones().filter_map(|(count, record)| Some((count, of(record)?))).collect()
}
