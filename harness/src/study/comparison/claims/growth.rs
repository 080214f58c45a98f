//! Claims on times against the number of lights: figure 4.13 and table 4.6.

use crate::report::fit::Fit;
use crate::report::format::{number, percent, significant};
use crate::report::rank::listed;
use crate::results::Record;
use crate::strategy::StrategyId;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::claims::members::Members;
use crate::study::comparison::claims::pairs::{ALIKE, Pairs};
use crate::study::comparison::page::scaling::{Straight, straight};
use crate::study::data::{Entry, Line, entries, is_of_the_paper, lines, means, poses};
use crate::study::manifest::Done;
use crate::study::page::lines::{Time, fit};

/// The counts of lights between which the paper fits its lines.
const RANGE: [u64; 2] = [100, 10_000];

/// The records of the paper's strategies over counts of lights, within the paper's range.
fn grown<'a>(done: &'a Done, scene: &'a str, most: u64) -> Vec<Line<'a>> {
    let scaling: Vec<Entry<'_>> = entries(done, scene, "scaling")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record) && entry.record.setting.lights <= most)
        .collect();
    let mut lines = lines(&scaling);
    lines.retain(|(_, records)| records.len() > 2);
    // The paper's own strategy comes before what stands in for it.
    lines.sort_by_key(|(id, _)| id.stand_in().is_some());
    lines
}

fn basis(lines: &[Line<'_>]) -> String {
    let records = || lines.iter().flat_map(|(_, records)| records.iter());
    let low = records().map(|record| record.setting.lights).min().unwrap_or(0);
    let high = records().map(|record| record.setting.lights).max().unwrap_or(0);
    let means = records().max_by_key(|record| poses(record)).map_or_else(String::new, |r| means(r));
    let [low, high] = [low, high].map(|count| number(count as f64));
    format!("lines fitted to the times from {low} to {high} lights ({means})")
}

/// Straight where the best line misses no time of the paper's range by more than a tenth. Both fits are
/// of that range; how far the line goes on beyond it is said beside them.
pub(crate) fn linear(done: &Done, scene: &str) -> Answer {
    let lines = grown(done, scene, u64::MAX);
    let paper = grown(done, scene, RANGE[1]);
    let (mut good, mut all, mut figures) = (0, 0, Vec::new());
    for (id, records) in &paper {
        let Some(within) = straight(records, Record::assign_and_shade_ms) else { continue };
        all += 1;
        good += usize::from(within.holds());
        let beyond = lines.iter().find(|(known, _)| known == id);
        let whole = beyond.and_then(|(_, all)| straight(all, Record::assign_and_shade_ms));
        figures.push(straightness(id, &within, whole, records));
    }
    if all == 0 {
        return Answer::unknown("scaling over four counts of lights");
    }
    let figure = format!("{}; {}", basis(&paper), figures.join("; "));
    Answer { figure, verdict: Verdict::of_parts(good, all, "strategies") }
}

/// `T-I: at most 9.0 % off the fitted line, at 1,000 lights (off the plain least-squares line: 9.8 %, at 100
/// lights). The times are linear from 100 to 30,000 lights`. Both distances are of `records`, those of the
/// paper's range.
fn straightness(
    id: &StrategyId,
    within: &Straight,
    whole: Option<Straight>,
    records: &[&Record],
) -> String {
    let mut text = format!(
        "{}: at most {} % off the fitted line, at {} lights",
        id.short(),
        percent(within.worst),
        number(within.at as f64)
    );
    if let Some(plain) = fit(records, Record::assign_and_shade_ms) {
        let points: Vec<(f64, f64)> =
            records.iter().map(|r| (r.setting.lights as f64, r.assign_and_shade_ms())).collect();
        let (off, at) = plain.worst(&points);
        let off = percent(off);
        text += &format!(" (off the plain least-squares line: {off} %, at {} lights)", number(at));
    }
    match whole.or(Some(*within)).and_then(|whole| whole.range) {
        Some([low, high]) => {
            let [low, high] = [low, high].map(|count| number(count as f64));
            text += &format!(". The times are linear from {low} to {high} lights");
        }
        None => text += ". The times are not linear over any four counts of lights",
    }
    text
}

/// The time of each strategy that a claim is about, as a line.
type Slopes<'a> = Members<'a, Fit>;

fn fit_lines<'a>(done: &'a Done, scene: &'a str, time: Time) -> Result<Slopes<'a>, Answer> {
    let lines = grown(done, scene, RANGE[1]);
    let all: Vec<(&StrategyId, Fit)> =
        lines.iter().filter_map(|(id, records)| Some((*id, fit(records, time)?))).collect();
    match all.is_empty() {
        true => Err(Answer::unknown("scaling over three counts of lights")),
        false => Ok(Members::new(basis(&lines), all)),
    }
}

/// The lines of assignment and those of shading.
fn fit_both<'a>(done: &'a Done, scene: &'a str) -> Result<[Slopes<'a>; 2], Answer> {
    let assign = fit_lines(done, scene, |record| record.times.assign_ms)?;
    Ok([assign, fit_lines(done, scene, |record| record.times.shade_ms)?])
}

/// Decides by the order of slopes or offsets.
fn ordered(slopes: &Slopes<'_>, chain: &[&[&str]], figure: fn(&Fit) -> f64) -> Pairs {
    slopes.pairs(chain, |less, more| Order::of_fits(figure(less), figure(more)))
}

/// Decides by the order of a figure of the lines through assign + shade.
fn by_order(
    done: &Done,
    scene: &str,
    what: &str,
    chain: &[&[&str]],
    figure: fn(&Fit) -> f64,
) -> Answer {
    let slopes = match fit_lines(done, scene, Record::assign_and_shade_ms) {
        Ok(slopes) => slopes,
        Err(answer) => return answer,
    };
    let pairs = ordered(&slopes, chain, figure);
    let known = slopes.ascending(&chain.concat(), figure, significant);
    let figure = format!("{}; {what}: {known}{}", slopes.basis, pairs.exceptions());
    Answer { figure, verdict: pairs.verdict() }
}

fn slope(fit: &Fit) -> f64 {
    fit.slope * 1e6
}

fn offset(fit: &Fit) -> f64 {
    fit.offset
}

/// The groups of table 4.6 by the slope of all stages.
pub(crate) fn slopes(done: &Done, scene: &str) -> Answer {
    let chain: [&[&str]; 5] = [&["SC-E", "SC-I"], &["T-E"], &["DC-I", "G"], &["T-I"], &["M"]];
    by_order(done, scene, "slopes in \u{b5}s per 1,000 lights", &chain, slope)
}

/// The groups of table 4.6 by the offset of all stages.
pub(crate) fn offsets(done: &Done, scene: &str) -> Answer {
    let chain: [&[&str]; 3] = [&["M", "T-I", "G", "DC-I"], &["T-E"], &["SC-I", "SC-E"]];
    by_order(done, scene, "offsets in ms", &chain, offset)
}

/// Shading grows faster than assignment, in each strategy.
pub(crate) fn shading_dominates(done: &Done, scene: &str) -> Answer {
    let [assign, shade] = match fit_both(done, scene) {
        Ok(both) => both,
        Err(answer) => return answer,
    };
    let (mut pairs, mut figures, mut faster) = (Pairs::default(), Vec::new(), Vec::new());
    for (id, of_assign) in &assign.all {
        let Some((_, of_shade)) = shade.all.iter().find(|(known, _)| known == id) else { continue };
        let name = id.short();
        let order = Order::of_fits(of_assign.slope, of_shade.slope);
        pairs.add("assignment", "shading", order);
        if order == Order::More {
            faster.push(format!("{name}\u{2019}s"));
        }
        let both = [of_assign, of_shade].map(|fit| significant(slope(fit)));
        figures.push(format!("{name} {} and {}", both[0], both[1]));
    }
    let figure = format!(
        "{}; slopes of assign and of shade in \u{b5}s per 1,000 lights: {}{}",
        assign.basis,
        figures.join(", "),
        match faster.is_empty() {
            true => String::new(),
            false => format!("; {} assignment grows faster than its shading", listed(&faster)),
        }
    );
    Answer { figure, verdict: pairs.verdict() }
}

/// M assigns with the least slope and shades with the greatest.
pub(crate) fn model_slopes(done: &Done, scene: &str) -> Answer {
    let [assign, shade] = match fit_both(done, scene) {
        Ok(both) => both,
        Err(answer) => return answer,
    };
    if assign.get("M").is_none() {
        return Answer::unknown("M over three counts of lights");
    }
    let others = ["SC-E", "SC-I", "T-E", "T-I", "G", "DC-I"];
    let less = ordered(&assign, &[&["M"], &others], slope);
    let more = ordered(&shade, &[&others, &["M"]], slope);
    let verdict = match (less.leader_verdict(), more.leader_verdict()) {
        (Verdict::Fails, Verdict::Fails) => Verdict::Fails,
        (_, Verdict::Fails) => {
            Verdict::Differs("M does not have the greatest slope of shading".to_owned())
        }
        (Verdict::Fails, _) => {
            Verdict::Differs("M does not have the least slope of assignment".to_owned())
        }
        (Verdict::Holds, other) | (other, _) => other,
    };
    let names = [&["M"][..], &others].concat();
    let figure = format!(
        "{}; slopes of assign in \u{b5}s per 1,000 lights: {}; slopes of shade: {}",
        assign.basis,
        assign.ascending(&names, slope, significant),
        shade.ascending(&names, slope, significant)
    );
    Answer { figure, verdict }
}

/// The slopes and the offsets of DC-I and G are alike.
pub(crate) fn grid_like_dense(done: &Done, scene: &str) -> Answer {
    let slopes = match fit_lines(done, scene, Record::assign_and_shade_ms) {
        Ok(slopes) => slopes,
        Err(answer) => return answer,
    };
    let (Some(dense), Some(grid)) = (slopes.get("DC-I"), slopes.get("G")) else {
        return Answer::unknown("DC-I and G over three counts of lights");
    };
    let apart = |of: fn(&Fit) -> f64| (of(dense) / of(grid)).max(of(grid) / of(dense));
    let good = [slope as fn(&Fit) -> f64, offset].into_iter().filter(|of| {
        let apart = apart(*of);
        apart > 0.0 && apart <= ALIKE
    });
    let names = ["DC-I", "G"];
    let verdict = match slopes.stand_in(&names) {
        Some(what) => Verdict::Differs(format!("with {what}")),
        None => Verdict::of_parts(good.count(), 2, "measures"),
    };
    let figure = format!(
        "{}; slopes: {} \u{b5}s per 1,000 lights; offsets: {} ms",
        slopes.basis,
        slopes.ascending(&names, slope, significant),
        slopes.ascending(&names, offset, significant)
    );
    Answer { figure, verdict }
}
