//! What the comparison paper (Enhuber 2019) claims, and what decides each claim in one scene.

use super::super::super::fit::Fit;
use super::super::super::format::{number, percent, significant};
use super::super::super::rank::{Ratio, first, ranks};
use super::super::super::raster::MARK;
use super::super::data::{
    Entry, counts, entries, family, is_bvh, is_near, is_of_the_paper, lines, nearest_count, short,
    tests as tests_of,
};
use super::super::path::Spread;
use super::super::scaling::fit;
use super::{Answer, Check, Paper, Verdict};
use crate::results::Record;
use crate::study::Done;

/// Enhuber 2019.
pub(super) const PAPER: Paper = Paper {
    name: "the comparison paper",
    about: "Enhuber 2019 timed these strategies on a GTX 780. Claims are decided by the strategies \
            of that paper and the counts of lights this study has.",
    checks: &CHECKS,
};

const CHECKS: [Check; 7] = [
    Check {
        id: "linear",
        place: "section 4.4.2",
        words: "Time grows linearly with the number of lights.",
        paper: "",
        departure: "",
        decide: linear,
    },
    Check {
        id: "bounds",
        place: "table 4.6",
        words: "Explicit bounds lower the slope and raise the offset.",
        paper: "slope: SC-E lowest, T-E medium, T-I very high; offset: T-I, G and DC-I low, T-E medium, \
                SC-I and SC-E high, because of the depth pre-pass and the bounds",
        departure: "SC-I reads depth too, so both rows of SC pay for the pre-pass. The paper lights hidden \
                    surfaces in spite of its pre-pass; here lighting is deferred.",
        decide: bounds,
    },
    Check {
        id: "many",
        place: "table 4.3",
        words: "SC-E is best at 10,000 lights.",
        paper: "",
        departure: "",
        decide: best_at_many,
    },
    Check {
        id: "few",
        place: "table 4.5",
        words: "DC-I or G is best at 100 lights.",
        paper: "",
        departure: "",
        decide: best_at_few,
    },
    Check {
        id: "tests",
        place: "section 4.3.1",
        words: "HS+SAT-N is the best intersection test.",
        paper: "",
        departure: "",
        decide: tests,
    },
    Check {
        id: "steady",
        place: "table 4.4",
        words: "SC-E depends least on the view.",
        paper: "",
        departure: "",
        decide: steadiness,
    },
    Check {
        id: "models",
        place: "section 4.4",
        words: "M suffers from large models, and dividing them mends it.",
        paper: "",
        departure: "",
        decide: models,
    },
];

/// From this share of the variance explained on, growth is called linear.
const LINEAR: f64 = 0.98;

/// Up to this root mean square of the points' relative distances from the line, too: the greatest
/// counts alone decide the variance.
const ASTRAY: f64 = 0.25;

/// A strategy with the line through its times, of three counts of lights at least.
fn fits<'a>(done: &'a Done, scene: &'a str) -> Vec<(&'a str, Fit, f64)> {
    let scaling: Vec<Entry<'_>> = entries(done, scene, "scaling")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    lines(&scaling)
        .into_iter()
        .filter_map(|(id, records)| {
            let fit = fit(&records, Record::assign_and_shade_ms)?;
            Some((id, fit, astray(&fit, &records)))
        })
        .filter(|(_, fit, _)| fit.points > 2)
        .collect()
}

/// Root mean square of the points' distances from the line, each over its own time.
fn astray(fit: &Fit, records: &[&Record]) -> f64 {
    let off = |record: &&Record| {
        let time = record.assign_and_shade_ms();
        (fit.at(record.lights as f64) / time - 1.0).powi(2)
    };
    (records.iter().map(off).sum::<f64>() / records.len().max(1) as f64).sqrt()
}

/// Linear where the line through each strategy's times explains nearly all of their variance.
fn linear(done: &Done, scene: &str) -> Answer {
    let fits = fits(done, scene);
    let worst = fits.iter().min_by(|a, b| a.1.r2.total_cmp(&b.1.r2));
    let Some((id, worst, _)) = worst else {
        return Answer::unknown("scaling over three counts of lights");
    };
    let is_straight = |fit: &Fit, astray: f64| fit.r2 >= LINEAR && astray <= ASTRAY;
    let good = fits.iter().filter(|(_, fit, astray)| is_straight(fit, *astray)).count();
    let far = fits.iter().map(|(.., astray)| *astray).fold(0.0, f64::max);
    let counts = counts(&entries(done, scene, "scaling"));
    let ends = [counts.first(), counts.last()].map(|end| end.map_or(0.0, |end| *end as f64));
    let figure = format!(
        "straight in {good} of {} strategies, {} to {} lights; least R\u{b2} {id}: {:.3}; points off \
         their line by {} % at most, root mean square",
        fits.len(),
        number(ends[0]),
        number(ends[1]),
        worst.r2,
        percent(far)
    );
    Answer { figure, verdict: Verdict::of_parts(good, fits.len(), "strategies") }
}

/// Explicit against implicit bounds of the same groups from the same source: slope lower, offset
/// higher. Decided as in the paper, where methods that read depth pay for a depth pre-pass; the bill of
/// a renderer that draws one anyway stands beside it.
fn bounds(done: &Done, scene: &str) -> Answer {
    let scaling: Vec<Entry<'_>> = entries(done, scene, "scaling")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    let lines = lines(&scaling);
    let of = |wanted: String, bvh: bool| {
        let (_, records) =
            lines.iter().find(|(id, _)| family(id) == wanted && is_bvh(id) == bvh)?;
        let fit = |time| fit(records, time).filter(|fit: &Fit| fit.points > 2);
        Some((fit(Record::with_depth_ms)?, fit(Record::assign_and_shade_ms)?))
    };
    // The pre-pass rasterises, which some chips do on a few of their processors.
    let is_weak = done.results.values().any(|results| results.machine.weak_raster().is_some());
    let mark = if is_weak { format!(" {MARK}") } else { String::new() };
    let has_depth = scaling.iter().any(|entry| entry.record.passes.get("depth").is_some());
    let (mut figures, mut good, mut all) = (Vec::new(), 0, 0);
    for group in ["T", "DC", "SC"] {
        for bvh in [false, true] {
            let pair = (of(format!("{group}-E"), bvh), of(format!("{group}-I"), bvh));
            let (Some((explicit, explicit_without)), Some((implicit, implicit_without))) = pair
            else {
                continue;
            };
            all += 2;
            good += usize::from(explicit.slope < implicit.slope)
                + usize::from(explicit.offset > implicit.offset);
            figures.push(format!(
                "{group}{}: slope \u{d7} {}, offset {} to {} ms{mark} with the depth pre-pass on the bill, {} to {} without",
                if bvh { "/bvh" } else { "" },
                significant(explicit.slope / implicit.slope),
                significant(implicit.offset),
                significant(explicit.offset),
                significant(implicit_without.offset),
                significant(explicit_without.offset),
            ));
        }
    }
    if all == 0 || !has_depth {
        return Answer::unknown("scaling of explicit and implicit bounds, with the depth pre-pass");
    }
    let verdict = Verdict::of_parts(good, all, "slopes and offsets");
    Answer { figure: figures.join("; "), verdict }
}

/// Whether one of the families leads at a count of lights.
fn best_at(done: &Done, scene: &str, wanted: u64, families: &[&str]) -> Answer {
    let main: Vec<Entry<'_>> = entries(done, scene, "main")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    let Some(count) = nearest_count(&counts(&main), wanted) else {
        return Answer::unknown("the main comparison");
    };
    if !is_near(count, wanted) {
        return Answer::unknown(&format!("measured at {} lights only", number(count as f64)));
    }
    let at_count = main.iter().map(|entry| entry.record).filter(|record| record.lights == count);
    let ranked = ranks(at_count);
    let best = first(&ranked);
    let Some(leader) = best.first() else {
        return Answer::unknown("an exact strategy");
    };
    let is_meant = |record: &Record| families.contains(&family(&record.strategy));
    let time = |record: &Record| {
        format!("{} {} ms", record.strategy, significant(record.assign_and_shade_ms()))
    };
    let mut figure = format!("at {} lights: {}", number(count as f64), time(leader));
    let meant = ranked.iter().find(|ranked| is_meant(ranked.record));
    let verdict = if is_meant(leader) {
        match best.iter().find(|record| !is_meant(record)) {
            Some(other) => {
                figure += &format!(", {}", time(other));
                Verdict::Differs(format!("cannot be told from {}", other.strategy))
            }
            None => Verdict::Holds,
        }
    } else {
        match meant {
            Some(meant) => {
                figure += &format!(", {}", time(meant.record));
                if meant.rank == 1 {
                    Verdict::Differs(format!("cannot be told from {}", leader.strategy))
                } else {
                    Verdict::Fails
                }
            }
            None => Verdict::Unknown(format!("no {}", families.join(" or "))),
        }
    };
    Answer { figure, verdict }
}

/// SC-E at 10,000 lights, or as many as there are.
fn best_at_many(done: &Done, scene: &str) -> Answer {
    best_at(done, scene, 10_000, &["SC-E"])
}

/// DC-I or G at 100 lights.
fn best_at_few(done: &Done, scene: &str) -> Answer {
    best_at(done, scene, 100, &["DC-I", "G"])
}

/// HS+SAT-N leads in each family, or cannot be told from what leads.
fn tests(done: &Done, scene: &str) -> Answer {
    const BEST: &str = "hs+sat-n";
    let all = entries(done, scene, "tests");
    let mut families: Vec<&str> = Vec::new();
    for entry in &all {
        if !families.contains(&family(&entry.record.strategy)) {
            families.push(family(&entry.record.strategy));
        }
    }
    let (mut figures, mut good, mut decided) = (Vec::new(), 0, 0);
    for name in families {
        let own = || all.iter().map(|entry| entry.record).filter(|r| family(&r.strategy) == name);
        let meant = own().find(|record| tests_of(record) == Some(BEST));
        let ranked = ranks(own());
        let best = first(&ranked);
        let Some(meant) = meant.filter(|_| !best.is_empty()) else { continue };
        decided += 1;
        good += usize::from(best.iter().any(|record| std::ptr::eq(*record, meant)));
        let said = |record: &Record| {
            let union = tests_of(record).unwrap_or("none").to_uppercase();
            format!("{union} {} ms", significant(record.assign_and_shade_ms()))
        };
        let others = || ranked.iter().map(|r| r.record).filter(|r| !std::ptr::eq(*r, meant));
        let fastest = others()
            .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
            .map_or_else(String::new, |other| format!(", the fastest other {}", said(other)));
        figures.push(format!("{name}: {}{fastest}", said(meant)));
    }
    if decided == 0 {
        return Answer::unknown("intersection tests");
    }
    Answer { figure: figures.join("; "), verdict: Verdict::of_parts(good, decided, "families") }
}

/// SC-E has the least relative deviation along the path, and the least worst frame over the median.
fn steadiness(done: &Done, scene: &str) -> Answer {
    let path: Vec<Entry<'_>> = entries(done, scene, "path")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    let Some(count) = nearest_count(&counts(&path), 10_000) else {
        return Answer::unknown("frames along the path");
    };
    if !is_near(count, 10_000) {
        return Answer::unknown(&format!("measured at {} lights only", number(count as f64)));
    }
    let spreads: Vec<(&str, Spread)> = path
        .iter()
        .filter(|entry| entry.record.lights == count)
        .filter_map(|entry| Some((entry.record.strategy.as_str(), Spread::of(entry.record)?)))
        .collect();
    let Some((_, own)) = spreads.iter().find(|(id, _)| family(id) == "SC-E") else {
        return Answer::unknown("SC-E along the path");
    };
    let least = |of: fn(&Spread) -> f64| {
        spreads.iter().min_by(|a, b| of(&a.1).total_cmp(&of(&b.1))).map_or("", |(id, _)| id)
    };
    let (deviation, worst) = (least(|s| s.relative), least(|s| s.worst_over_median));
    let figure = format!(
        "at {} lights SC-E: SD / mean {} %, worst / median {}; least SD / mean {}, least worst / median {}",
        number(count as f64),
        percent(own.relative),
        significant(own.worst_over_median),
        short(deviation),
        short(worst)
    );
    let good = [deviation, worst].iter().filter(|id| family(id) == "SC-E").count();
    Answer { figure, verdict: Verdict::of_parts(good, 2, "measures") }
}

/// The lists of parts are shorter than those of models, and the time is less.
fn models(done: &Done, scene: &str) -> Answer {
    let main = entries(done, scene, "main");
    let Some(count) = nearest_count(&counts(&main), 10_000) else {
        return Answer::unknown("the main comparison");
    };
    let of = |name: &str| {
        let own = |entry: &&Entry<'_>| {
            let id = &entry.record.strategy;
            entry.record.lights == count && short(id) == name && !is_bvh(id)
        };
        main.iter().find(own).map(|entry| entry.record)
    };
    let (Some(whole), Some(parts)) = (of("M"), of("M/2")) else {
        return Answer::unknown("M and M/2");
    };
    let (Some(long), Some(listed)) = (whole.listed_per_sample, parts.listed_per_sample) else {
        return Answer::unknown("lengths of lists");
    };
    let times = [whole, parts].map(Record::assign_and_shade_ms);
    let figure = format!(
        "at {} lights, M to M/2: {} to {} listed per sample, {} to {} ms (shade {} to {} ms)",
        number(count as f64),
        significant(long),
        significant(listed),
        significant(times[0]),
        significant(times[1]),
        significant(whole.shade_ms),
        significant(parts.shade_ms)
    );
    let is_faster = Ratio::of(parts, whole).is_some_and(|ratio| ratio.is_faster());
    let verdict = match (listed < long, is_faster) {
        (true, true) => Verdict::Holds,
        (true, false) => Verdict::Differs("lists are shorter, but the whole takes longer".into()),
        (false, true) => Verdict::Differs("the whole is faster, but lists are no shorter".into()),
        (false, false) => Verdict::Fails,
    };
    Answer { figure, verdict }
}
