//! What the engine paper (Dobetsberger 2025) claims of times, and what decides it: the paper times whole
//! frames, so frames decide; shading stands beside them.

use crate::report::format::{percent, significant};
use crate::report::rank::ALIKE;
use crate::results::Record;
use crate::study::area::page::models::{SPOTS, model};
use crate::study::claims::{Answer, Check, Tally, Verdict};
use crate::study::data::entries;
use crate::study::manifest::Done;

/// The record of a model at a number of lights.
pub(crate) fn at<'a>(
    done: &'a Done,
    scene: &'a str,
    wanted: &str,
    lights: u64,
) -> Option<&'a Record> {
    let all = entries(done, scene, "cost");
    let mut records = all.iter().map(|entry| entry.record);
    records.find(|record| model(record) == wanted && record.setting.lights == lights)
}

/// A frame and its shading, ms.
pub(crate) fn time(record: &Record) -> String {
    format!(
        "{} ms (shading {} ms)",
        significant(record.times.frame_ms),
        significant(record.times.shade_ms)
    )
}

/// Says which of two records is faster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Faster {
    First,
    Second,
    /// Their intervals overlap, or they are within half a per cent of each other.
    Tie,
}

/// Compares two records of different jobs by the intervals of their medians, because their frames were
/// not drawn in turn.
pub(crate) fn faster(first: &Record, second: &Record) -> Faster {
    let overlap = match (first.interval_ms(), second.interval_ms()) {
        (Some(a), Some(b)) => a.low <= b.high && b.low <= a.high,
        _ => false,
    };
    let ratio = first.assign_and_shade_ms() / second.assign_and_shade_ms();
    if overlap || (ratio - 1.0).abs() <= ALIKE {
        Faster::Tie
    } else if ratio < 1.0 {
        Faster::First
    } else {
        Faster::Second
    }
}

/// The paper's stochastic algorithm.
fn stochastic(samples: u32) -> String {
    format!("monte-carlo-reflected:{samples}")
}

/// Compares two models at 16 and 64 lights. `judge` makes the figure of a count, and decides whether that
/// count bears the claim out.
pub(crate) fn by_lights(
    done: &Done,
    scene: &str,
    models: [&str; 2],
    judge: impl Fn(&Record, &Record) -> (String, bool),
) -> Answer {
    let mut tally = Tally::default();
    for lights in [16, 64] {
        let [Some(first), Some(second)] = models.map(|model| at(done, scene, model, lights)) else {
            continue;
        };
        let (figure, bears_out) = judge(first, second);
        tally.add(bears_out, format!("{lights} lights: {figure}"));
    }
    tally.answer("counts of lights", &format!("{} at 16 or 64 lights", models.join(" and ")))
}

pub(crate) const ONE_LIGHT: Check = Check {
    id: "one-light",
    place: "section 5.5.3, figure 5.22",
    words: "With one light, MRP is fastest and LTC is second.",
    paper: "MRP is 0.21 ms faster",
    departure: "one stochastic sample is third. MRP is mrp-published, our reading of \
                equation 5.5",
    decide: |done, scene| {
        let record = |name: &str| at(done, scene, name, 1);
        let (Some(mrp), Some(ltc)) = (record("mrp-published"), record("ltc")) else {
            return Answer::unknown("mrp-published and ltc for one light");
        };
        let mut figure = format!("MRP {}, LTC {}", time(mrp), time(ltc));
        let mut parts = vec![faster(mrp, ltc)];
        if let Some(other) = record(&stochastic(1)) {
            figure += &format!(", one stochastic sample {}", time(other));
            parts.push(faster(ltc, other));
        }
        if let Some(own) = record("mrp") {
            figure += &format!("; mrp {}", time(own));
        }
        let good = parts.iter().filter(|part| **part == Faster::First).count();
        Answer { figure, verdict: Verdict::of_parts(good, parts.len(), "places") }
    },
};

/// The counts of lights for which the paper reports a gain, and the least gain that agrees with it.
const GAINS: [(u64, f64); 2] = [(16, 0.2), (64, 0.25)];

pub(crate) const MRP_GAIN: Check = Check {
    id: "mrp-gain",
    place: "section 5.5.3, figure 5.23",
    words: "MRP is about 30 % faster than LTC for 16 lights, and 35 % for 64.",
    paper: "30 and 35 % of the frame",
    departure: "every light shades every pixel. The paper\u{2019}s frames hold less shading and \
                more of everything else. MRP is mrp-published, our reading of equation 5.5",
    decide: |done, scene| {
        let (mut figures, mut parts) = (Vec::new(), Vec::new());
        for (lights, least) in GAINS {
            let record = |name| at(done, scene, name, lights);
            let (Some(mrp), Some(ltc)) = (record("mrp-published"), record("ltc")) else { continue };
            let gain = 1.0 - mrp.times.frame_ms / ltc.times.frame_ms;
            let shading = 1.0 - mrp.times.shade_ms / ltc.times.shade_ms;
            let mut figure = format!(
                "{lights} lights: the frame takes {} % less ({} ms with MRP, {} ms with LTC), \
                 shading {} % less",
                percent(gain),
                significant(mrp.times.frame_ms),
                significant(ltc.times.frame_ms),
                percent(shading)
            );
            if let Some(own) = record("mrp") {
                figure += &format!(
                    ", and with mrp {} % less",
                    percent(1.0 - own.times.shade_ms / ltc.times.shade_ms)
                );
            }
            figures.push(figure);
            parts.push((faster(mrp, ltc), gain >= least));
        }
        if parts.is_empty() {
            return Answer::unknown("mrp-published at 16 or 64 lights");
        }
        let verdict = if parts.iter().all(|(who, is_much)| *who == Faster::First && *is_much) {
            Verdict::Holds
        } else if parts.iter().all(|(who, _)| *who == Faster::First) {
            Verdict::Differs("faster, by less than in the paper".to_owned())
        } else if parts.iter().any(|(who, _)| *who == Faster::First) {
            Verdict::Differs("faster at one of the counts only".to_owned())
        } else {
            Verdict::Fails
        };
        Answer { figure: figures.join("; "), verdict }
    },
};

pub(crate) const ONE_SAMPLE: Check = Check {
    id: "one-sample",
    place: "section 5.5.3",
    words: "The stochastic algorithm is slower than MRP even with one sample.",
    paper: "a figure without numbers",
    departure: "MRP is mrp-published, our reading of equation 5.5",
    decide: |done, scene| {
        by_lights(done, scene, ["mrp-published", &stochastic(1)], |mrp, other| {
            let figure = format!("MRP {}, one stochastic sample {}", time(mrp), time(other));
            (figure, faster(mrp, other) == Faster::First)
        })
    },
};

pub(crate) const LIGHTS_OR_SAMPLES: Check = Check {
    id: "lights-or-samples",
    place: "section 5.5.3",
    words: "Four times the lights cost the stochastic algorithm more than four times the samples.",
    paper: "a figure without numbers",
    departure: "the base is 16 lights with one sample each",
    decide: |done, scene| {
        let record = |samples, lights| at(done, scene, &stochastic(samples), lights);
        let (Some(base), Some(samples), Some(lights)) =
            (record(1, 16), record(4, 16), record(1, 64))
        else {
            return Answer::unknown("1 and 4 samples at 16 lights, 1 at 64");
        };
        let figure = format!(
            "the base: {}; four times the samples: {}; four times the lights: {}",
            time(base),
            time(samples),
            time(lights)
        );
        let verdict = match faster(samples, lights) {
            Faster::First => Verdict::Holds,
            Faster::Tie => Verdict::Differs("a tie".to_owned()),
            Faster::Second => Verdict::Fails,
        };
        Answer { figure, verdict }
    },
};

/// The ratios that count as about twice.
const ABOUT_TWICE: std::ops::RangeInclusive<f64> = 1.5..=2.5;

pub(crate) const SPOTS_RATIO: Check = Check {
    id: "spots",
    place: "section 5.6, figures 5.25 and 5.26",
    words: "Area lights take about twice as long as spots.",
    paper: "about 2, of the frame, at 22 lights and at varying counts",
    departure: "measured with 1, 16 and 64 lights. \u{201c}About twice\u{201d} means 1.5 to 2.5 \
                times. Every light shades every pixel, and neither kind casts shadows",
    decide: |done, scene| {
        by_lights(done, scene, ["ltc", SPOTS], |ltc, spots| {
            let ratio = ltc.times.frame_ms / spots.times.frame_ms;
            let figure = format!(
                "area lights take {} times as long in whole frames, and {} times in shading",
                significant(ratio),
                significant(ltc.times.shade_ms / spots.times.shade_ms)
            );
            (figure, ABOUT_TWICE.contains(&ratio))
        })
    },
};

pub(crate) const FASTER: Check = Check {
    id: "ratings",
    place: "table 7.1",
    words: "MRP is very fast, LTC is fast, and the stochastic algorithm is slow.",
    paper: "ratings without numbers",
    departure: "the stochastic algorithm has 4 samples. MRP is mrp-published, our reading of \
                equation 5.5",
    decide: |done, scene| {
        let record = |name: &str| at(done, scene, name, 64);
        let stochastic = record(&stochastic(4));
        let (Some(mrp), Some(ltc), Some(other)) =
            (record("mrp-published"), record("ltc"), stochastic)
        else {
            return Answer::unknown("the three algorithms at 64 lights");
        };
        let figure =
            format!("64 lights: MRP {}, LTC {}, stochastic {}", time(mrp), time(ltc), time(other));
        let parts = [faster(mrp, ltc), faster(ltc, other)];
        let good = parts.iter().filter(|part| **part == Faster::First).count();
        Answer { figure, verdict: Verdict::of_parts(good, parts.len(), "places") }
    },
};
