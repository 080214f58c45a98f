//! Claims on how times vary along the path: table 4.4 and figure 4.8.

use super::super::super::super::format::{number, percent, significant};
use super::super::super::data::{
    Entry, counts, entries, family, is_near, is_of_the_paper, nearest_count, stand,
};
use super::super::super::order::Order;
use super::super::super::path::Spread;
use super::super::{Answer, Verdict};
use super::ALIKE;
use super::field::Pairs;
use crate::study::Done;

/// The strategies of table 4.4; the paper leaves DC-E out of it.
const COMPARED: [&str; 7] = ["SC-E", "SC-I", "T-E", "DC-I", "G", "T-I", "M"];

/// How each strategy's times vary along the path.
struct Spreads<'a> {
    basis: String,
    all: Vec<(&'a str, Spread)>,
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
            let why = format!("measured at {} lights only", number(lights as f64));
            return Err(Answer::unknown(&why));
        }
        let own = || path.iter().map(|entry| entry.record).filter(|r| r.lights == lights);
        let all = own().filter_map(|r| Some((family(&r.strategy), Spread::of(r)?))).collect();
        let most = own().max_by_key(|record| record.frames);
        let basis = most.map_or_else(String::new, |record| {
            format!("at {} lights, {}", number(lights as f64), stand(record))
        });
        Ok(Self { basis, all })
    }

    fn of(&self, name: &str) -> Option<&Spread> {
        self.all.iter().find(|(family, _)| *family == name).map(|(_, spread)| spread)
    }

    /// `SD G 0.007, SC-E 0.01 ms`: the strategies that are there by a figure, least first.
    fn ascending(&self, names: &[&str], of: fn(&Spread) -> f64, show: fn(f64) -> String) -> String {
        let mut all: Vec<(&str, f64)> =
            names.iter().filter_map(|name| Some((*name, of(self.of(name)?)))).collect();
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
    let pairs = Pairs::of_chain(chain, |less, more| spreads.order(less, more));
    let names: Vec<&str> =
        COMPARED.into_iter().filter(|name| chain.iter().any(|g| g.contains(name))).collect();
    let is_leader = matches!(chain, [[_], _]);
    let verdict = if is_leader { pairs.leader_verdict() } else { pairs.verdict() };
    Answer { figure: spreads.figure(&names) + &pairs.exceptions(), verdict }
}

/// SC-E has the least standard deviation.
pub(super) fn steadiest(done: &Done, scene: &str) -> Answer {
    by_deviation(done, scene, &[&["SC-E"], &COMPARED[1..]])
}

/// The groups of table 4.4 by standard deviation.
pub(super) fn groups(done: &Done, scene: &str) -> Answer {
    by_deviation(done, scene, &[&["SC-E", "SC-I"], &["T-E", "DC-I", "G"], &["T-I", "M"]])
}

/// Explicit bounds vary less than implicit ones, by both of the paper's statistics.
pub(super) fn explicit_is_steadier(done: &Done, scene: &str) -> Answer {
    let spreads = match Spreads::at(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let mut pairs = Pairs::default();
    for [explicit, implicit] in [["T-E", "T-I"], ["SC-E", "SC-I"]] {
        let (Some(less), Some(more)) = (spreads.of(explicit), spreads.of(implicit)) else {
            continue;
        };
        pairs.add(&format!("{explicit} (SD)"), implicit, less.compare(more));
        let relative = Order::of_figures(less.relative, more.relative);
        pairs.add(&format!("{explicit} (SD / mean)"), implicit, relative);
    }
    let names = ["T-E", "T-I", "SC-E", "SC-I"];
    Answer { figure: spreads.figure(&names) + &pairs.exceptions(), verdict: pairs.verdict() }
}

/// The standard deviations of G and DC-I are alike.
pub(super) fn grid_like_dense(done: &Done, scene: &str) -> Answer {
    let spreads = match Spreads::at(done, scene) {
        Ok(spreads) => spreads,
        Err(answer) => return answer,
    };
    let (Some(grid), Some(dense)) = (spreads.of("G"), spreads.of("DC-I")) else {
        return Answer::unknown("G and DC-I along the path");
    };
    let ratio = (grid.deviation / dense.deviation).max(dense.deviation / grid.deviation);
    let verdict = if ratio <= ALIKE { Verdict::Holds } else { Verdict::Fails };
    let figure =
        format!("{}; a factor of {} apart", spreads.figure(&["G", "DC-I"]), significant(ratio));
    Answer { figure, verdict }
}
