//! What times decide: the mean frame along the path.

use crate::report::fit::Fit;
use crate::report::format::{number, percent, significant};
use crate::results::Record;
use crate::strategy::Role;
use crate::study::claims::on_another_gpu;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Tally, Verdict};
use crate::study::culling::claims::modes::{
    Mode, bounding_sphere, capped, none, of_the_survey, raster_sphere, timed,
};
use crate::study::data::{entries, lines};
use crate::study::manifest::Done;

/// Points off their line by no more than this share of the growth, root mean square, are on it.
const ASTRAY: f64 = 0.05;

/// Growth below this share of the frame is noise.
const LEVEL: f64 = 0.01;

/// What share is left where the cost of lights is cut nearly in half.
const HALF: std::ops::RangeInclusive<f64> = 0.4..=0.6;

/// Up to this share of another's frame is a great difference.
const GREAT: f64 = 0.5;

/// The frame of the paper's clusters at the most lights, ms.
const FRAME_MS: f64 = 10.0;

/// Half to twice the paper's frame: what a figure of one digit covers.
const ABOUT: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// The paper's GPU.
const GPU: &str = "RTX 3080";

/// Each method's frames lie on a line, in each renderer.
pub(crate) fn linear(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let all = entries(done, scene, mode.name);
        let (mut straight, mut count, mut worst) = (0, 0, (0.0, ""));
        for (id, records) in
            lines(&all).into_iter().filter(|(id, _)| id.role() != Some(Role::Control))
        {
            let points: Vec<(f64, f64)> = records
                .iter()
                .map(|record| (record.setting.lights as f64, record.times.frame_ms))
                .collect();
            let Some(fit) = Fit::through(&points).filter(|fit| fit.points > 2) else { continue };
            let growth = fit.slope.abs() * mode.most() as f64;
            let off = fit.residual / growth.max(LEVEL * fit.offset);
            tally.count(off <= ASTRAY);
            straight += usize::from(off <= ASTRAY);
            count += 1;
            if off >= worst.0 {
                worst = (off, id.as_str());
            }
        }
        if count > 0 {
            tally.figures.push(format!(
                "{}: the times of {straight} of {count} methods lie on a line, at {} counts from 0 \
                 to {} lights. {} is farthest off its line, by {} % of its growth",
                mode.name,
                mode.counts.len(),
                number(mode.most() as f64),
                worst.1,
                percent(worst.0)
            ));
        }
    }
    tally.answer("methods", "three counts of lights")
}

/// No method is faster than the control, at any count.
pub(crate) fn clay(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        for &lights in &mode.counts {
            let Some(clay) = mode.at(lights, Record::is_control) else { continue };
            let others =
                mode.records.iter().filter(|r| r.setting.lights == lights && !r.is_control());
            let Some(least) = others.min_by(|a, b| a.times.frame_ms.total_cmp(&b.times.frame_ms))
            else {
                continue;
            };
            tally.count(!is_below(least, clay));
            if lights == mode.most() {
                let figure = format!("{}, {} lights", mode.name, number(lights as f64));
                tally.figures.push(format!("{figure}: {}, {}", timed(clay), timed(least)));
            }
        }
    }
    tally.answer("counts of lights", "the control")
}

/// Whether a frame is shorter than the control's. Their passes differ, so laps cannot pair them.
fn is_below(record: &Record, clay: &Record) -> bool {
    record.times.frame_ms < clay.times.frame_ms * (1.0 - LEVEL)
}

/// No other method is as slow as no culling, at the most lights.
pub(crate) fn slowest(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let Some(none) = mode.last(none) else { continue };
        let others =
            mode.records.iter().copied().filter(|r| r.setting.lights == none.setting.lights);
        let next = others
            .filter(|r| !r.is_baseline() && !r.is_control())
            .max_by(|a, b| a.times.frame_ms.total_cmp(&b.times.frame_ms));
        let Some(next) = next else { continue };
        let figure = format!("{}: {}, {}", mode.name, timed(none), timed(next));
        tally.add(Order::of_frames(next, none), figure);
    }
    tally.answer("renderers", "no culling")
}

/// No method of the survey is slower than no culling, at any count of lights.
pub(crate) fn gain(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        for lights in mode.lit() {
            let Some(none) = mode.at(lights, none) else { continue };
            let culling =
                mode.records.iter().filter(|r| r.setting.lights == lights && of_the_survey(r));
            for record in culling {
                // No longer than no culling: a tie holds as well.
                let order = match Order::of_frames(record, none) {
                    Order::Tie => Order::Less,
                    order => order,
                };
                tally.count(order);
                if order != Order::Less {
                    let figure = format!("{}, {} lights", mode.name, number(lights as f64));
                    tally.figures.push(format!("{figure}: {}, {}", timed(record), timed(none)));
                }
            }
        }
    }
    if tally.figures.is_empty() {
        tally.figures.push(format!("{} of {} rows", tally.good, tally.all));
    }
    tally.answer("rows", "methods that cull")
}

/// The share of the cost of lights that the bounding sphere leaves, in each renderer.
pub(crate) fn sphere(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let growths = mode.growth(bounding_sphere).zip(mode.growth(none));
        let Some((own, all)) = growths.filter(|(_, all)| *all > 0.0) else { continue };
        let share = own / all;
        let figure = format!(
            "{}: lights cost {} ms with the bounding sphere and {} ms without culling: {} % is left",
            mode.name,
            significant(own),
            significant(all),
            percent(share)
        );
        tally.add(HALF.contains(&share), figure);
    }
    tally.answer("renderers", "frames without a light")
}

/// The raster sphere is slower than the bounding sphere and faster than no culling.
pub(crate) fn raster(done: &Done, scene: &str) -> Answer {
    for mode in Mode::all(done, scene) {
        let rows = (mode.last(raster_sphere), mode.last(bounding_sphere), mode.last(none));
        let (Some(raster), Some(sphere), Some(none)) = rows else { continue };
        let few = || Verdict::Differs("too few laps for so small a difference".to_owned());
        let verdict = match (Order::of_frames(raster, none), Order::of_frames(sphere, raster)) {
            (Order::Tie | Order::More, _) => Verdict::Differs("it gains nothing".to_owned()),
            (Order::Unsure, _) | (_, Order::Unsure) => few(),
            (Order::Less, Order::Less) => Verdict::Holds,
            (Order::Less, Order::More) => Verdict::Fails,
            (Order::Less, Order::Tie) => Verdict::Differs("a tie".to_owned()),
        };
        let figure =
            format!("{}: {}, {}, {}", mode.name, timed(raster), timed(sphere), timed(none));
        return Answer { figure, verdict };
    }
    Answer::unknown("the raster sphere")
}

/// Deferred against forward lighting. A GPU that runs fragments on a few processors cannot tell.
pub(crate) fn deferred(done: &Done, scene: &str) -> Answer {
    let modes = Mode::all(done, scene);
    let [deferred, forward] = modes.as_slice() else { return Answer::unknown("both renderers") };
    let mut tally = Tally::default();
    for is_it in [none, bounding_sphere] as [fn(&Record) -> bool; 2] {
        let lights = deferred.most().min(forward.most());
        let pair = deferred.at(lights, is_it).zip(forward.at(lights, is_it));
        let Some((own, other)) = pair else { continue };
        let figure = format!(
            "{}: deferred {} ms, forward {} ms",
            own.strategy,
            significant(own.times.frame_ms),
            significant(other.times.frame_ms)
        );
        // Renderers run in jobs of their own: their rounds are not pairs.
        tally.add(Order::of_figures(own.times.frame_ms, other.times.frame_ms), figure);
    }
    let mut answer = tally.answer("methods", "no culling in both renderers");
    if done.results.values().any(|results| results.machine.weak_raster().is_some()) {
        let why =
            "this GPU runs fragment shaders, and so forward lighting, on a few of its processors";
        answer.verdict = Verdict::undecided(why);
    }
    answer
}

/// The paper's clusters take at most half of the frame of every other method of the survey.
pub(crate) fn clusters(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let Some(own) = mode.last(capped) else { continue };
        let others = [none, bounding_sphere, raster_sphere] as [fn(&Record) -> bool; 3];
        let others = others.into_iter().filter_map(|is_it| mode.last(is_it));
        let Some(next) = others.min_by(|a, b| a.times.frame_ms.total_cmp(&b.times.frame_ms)) else {
            continue;
        };
        let figure = format!("{}: {}, {}", mode.name, timed(own), timed(next));
        tally.add(own.times.frame_ms <= GREAT * next.times.frame_ms, figure);
    }
    tally.answer("renderers", "clusters with the paper\u{2019}s cap")
}

/// The paper's clusters draw a frame of the most lights in about the paper's time, on its GPU.
pub(crate) fn rate(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for mode in Mode::all(done, scene) {
        let Some(own) = mode.last(capped) else { continue };
        let figure = format!(
            "{}: {}, {} lights; the paper {FRAME_MS} ms",
            mode.name,
            timed(own),
            number(own.setting.lights as f64)
        );
        tally.add(ABOUT.contains(&(own.times.frame_ms / FRAME_MS)), figure);
    }
    let is_measured = tally.all > 0;
    let mut answer = tally.answer("renderers", "clusters with the paper\u{2019}s cap");
    if let Some(verdict) = on_another_gpu(done, GPU).filter(|_| is_measured) {
        answer.verdict = verdict;
    }
    answer
}
