//! Claims on lights that frames subdivide. A frame's time is what it would be if the light moved: drawing all maps, the
//! test for bands, and shading.

use crate::report::format::{number, significant};
use crate::results::{Record, mean};
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Check, Tally, Verdict, on_another_gpu};
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::shadows::cells::{adaptive, distance_m, fell_back, maps, moving_ms, on_software};
use crate::study::shadows::jobs::APPROACH;

use super::SOFTWARE;

/// The paper's GPU.
const GPU: &str = "RTX 3070";

/// The paper's choice: the test looks at one pixel in so many along each axis.
const DOWN: u32 = 8;

const MISSING: &str = "adaptive and fixed maps at the same distances";

/// Jobs along the approach.
fn approach<'a>(
    done: &'a Done,
    scene: &'a str,
    is_wanted: impl Fn(&Record) -> bool,
) -> Vec<Entry<'a>> {
    let mut all = entries(done, scene, APPROACH);
    all.retain(|entry| !fell_back(entry.record) && is_wanted(entry.record));
    all
}

fn is_tested_at(record: &Record, down: u32) -> bool {
    adaptive(record).is_some_and(|adaptive| adaptive.down == down)
}

pub(crate) const COST: Check = Check {
    id: "adaptive-cost",
    place: "section 6.4",
    words: "With a test at an eighth of the viewport, the test takes 3 to 4 ms in a frame, and drawing the maps about 3 ms.",
    paper: "3 to 4 ms, and about 3 ms, on an RTX 3070 at 1920\u{d7}1080",
    departure: "the paper draws the scene once more for each quad. Here one pass reads the G-buffer for all quads. Its time \
                is that of a settled view",
    decide: |done, scene| {
        /// The paper's times, ms; about 3 is 2 to 4.
        const TEST_MS: std::ops::RangeInclusive<f64> = 3.0..=4.0;
        const DRAW_MS: std::ops::RangeInclusive<f64> = 2.0..=4.0;
        if on_software(done) {
            return Answer::undecided(SOFTWARE);
        }
        let times = |entry: &Entry<'_>| {
            let draw_ms = entry.record.setting.shadows.as_ref()?.draw_ms?;
            Some((adaptive(entry.record)?.banding_ms?, draw_ms))
        };
        let found = approach(done, scene, |record| is_tested_at(record, DOWN));
        let (tests, draws): (Vec<f64>, Vec<f64>) = found.iter().filter_map(times).unzip();
        if tests.is_empty() {
            return Answer::unknown("tests at an eighth of the viewport");
        }
        let (test_ms, draw_ms) = (mean(&tests), mean(&draws));
        let figure = format!(
            "{} ms to test and {} ms to draw, on average over {} distances",
            significant(test_ms),
            significant(draw_ms),
            tests.len()
        );
        let good = [TEST_MS.contains(&test_ms), DRAW_MS.contains(&draw_ms)];
        let good = good.into_iter().filter(|is_good| *is_good).count();
        let verdict = on_another_gpu(done, GPU);
        Answer { figure, verdict: verdict.unwrap_or_else(|| Verdict::of_parts(good, 2, "times")) }
    },
};

pub(crate) const RESOLUTION: Check = Check {
    id: "adaptive-resolution",
    place: "section 6.4, figure 6.7",
    words: "The fewer pixels are tested, the faster is the frame.",
    paper: "frame rates at full resolution down to a sixteenth",
    departure: "judged at each distance and each step to fewer pixels, by the time of a frame whose light moves",
    decide: |done, scene| {
        if on_software(done) {
            return Answer::undecided(SOFTWARE);
        }
        let found = approach(done, scene, |record| adaptive(record).is_some());
        let mut times: Vec<(f64, u32, f64)> = found
            .iter()
            .filter_map(|entry| {
                Some((distance_m(entry)?, adaptive(entry.record)?.down, moving_ms(entry.record)?))
            })
            .collect();
        times.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut tally = Tally::default();
        for pair in times.windows(2) {
            let [(distance, down, ms), (next_distance, next, next_ms)] = *pair else { continue };
            if distance != next_distance {
                continue;
            }
            let figure = format!(
                "at {} m: {} ms at 1/{down}, {} ms at 1/{next}",
                significant(distance),
                significant(ms),
                significant(next_ms)
            );
            tally.add(Order::of_figures(next_ms, ms), figure);
        }
        tally.answer("steps", "tests at two resolutions from one distance")
    },
};

pub(crate) const ADAPTIVE: Check = Check {
    id: "adaptive",
    place: "section 6.4, figure 6.8",
    words: "On average over an approach to the light, subdivision is slower than 25 fixed maps and faster than 81.",
    paper: "frame rates, with a test at an eighth of the viewport and at most 64 maps",
    departure: "three distances instead of an animation, and the time of a frame whose light moves: drawing all maps, the \
                test, and shading. All maps have the same side; the paper\u{2019}s 81 are smaller",
    decide: |done, scene| {
        if on_software(done) {
            return Answer::undecided(SOFTWARE);
        }
        let mean_ms = |is_wanted: &dyn Fn(&Record) -> bool| {
            let found = approach(done, scene, is_wanted);
            let times: Vec<f64> =
                found.iter().filter_map(|entry| moving_ms(entry.record)).collect();
            (times.len(), mean(&times))
        };
        let (stops, subdivided) = mean_ms(&|record| is_tested_at(record, DOWN));
        let fixed = [25, 81]
            .map(|count| mean_ms(&|record| maps(record).is_some_and(|maps| maps.maps == count)));
        if stops == 0 || fixed.iter().any(|(count, _)| *count != stops) {
            return Answer::unknown(MISSING);
        }
        let [few, many] = fixed.map(|(_, ms)| ms);
        let mut tally = Tally::default();
        let figure = format!("{} ms, 25 maps {} ms", significant(subdivided), significant(few));
        tally.add(Order::of_figures(few, subdivided), figure);
        tally.add(Order::of_figures(subdivided, many), format!("81 maps {} ms", significant(many)));
        let mut answer = tally.answer("comparisons", MISSING);
        answer.figure += &format!(" on average over {} distances", number(stops as f64));
        answer
    },
};
