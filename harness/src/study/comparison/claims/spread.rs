//! Claims on how times vary along the path: table 4.4 and figure 4.8.

use crate::report::format::{number, percent, significant};
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::claims::field::{chain_verdict, count_near};
use crate::study::comparison::claims::members::Members;
use crate::study::comparison::claims::pairs::{ALIKE, Pairs};
use crate::study::comparison::page::path::Spread;
use crate::study::data::{Entry, entries, is_of_the_paper, stand};
use crate::study::manifest::Done;

/// The strategies of table 4.4; the paper leaves DC-E out of it.
const COMPARED: [&str; 7] = ["SC-E", "SC-I", "T-E", "DC-I", "G", "T-I", "M"];

/// How each strategy's times vary along the path.
type Spreads<'a> = Members<'a, Spread>;

fn spreads<'a>(done: &'a Done, scene: &'a str) -> Result<Spreads<'a>, Answer> {
    let path: Vec<Entry<'_>> = entries(done, scene, "path")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    let lights = count_near(&path, 10_000, "times along the path")?;
    let chosen = || path.iter().map(|entry| entry.record).filter(|r| r.setting.lights == lights);
    let all = chosen().filter_map(|r| Some((&r.strategy, Spread::measure(r)?))).collect();
    let most = chosen().max_by_key(|record| record.times.frames);
    let basis = most.map_or_else(String::new, |record| {
        format!("at {} lights, {}", number(lights as f64), stand(record))
    });
    Ok(Members::new(basis, all))
}

/// The paper's statistic first, the others beside it.
fn figure(spreads: &Spreads<'_>, names: &[&str]) -> String {
    format!(
        "{}; SD: {} ms; SD / mean: {} %; slowest pose / median pose: {}",
        spreads.basis,
        spreads.ascending(names, |spread| spread.deviation, significant),
        spreads.ascending(names, |spread| spread.relative, percent),
        spreads.ascending(names, |spread| spread.worst_over_median, significant),
    )
}

/// Decides by the order of standard deviations.
fn by_deviation(done: &Done, scene: &str, chain: &[&[&str]]) -> Answer {
    let spreads = match spreads(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let pairs = spreads.pairs(chain, Spread::compare);
    let names: Vec<&str> =
        COMPARED.into_iter().filter(|name| chain.iter().any(|g| g.contains(name))).collect();
    let figure = figure(&spreads, &names) + &pairs.exceptions();
    Answer { figure, verdict: chain_verdict(chain, &pairs) }
}

/// SC-E has the least standard deviation.
pub(crate) fn steadiest(done: &Done, scene: &str) -> Answer {
    by_deviation(done, scene, &[&["SC-E"], &COMPARED[1..]])
}

/// The groups of table 4.4 by standard deviation.
pub(crate) fn groups(done: &Done, scene: &str) -> Answer {
    by_deviation(done, scene, &[&["SC-E", "SC-I"], &["T-E", "DC-I", "G"], &["T-I", "M"]])
}

/// Explicit bounds vary less than implicit ones, by both of the paper's statistics.
pub(crate) fn explicit_is_steadier(done: &Done, scene: &str) -> Answer {
    let spreads = match spreads(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let mut pairs = Pairs::default();
    for [explicit, implicit] in [["T-E", "T-I"], ["SC-E", "SC-I"]] {
        let member = |name: &str| spreads.member(name);
        let relative =
            |less: &Spread, more: &Spread| Order::of_figures(less.relative, more.relative);
        let names = [explicit, implicit];
        pairs.compare(names, member, |less, more| spreads.order(less, more, Spread::compare));
        pairs.compare(names, member, |less, more| spreads.order(less, more, relative));
    }
    let names = ["T-E", "T-I", "SC-E", "SC-I"];
    let figure = figure(&spreads, &names) + &pairs.exceptions();
    Answer { figure, verdict: pairs.verdict() }
}

/// The standard deviations of G and DC-I are alike.
pub(crate) fn grid_like_dense(done: &Done, scene: &str) -> Answer {
    let spreads = match spreads(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let (Some(grid), Some(dense)) = (spreads.get("G"), spreads.get("DC-I")) else {
        return Answer::unknown("G and DC-I along the path");
    };
    let ratio = (grid.deviation / dense.deviation).max(dense.deviation / grid.deviation);
    let verdict = match spreads.stand_in(&["G"]) {
        Some(what) => Verdict::Differs(format!("with {what}")),
        None if ratio <= ALIKE => Verdict::Holds,
        None => Verdict::Fails,
    };
    let figure = format!(
        "{}; the SDs are a factor of {} apart",
        figure(&spreads, &["G", "DC-I"]),
        significant(ratio)
    );
    Answer { figure, verdict }
}
