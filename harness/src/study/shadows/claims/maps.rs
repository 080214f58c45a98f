//! Claims on errors: the number of maps, their size and their filter.

use crate::report::format::{difference, number};
use crate::report::rank::listed;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Check, Outcome, Tally, Verdict};
use crate::study::data::entries;
use crate::study::manifest::Done;
use crate::study::shadows::cells::{
    METRIC, Maps, Step, atlases, error, fell_back, least, maps, steps,
};
use crate::study::shadows::jobs::TAPS;

/// `25 maps of 112\u{b2} 0.0331`, of each step.
fn told(steps: &[Step]) -> String {
    let one = |(maps, error): &Step| {
        let count = if maps.maps == 1 { "1 map".to_owned() } else { format!("{} maps", maps.maps) };
        format!("{count} of {}\u{b2} {}", number(f64::from(maps.px)), difference(*error))
    };
    steps.iter().map(one).collect::<Vec<_>>().join(", ")
}

pub(crate) const TURN: Check = Check {
    id: "turn",
    place: "section 6.2, figure 6.5",
    words: "In one atlas, more maps lessen the error up to a point and raise it beyond.",
    paper: "LPIPS turns at 81 maps in 8192\u{b2} texels and at 25 in 2048\u{b2}",
    departure: "judged by FLIP: the least error must be below that of the fewest and of the most maps",
    decide: |done, scene| {
        let mut tally = Tally::default();
        for atlas in atlases(done, scene) {
            let steps = steps(done, scene, atlas);
            let best = least(&steps);
            let ([first, _, .., last], Some(from), Some(to)) =
                (&steps[..], best.first(), best.last())
            else {
                continue;
            };
            let outcome = match () {
                () if from.0 != first.0 && to.0 != last.0 => Outcome::Good,
                () if best.len() == 1 => Outcome::Bad,
                () => Outcome::Tie,
            };
            tally.add(outcome, format!("FLIP in {atlas}\u{b2}: {}", told(&steps)));
        }
        tally.answer("atlases", "three numbers of maps in one atlas")
    },
};

/// Judges where the error in an atlas is least. Both neighbours of the number must be measured.
fn least_at(done: &Done, scene: &str, atlas: u32, wanted: u32) -> Answer {
    let steps = steps(done, scene, atlas);
    let counts: Vec<u32> = steps.iter().map(|(maps, _)| maps.maps).collect();
    let known = shading::MAP_COUNTS.windows(3).find(|around| around[1] == wanted);
    if !known.is_some_and(|around| around.iter().all(|count| counts.contains(count))) {
        return Answer::unknown(&format!(
            "{wanted} maps and their neighbours in an atlas of {atlas}\u{b2}"
        ));
    }
    let best = least(&steps);
    let (here, others): (Vec<Step>, Vec<Step>) =
        best.iter().partition(|(maps, _)| maps.maps == wanted);
    let verdict = match (here.is_empty(), others.is_empty()) {
        (true, _) => Verdict::Fails,
        (false, true) => Verdict::Holds,
        (false, false) => {
            let others: Vec<String> =
                others.iter().map(|(maps, _)| maps.maps.to_string()).collect();
            Verdict::Differs(format!("a tie of {wanted} with {}", listed(&others)))
        }
    };
    Answer { figure: format!("FLIP: {}", told(&steps)), verdict }
}

pub(crate) const LARGE_ATLAS: Check = Check {
    id: "least-8192",
    place: "section 6.2",
    words: "In an atlas of 8192\u{b2} texels, the error is least with 81 maps.",
    paper: "mean LPIPS, about 0.071",
    departure: "judged by FLIP",
    decide: |done, scene| least_at(done, scene, 8192, 81),
};

pub(crate) const SMALL_ATLAS: Check = Check {
    id: "least-2048",
    place: "section 6.2",
    words: "In an atlas of 2048\u{b2} texels, the error is least with 25 maps.",
    paper: "mean LPIPS, without a number",
    departure: "judged by FLIP",
    decide: |done, scene| least_at(done, scene, 2048, 25),
};

/// Below this side, the paper gains nothing, texels.
const SMALLEST_PX: u32 = 256;

pub(crate) const BELOW: Check = Check {
    id: "below-256",
    place: "section 6.2",
    words: "More maps do not help once a map is smaller than 256\u{b2} texels.",
    paper: "read from the turning points of both atlases",
    departure: "judged by FLIP, at each step to more maps that makes them smaller than 256\u{b2}. A map of ours has \
                three times the texels of a tile of that side",
    decide: |done, scene| {
        let mut tally = Tally::default();
        for atlas in atlases(done, scene) {
            for pair in steps(done, scene, atlas).windows(2) {
                let [before, after] = pair else { continue };
                if after.0.px >= SMALLEST_PX {
                    continue;
                }
                let outcome = match Order::of_figures(after.1, before.1) {
                    Order::Less => Outcome::Bad,
                    Order::More => Outcome::Good,
                    Order::Tie | Order::Unsure => Outcome::Tie,
                };
                let [from, to] = [before, after].map(|step| told(&[*step]));
                tally.add(outcome, format!("FLIP in {atlas}\u{b2}: from {from} to {to}"));
            }
        }
        tally.answer("steps", "steps to maps below 256\u{b2} in one atlas")
    },
};

pub(crate) const FILTER: Check = Check {
    id: "filter",
    place: "section 6.1, figure 6.4",
    words: "Percentage-closer filtering greatly reduces the number of maps that soft shadows need.",
    paper: "pictures only, with 4 maps and a kernel of size 32",
    departure: "judged by FLIP: some filter must lessen the error at the same number of maps. At most 25 texels are \
                compared",
    decide: |done, scene| {
        let all = entries(done, scene, TAPS);
        let known: Vec<(Maps, f64)> = all
            .iter()
            .filter(|entry| !fell_back(entry.record))
            .filter_map(|entry| Some((maps(entry.record)?, error(entry.record, METRIC)?)))
            .collect();
        let mut tally = Tally::default();
        for (plain, without) in known.iter().filter(|(maps, _)| maps.taps == 1) {
            let is_alike = |maps: &Maps| maps.maps == plain.maps && maps.px == plain.px;
            let filtered = known.iter().filter(|(maps, _)| maps.taps > 1 && is_alike(maps));
            let Some((best, with)) = filtered.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
            let outcome = match Order::of_figures(*with, *without) {
                Order::Less => Outcome::Good,
                Order::More => Outcome::Bad,
                Order::Tie | Order::Unsure => Outcome::Tie,
            };
            let [with, without] = [*with, *without].map(difference);
            tally.add(
                outcome,
                format!(
                    "{} maps: FLIP {without} without a filter, {with} with {} taps",
                    plain.maps, best.taps
                ),
            );
        }
        tally.answer("numbers of maps", "maps with and without a filter")
    },
};
