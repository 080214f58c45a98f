//! Claims on how times vary along the path: table 4.4 and figure 4.8.

use crate::report::format::{number, percent, significant};
use crate::strategy::StrategyId;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::claims::pairs::{ALIKE, Member, Pairs};
use crate::study::comparison::page::path::Spread;
use crate::study::data::{Entry, counts, entries, is_near, is_of_the_paper, nearest_count, stand};
use crate::study::manifest::Done;

/// The strategies of table 4.4; the paper leaves DC-E out of it.
const COMPARED: [&str; 7] = ["SC-E", "SC-I", "T-E", "DC-I", "G", "T-I", "M"];

/// How each strategy's times vary along the path.
struct Spreads<'a> {
    basis: String,
    all: Vec<(&'a StrategyId, Spread)>,
}

impl<'a> Spreads<'a> {
    fn at(done: &'a Done, scene: &'a str) -> Result<Self, Answer> {
        let path: Vec<Entry<'_>> = entries(done, scene, "path")
            .into_iter()
            .filter(|entry| is_of_the_paper(entry.record))
            .collect();
        let Some(lights) = nearest_count(&counts(&path), 10_000) else {
            return Err(Answer::unknown("times along the path"));
        };
        if !is_near(lights, 10_000) {
            let why = format!("only {} lights were measured", number(lights as f64));
            return Err(Answer::undecided(&why));
        }
        let own = || path.iter().map(|entry| entry.record).filter(|r| r.setting.lights == lights);
        let mut all: Vec<(&StrategyId, Spread)> =
            own().filter_map(|r| Some((&r.strategy, Spread::of(r)?))).collect();
        // The paper's own strategy comes before what stands in for it.
        all.sort_by_key(|(id, _)| id.stand_in().is_some());
        let most = own().max_by_key(|record| record.times.frames);
        let basis = most.map_or_else(String::new, |record| {
            format!("at {} lights, {}", number(lights as f64), stand(record))
        });
        Ok(Self { basis, all })
    }

    fn of_family(&self, name: &str) -> Option<&(&'a StrategyId, Spread)> {
        self.all.iter().find(|(id, _)| id.family() == name)
    }

    fn of(&self, name: &str) -> Option<&Spread> {
        self.of_family(name).map(|(_, spread)| spread)
    }

    fn member(&self, name: &str) -> Member {
        Member::of(self.of_family(name).map(|(id, _)| *id))
    }

    /// `SD G 0.007, SC-E 0.01 ms`: the strategies that are there by a figure, least first.
    fn ascending(&self, names: &[&str], of: fn(&Spread) -> f64, show: fn(f64) -> String) -> String {
        let own = names.iter().filter_map(|name| self.of_family(name));
        let mut all: Vec<(String, f64)> =
            own.map(|(id, spread)| (id.short(), of(spread))).collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let said = all.iter().map(|(name, figure)| format!("{name} {}", show(*figure)));
        said.collect::<Vec<_>>().join(", ")
    }

    /// The paper's statistic first, the others beside it.
    fn figure(&self, names: &[&str]) -> String {
        format!(
            "{}: SD {} ms; SD / mean {} %; worst / median {}",
            self.basis,
            self.ascending(names, |spread| spread.deviation, significant),
            self.ascending(names, |spread| spread.relative, percent),
            self.ascending(names, |spread| spread.worst_over_median, significant),
        )
    }

    fn order(&self, less: &str, more: &str) -> Option<Order> {
        Some(self.of(less)?.compare(self.of(more)?))
    }
}

/// Decides by the order of standard deviations.
fn by_deviation(done: &Done, scene: &str, chain: &[&[&str]]) -> Answer {
    let spreads = match Spreads::at(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let order = |less: &str, more: &str| spreads.order(less, more);
    let pairs = Pairs::of_chain(chain, |name| spreads.member(name), order);
    let names: Vec<&str> =
        COMPARED.into_iter().filter(|name| chain.iter().any(|g| g.contains(name))).collect();
    let is_leader = matches!(chain, [[_], _]);
    let verdict = if is_leader { pairs.leader_verdict() } else { pairs.verdict() };
    Answer { figure: spreads.figure(&names) + &pairs.exceptions(), verdict }
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
    let spreads = match Spreads::at(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let mut pairs = Pairs::default();
    for [explicit, implicit] in [["T-E", "T-I"], ["SC-E", "SC-I"]] {
        let member = |name: &str| spreads.member(name);
        let relative = |less: &str, more: &str| {
            let [less, more] = [spreads.of(less)?, spreads.of(more)?];
            Some(Order::of_figures(less.relative, more.relative))
        };
        pairs.compare([explicit, implicit], member, |less, more| spreads.order(less, more));
        pairs.compare([explicit, implicit], member, relative);
    }
    let names = ["T-E", "T-I", "SC-E", "SC-I"];
    Answer { figure: spreads.figure(&names) + &pairs.exceptions(), verdict: pairs.verdict() }
}

/// The standard deviations of G and DC-I are alike.
pub(crate) fn grid_like_dense(done: &Done, scene: &str) -> Answer {
    let spreads = match Spreads::at(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let (Some(grid), Some(dense)) = (spreads.of("G"), spreads.of("DC-I")) else {
        return Answer::unknown("G and DC-I along the path");
    };
    let ratio = (grid.deviation / dense.deviation).max(dense.deviation / grid.deviation);
    let verdict = match spreads.of_family("G").and_then(|(id, _)| id.stand_in()) {
        Some(what) => Verdict::Differs(format!("with {what}")),
        None if ratio <= ALIKE => Verdict::Holds,
        None => Verdict::Fails,
    };
    let figure =
        format!("{}; a factor of {} apart", spreads.figure(&["G", "DC-I"]), significant(ratio));
    Answer { figure, verdict }
}
