//! What Van Oosten 2017 claims of lights that move.

use super::jobs::DENSITY;
use super::page::density::{PUBLISHED, hierarchy_ms};
use crate::report::finding::lights;
use crate::report::format::{percent, significant};
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Check, Paper, Tally, on_another_gpu};
use crate::study::data::{counts, entries};
use crate::study::manifest::Done;

/// Van Oosten 2017.
pub(crate) const PAPER: Paper = Paper {
    name: "the thesis on volume tiles",
    about: "Van Oosten 2017 (Volume Tiled Forward Shading, Utrecht University) timed clusters with a hierarchy \
            over the lights on a GTX TITAN X, in Sponza at 1920x1080, from a still camera, mean over at least \
            500 frames, with at most one light per cubic unit. The GPU sorts the lights and builds the hierarchy \
            in every frame. Our jobs at that density decide.",
    checks: &CHECKS,
};

const CHECKS: [Check; 3] = [
    Check {
        id: "volume-tiles-hierarchy",
        place: "results, techniques compared",
        words: "At a constant density, a hierarchy that is made in every frame is faster than the plain list.",
        paper: "200,000 lights: 4.33 ms a frame with it; without it 54.6 ms (tiles) and 64.7 ms (volume tiles)",
        departure: "we compare assign + shade; tiles with explicit bounds read the plain list",
        decide: hierarchy,
    },
    Check {
        id: "volume-tiles-sort",
        place: "results, Sponza with a hierarchy",
        words: "With a million lights or more, sorting them and building the hierarchy takes most of the frame.",
        paper: "1,000,000 lights: 6.53 of 9.50 ms; 4,000,000: 27.7 of 32.0 ms",
        departure: "the share of assign + shade in the fastest method that reads the hierarchy. Our frame also \
                    draws a G-buffer, which would lower the share",
        decide: sort,
    },
    Check {
        id: "volume-tiles-rate",
        place: "results, Sponza with a hierarchy",
        words: "200,000 lights take 4.3 ms a frame, 1,000,000 take 9.5 and 4,000,000 take 32.",
        paper: "4.327, 9.501 and 32.037 ms on a GTX TITAN X",
        departure: "decided on the thesis\u{2019}s GPU only. The claim holds from half to twice the figure",
        decide: rate,
    },
];

/// The thesis's GPU.
const GPU: &str = "TITAN X";

/// The least number of lights of the claim on sorting.
const MANY: u64 = 1_000_000;

/// Half to twice a figure.
const ABOUT: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// The records at the thesis's density: by number of lights, those that read the hierarchy and those that read
/// the plain list.
fn fastest<'a>(done: &'a Done, scene: &'a str) -> Vec<(u64, [Option<&'a Record>; 2])> {
    let all = entries(done, scene, DENSITY);
    let of_count = |count: u64| {
        let of_source = |bvh: bool| {
            let here = all.iter().map(|entry| entry.record).filter(|r| r.setting.lights == count);
            here.filter(|r| r.is_exact() && r.strategy.is_bvh() == bvh)
                .filter(|r| bvh || reads_list(r))
                .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
        };
        (count, [true, false].map(of_source))
    };
    counts(&all).into_iter().map(of_count).collect()
}

/// Whether a method could read the hierarchy and reads the plain list.
fn reads_list(record: &Record) -> bool {
    let row = record.strategy.row();
    row.is_some_and(|row| row.has_axis(crate::strategy::Axis::Source)) && !record.strategy.is_bvh()
}

fn timed(record: &Record) -> String {
    format!("{} {} ms", record.strategy, significant(record.assign_and_shade_ms()))
}

/// The hierarchy, made in every frame, against the plain list at each number of lights.
fn hierarchy(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for (count, found) in fastest(done, scene) {
        let [Some(hierarchy), Some(list)] = found else { continue };
        let figure = format!("{}: {}, {}", lights(count), timed(hierarchy), timed(list));
        tally.add(Order::of_times(hierarchy, list), figure);
    }
    tally.answer("numbers of lights", "both sources of lights at one light per cubic metre")
}

/// The share of sorting and boxing in assign + shade, from a million lights on.
fn sort(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for (count, [hierarchy, _]) in fastest(done, scene) {
        let Some(record) = hierarchy.filter(|_| count >= MANY) else { continue };
        let (part, whole) = (hierarchy_ms(record), record.assign_and_shade_ms());
        let figure = format!(
            "{}: {} ms of {}, {} %",
            lights(count),
            significant(part),
            timed(record),
            percent(part / whole)
        );
        tally.add(part > 0.5 * whole, figure);
    }
    tally.answer("numbers of lights", "a million lights at one light per cubic metre")
}

/// The frame of the fastest method beside that of the thesis, on its GPU.
fn rate(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for (count, [hierarchy, _]) in fastest(done, scene) {
        let published = PUBLISHED.iter().find(|published| published.lights == count);
        let (Some(record), Some(published)) = (hierarchy, published) else { continue };
        let figure = format!(
            "{}: a frame of {} {} ms, the thesis {} ms",
            lights(count),
            record.strategy,
            significant(record.times.frame_ms),
            significant(published.frame)
        );
        tally.add(ABOUT.contains(&(record.times.frame_ms / published.frame)), figure);
    }
    let is_measured = tally.all > 0;
    let mut answer = tally.answer("numbers of lights", "the thesis\u{2019}s numbers of lights");
    if let Some(verdict) = on_another_gpu(done, GPU).filter(|_| is_measured) {
        answer.verdict = verdict;
    }
    answer
}
